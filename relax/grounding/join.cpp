#include "join.hpp"

#include <algorithm>

#include "truth.hpp"

namespace relax::grounding {

void Joiner::run(const Rule& rule, const JoinPlan& plan, std::optional<TupleId> given) {
    plan_ = &plan;
    rule_ = &rule;
    given_ = given;
    is_done_ = false;
    bindings_.resize(std::max<std::size_t>(bindings_.size(), rule.slot_count));
    if (!given) {
        join(0);
        return;
    }
    const JoinStep& first = plan.steps[0];
    if (fits(first, knowledge_.relations[rule.patterns[first.pattern].relation][*given])) {
        join(1);
    }
}

bool Joiner::fits(const JoinStep& step, std::span<const ObjectId> tuple) {
    for (const auto& [position, slot] : step.binds) {
        const ObjectSet* domain = rule_->domains[slot];
        if (domain != nullptr && !domain->contains(tuple[position])) {
            return false;
        }
        bindings_[slot] = tuple[position];
    }
    return std::ranges::all_of(
        step.same, [&](const auto& pair) { return tuple[pair.first] == object_of(pair.second, bindings_); });
}

std::optional<TupleId> Joiner::find(RelationId relation, const JoinStep& step) {
    key_.clear();
    for (const Term term : step.key) {
        key_.push_back(object_of(term, bindings_));
    }
    return knowledge_.relations[relation].find(key_);
}

void Joiner::join(std::size_t at) {
    if (at == plan_->steps.size()) {
        emit_(plan_->rule, bindings_);
        is_done_ = rule_->result.has_value();
        return;
    }
    const JoinStep& step = plan_->steps[at];
    switch (step.kind) {
        case JoinStep::Kind::Lookup:
            lookup(step, at + 1);
            break;
        case JoinStep::Kind::Enumerate:
            enumerate(step, at + 1);
            break;
        case JoinStep::Kind::Member: {
            const RelationId relation = rule_->patterns[step.pattern].relation;
            const auto tuple = find(relation, step);
            if (tuple && *tuple < knowledge_.relations[relation].visible_count() && !is_excluded(step, *tuple)) {
                join(at + 1);
            }
            break;
        }
        case JoinStep::Kind::Assign: {
            const ObjectId object = object_of(step.key[0], bindings_);
            const ObjectSet* domain = rule_->domains[step.slot];
            if (domain == nullptr || domain->contains(object)) {
                bindings_[step.slot] = object;
                join(at + 1);
            }
            break;
        }
        case JoinStep::Kind::Test:
            if (is_relaxed_true(knowledge_, limits_, rule_->tests[step.test], bindings_)) {
                join(at + 1);
            }
            break;
        case JoinStep::Kind::IsNew:
            if (!find(rule_->result->relation, step)) {
                join(at + 1);
                is_done_ = false;
            }
            break;
    }
}

void Joiner::lookup(const JoinStep& step, std::size_t next) {
    const Relation& relation = knowledge_.relations[rule_->patterns[step.pattern].relation];
    key_.clear();
    for (const Term term : step.key) {
        key_.push_back(object_of(term, bindings_));
    }
    for (auto tuple = relation.first(step.index, key_); tuple && !is_done_; tuple = relation.next(step.index, *tuple)) {
        limits_.stop_if_reached();
        if (!is_excluded(step, *tuple) && fits(step, relation[*tuple])) {
            join(next);
        }
    }
}

void Joiner::enumerate(const JoinStep& step, std::size_t next) {
    for (const ObjectId object : rule_->domains[step.slot]->members()) {
        if (is_done_) {
            return;
        }
        limits_.stop_if_reached();
        bindings_[step.slot] = object;
        join(next);
    }
}

JoinEngine::JoinEngine(Knowledge& knowledge, std::vector<bool> grows, Limits& limits, Emit emit)
    : knowledge_(knowledge),
      grows_(std::move(grows)),
      limits_(limits),
      joiner_(knowledge, limits, std::move(emit)),
      triggered_(knowledge.relations.size()) {
    for (RelationId relation = 0; relation < knowledge_.relations.size(); ++relation) {
        if (!grows_[relation]) {
            knowledge_.relations[relation].show_all(limits_);
        }
    }
}

void JoinEngine::plan() {
    is_planned_ = true;
    for (std::uint32_t number = 0; number < rules_.size(); ++number) {
        const Rule& rule = rules_[number];
        limits_.stop_if_reached();
        bool is_triggered = false;
        for (std::uint32_t pattern = 0; pattern < rule.patterns.size(); ++pattern) {
            const RelationId relation = rule.patterns[pattern].relation;
            if (grows_[relation]) {
                is_triggered = true;
                triggered_[relation].push_back(plan_join(knowledge_, grows_, rule, number, pattern, limits_));
            }
        }
        if (!is_triggered) {
            joiner_.run(rule, plan_join(knowledge_, grows_, rule, number, std::nullopt, limits_), std::nullopt);
        }
    }
}

void JoinEngine::run() {
    if (!is_planned_) {
        plan();
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (RelationId id = 0; id < knowledge_.relations.size(); ++id) {
            Relation& relation = knowledge_.relations[id];
            while (relation.visible_count() < relation.size()) {
                limits_.stop_if_reached();
                changed = true;
                const TupleId tuple = relation.visible_count();
                relation.show_next();
                for (const JoinPlan& plan : triggered_[id]) {
                    joiner_.run(rules_[plan.rule], plan, tuple);
                }
            }
        }
    }
}

}  // namespace relax::grounding
