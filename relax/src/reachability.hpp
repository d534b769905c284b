#ifndef RELAX_REACHABILITY_HPP
#define RELAX_REACHABILITY_HPP

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "relation.hpp"
#include "relax/lifted_problem.hpp"
#include "relax/limits.hpp"
#include "rule.hpp"

namespace relax {

// Thrown inside the grounder when a limit is reached.
struct GroundingStopped {
    StopReason reason;
};

// An instance of a lifted task: its number (actions first), and its tuple in the task's relation.
struct TaskInstance {
    std::uint32_t task;
    TupleId tuple;
    bool operator==(const TaskInstance&) const = default;
};

struct MethodInstance {
    std::uint32_t schema;
    TaskInstance task;
    std::vector<ObjectId> arguments;
    std::vector<TaskInstance> subtasks;
};

// Relaxed reachability: which facts, actions and tasks there can be at all, if nothing that became true ever becomes
// false and every task that can be accomplished somewhere can be accomplished anywhere. First bottom-up over facts,
// actions and tasks (as a semi-naive evaluation of rules: every new tuple is joined with what is there), then top-down
// from the initial task, where the methods' instances are made.
class Reachability {
public:
    Reachability(const LiftedProblem& problem, Limits& limits);

    void run();

    const LiftedProblem& problem() const { return problem_; }
    const Domains& domains() const { return domains_; }
    bool is_static(std::uint32_t predicate) const { return !is_added_[predicate] && !is_deleted_[predicate]; }
    const Relation& facts(std::uint32_t predicate) const { return relations_[predicate]; }
    const Relation& instances(std::uint32_t task) const { return relations_[problem_.predicate_count + task]; }
    // By fluent predicate: how many of its tuples are facts of the initial state; they come first.
    std::size_t initial_count(std::uint32_t predicate) const { return initial_count_[predicate]; }
    // What is needed by the initial task, in the order in which it was found. Empty if the initial task is out of
    // reach.
    const std::vector<TaskInstance>& needed() const { return needed_; }
    const std::vector<MethodInstance>& methods() const { return methods_; }

    void check_limits();

private:
    struct Trigger {
        std::size_t rule;
        std::size_t atom;
        JoinPlan plan;
    };
    // A rule makes tasks of one kind from an action's precondition or a method's subtasks.
    struct TaskRule {
        Rule rule;
        std::uint32_t schema;
        bool is_method;
        std::vector<Term> head;
        std::vector<const Formula*> residual;  // conditions on facts that are not conjunctions of atoms
        Binding start;                         // irrelevant parameters are bound from the start
        bool can_fire = true;
    };

    void find_static_predicates();
    void add_initial_state();
    void add_action_rule(std::uint32_t schema);
    void add_method_rule(std::uint32_t schema);
    void add_condition(TaskRule& rule, const Formula& formula);
    void bind_irrelevant(TaskRule& rule);
    void make_triggers();
    void saturate();
    void show_new_tuples();
    void fire(std::size_t rule, std::span<const ObjectId> binding);
    bool try_action(std::uint32_t schema, TupleId candidate);
    bool apply_effects(std::uint32_t schema, std::span<const ObjectId> arguments);
    void expand(TaskInstance instance);
    void need(const TaskInstance& instance);

    bool has_fluent(const Formula& formula) const;
    // Over-approximates the truth of a formula under a binding; exact where it reads no fluents.
    bool is_possible(const Formula& formula, Binding& binding, bool negated) const;

    const LiftedProblem& problem_;
    Limits& limits_;
    Domains domains_;
    std::vector<bool> is_added_;       // by predicate
    std::vector<bool> is_deleted_;     // by predicate
    std::vector<Relation> relations_;  // predicates, then tasks
    std::vector<std::size_t> initial_count_;
    std::deque<TaskRule> rules_;                       // actions, then methods; a deque, since plans point into it
    std::vector<std::vector<Trigger>> triggers_;       // by relation
    std::vector<Relation> candidates_;                 // by action: instances whose joins succeed
    std::vector<TaskInstance> waiting_;                // candidates whose other conditions are not yet possible
    std::vector<TaskInstance> unfinished_;             // actions some of whose conditional effects are not yet possible
    std::vector<std::vector<JoinPlan>> method_plans_;  // by method: one plan, given the task's arguments
    std::vector<std::vector<std::uint32_t>> methods_of_;  // by compound task
    std::vector<std::vector<bool>> is_needed_;            // by task, by tuple
    std::vector<TaskInstance> needed_;
    std::vector<MethodInstance> methods_;
};

// The slots of the free variables of a formula, each once.
std::vector<std::uint32_t> free_slots(const Formula& formula);

// Call `visit` with every binding of the variables from their domains; a false answer ends it and is returned.
template <typename Visitor>
bool for_all_objects(std::span<const LiftedVariable> variables, const Domains& domains, std::span<ObjectId> binding,
                     Visitor visit) {
    if (variables.empty()) {
        return visit();
    }
    for (const ObjectId object : domains.objects(variables.front().domain)) {
        binding[variables.front().slot] = object;
        if (!for_all_objects(variables.subspan(1), domains, binding, visit)) {
            return false;
        }
    }
    return true;
}

}  // namespace relax

#endif
