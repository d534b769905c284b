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

using MacroId = std::uint32_t;

// Sequences of actions as one action: what it needs before and what it has changed after. Sequences that need and
// change the same are the same macro-action, whatever they cost. No state that can be reached tells them apart.
class MacroActions {
public:
    static constexpr MacroId kNothing = 0;  // the empty sequence, and all that need and change nothing

    MacroActions(const AnalysedProblem& problem, Limits& limits);  // throws Stopped

    // Whether an action can be part of one: neither its effects nor its cost have conditions.
    bool fits(ActionId action) const;

    // The macro-action of the action and then those of another one; nothing where they can never be executed so.
    std::optional<MacroId> prepend(ActionId action, MacroId rest);

private:
    // Both sorted; what is changed does not hold before for certain.
    struct Macro {
        std::vector<Literal> needed;
        std::vector<Literal> made;
        bool operator==(const Macro&) const = default;
    };
    static constexpr MacroId kImpossible = static_cast<MacroId>(-1);

    Macro of_action(ActionId action) const;
    MacroId compose(ActionId action, MacroId rest);
    bool contradicts(Literal one, Literal other) const;
    MacroId intern(Macro macro);
    static std::uint64_t hash(const Macro& macro);

    const GroundProblem& problem_;
    const Mutexes& mutexes_;
    std::vector<Macro> macros_;  // by MacroId
    IdTable table_;
    std::unordered_map<std::uint64_t, MacroId> composed_;  // by the pair of action and rest
};

}  // namespace relax

#endif
