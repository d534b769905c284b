#include "relaxed_model_builder.hpp"

#include <algorithm>
#include <utility>

namespace relax {

namespace {

// Turn "row -> values" round: for each value the rows that hold it.
template <typename Value>
void append(std::vector<Value>& values, std::span<const Value> more) {
    values.insert(values.end(), more.begin(), more.end());
}

// Facts that some action reads negatively, and those on which a cost part with a price depends: it is due by its
// condition, and not due by the negation.
std::vector<FactId> facts_with_complement(const GroundProblem& problem, std::span<const Cost> part_prices,
                                          Limits& limits) {
    std::vector<FactId> facts;
    for (const CostPartId part : all_ids<CostPartId>(part_prices.size())) {
        limits.stop_if_reached();
        for (const AlternativeId alternative : problem.cost_alternatives[part]) {
            if (part_prices[part] > 0) {
                append(facts, problem.cost_conditions[alternative]);
                append(facts, problem.cost_negative_conditions[alternative]);
            }
        }
    }
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        append(facts, problem.negative_preconditions[action]);
    }
    for (const EffectId effect : all_ids<EffectId>(problem.effect_negative_conditions.size())) {
        limits.stop_if_reached();
        append(facts, problem.effect_negative_conditions[effect]);
    }
    sort_unique(facts);
    return facts;
}

}  // namespace

RelaxedModelBuilder::RelaxedModelBuilder(const GroundProblem& problem, std::span<const Cost> costs,
                                         std::span<const Cost> part_prices, Limits& limits)
    : problem_(problem), first_part_(costs.size()), complement_of_(problem.fact_count(), RelaxedModel::kAlwaysTrue) {
    append(model.owner_cost, costs);
    append(model.owner_cost, part_prices);
    model.owner_cost.push_back(0);
    RelaxedFact next = model.holds(FactId(problem.fact_count()));
    for (const FactId fact : facts_with_complement(problem, part_prices, limits)) {
        complement_of_[fact] = next;
        model.complements.emplace_back(fact, next++);
    }
    model.first_reached = next;
    fact_count_ = next + problem.task_count();
}

void RelaxedModelBuilder::add_starts() {
    model.first_start = static_cast<RelaxedFact>(fact_count_);
    model.action_count = problem_.action_count();
    fact_count_ += problem_.task_count();
}

void RelaxedModelBuilder::add_operator(std::vector<RelaxedFact> needed, std::vector<RelaxedFact> made, OwnerId owner) {
    if (needed.empty()) {
        needed.push_back(RelaxedModel::kAlwaysTrue);
    }
    sort_unique(needed);
    sort_unique(made);
    model.preconditions.add_row(needed);
    model.adds.add_row(made);
    model.owner.push_back(owner);
}

void RelaxedModelBuilder::add_action(ActionId action, OwnerId owner) {
    std::vector<RelaxedFact> needed;
    if (model.is_decomposition()) {
        needed.push_back(model.may_start(task_of(action)));
    }
    for (const FactId fact : problem_.preconditions[action]) {
        needed.push_back(model.holds(fact));
    }
    for (const FactId fact : problem_.negative_preconditions[action]) {
        needed.push_back(complement_of_[fact]);
    }
    settle_costs(action, needed);
    std::vector<RelaxedFact> always{model.reached(task_of(action))};
    for (const EffectId effect : problem_.effects[action]) {
        std::vector<RelaxedFact> made;
        for (const FactId fact : problem_.effect_adds[effect]) {
            made.push_back(model.holds(fact));
        }
        for (const FactId fact : problem_.effect_deletes[effect]) {
            if (complement_of_[fact] != RelaxedModel::kAlwaysTrue) {
                made.push_back(complement_of_[fact]);
            }
        }
        std::vector<RelaxedFact> condition;
        for (const FactId fact : problem_.effect_conditions[effect]) {
            condition.push_back(model.holds(fact));
        }
        for (const FactId fact : problem_.effect_negative_conditions[effect]) {
            condition.push_back(complement_of_[fact]);
        }
        if (condition.empty()) {
            always.insert(always.end(), made.begin(), made.end());
        } else if (!made.empty()) {
            condition.insert(condition.end(), needed.begin(), needed.end());
            add_operator(std::move(condition), std::move(made), owner);
        }
    }
    add_operator(std::move(needed), std::move(always), owner);
}

// `needed`: what the first part needs; afterwards, what the effects need.
void RelaxedModelBuilder::settle_costs(ActionId action, std::vector<RelaxedFact>& needed) {
    std::vector<RelaxedFact> asked_for;
    if (model.is_decomposition()) {
        asked_for.push_back(model.may_start(task_of(action)));
    }
    for (const CostPartId part : problem_.cost_parts[action]) {
        if (model.owner_cost[part_owner(part)] == 0) {
            continue;
        }
        const RelaxedFact settled = add_fact();
        const auto alternatives = problem_.cost_alternatives[part];
        std::vector<RelaxedFact> not_due = needed;
        for (const AlternativeId alternative : alternatives) {
            std::vector<RelaxedFact> due = needed;
            for (const FactId fact : problem_.cost_conditions[alternative]) {
                due.push_back(model.holds(fact));
            }
            for (const FactId fact : problem_.cost_negative_conditions[alternative]) {
                due.push_back(complement_of_[fact]);
            }
            add_operator(std::move(due), {settled}, part_owner(part));
            if (alternatives.size() > 1) {
                not_due.push_back(add_fact());
                add_failures(alternative, asked_for, not_due.back());
            }
        }
        if (alternatives.size() == 1) {
            add_failures(alternatives.front(), needed, settled);
        } else {
            add_operator(std::move(not_due), {settled}, free_owner());
        }
        needed = asked_for;
        needed.push_back(settled);
    }
}

// The ways in which an alternative of a condition does not hold: one of its facts is false, or of those negated true.
void RelaxedModelBuilder::add_failures(AlternativeId alternative, const std::vector<RelaxedFact>& needed,
                                       RelaxedFact made) {
    const auto add = [&](RelaxedFact fails) {
        std::vector<RelaxedFact> all = needed;
        all.push_back(fails);
        add_operator(std::move(all), {made}, free_owner());
    };
    for (const FactId fact : problem_.cost_conditions[alternative]) {
        add(complement_of_[fact]);
    }
    for (const FactId fact : problem_.cost_negative_conditions[alternative]) {
        add(model.holds(fact));
    }
}

RelaxedModel RelaxedModelBuilder::finish(Limits& limits) {
    model.precondition_of = invert(model.preconditions, fact_count_, limits);
    model.achievers = invert(model.adds, fact_count_, limits);
    model.owner_operators = Rows<OperatorId>::filled(model.owner_cost.size(), [&](const auto& put) {
        for (OperatorId op = 0; op < model.owner.size(); ++op) {
            limits.stop_if_reached();
            if (model.owner[op] != free_owner()) {
                put(model.owner[op], op);
            }
        }
    });
    return std::move(model);
}

}  // namespace relax
