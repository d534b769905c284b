#ifndef RELAX_NETWORKS_MACRO_ACTIONS_HPP
#define RELAX_NETWORKS_MACRO_ACTIONS_HPP

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/analysis/mutexes.hpp"
#include "relax/analysis/task_profiles.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

using MacroId = Id<struct MacroTag>;

// Sequences of actions without conditional effects as one action each: the literals that it needs before, and those
// that it has made true after. Sequences that need and make the same literals are the same macro-action, whatever they
// cost.
//
// (1) A sequence can be executed in a state that can be reached only if all that is needed holds there, and then it
//     can: an action that needs what an earlier one has made false, or literals needed together of which two never
//     hold together (Mutexes), make the sequence impossible.
// (2) In such a state, executing it makes true exactly `made`. Literals that hold before anyway are left out: those
//     that are needed, and those whose negation never holds together with one that is needed.
//
// By induction on the length of the sequence, where a literal that an action needs is needed of the sequence unless an
// earlier action makes it, and of two that make a fact and its negation the later one counts. Where the mutexes were
// used, (2) claims something of states that cannot be reached, which does no harm. Hence two sequences with the same
// macro-action can be executed in the same states that can be reached, and lead to the same states.
class MacroActions {
public:
    static constexpr MacroId kNothing{0};  // the empty sequence, and all that need and make nothing

    MacroActions(const AnalysedProblem& problem, Limits& limits);  // throws Stopped

    // Whether an action can be part of one: neither its effects nor its cost have conditions.
    bool fits(ActionId action) const;

    // The macro-action of the action and then another one; nothing where that is impossible.
    std::optional<MacroId> prepend(ActionId action, MacroId rest);

private:
    // Both sorted; what is made does not hold before for certain.
    struct Macro {
        std::vector<Literal> needed;
        std::vector<Literal> made;
        bool operator==(const Macro&) const = default;
    };
    static constexpr MacroId kImpossible{std::numeric_limits<std::uint32_t>::max()};

    Macro of_action(ActionId action) const;
    MacroId compose(ActionId action, MacroId rest);
    bool contradicts(Literal one, Literal other) const;
    MacroId intern(Macro macro);
    static std::uint64_t hash(const Macro& macro);

    const GroundProblem& problem_;
    const Mutexes& mutexes_;
    std::vector<Macro> macros_;  // by MacroId
    IdTable<MacroId> table_;
    std::unordered_map<std::uint64_t, MacroId> composed_;  // by the pair of action and rest
};

}  // namespace relax

#endif
