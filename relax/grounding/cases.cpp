#include "cases.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "formulas.hpp"

namespace relax::grounding {

namespace {

// The conditions of a lifted action in negation normal form.
struct NormalAction {
    Formula precondition;
    std::vector<Formula> dependents;  // effects, then cost conditions
};

NormalAction normal_action(const Knowledge& knowledge, const LiftedAction& action) {
    NormalAction normal{normal_form(knowledge, action.precondition), {}};
    for (const LiftedEffect& effect : action.effects) {
        normal.dependents.push_back(normal_form(knowledge, effect.condition));
    }
    for (const LiftedCostCondition& cost : action.cost_conditions) {
        normal.dependents.push_back(normal_form(knowledge, cost.condition));
    }
    return normal;
}

// Literals that become true under a condition; unconditional ones stand under
// the empty condition, which comes first.
using Effects = std::map<Conjunction, Conjunction>;

void add_change(Effects& effects, const Disjunction& condition, Literal change) {
    for (const Conjunction& conjunction : condition) {
        effects[conjunction].push_back(change);
    }
}

// Adding wins over deleting, and an effect without a condition makes the same
// effect under a condition redundant.
void tidy(Effects& effects) {
    const auto always = effects.find({});
    const Conjunction unconditional = always == effects.end() ? Conjunction{} : always->second;
    const auto contains = [](const Conjunction& literals, Literal literal) {
        return std::ranges::count(literals, literal) > 0;
    };
    for (auto& [condition, changes] : effects) {
        const Conjunction before = changes;
        std::erase_if(changes, [&](Literal change) {
            const Literal added = literal_of(fact_of(change));
            return (is_negated(change) && (contains(before, added) || contains(unconditional, added))) ||
                   (!condition.empty() && contains(unconditional, change));
        });
        std::ranges::sort(changes);
        const auto repeated = std::ranges::unique(changes);
        changes.erase(repeated.begin(), repeated.end());
    }
    std::erase_if(effects, [](const auto& effect) { return effect.second.empty(); });
}

class CaseMaker {
public:
    CaseMaker(const Knowledge& knowledge, const Expander& expander, const TaskGraph& graph,
              const Dependents& dependents, Limits& limits)
        : knowledge_(knowledge), expander_(expander), graph_(graph), dependents_(dependents), limits_(limits) {
        order_.resize(dependents.keys.size());
        std::iota(order_.begin(), order_.end(), 0U);
        std::ranges::stable_sort(order_, {}, [&](std::uint32_t at) { return dependents.keys[at]; });
        cases_.branches.emplace_back();
        cases_.branch_objects.finish_row();
    }

    Cases make() {
        for (std::uint32_t action = 0; action < knowledge_.problem.actions.size(); ++action) {
            const NormalAction normal = normal_action(knowledge_, knowledge_.problem.actions[action]);
            const TupleId count = knowledge_.relations[knowledge_.task_relation(action)].size();
            for (TupleId instance = 0; instance < count; ++instance) {
                limits_.stop_if_reached();
                add_instance(action, normal, instance);
                finish_instance();
            }
        }
        cases_.is_alive.assign(cases_.owner.size(), true);
        cases_.is_effect_alive.assign(cases_.effect_owner.size(), true);
        return std::move(cases_);
    }

private:
    void finish_instance() {
        cases_.cases.share_out(cases_.owner.size());
        cases_.effects.share_out(cases_.effect_owner.size());
        cases_.cost_parts.share_out(cases_.cost_blocks.size());
    }

    void add_instance(std::uint32_t action, const NormalAction& normal, TupleId instance) {
        const auto own = std::ranges::equal_range(order_, std::pair(action, instance), {}, [&](std::uint32_t at) {
            return std::pair(dependents_.keys[at].action, dependents_.keys[at].instance);
        });
        const NodeId node = graph_.task_begin[action] + instance;
        if (!graph_.is_node_alive[node]) {
            return;
        }
        const std::span<const ObjectId> arguments = knowledge_.relations[knowledge_.task_relation(action)][instance];
        Bindings bindings(knowledge_.problem.actions[action].slot_count);
        std::ranges::copy(arguments, bindings.begin());
        branch_numbers_.clear();
        try {
            add_cases(node, normal, bindings);
            add_effects(action, node, normal, own, bindings);
            add_costs(action, normal, own, bindings);
        } catch (const CaseLimitExceeded&) {
            throw TooManyCases{action, instance};
        }
    }

    void add_cases(NodeId node, const NormalAction& normal, Bindings& bindings) {
        for (const Conjunction& condition : expander_.expand(normal.precondition, bindings)) {
            cases_.owner.push_back(node);
            cases_.condition.add_row(condition);
        }
    }

    // The number of a dependent's branch. The objects of its variables begin with those of the branch's block.
    BranchId branch_of(std::uint32_t action, const std::optional<LiftedBranch>& branch,
                       std::span<const ObjectId> objects) {
        if (!branch) {
            return Cases::kCertain;
        }
        const auto count = knowledge_.problem.actions[action].outcome_blocks[branch->block].variable_count;
        objects = objects.first(count);
        const auto [entry, is_new] = branch_numbers_.try_emplace(
            {branch->block, branch->branch, {objects.begin(), objects.end()}}, cases_.branches.size());
        if (is_new) {
            cases_.branches.push_back(*branch);
            cases_.branch_objects.add_row(objects);
        }
        return entry->second;
    }

    // Blocks that are due on the same condition are one part.
    template <typename Keys>
    void add_costs(std::uint32_t action, const NormalAction& normal, const Keys& own, Bindings& bindings) {
        const LiftedAction& lifted = knowledge_.problem.actions[action];
        std::map<std::pair<BranchId, Disjunction>, std::vector<std::uint32_t>> costs;
        for (const std::uint32_t at : own) {
            const std::uint32_t dependent = dependents_.keys[at].dependent;
            if (dependent >= lifted.effects.size()) {
                const LiftedCostCondition& cost = lifted.cost_conditions[dependent - lifted.effects.size()];
                const std::span<const ObjectId> objects = dependents_.objects[at];
                bind(cost.variables, objects, bindings);
                std::vector<std::uint32_t>& blocks = costs[{branch_of(action, cost.branch, objects),
                                                            expander_.expand(normal.dependents[dependent], bindings)}];
                blocks.push_back(cost.block);
                blocks.push_back(static_cast<std::uint32_t>(objects.size()));
                blocks.insert(blocks.end(), objects.begin(), objects.end());
            }
        }
        for (const auto& [due, blocks] : costs) {
            cases_.cost_blocks.add_row(blocks);
            cases_.cost_branch.push_back(due.first);
            for (const Conjunction& alternative : due.second) {
                cases_.cost_condition.add_row(alternative);
            }
            cases_.cost_alternatives.share_out(cases_.cost_condition.size());
        }
    }

    static void bind(const std::vector<LiftedVariable>& variables, std::span<const ObjectId> objects,
                     Bindings& bindings) {
        for (std::size_t at = 0; at < variables.size(); ++at) {
            bindings[variables[at].slot] = objects[at];
        }
    }

    template <typename Keys>
    void add_effects(std::uint32_t action, NodeId node, const NormalAction& normal, const Keys& own,
                     Bindings& bindings) {
        const LiftedAction& lifted = knowledge_.problem.actions[action];
        std::map<BranchId, Effects> effects_of;
        const auto add = [&](const LiftedEffect& effect, std::span<const ObjectId> objects,
                             const Disjunction& condition) {
            if (const auto fact = expander_.fact(effect.predicate, effect.arguments, bindings)) {
                add_change(effects_of[branch_of(action, effect.branch, objects)], condition,
                           literal_of(*fact, !effect.positive));
            }
        };
        for (const LiftedEffect& effect : lifted.effects) {
            if (is_simple(effect)) {
                add(effect, {}, {Conjunction{}});
            }
        }
        for (const std::uint32_t at : own) {
            const std::uint32_t dependent = dependents_.keys[at].dependent;
            if (dependent < lifted.effects.size()) {
                const std::span<const ObjectId> objects = dependents_.objects[at];
                bind(lifted.effects[dependent].variables, objects, bindings);
                add(lifted.effects[dependent], objects, expander_.expand(normal.dependents[dependent], bindings));
            }
        }
        for (auto& [branch, effects] : effects_of) {
            tidy(effects);
            for (const auto& [condition, changes] : effects) {
                cases_.effect_owner.push_back(node);
                cases_.effect_condition.add_row(condition);
                cases_.effect_changes.add_row(changes);
                cases_.effect_branch.push_back(branch);
            }
        }
    }

    const Knowledge& knowledge_;
    const Expander& expander_;
    const TaskGraph& graph_;
    const Dependents& dependents_;
    Limits& limits_;
    std::vector<std::uint32_t> order_;  // of the dependents: by action, instance, dependent
    // Of the instance looked at: by block, branch and objects.
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::vector<ObjectId>>, BranchId> branch_numbers_;
    Cases cases_;
};

}  // namespace

Cases make_cases(const Knowledge& knowledge, const Expander& expander, const TaskGraph& graph,
                 const Dependents& dependents, Limits& limits) {
    return CaseMaker(knowledge, expander, graph, dependents, limits).make();
}

}  // namespace relax::grounding
