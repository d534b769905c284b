#include "relax/search/label_space.hpp"

#include <algorithm>

namespace relax {

namespace {

std::uint64_t hash_of(StateId state, NetworkId network) { return mix((std::uint64_t{state} << 32) | network); }

template <typename Value>
std::span<Value> copied(RunArena<Value>& arena, std::span<const Value> values) {
    const std::span<Value> run = arena.allocate(values.size());
    std::ranges::copy(values, run.begin());
    return run;
}

}  // namespace

NodeId LabelSpace::find_node(StateId state, NetworkId network) {
    const auto known = node_table_.find(
        hash_of(state, network), [&](NodeId id) { return nodes_[id].state == state && nodes_[id].network == network; });
    if (known) {
        return *known;
    }
    const auto id = static_cast<NodeId>(nodes_.size());
    const std::span<Cost> least = costs_.allocate(price_count_);
    std::ranges::fill(least, 0);
    nodes_.push_back({state, network, least, 0, false, {}});
    kept_.push_back({});
    node_table_.add(hash_of(state, network), id);
    return id;
}

void LabelSpace::set_edges(NodeId node, std::span<const Edge> edges) {
    nodes_[node].edges = copied(edges_, edges);
    nodes_[node].is_expanded = true;
}

std::span<const CostPartId> LabelSpace::store(std::span<const CostPartId> parts) { return copied(parts_, parts); }

Edge LabelSpace::make_edge(NodeId to, std::span<const SearchStep> steps, std::span<const Execution> executions) {
    const std::span<Cost> costs = costs_.allocate(price_count_);
    std::ranges::fill(costs, 0);
    for (std::size_t price = 0; price < price_count_; ++price) {
        for (const Execution& execution : executions) {
            const Cost cost = valuation_.prices()[price]->cost(execution.action, execution.due_parts);
            costs[price] = add_bounds(costs[price], cost);
        }
    }
    return {to, copied(steps_, steps), copied(executions_, executions), costs};
}

std::optional<LabelId> LabelSpace::add(const Label& label) {
    if (valuation_.is_total_order()) {
        return add_in_order(label);
    }
    std::vector<Kept>& kept = kept_[label.node];
    const CostToCome known = to_come(label.node);
    if (is_superfluous({LabelId{}, label.value, label.actions}, kept, known)) {
        return std::nullopt;
    }
    const LabelId id = store(label, kept, kept.size());
    // The others that the new one makes superfluous. It is never so itself: of equal labels the older stays.
    for (std::size_t index = 0; index + 1 < kept.size();) {
        const Kept other = kept[index];
        if (valuation_.is_as_good(label.value, other.value, known)) {
            kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(index));
            if (is_superfluous(other, kept, known)) {
                labels_[other.id].is_kept = false;
                continue;
            }
            kept.insert(kept.begin() + static_cast<std::ptrdiff_t>(index), other);
        }
        ++index;
    }
    return id;
}

// Of two labels one is as good as the other: the kept ones stand in the order of their worth, those that are as good as
// the new one before its place.
std::optional<LabelId> LabelSpace::add_in_order(const Label& label) {
    std::vector<Kept>& kept = kept_[label.node];
    const Worth worth = valuation_.worth(label.value);
    const auto same = std::ranges::find(kept, label.actions, &Kept::actions);
    if (same != kept.end()) {
        has_pruned_ = has_pruned_ || count_ == 1;  // lists of actions are not told apart then
        if (valuation_.worth(same->value) <= worth) {
            return std::nullopt;
        }
        labels_[same->id].is_kept = false;
        kept.erase(same);
    }
    const auto place =
        std::ranges::upper_bound(kept, worth, {}, [this](const Kept& other) { return valuation_.worth(other.value); });
    const auto index = static_cast<std::size_t>(place - kept.begin());
    if (limits_labels_ && index >= count_) {
        has_pruned_ = true;
        return std::nullopt;
    }
    const LabelId id = store(label, kept, index);
    if (limits_labels_ && kept.size() > count_) {
        has_pruned_ = true;
        labels_[kept.back().id].is_kept = false;
        kept.pop_back();
    }
    return id;
}

bool LabelSpace::is_superfluous(const Kept& label, const std::vector<Kept>& kept, const CostToCome& to_come) {
    if (count_ == 1 && limits_labels_) {
        values_.clear();
        std::ranges::transform(kept, std::back_inserter(values_), &Kept::value);
        const bool is_superfluous = valuation_.are_as_good(values_, label.value, to_come);
        has_pruned_ = has_pruned_ || is_superfluous;
        return is_superfluous;
    }
    lists_.clear();
    for (const Kept& other : kept) {
        const bool is_listed = std::ranges::find(lists_, other.actions) != lists_.end();
        if (is_listed || !valuation_.is_as_good(other.value, label.value, to_come)) {
            continue;
        }
        if (other.actions == label.actions) {
            return true;
        }
        lists_.push_back(other.actions);
        if (limits_labels_ && lists_.size() == count_) {
            has_pruned_ = true;
            return true;
        }
    }
    return false;
}

LabelId LabelSpace::store(const Label& label, std::vector<Kept>& kept, std::size_t place) {
    const auto id = static_cast<LabelId>(labels_.size());
    labels_.push_back(label);
    labels_[id].is_kept = true;
    kept.insert(kept.begin() + static_cast<std::ptrdiff_t>(place), {id, label.value, label.actions});
    return id;
}

}  // namespace relax
