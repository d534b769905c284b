#ifndef RELAX_PROGRESSION_FIRST_ACTIONS_HPP
#define RELAX_PROGRESSION_FIRST_ACTIONS_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/rows.hpp"
#include "relax/problem/state.hpp"

namespace relax {

// The actions that come before all other subtasks of their methods (one of its outcomes where it has several). A method
// is dead in a state in which its task comes next and this action is not applicable.
//
// A task may have thousands of methods, such as "any action of the domain, and again". They are grouped by a fact that
// their first actions need, the one that the fewest of the task's methods need, so that a state is asked for facts and
// not for methods. That is done when the task is first met: most tasks never are.
class FirstActions {
public:
    // `in_sequence`: subtasks without an order come in the order that is chosen for them. Throws Stopped.
    FirstActions(const AnalysedProblem& problem, bool in_sequence, Limits& limits);

    // None where it depends on what comes before it.
    std::optional<ActionId> operator[](MethodId method) const { return actions_[method]; }
    // Append the methods of a compound task that are not dead if it comes next, in their order.
    void add_live(TaskId task, std::span<const std::uint64_t> state, std::vector<MethodId>& live);

private:
    static constexpr std::size_t kFew = 16;  // methods that are looked at one by one
    static constexpr std::uint32_t kUngrouped = static_cast<std::uint32_t>(-1);

    struct Group {
        std::optional<FactId> needed;
        std::vector<MethodId> methods;
    };

    bool is_live(MethodId method, std::span<const std::uint64_t> state) const {
        return !actions_[method] || transition_.is_applicable(*actions_[method], state);
    }
    std::vector<Group> grouped(std::span<const MethodId> methods);

    const GroundProblem& problem_;
    StateTransition transition_;
    std::vector<std::optional<ActionId>> actions_;  // by MethodId
    std::vector<std::uint32_t> groups_of_;          // by compound task, if it has many methods: its place below
    std::vector<std::vector<Group>> groups_;
    std::vector<std::uint32_t> needs_;  // by fact, while groups are made: how many methods need it
};

}  // namespace relax

#endif
