#include "relax/valuations/least_laws.hpp"

#include <optional>

#include "relax/analysis/cost_cases.hpp"
#include "relax/valuations/law_bounds.hpp"

namespace relax {

namespace {

// For what rounding and `highest_of` may have lost, over all cases.
constexpr double kCaseLift = 0x1p-36;

LawId least_of_group(const GroundProblem& problem, ActionId action, std::span<const CostPartId> group,
                     std::span<const LawId> parts, LawTable& table, Limits& limits) {
    std::optional<LawId> highest;
    for (const std::vector<CostPartId>& due : least_cost_cases(problem, action, group)) {
        LawId sum = LawTable::kFree;
        for (const CostPartId part : due) {
            sum = table.sum(sum, parts[part], limits);
        }
        highest = highest ? highest_of(table, *highest, sum) : sum;
    }
    return *highest;
}

}  // namespace

std::vector<LawId> least_laws(const GroundProblem& problem, std::vector<LawId> laws, std::span<const LawId> parts,
                              LawTable& table, Limits& limits) {
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        const LawId always = laws[action];
        for (const std::vector<CostPartId>& group : unrelated_cost_groups(problem, action)) {
            if (!group.empty()) {
                const LawId least = least_of_group(problem, action, group, parts, table, limits);
                laws[action] = table.sum(laws[action], least, limits);
            }
        }
        if (laws[action] != always) {
            laws[action] = lifted(table, laws[action], kCaseLift);
        }
    }
    return laws;
}

}  // namespace relax
