#include "relax/policies/network_nodes.hpp"

#include <algorithm>

#include "relax/base/cost.hpp"

namespace relax {

PairId NetworkNodes::pair_of(StateId state, NetworkId network) {
    const Pair pair{state, network};
    const std::uint64_t hash = hash_of(pair);
    if (const auto found = pair_table_.find(
            hash, [&](PairId id) { return pairs_[id].state == state && pairs_[id].network == network; })) {
        return *found;
    }
    const PairId id(pairs_.size());
    pairs_.push_back(pair);
    pair_table_.add(hash, id);
    return id;
}

PolicyNodeId NetworkNodes::find(PairId pair, AmountLeft left) const {
    const auto found = node_table_.find(
        hash_of(Node{pair, left}), [&](PolicyNodeId id) { return nodes_[id].pair == pair && nodes_[id].left == left; });
    return found.value_or(PolicyNodeId(nodes_.size()));
}

void NetworkNodes::add(PairId pair, AmountLeft left) {
    const PolicyNodeId id(nodes_.size());
    nodes_.push_back({pair, left});
    node_table_.add(hash_of(Node{pair, left}), id);
}

namespace {

// What it saves to expand no node that need not be expanded is not known here: as much as many evaluations.
constexpr std::uint64_t kWorkSaved = std::uint64_t{1} << 8;
// In units of the heuristic's work: at first it may take a part of a second; then as much as an expansion takes, about,
// for each pair that was never looked at closer, since it has not saved more than the expansion of these.
constexpr std::uint64_t kWorkPerPair = 1500;
constexpr std::uint64_t kFirstWork = std::uint64_t{1} << 24;

}  // namespace

PairBounds::PairBounds(const PricedProblem& priced, const HeuristicInfo& heuristic, PolicyProgression& progression,
                       const NetworkNodes& nodes, Limits& limits)
    : progression_(progression),
      nodes_(nodes),
      network_bounds_(progression.networks(), priced.task_bounds(limits)),
      heuristic_(heuristic.make(priced, limits), heuristic.is_blind) {}

Cost PairBounds::known(PairId pair) {
    while (pair >= entries_.size()) {
        entries_.push_back({network_bounds_[nodes_.network(PairId(entries_.size()))], false, false});
    }
    return entries_[pair].bound;
}

Cost PairBounds::closer(PairId pair) {
    known(pair);
    Entry& entry = entries_[pair];
    met_pairs_ += entry.is_met ? 0 : 1;
    entry.is_met = true;
    if (entry.is_asked || entry.bound >= kInfinity || !is_affordable() || !heuristic_.is_worth_asking()) {
        return entry.bound;
    }
    NodeView view = progression_.view(nodes_.state(pair), nodes_.network(pair));
    view.tdg_bound = entry.bound;
    const Cost told = heuristic_->evaluate(view).value_or(kInfinity);
    heuristic_.note_answer(told > entry.bound, kWorkSaved);
    entry.bound = std::max(entry.bound, told);
    entry.is_asked = true;
    return entry.bound;
}

bool PairBounds::is_affordable() {
    return heuristic_->work() <= kFirstWork + kWorkPerPair * (nodes_.pair_count() - met_pairs_);
}

}  // namespace relax
