#include "pruning.hpp"

#include <algorithm>

namespace relax::grounding {

namespace {

// Relaxed reachability by counting unmet conditions. Conditions are numbered:
// cases first, then effects, which have one condition more: that their action
// is reached.
class LiteralReachability {
public:
    LiteralReachability(const Cases& cases, const std::vector<bool>& is_initially_true, Limits& limits)
        : cases_(cases), is_initially_true_(is_initially_true) {
        watchers_ = Rows<std::uint32_t, Literal>::filled(2 * is_initially_true.size(), [&](auto put) {
            for (std::uint32_t number = 0; number < count(); ++number) {
                limits.stop_if_reached();
                std::ranges::for_each(condition(number), [&](Literal literal) { put(literal, number); });
            }
        });
    }

    // Returns by literal whether it is reached by the living cases and effects;
    // `is_met` then tells of conditions.
    std::vector<bool> run(Limits& limits) {
        is_reached_.assign(2 * is_initially_true_.size(), false);
        is_owner_reached_.assign(cases_.cases.size(), false);
        unmet_.clear();
        for (std::uint32_t number = 0; number < count(); ++number) {
            limits.stop_if_reached();
            unmet_.push_back(static_cast<std::uint32_t>(condition(number).size()) + (is_case(number) ? 0 : 1));
        }
        for (const ReachedFactId fact : all_ids<ReachedFactId>(is_initially_true_.size())) {
            reach(literal_of(fact, !is_initially_true_[fact]));
        }
        for (CaseId number = 0; number < cases_.owner.size(); ++number) {
            if (unmet_[number] == 0) {
                fire(number);
            }
        }
        while (!pending_.empty()) {
            limits.stop_if_reached();
            const Literal literal = pending_.back();
            pending_.pop_back();
            for (const std::uint32_t watcher : watchers_[literal]) {
                limits.stop_if_reached();
                meet(watcher);
            }
        }
        return is_reached_;
    }

    bool is_case_met(CaseId number) const { return unmet_[number] == 0; }
    bool is_effect_met(std::uint32_t effect) const { return unmet_[cases_.owner.size() + effect] == 0; }

private:
    std::size_t count() const { return cases_.owner.size() + cases_.effect_owner.size(); }
    bool is_case(std::uint32_t number) const { return number < cases_.owner.size(); }
    std::span<const Literal> condition(std::uint32_t number) const {
        return is_case(number) ? cases_.condition[number] : cases_.effect_condition[number - cases_.owner.size()];
    }

    void reach(Literal literal) {
        if (!is_reached_[literal]) {
            is_reached_[literal] = true;
            pending_.push_back(literal);
        }
    }

    void meet(std::uint32_t number) {
        if (--unmet_[number] == 0) {
            fire(number);
        }
    }

    void fire(std::uint32_t number) {
        if (!is_case(number)) {
            const std::size_t effect = number - cases_.owner.size();
            if (cases_.is_effect_alive[effect]) {
                for (const Literal change : cases_.effect_changes[effect]) {
                    reach(change);
                }
            }
            return;
        }
        const NodeId owner = cases_.owner[number];
        if (cases_.is_alive[number] && !is_owner_reached_[owner]) {
            is_owner_reached_[owner] = true;
            for (const EffectId effect : cases_.effects[owner]) {
                meet(static_cast<std::uint32_t>(cases_.owner.size()) + effect);
            }
        }
    }

    const Cases& cases_;
    const std::vector<bool>& is_initially_true_;
    Rows<std::uint32_t, Literal> watchers_;  // conditions that have it
    std::vector<bool> is_reached_;           // by literal
    std::vector<bool> is_owner_reached_;     // by action node
    std::vector<std::uint32_t> unmet_;       // by condition
    std::vector<Literal> pending_;
};

// An action lives while one of its cases does.
void drop_actions(TaskGraph& graph, const Cases& cases) {
    for (NodeId node = 0; node < graph.action_node_count; ++node) {
        bool is_alive = false;
        for (const CaseId number : cases.cases[node]) {
            is_alive = is_alive || cases.is_alive[number];
        }
        graph.is_node_alive[node] = graph.is_node_alive[node] && is_alive;
    }
}

// Returns whether any case was dropped.
bool drop_cases(const TaskGraph& graph, Cases& cases) {
    bool has_dropped = false;
    for (CaseId number = 0; number < cases.owner.size(); ++number) {
        if (cases.is_alive[number] && !graph.is_node_alive[cases.owner[number]]) {
            cases.is_alive[number] = false;
            has_dropped = true;
        }
    }
    for (std::size_t effect = 0; effect < cases.effect_owner.size(); ++effect) {
        cases.is_effect_alive[effect] =
            cases.is_effect_alive[effect] && graph.is_node_alive[cases.effect_owner[effect]];
    }
    return has_dropped;
}

}  // namespace

std::vector<bool> prune(TaskGraph& graph, Cases& cases, const std::vector<bool>& is_initially_true, Limits& limits) {
    LiteralReachability reachability(cases, is_initially_true, limits);
    while (true) {
        std::vector<bool> is_reached = reachability.run(limits);
        for (CaseId number = 0; number < cases.owner.size(); ++number) {
            cases.is_alive[number] = cases.is_alive[number] && reachability.is_case_met(number);
        }
        for (std::uint32_t effect = 0; effect < cases.effect_owner.size(); ++effect) {
            cases.is_effect_alive[effect] = cases.is_effect_alive[effect] && reachability.is_effect_met(effect);
        }
        drop_actions(graph, cases);
        prune_bottom_up(graph, limits);
        prune_top_down(graph, limits);
        if (!drop_cases(graph, cases)) {
            return is_reached;
        }
    }
}

}  // namespace relax::grounding
