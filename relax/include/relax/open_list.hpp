#ifndef RELAX_OPEN_LIST_HPP
#define RELAX_OPEN_LIST_HPP

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/ids.hpp"
#include "relax/search_node.hpp"

namespace relax {

// The open list: a heap by priority (f, say); ties by low h, then by fewer pending tasks, so that recursion that costs
// nothing does not dive for ever, then the newest first. Entries are not removed when their node improves: who pops one
// asks the node.
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
        if (left.pending_tasks != right.pending_tasks) {
            return left.pending_tasks > right.pending_tasks;
        }
        return left.age < right.age;
    }

    std::vector<Entry> heap_;
    std::uint64_t next_age_ = 0;
};

}  // namespace relax

#endif
