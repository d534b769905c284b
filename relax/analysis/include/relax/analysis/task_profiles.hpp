#ifndef RELAX_ANALYSIS_TASK_PROFILES_HPP
#define RELAX_ANALYSIS_TASK_PROFILES_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "relax/base/bits.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/on_demand.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/problem/literal.hpp"

namespace relax {

// A set of literals, as bits.
class Literals {
public:
    explicit Literals(std::size_t fact_count = 0) : words_(words_for(2 * fact_count), 0) {}

    bool contains(Literal literal) const { return has_bit(words_, literal); }
    void insert(Literal literal) { set_bit(words_, literal); }
    void erase(Literal literal) { clear_bit(words_, literal); }
    void clear() { std::ranges::fill(words_, 0); }
    void insert_all(const Literals& others) { unite(words_, others.words_); }

private:
    std::vector<std::uint64_t> words_;
};

// What executing a task may have to do with the state, whichever of its decompositions is chosen.
struct TaskProfile {
    // What some action reads: its preconditions, and the conditions of its effects and of its cost, each with its
    // negation.
    Literals reads;
    // What some action may make true.
    Literals makes;
    // What the action makes false whatever the state is; nothing for a compound task.
    Literals undoes;
    // For an action and a chance task: its preconditions, and the same as `reads` and `makes`.
    std::vector<Literal> preconditions;
    std::vector<Literal> read_list;
    std::vector<Literal> made_list;

    static TaskProfile empty(const GroundProblem& problem) {
        const Literals none(problem.fact_count());
        return {none, none, none, {}, {}, {}};
    }
};

// The profiles of tasks, each made when it is first asked for, also by several threads.
class TaskProfiles {
public:
    explicit TaskProfiles(const GroundProblem& problem) : problem_(problem), profiles_(problem.task_count()) {}

    // Throws Stopped.
    const TaskProfile& of(TaskId task, Limits& limits) const;

private:
    TaskProfile of_action(ActionId action) const;
    TaskProfile of_chance(TaskId task, Limits& limits) const;
    TaskProfile of_compound(TaskId task, Limits& limits) const;

    const GroundProblem& problem_;
    std::vector<OnDemand<TaskProfile>> profiles_;  // by TaskId
};

}  // namespace relax

#endif
