#include "relax/valuations/cost_laws.hpp"

#include <algorithm>
#include <cassert>

#include "relax/analysis/tdg_bound.hpp"
#include "relax/valuations/least_laws.hpp"

namespace relax {

namespace {

// Of all laws of the graph together, about: where there are many methods, each has fewer.
constexpr std::size_t kOutcomesInAll = std::size_t{1} << 21;
constexpr std::size_t kFewestOutcomes = 16;
// Where there are many sums of laws with many outcomes each: of tasks, and of networks.
constexpr std::size_t kFewOfTasks = 256;
constexpr std::size_t kFewOfNetworks = 128;
constexpr double kUnitsPerStep = 16;  // of means by which tasks are put in order

// The graph of laws keeps the largest of several probabilities at each cost, and of that no mean beyond a bound.
LawDetail detail_of_bounds(const LawDetail& detail, std::size_t most_outcomes, std::size_t fewest_outcomes) {
    LawDetail of_bounds = detail.is_flat_beyond ? detail : LawDetail{};
    of_bounds.most_outcomes = most_outcomes;
    of_bounds.fewest_outcomes = fewest_outcomes;
    return of_bounds;
}

std::size_t outcomes_for(const GroundProblem& problem, std::size_t most) {
    return std::min(most, std::max(kFewestOutcomes, kOutcomesInAll / (problem.method_count() + 1)));
}

}  // namespace

std::vector<LawId> CostLaws::in(LawTable& table, const std::vector<std::uint32_t>& numbers) const {
    std::vector<LawId> ids;
    for (const Outcomes& law : laws) {
        ids.push_back(table.add(law.at, law.probabilities));
    }
    std::vector<LawId> by_owner;
    for (const std::uint32_t number : numbers) {
        by_owner.push_back(ids[number]);
    }
    return by_owner;
}

LawsSoFar::LawsSoFar(const CostLaws& costs, const LawDetail& detail)
    : table_(detail), actions_(costs.in(table_, costs.actions)), parts_(costs.in(table_, costs.parts)) {}

LawId LawsSoFar::extend(LawId law, ActionId action, std::span<const CostPartId> due_parts, Limits& limits) {
    LawId sum = table_.sum(law, actions_[action], limits);
    for (const CostPartId part : due_parts) {
        sum = table_.sum(sum, parts_[part], limits);
    }
    return sum;
}

LawsToCome::LawsToCome(const PricedProblem& least, const CostLaws& costs, const LawDetail& detail,
                       const LawOptions& options)
    : least_(least),
      has_parts_(options.graph_parts),
      table_(detail_of_bounds(detail, outcomes_for(least.problem, options.graph_outcomes), kFewOfTasks)),
      network_table_(detail_of_bounds(detail, options.network_outcomes, kFewOfNetworks)),
      actions_(costs.in(table_, costs.actions)),
      parts_(costs.in(table_, costs.parts)) {
    assert(costs.actions.size() == least.problem.action_count());
}

void LawsToCome::begin(const TaskNetworks& networks, Limits& limits) {
    of_task(least_.problem.initial_task, limits);
    networks_.emplace(networks, *graph_, table_, network_table_);
}

const Law& LawsToCome::of(NetworkId network, Limits& limits) { return networks_->of(network, limits); }

const Law& LawsToCome::of_task(TaskId task, Limits& limits) {
    if (!graph_) {
        const std::vector<LawId> actions =
            has_parts_ ? least_laws(least_.problem, actions_, parts_, table_, limits) : actions_;
        std::vector<Cost> means;
        for (const LawId law : actions) {
            means.push_back(static_cast<Cost>(table_[law].mean() * kUnitsPerStep));
        }
        const std::vector<Cost> task_means = tdg_bound(least_.problem, means, limits);
        graph_.emplace(least_.problem, table_, actions, least_.task_bounds(limits), task_means, limits);
    }
    return table_[(*graph_)[task]];
}

}  // namespace relax
