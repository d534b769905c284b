#include "relax/networks/macro_actions.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace relax {

namespace {

bool has(const std::vector<Literal>& sorted, Literal literal) {
    assert(std::ranges::is_sorted(sorted));
    return std::ranges::binary_search(sorted, literal);
}

void put(std::vector<Literal>& sorted, Literal literal) {
    const auto at = std::ranges::lower_bound(sorted, literal);
    if (at == sorted.end() || *at != literal) {
        sorted.insert(at, literal);
    }
}

}  // namespace

MacroActions::MacroActions(const AnalysedProblem& problem, Limits& limits)
    : problem_(problem), mutexes_(problem.mutexes(limits)) {
    intern({});
}

bool MacroActions::fits(ActionId action) const {
    if (!problem_.cost_parts[action].empty()) {
        return false;
    }
    for (const EffectId effect : problem_.effects[action]) {
        if (!problem_.effect_conditions[effect].empty() || !problem_.effect_negative_conditions[effect].empty()) {
            return false;
        }
    }
    return true;
}

std::optional<MacroId> MacroActions::prepend(ActionId action, MacroId rest) {
    assert(rest < macros_.size());
    const auto [entry, is_new] = composed_.try_emplace((std::uint64_t{action} << 32) | rest, kImpossible);
    if (is_new) {
        entry->second = compose(action, rest);
    }
    return entry->second == kImpossible ? std::nullopt : std::optional(entry->second);
}

// The action alone. What it makes may hold before.
MacroActions::Macro MacroActions::of_action(ActionId action) const {
    Macro macro;
    for (const FactId fact : problem_.preconditions[action]) {
        put(macro.needed, literal_of(fact));
    }
    for (const FactId fact : problem_.negative_preconditions[action]) {
        put(macro.needed, literal_of(fact, true));
    }
    for (const EffectId effect : problem_.effects[action]) {
        for (const FactId fact : problem_.effect_adds[effect]) {
            put(macro.made, literal_of(fact));
        }
    }
    for (const EffectId effect : problem_.effects[action]) {
        for (const FactId fact : problem_.effect_deletes[effect]) {
            if (!has(macro.made, literal_of(fact))) {  // adding wins over deleting
                put(macro.made, literal_of(fact, true));
            }
        }
    }
    return macro;
}

MacroId MacroActions::compose(ActionId action, MacroId rest) {
    const Macro first = of_action(action);
    const Macro& second = macros_[rest];
    Macro both = first;
    for (const Literal literal : second.needed) {
        if (has(first.made, negation(literal))) {
            return kImpossible;
        }
        if (!has(first.made, literal)) {
            put(both.needed, literal);
        }
    }
    for (const Literal one : both.needed) {
        for (const Literal other : both.needed) {
            if (contradicts(one, other)) {
                return kImpossible;
            }
        }
    }
    for (const Literal literal : second.made) {
        std::erase(both.made, negation(literal));
        put(both.made, literal);
    }
    // What holds before anyway is no change.
    std::erase_if(both.made, [&](Literal literal) {
        return has(both.needed, literal) ||
               std::ranges::any_of(both.needed, [&](Literal needed) { return contradicts(needed, negation(literal)); });
    });
    return intern(std::move(both));
}

// Whether the two never hold together.
bool MacroActions::contradicts(Literal one, Literal other) const { return mutexes_.are_mutex(one, other); }

MacroId MacroActions::intern(Macro macro) {
    const std::uint64_t hash_of_it = hash(macro);
    if (const auto known = table_.find(hash_of_it, [&](MacroId id) { return macros_[id] == macro; })) {
        return *known;
    }
    const auto id = static_cast<MacroId>(macros_.size());
    macros_.push_back(std::move(macro));
    table_.add(hash_of_it, id);
    return id;
}

std::uint64_t MacroActions::hash(const Macro& macro) {
    return combine(hash_values(macro.needed), hash_values(macro.made));
}

}  // namespace relax
