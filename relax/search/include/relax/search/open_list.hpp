#ifndef RELAX_SEARCH_OPEN_LIST_HPP
#define RELAX_SEARCH_OPEN_LIST_HPP

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/search/search_node.hpp"

namespace relax {

// The open list: a heap by priority (f, say); ties by low h, then the newest first, but for recursion that costs
// nothing and would dive for ever: a network comes after all those with half as many tasks or fewer. Entries are not
// removed when their node improves: who pops one asks the node.
class OpenList {
public:
    struct Entry {
        Cost priority;
        Cost h;
        std::uint32_t pending_tasks;
        NodeId node;
        std::uint64_t age;
    };

    bool is_empty() const { return heap_.empty(); }
    const Entry& top() const { return heap_.front(); }
    std::span<const Entry> entries() const { return heap_; }

    void push(NodeId node, Cost priority, Cost h, std::uint32_t pending_tasks) {
        heap_.push_back({priority, h, pending_tasks, node, next_age_++});
        std::push_heap(heap_.begin(), heap_.end(), comes_later);
    }

    Entry pop() {
        std::pop_heap(heap_.begin(), heap_.end(), comes_later);
        const Entry entry = heap_.back();
        heap_.pop_back();
        return entry;
    }

private:
    static bool comes_later(const Entry& left, const Entry& right) {
        if (left.priority != right.priority) {
            return left.priority > right.priority;
        }
        if (left.h != right.h) {
            return left.h > right.h;
        }
        const int left_scale = std::bit_width(left.pending_tasks);
        const int right_scale = std::bit_width(right.pending_tasks);
        if (left_scale != right_scale) {
            return left_scale > right_scale;
        }
        return left.age < right.age;
    }

    std::vector<Entry> heap_;
    std::uint64_t next_age_ = 0;
};

}  // namespace relax

#endif
