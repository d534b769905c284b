#ifndef RELAX_SEARCH_OPEN_LIST_HPP
#define RELAX_SEARCH_OPEN_LIST_HPP

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/ids.hpp"

namespace relax {

// The open list, of nodes or labels: a heap by priority (f, say). Ties: low h first; then, so that recursion without a
// cost does not go on without end, small networks, by powers of two of their sizes; then the newest. An entry is not
// removed when its node improves: whoever pops one compares it with the node.
template <typename Element>
class OpenList {
public:
    struct Entry {
        Cost priority;
        Cost h;
        std::uint32_t pending_tasks;
        Element id;
        std::uint64_t age;
    };

    bool is_empty() const { return heap_.empty(); }
    const Entry& top() const {
        assert(!is_empty());
        return heap_.front();
    }
    std::span<const Entry> entries() const { return heap_; }

    void push(Element id, Cost priority, Cost h, std::uint32_t pending_tasks) {
        heap_.push_back({priority, h, pending_tasks, id, next_age_++});
        std::push_heap(heap_.begin(), heap_.end(), comes_later);
    }

    Entry pop() {
        assert(!is_empty());
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
