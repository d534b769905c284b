#include "relax/analysis/cost_shifting.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "relax/analysis/cost_cases.hpp"
#include "relax/base/cost.hpp"

namespace relax {

namespace {

constexpr std::uint32_t kMostSteps = 1000;  // of a search for a state; then one counts as found

// Looks for a state in which none of some cost parts is due: every alternative of theirs needs a literal that is false.
class StateWithout {
public:
    explicit StateWithout(const GroundProblem& problem) : problem_(problem) {}

    bool exists(std::span<const CostPartId> parts) {
        alternatives_.clear();
        part_of_.clear();
        for (std::uint32_t at = 0; at < parts.size(); ++at) {
            for (const AlternativeId alternative : problem_.cost_alternatives[parts[at]]) {
                alternatives_.push_back(alternative);
                part_of_.push_back(at);
            }
        }
        is_true_.clear();
        steps_ = 0;
        deepest_ = 0;
        return can_avoid_all(0);
    }

    // How many of the parts, from the first one, were needed to see that there is no such state.
    std::size_t needed() const { return part_of_[deepest_] + 1; }

private:
    bool can_avoid_all(std::uint32_t from) {
        if (from == alternatives_.size() || ++steps_ > kMostSteps) {
            return true;
        }
        deepest_ = std::max(deepest_, from);
        return can_avoid(from, problem_.cost_conditions[alternatives_[from]], false) ||
               can_avoid(from, problem_.cost_negative_conditions[alternatives_[from]], true);
    }

    // Whether one of the facts can have that value, and the rest be avoided, too.
    bool can_avoid(std::uint32_t at, std::span<const FactId> facts, bool value) {
        return std::ranges::any_of(facts, [&](FactId fact) {
            const auto [entry, is_new] = is_true_.try_emplace(fact, value);
            const bool can = entry->second == value && can_avoid_all(at + 1);
            if (is_new && !can) {
                is_true_.erase(fact);
            }
            return can;
        });
    }

    const GroundProblem& problem_;
    std::vector<AlternativeId> alternatives_;
    std::vector<std::uint32_t> part_of_;  // by index of `alternatives_`
    std::unordered_map<FactId, bool> is_true_;
    std::uint32_t steps_ = 0;
    std::uint32_t deepest_ = 0;
};

// Only then can one of the parts be due in every state.
bool reads_some_fact_both_ways(const GroundProblem& problem, std::span<const CostPartId> parts) {
    std::vector<FactId> positive;
    std::vector<FactId> negative;
    for (const CostPartId part : parts) {
        append_cost_facts(problem, part, positive, negative);
    }
    std::ranges::sort(positive);
    return std::ranges::any_of(negative, [&](FactId fact) { return std::ranges::binary_search(positive, fact); });
}

// Keep just as many of the parts as it takes for one of them to be due in every state.
void make_minimal(std::vector<CostPartId>& parts, StateWithout& state, Limits& limits) {
    for (std::size_t at = parts.size(); at-- > 0;) {
        limits.stop_if_reached();
        const CostPartId part = parts[at];
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(at));
        if (state.exists(parts)) {
            parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(at), part);
        }
    }
}

// As long as one of the parts with a price is due in every state, shift the least of their prices.
void shift_within(const GroundProblem& problem, ActionId action, std::span<const CostPartId> group, Prices& prices,
                  Limits& limits) {
    StateWithout state(problem);
    std::vector<CostPartId> parts;
    while (true) {
        parts.clear();
        std::ranges::copy_if(group, std::back_inserter(parts), [&](CostPartId part) { return prices.parts[part] > 0; });
        if (!reads_some_fact_both_ways(problem, parts) || state.exists(parts)) {
            return;
        }
        parts.resize(state.needed());
        make_minimal(parts, state, limits);
        Cost least = std::numeric_limits<Cost>::max();
        for (const CostPartId part : parts) {
            least = std::min(least, prices.parts[part]);
        }
        for (const CostPartId part : parts) {
            prices.parts[part] -= least;
        }
        prices.actions[action] = add_bounds(prices.actions[action], least);
    }
}

}  // namespace

Prices shift_costs(const GroundProblem& problem, Prices prices, Limits& limits) {
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        if (problem.cost_parts[action].empty()) {
            continue;
        }
        for (const std::vector<CostPartId>& group : unrelated_cost_groups(problem, action)) {
            shift_within(problem, action, group, prices, limits);
        }
    }
    return prices;
}

}  // namespace relax
