#include "relax/search/forced_steps.hpp"

namespace relax {

namespace {

constexpr std::uint32_t kMostSteps = 1000;  // recursion that is forced may have no end

}  // namespace

std::optional<NodeId> ForcedSteps::follow(NodeId id, const Generate& generate) {
    const Cost priority = priority_(nodes_[id]);
    std::uint32_t step = 0;
    for (; step < kMostSteps && priority_(nodes_[id]) <= priority && !limits_.check(); ++step) {
        SearchNode& node = nodes_[id];
        if (node.has_several_successors || !progression_.expand_if_forced(node.state, node.network, successors_)) {
            node.has_several_successors = true;
            return id;
        }
        node.is_expanded = true;
        ++statistics_.expanded;
        const auto next = successors_.empty() ? std::nullopt : generate(id, successors_.front());
        if (!next) {
            return std::nullopt;
        }
        id = *next;
        nodes_[id].is_forced = true;
    }
    if (step > 0 && forced_cycle_.closes(nodes_, progression_.networks(), id)) {
        ++statistics_.dead_ends;
        nodes_[id].h = kInfinity;
        return std::nullopt;
    }
    return id;
}

}  // namespace relax
