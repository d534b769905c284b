#ifndef RELAX_HEURISTICS_RELAXED_TASK_HPP
#define RELAX_HEURISTICS_RELAXED_TASK_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "relax/analysis/relaxed_model.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/rows.hpp"
#include "relax/heuristics/heuristic.hpp"

namespace relax {

// What of a relaxed model a search node sees: its facts and its goals, and either the operators that are reachable from
// its network (composition model) or the tasks that may start at once (decomposition model).
//
// In the decomposition model the network's order makes operators of its own, which are numbered after the model's: they
// let a task start when those before it have been reached. They are free.
class RelaxedTask {
public:
    // `lists_operators`: whether `operators` is asked for, which takes a while on large problems.
    RelaxedTask(const RelaxedModel& model, bool lists_operators, Limits& limits);

    // Throws Stopped.
    void set(const NodeView& node);

    const RelaxedModel& model() const { return model_; }
    std::span<const RelaxedFact> facts() const { return facts_; }
    std::span<const RelaxedFact> goals() const { return goals_; }
    // Of the composition model.
    std::span<const OperatorId> operators() const { return operators_; }
    bool is_reachable(OperatorId op) const { return seen_[model_.operator_task[op]] == epoch_; }
    // Of the decomposition model: tasks that nothing is ordered before may start.
    std::span<const RelaxedFact> starts() const { return starts_; }

    // The model's facts and operators, and the network's.
    std::size_t fact_count() const { return fact_count_; }
    std::size_t operator_count() const { return model_.operator_count() + order_needs_.size(); }
    std::span<const RelaxedFact> preconditions(OperatorId op) const {
        return is_of_model(op) ? model_.preconditions[op] : order_needs_[op - model_.operator_count()];
    }
    std::span<const RelaxedFact> adds(OperatorId op) const {
        return is_of_model(op) ? model_.adds[op] : order_makes_[op - model_.operator_count()];
    }
    OwnerId owner(OperatorId op) const { return is_of_model(op) ? model_.owner[op] : free_owner_; }
    template <typename Visit>
    void for_each_reader(RelaxedFact fact, Visit visit) const {
        for (const OperatorId op : row(model_.precondition_of, fact)) {
            visit(op);
        }
        follow(first_reader_, readers_, fact, visit);
    }
    template <typename Visit>
    void for_each_achiever(RelaxedFact fact, Visit visit) const {
        for (const OperatorId op : row(model_.achievers, fact)) {
            visit(op);
        }
        follow(first_achiever_, achievers_, fact, visit);
    }

private:
    // Chains through a list: where each fact's starts, as of an epoch.
    struct Start {
        std::uint32_t epoch;
        std::uint32_t link;
    };
    struct Link {
        OperatorId op;
        std::uint32_t next;
    };
    static constexpr std::uint32_t kEnd = static_cast<std::uint32_t>(-1);

    std::span<const OperatorId> row(const Rows<OperatorId, RelaxedFact>& rows, RelaxedFact fact) const {
        return fact < model_.fact_count() ? rows[fact] : std::span<const OperatorId>{};
    }
    bool is_of_model(OperatorId op) const { return op < model_.operator_count(); }
    void set_facts(std::span<const std::uint64_t> state);
    void reach_operators();
    void reach(TaskId task);
    void start_in_order(const NodeView& node);
    void start_one_by_one(std::span<const TaskId> tasks);
    RelaxedFact add_fact();
    void add_order(std::span<const RelaxedFact> needed, std::span<const RelaxedFact> made);
    void chain(std::vector<Start>& starts, std::vector<Link>& links, RelaxedFact fact, OperatorId op) const;

    template <typename Visit>
    void follow(const std::vector<Start>& starts, const std::vector<Link>& links, RelaxedFact fact, Visit visit) const {
        if (starts.empty() || starts[fact].epoch != epoch_) {
            return;
        }
        for (std::uint32_t at = starts[fact].link; at != kEnd; at = links[at].next) {
            visit(links[at].op);
        }
    }

    const RelaxedModel& model_;
    Limits& limits_;
    bool lists_operators_;
    OwnerId free_owner_;
    std::vector<RelaxedFact> facts_;
    std::vector<RelaxedFact> goals_;
    std::vector<OperatorId> operators_;
    std::vector<RelaxedFact> starts_;
    std::vector<TaskId> pending_;
    std::vector<std::uint32_t> seen_;  // by TaskId: the epoch in which it was seen
    // The network's operators: what they need and make, and who reads or makes a fact (by RelaxedFact).
    Rows<RelaxedFact> order_needs_;
    Rows<RelaxedFact> order_makes_;
    std::vector<Start> first_reader_;
    std::vector<Start> first_achiever_;
    std::vector<Link> readers_;
    std::vector<Link> achievers_;
    std::vector<RelaxedFact> needed_;
    std::size_t fact_count_ = 0;
    std::uint32_t epoch_ = 0;
};

}  // namespace relax

#endif
