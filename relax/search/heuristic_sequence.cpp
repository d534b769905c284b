#include "relax/search/heuristic_sequence.hpp"

#include <algorithm>

#include "relax/base/cost.hpp"

namespace relax {

HeuristicSequence::HeuristicSequence(const PricedProblem& priced, const FindPlansOptions& options,
                                     Progression& progression, NetworkBounds& bounds, Limits& limits,
                                     SearchStatistics& statistics)
    : progression_(progression), bounds_(bounds), statistics_(statistics) {
    if (options.endings && !progression.networks().are_totally_ordered()) {
        ending_.emplace(priced.problem, limits);
    }
    for (const HeuristicInfo* const heuristic : options.heuristics) {
        heuristics_.emplace_back(heuristic->make(priced, limits), !options.selective);
    }
}

bool HeuristicSequence::raise_h(SearchNode& node, std::uint64_t work_so_far, std::uint64_t expanded) {
    if (!can_end(node)) {
        ++statistics_.dead_ends;
        node.h = kInfinity;
    }
    while (node.h < kInfinity && node.heuristics_asked < heuristics_.size()) {
        SelectiveHeuristic& heuristic = heuristics_[node.heuristics_asked++];
        if (!heuristic.is_worth_asking()) {
            continue;
        }
        const std::uint64_t cuts_before = heuristic->rounds();
        NodeView view = progression_.view(node.state, node.network);
        view.tdg_bound = bounds_[node.network];
        const auto h = heuristic->evaluate(view);
        ++statistics_.evaluated;
        statistics_.cuts += heuristic->rounds() - cuts_before;
        statistics_.dead_ends += h ? 0 : 1;
        heuristic.note_answer(!h || *h > node.h, work_saved(heuristic, work_so_far, expanded));
        node.h = std::max(node.h, h.value_or(kInfinity));
        return true;
    }
    return node.h >= kInfinity;
}

bool HeuristicSequence::can_end(const SearchNode& node) {
    return !ending_ || node.heuristics_asked > 0 || !ending_->is_worth_asking() ||
           ending_->is_possible(progression_.ordered_tasks(node.network));
}

// What it saves not to expand a node: what one has cost so far on average, this heuristic left out. The first heuristic
// is always worth its work.
std::uint64_t HeuristicSequence::work_saved(const SelectiveHeuristic& heuristic, std::uint64_t work_so_far,
                                            std::uint64_t expanded) const {
    if (&heuristic == &heuristics_.front()) {
        return std::uint64_t{1} << 50;
    }
    return (work_so_far + work() - heuristic->work()) / std::max<std::uint64_t>(1, expanded);
}

std::uint64_t HeuristicSequence::work() const {
    std::uint64_t work = ending_ ? ending_->work() : 0;
    for (const SelectiveHeuristic& heuristic : heuristics_) {
        work += heuristic->work();
    }
    return work;
}

}  // namespace relax
