#include "relax/policies/explicit_source.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace relax {

ExplicitSource::ExplicitSource(std::vector<ExplicitNode> nodes, std::uint32_t root)
    : nodes_(std::move(nodes)), root_(root), ids_(nodes_.size()) {
    const auto check = [this](std::uint32_t number) {
        if (number >= nodes_.size()) {
            throw std::out_of_range("no such node: " + std::to_string(number));
        }
    };
    check(root);
    for (const ExplicitNode& node : nodes_) {
        for (const DraftDecision& decision : node.decisions) {
            std::ranges::for_each(decision.successors, check);
        }
    }
}

void ExplicitSource::decide(DecisionGraph& graph, PolicyNodeId node, std::vector<DraftDecision>& decisions) {
    decisions = nodes_[numbers_[node]].decisions;
    for (DraftDecision& decision : decisions) {
        for (PolicyNodeId& successor : decision.successors) {
            successor = add(graph, successor);
        }
    }
}

double ExplicitSource::bound(PolicyNodeId node, double known) { return std::max(known, nodes_[numbers_[node]].lower); }

PolicyNodeId ExplicitSource::add(DecisionGraph& graph, std::uint32_t number) {
    if (!ids_[number]) {
        const ExplicitNode& node = nodes_[number];
        ids_[number] = node.is_done ? graph.add_done(node.stop) : graph.add_open(node.first_lower, node.stop, 0);
        numbers_.push_back(number);
    }
    return *ids_[number];
}

}  // namespace relax
