// Mutexes and macro-actions without Python, for sanitizer builds: a lorry, a parcel and three places.

#include <cstdio>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "relax/analysis/mutexes.hpp"
#include "relax/networks/macro_actions.hpp"
#include "relax/problem/state.hpp"

namespace {

using Facts = std::vector<relax::FactId>;

constexpr std::uint32_t kPlaces = 3;
// Facts: the lorry is at 0, 1, 2; the parcel is at 3, 4, 5, or in the lorry: 6.
constexpr relax::FactId kInside{2 * kPlaces};

relax::FactId lorry_at(std::uint32_t place) { return relax::FactId{place}; }
relax::FactId parcel_at(std::uint32_t place) { return relax::FactId{kPlaces + place}; }

void add_action(relax::GroundProblem& problem, const Facts& needs, const Facts& adds, const Facts& deletes) {
    problem.preconditions.add_row(needs);
    problem.negative_preconditions.finish_row();
    problem.effect_conditions.finish_row();
    problem.effect_negative_conditions.finish_row();
    problem.effect_adds.add_row(adds);
    problem.effect_deletes.add_row(deletes);
    problem.effects.share_out(problem.effect_adds.size());
    problem.cost_parts.share_out(0);
    problem.action_schema.push_back(0);
}

relax::ActionId drive(std::uint32_t from, std::uint32_t to) { return relax::ActionId{from * kPlaces + to}; }
relax::ActionId load(std::uint32_t at) { return relax::ActionId{kPlaces * kPlaces + 2 * at}; }
relax::ActionId unload(std::uint32_t at) { return relax::ActionId{load(at) + 1}; }

relax::GroundProblem make_problem() {
    relax::GroundProblem problem;
    problem.fact_predicate.assign(kInside + 1, 0);
    for (std::uint32_t from = 0; from < kPlaces; ++from) {
        for (std::uint32_t to = 0; to < kPlaces; ++to) {
            add_action(problem, {lorry_at(from)}, {lorry_at(to)}, {lorry_at(from)});
        }
    }
    for (std::uint32_t at = 0; at < kPlaces; ++at) {
        add_action(problem, {lorry_at(at), parcel_at(at)}, {kInside}, {parcel_at(at)});
        add_action(problem, {lorry_at(at), kInside}, {parcel_at(at)}, {kInside});
    }
    problem.initial_state = {lorry_at(0), parcel_at(1)};
    return problem;
}

// Every pair that no reachable state has is a mutex, and no other: on this problem h^2 misses nothing.
bool finds_mutexes(const relax::GroundProblem& problem) {
    const relax::StateTransition transition(problem);
    std::set<relax::StateBits> reached{transition.initial_state()};
    std::vector<relax::StateBits> pending(reached.begin(), reached.end());
    relax::StateBits next(transition.word_count());
    while (!pending.empty()) {
        const relax::StateBits state = pending.back();
        pending.pop_back();
        for (const relax::ActionId action : problem.actions()) {
            if (transition.is_applicable(action, state)) {
                transition.apply(action, state, next);
                if (reached.insert(next).second) {
                    pending.push_back(next);
                }
            }
        }
    }
    relax::Limits limits;
    const relax::Mutexes mutexes(problem, limits);
    for (const relax::FactId one : problem.facts()) {
        for (const relax::FactId other : problem.facts()) {
            bool together = one == other;
            for (const relax::StateBits& state : reached) {
                together = together || (relax::holds(state, one) && relax::holds(state, other));
            }
            if (mutexes.are_mutex(relax::literal_of(one), relax::literal_of(other)) == together) {
                return false;
            }
        }
    }
    return true;
}

std::optional<relax::MacroId> macro_of(relax::MacroActions& macros, const std::vector<relax::ActionId>& actions) {
    relax::MacroId macro = relax::MacroActions::kNothing;
    for (std::size_t at = actions.size(); at-- > 0;) {
        const auto longer = macros.prepend(actions[at], macro);
        if (!longer) {
            return std::nullopt;
        }
        macro = *longer;
    }
    return macro;
}

}  // namespace

int main() {
    const relax::AnalysedProblem problem(make_problem());
    relax::Limits limits;
    relax::MacroActions macros(problem, limits);
    const auto direct = macro_of(macros, {drive(0, 2)});
    const auto fetch = macro_of(macros, {load(0), drive(0, 1), unload(1)});
    int failed = 0;
    const auto check = [&failed](bool good, const std::string& what) {
        if (!good) {
            std::printf("wrong: %s\n", what.c_str());
            ++failed;
        }
    };
    check(finds_mutexes(problem), "mutexes");
    check(direct && macro_of(macros, {drive(0, 1), drive(1, 2)}) == direct, "a way round changes no more");
    check(direct && macro_of(macros, {drive(0, 1)}) != direct, "another place");
    check(fetch && macro_of(macros, {load(0), drive(0, 2), drive(2, 1), unload(1)}) == fetch,
          "a parcel by a way round");
    check(fetch && macro_of(macros, {drive(0, 1)}) != fetch, "a parcel, or none");
    check(macro_of(macros, {drive(0, 0), drive(0, 2)}) == direct, "standing still");
    check(macro_of(macros, {drive(0, 0)}) != relax::MacroActions::kNothing, "what changes nothing may need something");
    check(!macro_of(macros, {drive(0, 1), drive(2, 1)}), "not there");
    check(!macro_of(macros, {load(0), load(0)}), "loaded already");
    check(!macro_of(macros, {drive(0, 1), load(1), load(2)}), "the parcel is nowhere else");
    std::printf("%d failed\n", failed);
    return failed == 0 ? 0 : 1;
}
