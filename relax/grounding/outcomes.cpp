#include "outcomes.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace relax::grounding {

namespace {

constexpr std::size_t kMostOutcomes = 64;
constexpr std::size_t kMostCombinations = std::size_t{1} << 12;

// A block of outcomes with objects for its variables.
struct Instance {
    std::uint32_t block;
    std::span<const ObjectId> objects;
    std::vector<const RemainingBranch*> branches;  // by number; nothing for one that does nothing
};

class OutcomeMaker {
public:
    OutcomeMaker(const Remains& remains, const LiftedAction& action, const RemainingCase& one,
                 const std::vector<std::optional<FactId>>& number_of_fact)
        : remains_(remains), case_(one), number_of_fact_(number_of_fact) {
        find_instances(action);
    }

    std::optional<std::vector<RemainingOutcome>> make() {
        std::size_t count = 1;
        for (const Instance& instance : instances_) {
            count *= instance.branches.size();
            if (count > kMostCombinations) {
                return std::nullopt;
            }
        }
        chosen_.assign(instances_.size(), 0);
        for (std::size_t combination = 0; combination < count; ++combination) {
            remains_.limits.stop_if_reached();
            add_combination();
            if (by_changes_.size() > kMostOutcomes) {
                return std::nullopt;
            }
            for (std::size_t at = instances_.size(); at-- > 0;) {  // the last instance runs fastest
                chosen_[at] = (chosen_[at] + 1) % instances_[at].branches.size();
                if (chosen_[at] != 0) {
                    break;
                }
            }
        }
        return std::move(outcomes_);
    }

private:
    bool is_read(Literal change) const { return number_of_fact_[fact_of(change)].has_value(); }

    bool matters(const RemainingBranch& branch) const {
        return !branch.costs.empty() || std::ranges::any_of(branch.effects, [this](const auto& effect) {
            return std::ranges::any_of(effect.second, [this](Literal change) { return is_read(change); });
        });
    }

    void find_instances(const LiftedAction& action) {
        for (const RemainingBranch& branch : case_.branches) {
            if (!matters(branch)) {
                continue;
            }
            const auto [block, number] = remains_.cases.branches[branch.id];
            const std::span<const ObjectId> objects = remains_.cases.branch_objects[branch.id];
            auto instance = std::ranges::find_if(instances_, [&](const Instance& other) {
                return other.block == block && std::ranges::equal(other.objects, objects);
            });
            if (instance == instances_.end()) {
                instances_.push_back({block, objects, {}});
                instance = std::prev(instances_.end());
                instance->branches.resize(action.outcome_blocks[block].branch_count, nullptr);
            }
            instance->branches[number] = &branch;
        }
    }

    // Add the combination of branches that are chosen.
    void add_combination() {
        Effects effects = case_.effects;
        bool is_mixed = true;  // what the branches cost is due in every state
        for_each_chosen([&](const RemainingBranch& branch) {
            for (const auto& [condition, changes] : branch.effects) {
                std::ranges::copy(changes, std::back_inserter(effects[condition]));
            }
            is_mixed =
                is_mixed && std::ranges::all_of(branch.costs, [](const auto& cost) { return is_true(cost.first); });
        });
        tidy(effects, case_.condition);
        std::optional<std::size_t>& mixture = by_changes_[read_changes(effects)];
        const std::size_t number = is_mixed && mixture ? *mixture : outcomes_.size();
        if (number == outcomes_.size()) {
            outcomes_.push_back({{}, std::move(effects), case_.costs});
            paid_.emplace_back();
            if (is_mixed) {
                mixture = number;
            }
        }
        write_combination(outcomes_[number].branches);
        // Which blocks of a mixture's cost are due together, its combinations tell.
        for_each_chosen([&](const RemainingBranch& branch) {
            if (paid_[number].insert(branch.id).second) {
                for (const auto& [condition, blocks] : branch.costs) {
                    std::ranges::copy(blocks, std::back_inserter(outcomes_[number].costs[condition]));
                }
            }
        });
    }

    template <typename Visit>
    void for_each_chosen(Visit visit) const {
        for (std::size_t at = 0; at < instances_.size(); ++at) {
            if (const RemainingBranch* const branch = instances_[at].branches[chosen_[at]]) {
                visit(*branch);
            }
        }
    }

    // The changes of facts that something reads.
    Effects read_changes(const Effects& effects) const {
        Effects read;
        for (const auto& [condition, changes] : effects) {
            for (const Literal change : changes) {
                if (is_read(change)) {
                    read[condition].push_back(change);
                }
            }
        }
        return read;
    }

    // As a row of GroundProblem::action_branches has it.
    void write_combination(std::vector<std::uint32_t>& row) const {
        if (instances_.empty()) {
            return;
        }
        row.push_back(static_cast<std::uint32_t>(instances_.size()));
        for (std::size_t at = 0; at < instances_.size(); ++at) {
            const Instance& instance = instances_[at];
            row.push_back(instance.block);
            row.push_back(static_cast<std::uint32_t>(chosen_[at]));
            row.push_back(static_cast<std::uint32_t>(instance.objects.size()));
            row.insert(row.end(), instance.objects.begin(), instance.objects.end());
        }
    }

    const Remains& remains_;
    const RemainingCase& case_;
    const std::vector<std::optional<FactId>>& number_of_fact_;
    std::vector<Instance> instances_;
    std::vector<std::size_t> chosen_;  // by instance: a branch
    std::vector<RemainingOutcome> outcomes_;
    std::vector<std::set<BranchId>> paid_;  // by outcome: whose costs it has
    // By what is changed: the outcome to which others that change the same are added.
    std::map<Effects, std::optional<std::size_t>> by_changes_;
};

}  // namespace

std::optional<std::vector<RemainingOutcome>> outcomes_of(const Remains& remains, const LiftedAction& action,
                                                         RemainingCase& one,
                                                         const std::vector<std::optional<FactId>>& number_of_fact) {
    if (one.branches.empty()) {
        std::vector<RemainingOutcome> outcomes;
        outcomes.push_back({{}, std::move(one.effects), std::move(one.costs)});
        return outcomes;
    }
    return OutcomeMaker(remains, action, one, number_of_fact).make();
}

void write_action(const Conjunction& precondition, const RemainingOutcome& outcome,
                  const std::vector<std::optional<FactId>>& number_of_fact, GroundProblem& problem) {
    const auto number = [&](Literal literal) { return number_of_fact[fact_of(literal)]; };
    const auto write = [&](const Conjunction& literals, auto& positive, auto& negative) {
        assert(std::ranges::is_sorted(literals));
        for (const Literal literal : literals) {
            if (const auto fact = number(literal)) {
                (is_negated(literal) ? negative : positive).push(*fact);
            }
        }
        positive.finish_row();
        negative.finish_row();
    };
    write(precondition, problem.preconditions, problem.negative_preconditions);
    for (const auto& [condition, changes] : outcome.effects) {
        if (std::ranges::any_of(changes, [&](Literal change) { return number(change).has_value(); })) {
            write(condition, problem.effect_conditions, problem.effect_negative_conditions);
            write(changes, problem.effect_adds, problem.effect_deletes);
        }
    }
    problem.effects.share_out(problem.effect_adds.size());
    for (const auto& [condition, blocks] : outcome.costs) {
        if (is_true(condition)) {
            std::ranges::for_each(blocks, [&](std::uint32_t entry) { problem.action_cost_blocks.push(entry); });
            continue;
        }
        problem.cost_part_blocks.add_row(blocks);
        for (const Conjunction& alternative : condition) {
            write(alternative, problem.cost_conditions, problem.cost_negative_conditions);
        }
        problem.cost_alternatives.share_out(problem.cost_conditions.size());
    }
    problem.action_cost_blocks.finish_row();
    problem.action_branches.add_row(outcome.branches);
    problem.cost_parts.share_out(problem.cost_part_count());
}

}  // namespace relax::grounding
