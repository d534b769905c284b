// The policy search without Python, for sanitizer builds: one try after the other, for agents who mind nothing, an
// amount, or all that they have spent.

#include <cmath>
#include <cstdio>
#include <memory>
#include <variant>
#include <vector>

#include "relax/grounding/grounder.hpp"
#include "relax/policies/cut_source.hpp"
#include "relax/policies/network_source.hpp"
#include "relax/policies/policy_search.hpp"
#include "relax/policies/policy_trace.hpp"
#include "relax/policies/spending_source.hpp"

namespace {

using relax::Formula;
using relax::FormulaKind;

// T is done where p holds, or tries a, which costs 1 and makes p true with probability 1/2, and then T again.
struct Retry {
    Retry() {
        relax::LiftedProblem lifted;
        const Formula held{FormulaKind::Atom, {}, 0, {}, {}};
        lifted.predicate_count = 1;
        lifted.actions.resize(2);
        lifted.actions[0].precondition = {FormulaKind::Not, {held}, 0, {}, {}};
        lifted.actions[0].effects = {{{}, {}, 0, {}, true, relax::LiftedBranch{0, 0}}};
        lifted.actions[0].outcome_blocks = {{0, 2}};
        lifted.actions[1].precondition = held;
        lifted.actions[1].is_precondition = true;
        lifted.tasks.resize(2);
        lifted.methods = {method(2, {1}), method(2, {0, 2}), method(3, {2})};
        lifted.initial_task = 3;
        auto result = relax::ground(lifted, {}, limits);
        problem = std::move(std::get<std::unique_ptr<relax::AnalysedProblem>>(result));
        for (const relax::ActionId action : problem->actions()) {
            const bool is_try = problem->action_schema[action] == 0;
            probabilities.push_back(is_try ? 0.5 : 1);
            free.push_back(!is_try);
            costs.push_back(is_try ? 1 : 0);
            laws.actions.push_back(is_try ? 1 : 0);
            prices.actions.push_back(is_try ? 1 : 0);
        }
        laws.laws = {{{0}, {1}}, {{1}, {1}}};
        priced = std::make_unique<relax::PricedProblem>(*problem, prices);
        progression.emplace(*problem, free, relax::SeenCosts{free, {}}, relax::PolicyOptions{}, limits);
    }

    static relax::LiftedMethod method(std::uint32_t task, const std::vector<std::uint32_t>& subtasks) {
        relax::LiftedMethod result;
        result.task = task;
        for (const std::uint32_t subtask : subtasks) {
            result.subtasks.push_back({subtask, {}});
        }
        for (std::uint32_t later = 1; later < subtasks.size(); ++later) {
            result.ordering.emplace_back(later - 1, later);
        }
        return result;
    }

    const relax::HeuristicInfo& heuristic() const { return relax::heuristic_named("lmcut"); }

    relax::Limits limits;
    std::unique_ptr<relax::AnalysedProblem> problem;
    std::vector<double> probabilities;
    std::vector<bool> free;
    std::vector<double> costs;
    relax::CostLaws laws;
    relax::Prices prices;
    std::unique_ptr<relax::PricedProblem> priced;
    std::optional<relax::PolicyProgression> progression;
};

// The worth of the best policy, where bounds meet and the policy can be written down.
double best(Retry& retry, relax::PlanningSource& source, relax::Recursion recursion) {
    relax::PolicySearchOptions options;
    options.recursion = recursion;
    options.precision = 1e-12;
    relax::PolicyStatistics statistics;
    relax::PolicySearch search(source, options, retry.limits, statistics);
    const relax::PolicySearchResult result = search.run();
    if (!result.policy || !(result.statistics.upper - result.statistics.lower <= 1e-9)) {
        return relax::kNever;
    }
    const relax::PolicyTrace trace = relax::trace_policy(source, search.graph(), *result.policy, retry.limits);
    return trace.ends.empty() ? relax::kNever : result.statistics.upper;
}

bool is_near(double one, double other) { return std::abs(one - other) < 1e-9; }

bool minds_nothing() {
    Retry retry;
    relax::NetworkSource source(*retry.progression, retry.probabilities, {retry.costs, {}}, {retry.costs, {}}, {},
                                *retry.priced, retry.heuristic(), retry.limits);
    return is_near(best(retry, source, relax::Recursion::Expected), 2);
}

// By how much more than 2 is spent: a half of a half of the time it is 2 in the mean.
bool minds_an_amount() {
    Retry retry;
    const relax::SpendingSource::Worths worths{{{0.0}, 0, 0, 1}, relax::SpendingSource::GivingUp::No, 0};
    relax::SpendingSource source(*retry.progression, retry.probabilities, retry.laws, worths, *retry.priced,
                                 *retry.priced, 1, retry.heuristic(), retry.limits);
    source.begin_with(2);
    return is_near(best(retry, source, relax::Recursion::Expected), 0.5);
}

// The disutility C + (e^(C/2) - 1) / (1/2): of the mean 2, and of the mean of e^(C/2), r / (1 - r) with r = e^(1/2)
// / 2.
bool minds_all(relax::AmountLeft cut) {
    Retry retry;
    const double r = std::exp(0.5) / 2;
    const auto term = [&](double slope) {
        return relax::CutSource::PricedTerm{
            relax::DisutilityTerm::of(slope, 0, 1), {retry.costs, {}}, retry.priced.get(), 1};
    };
    const std::vector<relax::CutSource::PricedTerm> terms{term(0.5), term(0)};
    relax::CutSource source(*retry.progression, retry.probabilities, retry.laws, {1}, terms, retry.heuristic(),
                            retry.limits);
    source.set_cut(cut);
    const double worth = best(retry, source, relax::Recursion::LogExpected);
    const double disutility = 2 + 2 * (r / (1 - r) - 1);
    return is_near(std::exp(worth), disutility + terms[0].term.base + terms[1].term.base);
}

}  // namespace

int main() {
    int passed = 0;
    int failed = 0;
    for (const bool result : {minds_nothing(), minds_an_amount(), minds_all(0), minds_all(5)}) {
        ++(result ? passed : failed);
    }
    std::printf("%d passed, %d failed\n", passed, failed);
    return failed == 0 ? 0 : 1;
}
