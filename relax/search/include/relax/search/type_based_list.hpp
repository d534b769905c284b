#ifndef RELAX_SEARCH_TYPE_BASED_LIST_HPP
#define RELAX_SEARCH_TYPE_BASED_LIST_HPP

#include <cassert>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/search/search_node.hpp"

namespace relax {

// Open nodes in buckets by h and g; what comes next is a random node of a random bucket, so that rare kinds of nodes
// are expanded, too (Xie, Mueller, Holte and Imai, "Type-Based Exploration with Multiple Search Queues for Satisficing
// Planning", AAAI 2014). The sequence of random numbers is always the same.
class TypeBasedList {
public:
    bool is_empty() const { return buckets_.empty(); }

    void push(NodeId node, Cost h, Cost g) {
        const auto [known, is_new] = bucket_of_.try_emplace({h, g}, buckets_.size());
        if (is_new) {
            buckets_.push_back({{h, g}, {}});
        }
        buckets_[known->second].nodes.push_back(node);
    }

    NodeId pop() {
        assert(!is_empty());
        const std::size_t chosen = random(buckets_.size());
        std::vector<NodeId>& nodes = buckets_[chosen].nodes;
        std::swap(nodes[random(nodes.size())], nodes.back());
        const NodeId node = nodes.back();
        nodes.pop_back();
        if (nodes.empty()) {
            bucket_of_[buckets_.back().type] = chosen;
            bucket_of_.erase(buckets_[chosen].type);
            std::swap(buckets_[chosen], buckets_.back());
            buckets_.pop_back();
        }
        return node;
    }

private:
    using Type = std::pair<Cost, Cost>;
    struct Bucket {
        Type type;
        std::vector<NodeId> nodes;
    };

    // Marsaglia's xorshift generator.
    std::size_t random(std::size_t below) {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 7;
        state_ ^= state_ << 17;
        return static_cast<std::size_t>(state_ % below);
    }

    std::vector<Bucket> buckets_;
    std::map<Type, std::size_t> bucket_of_;
    std::uint64_t state_ = 88172645463325252ULL;
};

}  // namespace relax

#endif
