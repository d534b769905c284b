#include "relax/analysis/cost_cases.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <unordered_map>
#include <utility>

namespace relax {

namespace {

constexpr std::size_t kMostFacts = 8;  // of a group whose cases are worked out

// Whether one of the part's alternatives holds. `is_true`: of the facts that it depends on.
template <typename Predicate>
bool is_due(const GroundProblem& problem, CostPartId part, Predicate is_true) {
    return std::ranges::any_of(problem.cost_alternatives[part], [&](AlternativeId alternative) {
        return std::ranges::all_of(problem.cost_conditions[alternative], is_true) &&
               std::ranges::none_of(problem.cost_negative_conditions[alternative], is_true);
    });
}

// Sorted, without those that the action's preconditions decide.
std::vector<FactId> undecided_facts(const GroundProblem& problem, ActionId action, std::span<const CostPartId> group) {
    std::vector<FactId> facts;
    for (const CostPartId part : group) {
        append_cost_facts(problem, part, facts, facts);
    }
    std::erase_if(facts, [&](FactId fact) {
        return std::ranges::binary_search(problem.preconditions[action], fact) ||
               std::ranges::binary_search(problem.negative_preconditions[action], fact);
    });
    std::ranges::sort(facts);
    const auto repeated = std::ranges::unique(facts);
    facts.erase(repeated.begin(), repeated.end());
    return facts;
}

}  // namespace

void append_cost_facts(const GroundProblem& problem, CostPartId part, std::vector<FactId>& positive,
                       std::vector<FactId>& negative) {
    for (const AlternativeId alternative : problem.cost_alternatives[part]) {
        std::ranges::copy(problem.cost_conditions[alternative], std::back_inserter(positive));
        std::ranges::copy(problem.cost_negative_conditions[alternative], std::back_inserter(negative));
    }
}

std::vector<std::vector<CostPartId>> unrelated_cost_groups(const GroundProblem& problem, ActionId action) {
    std::vector<std::vector<CostPartId>> groups;
    std::unordered_map<FactId, std::size_t> group_of;
    std::vector<FactId> facts;
    for (const CostPartId part : problem.cost_parts[action]) {
        std::vector<CostPartId> group{part};
        facts.clear();
        append_cost_facts(problem, part, facts, facts);
        for (std::size_t at = 0; at < facts.size(); ++at) {
            const auto known = group_of.find(facts[at]);
            if (known == group_of.end() || known->second == groups.size()) {
                group_of[facts[at]] = groups.size();
                continue;
            }
            for (const CostPartId other : std::exchange(groups[known->second], {})) {
                group.push_back(other);
                append_cost_facts(problem, other, facts, facts);
            }
            known->second = groups.size();
        }
        std::ranges::sort(group);
        groups.push_back(std::move(group));
    }
    return groups;
}

std::vector<std::vector<CostPartId>> least_cost_cases(const GroundProblem& problem, ActionId action,
                                                      std::span<const CostPartId> group) {
    const std::vector<FactId> facts = undecided_facts(problem, action, group);
    if (facts.size() > kMostFacts) {
        return {{}};
    }
    std::vector<std::vector<CostPartId>> cases;
    for (std::uint32_t truth = 0; truth < std::uint32_t{1} << facts.size(); ++truth) {
        const auto is_true = [&](FactId fact) {
            const auto at = std::ranges::lower_bound(facts, fact);
            return at != facts.end() && *at == fact ? (truth >> (at - facts.begin()) & 1) != 0
                                                    : std::ranges::binary_search(problem.preconditions[action], fact);
        };
        std::vector<CostPartId> due;
        std::ranges::copy_if(group, std::back_inserter(due),
                             [&](CostPartId part) { return is_due(problem, part, is_true); });
        const auto has_all_of = [](const auto& one, const auto& other) { return std::ranges::includes(one, other); };
        if (std::ranges::any_of(cases, [&](const auto& known) { return has_all_of(due, known); })) {
            continue;
        }
        std::erase_if(cases, [&](const auto& known) { return has_all_of(known, due); });
        cases.push_back(std::move(due));
    }
    return cases;
}

}  // namespace relax
