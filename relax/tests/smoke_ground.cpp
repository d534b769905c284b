// Grounding without Python, for sanitizer builds: a hand-made lifted problem with a choice, a conditional cost, an
// effect on a condition and a recursive method; what comes out is solved.

#include <cstdio>
#include <utility>
#include <variant>
#include <vector>

#include "relax/grounding/grounder.hpp"
#include "relax/search/search.hpp"

namespace {

using relax::Formula;
using relax::FormulaKind;

Formula atom(std::uint32_t predicate, std::vector<relax::Term> terms) {
    return {FormulaKind::Atom, {}, predicate, std::move(terms), {}};
}

Formula negation(Formula operand) { return {FormulaKind::Not, {std::move(operand)}, 0, {}, {}}; }

// A walk over a line of places: road(x, y) is static, at(x) and lit(x) change. `walk` costs more in the dark.
relax::LiftedProblem line(std::uint32_t places) {
    const std::uint32_t road = 0;
    const std::uint32_t at = 1;
    const std::uint32_t lit = 2;
    relax::LiftedProblem problem;
    problem.object_count = places;
    problem.predicate_count = 3;
    problem.domains.resize(1);
    for (std::uint32_t place = 0; place < places; ++place) {
        problem.domains[0].emplace_back(place);
        if (place > 0) {
            problem.initial_state.push_back({road, place - 1, place});
        }
    }
    problem.initial_state.push_back({at, 0});

    relax::LiftedAction walk;
    walk.parameters = {0, 0};
    walk.slot_count = 2;
    walk.precondition = {FormulaKind::And, {atom(at, {0}), atom(road, {0, 1})}, 0, {}, {}};
    walk.effects = {{{}, {}, at, {1}, true}, {{}, {}, at, {0}, false}, {{}, atom(lit, {0}), lit, {1}, true}};
    walk.cost_conditions = {{0, {}, negation(atom(lit, {0}))}};
    relax::LiftedAction light;
    light.parameters = {0};
    light.slot_count = 1;
    light.precondition = {FormulaKind::Or, {atom(at, {0}), atom(lit, {0})}, 0, {}, {}};
    light.effects = {{{}, {}, lit, {0}, true}};
    relax::LiftedAction arrived;
    arrived.precondition = atom(at, {~static_cast<relax::Term>(places - 1)});
    arrived.is_precondition = true;
    problem.actions = {walk, light, arrived};

    problem.tasks = {{{0}}, {{}}};
    const std::uint32_t go = 3;
    const std::uint32_t top = 4;
    problem.methods = {
        {{0, 0}, 2, go, {0}, {}, {{0, {0, 1}}, {go, {1}}}, {{0, 1}}},
        {{0}, 1, go, {0}, {}, {}, {}},
        {{}, 0, top, {}, {}, {{1, {~0}}, {go, {~0}}, {2, {}}}, {{0, 2}, {1, 2}}},
    };
    problem.initial_task = top;
    return problem;
}

bool solve(std::uint32_t places) {
    relax::Limits limits;
    const auto grounded = relax::ground(line(places), {}, limits);
    const auto* found = std::get_if<std::unique_ptr<relax::AnalysedProblem>>(&grounded);
    if (found == nullptr || !(*found)->solvable) {
        return false;
    }
    const relax::AnalysedProblem& problem = **found;
    relax::Prices prices;
    for (const relax::ActionId action : problem.actions()) {
        const std::uint32_t schema = problem.action_schema[action];
        const relax::Cost dark = problem.action_cost_blocks[action].empty() ? 0 : 10;
        prices.actions.push_back(schema == 0 ? 1 + dark : schema == 1 ? 2 : 0);
    }
    prices.parts.assign(problem.cost_part_count(), 10);
    relax::SearchStatistics statistics;
    const auto result = relax::search(relax::PricedProblem(problem, prices), {}, limits, statistics);
    return result.status == relax::SearchStatus::Optimal && result.cost == relax::Cost{2} + (places - 1);
}

}  // namespace

int main() {
    int passed = 0;
    int failed = 0;
    for (const std::uint32_t places : {2U, 5U, 20U}) {
        ++(solve(places) ? passed : failed);
    }
    std::printf("%d passed, %d failed\n", passed, failed);
    return failed == 0 ? 0 : 1;
}
