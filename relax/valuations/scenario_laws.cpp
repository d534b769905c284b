#include "relax/valuations/scenario_laws.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "relax/base/cost.hpp"
#include "relax/valuations/law_valuation.hpp"

namespace relax {

namespace {

// Of a law that is only for a bound: where there are more, costs are rounded down.
constexpr std::size_t kMostOutcomes = 4096;
// Of those of the graphs of laws, of which there is one for each scenario.
constexpr std::size_t kOutcomesOfTasks = 256;
constexpr std::size_t kOutcomesOfNetworks = 128;

LawOptions for_many(LawOptions options) {
    options.graph_outcomes = std::min(options.graph_outcomes, kOutcomesOfTasks);
    options.network_outcomes = std::min(options.network_outcomes, kOutcomesOfNetworks);
    return options;
}

// What neither the objective nor a budget needs to know.
LawDetail detail_of(const LawObjective& objective, std::span<const ScenarioBudget> budgets) {
    LawDetail detail = objective.detail();
    for (const ScenarioBudget& budget : budgets) {
        detail.last = std::max(detail.last, budget.deadline->detail().last);
    }
    return detail;
}

std::vector<const PricedProblem*> least_of(std::span<const ScenarioCosts> scenarios) {
    std::vector<const PricedProblem*> least;
    std::ranges::transform(scenarios, std::back_inserter(least), &ScenarioCosts::least);
    return least;
}

std::uint64_t hash_of(std::span<const LawId> laws) {
    std::uint64_t hash = laws.size();
    for (const LawId law : laws) {
        hash = combine(hash, std::uint32_t{law});
    }
    return hash;
}

}  // namespace

ScenarioLaws::Scenario::Scenario(const ScenarioCosts& costs, const LawDetail& detail, const LawOptions& options)
    : probability(costs.probability),
      so_far(costs.laws, detail),
      to_come(*costs.least, costs.laws, detail, options),
      sums({.last = std::numeric_limits<double>::infinity(), .is_flat_beyond = false, .most_outcomes = kMostOutcomes}) {
}

ScenarioLaws::ScenarioLaws(const std::vector<ScenarioCosts>& scenarios, std::vector<ScenarioTangent> tangents,
                           bool asks_scenarios, std::shared_ptr<const LawObjective> objective,
                           std::vector<ScenarioBudget> budgets, const ScenarioOptions& options,
                           const LawOptions& law_options)
    : ScenarioValuation(std::move(tangents), least_of(scenarios), asks_scenarios, std::move(objective),
                        std::move(budgets), options),
      law_options_(for_many(law_options)) {
    const LawDetail detail = detail_of(this->objective(), this->budgets());
    for (const ScenarioCosts& costs : scenarios) {
        scenarios_.emplace_back(costs, detail, law_options_);
    }
}

void ScenarioLaws::begin(const TaskNetworks& networks, Limits& limits) {
    limits_ = &limits;
    if (stages() > 1) {
        for (Scenario& scenario : scenarios_) {
            scenario.to_come.begin(networks, limits);
        }
    }
}

ValueId ScenarioLaws::start() {
    row_.assign(scenarios_.size(), LawTable::kFree);
    return intern();
}

ValueId ScenarioLaws::extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) {
    row_.assign(laws(value).begin(), laws(value).end());
    for (std::size_t k = 0; k < row_.size(); ++k) {
        row_[k] = scenarios_[k].so_far.extend(row_[k], action, due_parts, *limits_);
    }
    return intern();
}

Worth ScenarioLaws::worth(ValueId value) {
    mixture_.clear();
    for (std::size_t k = 0; k < scenarios_.size(); ++k) {
        const Law& law = scenarios_[k].so_far[laws(value)[k]];
        for (std::size_t i = 0; i < law.size(); ++i) {
            mixture_.add(law.at[i], scenarios_[k].probability * law.probability[i]);
        }
    }
    return worth_of(mixture_.law());
}

Worth ScenarioLaws::bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) {
    if (to_come.is_dead_end()) {
        return kNoWorth;
    }
    return bound_of(stage == 0 ? shifted(value, to_come) : with_graphs(value, to_come), value, to_come);
}

// The mixture of what a way has cost and the least costs to come.
const Law& ScenarioLaws::shifted(ValueId value, const CostToCome& to_come) {
    mixture_.clear();
    for (std::size_t k = 0; k < scenarios_.size(); ++k) {
        const Law& law = scenarios_[k].so_far[laws(value)[k]];
        for (std::size_t i = 0; i < law.size(); ++i) {
            mixture_.add(law.at[i] + least(to_come, k), scenarios_[k].probability * law.probability[i]);
        }
    }
    return mixture_.law();
}

// The mixture of what a way has cost and the graphs of laws, which are raised to the least costs to come.
const Law& ScenarioLaws::with_graphs(ValueId value, const CostToCome& to_come) {
    mixture_.clear();
    for (std::size_t k = 0; k < scenarios_.size(); ++k) {
        Scenario& scenario = scenarios_[k];
        const Law& graph = scenario.to_come.of(to_come.network, *limits_);
        const double floor = least(to_come, k);
        const std::size_t below = graph.outcomes_up_to(floor);
        at_.clear();
        probability_.clear();
        if (below > 0) {
            at_.push_back(floor);
            probability_.push_back(graph.total() - graph.above_of(below));
        }
        for (std::size_t i = below; i < graph.size(); ++i) {
            at_.push_back(graph.at[i]);
            probability_.push_back(graph.probability[i]);
        }
        const Law& spent = scenario.so_far[laws(value)[k]];
        const LawId to_add = scenario.sums.add(at_, probability_);
        const LawId so_far = scenario.sums.add(spent.at, spent.probability);
        const Law& law = scenario.sums[scenario.sums.sum(so_far, to_add, *limits_)];
        for (std::size_t i = 0; i < law.size(); ++i) {
            mixture_.add(law.at[i], scenario.probability * law.probability[i]);
        }
    }
    return mixture_.law();
}

double ScenarioLaws::spent(ValueId value, const ScenarioTangent& tangent) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < scenarios_.size(); ++k) {
        sum += tangent.weights[k] * scenarios_[k].so_far[laws(value)[k]].mean();
    }
    return sum;
}

bool ScenarioLaws::is_as_good(ValueId one, ValueId other, const CostToCome& to_come) {
    if (one == other) {
        return true;
    }
    if (!options().compare_scenarios) {
        return false;
    }
    for (std::size_t k = 0; k < scenarios_.size(); ++k) {
        if (laws(one)[k] == laws(other)[k]) {
            continue;
        }
        const Law& law = scenarios_[k].so_far[laws(one)[k]];
        const Law& other_law = scenarios_[k].so_far[laws(other)[k]];
        const auto is_as_good_by = [&](const LawObjective& objective) {
            return relax::is_as_good(objective, law_options_, law, other_law, least(to_come, k));
        };
        if (!is_as_good_by(objective()) || !std::ranges::all_of(budgets(), [&](const ScenarioBudget& budget) {
                return is_as_good_by(*budget.deadline);
            })) {
            return false;
        }
    }
    return true;
}

ValueId ScenarioLaws::intern() {
    const std::uint64_t hash = hash_of(row_);
    if (const auto known = table_.find(hash, [&](ValueId id) { return std::ranges::equal(laws(id), row_); })) {
        return *known;
    }
    const auto id = static_cast<ValueId>(rows_.size());
    const std::span<LawId> row = ids_.allocate(row_.size());
    std::ranges::copy(row_, row.begin());
    rows_.push_back(row.data());
    table_.add(hash, id);
    return id;
}

}  // namespace relax
