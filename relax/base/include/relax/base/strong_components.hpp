#ifndef RELAX_BASE_STRONG_COMPONENTS_HPP
#define RELAX_BASE_STRONG_COMPONENTS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace relax {

// The strongly connected components of a graph (Tarjan 1972), without recursion. A component is visited after all that
// can be reached from it.
class StrongComponents {
public:
    // `successors(vertex)`: a span of vertices, those that are no vertex of the graph being at least `count`; valid
    // until the next call with the same vertex. `visit(component)`: a span of its vertices.
    template <typename Successors, typename Visit>
    void find(std::uint32_t count, Successors successors, Visit visit) {
        find(0, count, successors, visit);
    }
    // Of the graph of the vertices from `first` on, so many.
    template <typename Successors, typename Visit>
    void find(std::uint32_t first, std::uint32_t count, Successors successors, Visit visit) {
        first_ = first;
        index_.assign(count, kUnseen);
        low_.resize(count);
        std::uint32_t next = 0;
        for (std::uint32_t start = 0; start < count; ++start) {
            if (index_[start] != kUnseen) {
                continue;
            }
            enter(first_ + start, next);
            while (!frames_.empty()) {
                Frame& frame = frames_.back();
                const auto row = successors(frame.vertex);
                if (frame.at < row.size()) {
                    const std::uint32_t to = row[frame.at++];
                    if (to < first_ || to - first_ >= count) {
                        continue;
                    }
                    const std::uint32_t index = index_[to - first_];
                    if (index == kUnseen) {
                        enter(to, next);
                    } else if (index != kClosed) {
                        low(frame.vertex) = std::min(low(frame.vertex), index);
                    }
                    continue;
                }
                leave(visit);
            }
        }
    }

private:
    static constexpr std::uint32_t kUnseen = std::numeric_limits<std::uint32_t>::max();
    static constexpr std::uint32_t kClosed = kUnseen - 1;

    struct Frame {
        std::uint32_t vertex;
        std::uint32_t at;
    };

    std::uint32_t& low(std::uint32_t vertex) { return low_[vertex - first_]; }

    void enter(std::uint32_t vertex, std::uint32_t& next) {
        index_[vertex - first_] = low(vertex) = next++;
        stack_.push_back(vertex);
        frames_.push_back({vertex, 0});
    }

    template <typename Visit>
    void leave(Visit visit) {
        const std::uint32_t vertex = frames_.back().vertex;
        frames_.pop_back();
        if (!frames_.empty()) {
            std::uint32_t& above = low(frames_.back().vertex);
            above = std::min(above, low(vertex));
        }
        if (low(vertex) != index_[vertex - first_]) {
            return;
        }
        std::size_t begin = stack_.size() - 1;
        while (stack_[begin] != vertex) {
            --begin;
        }
        for (std::size_t at = begin; at < stack_.size(); ++at) {
            index_[stack_[at] - first_] = kClosed;
        }
        visit(std::span<const std::uint32_t>(stack_).subspan(begin));
        stack_.resize(begin);
    }

    std::uint32_t first_ = 0;
    std::vector<std::uint32_t> index_;  // by vertex from `first_` on, in the order of discovery
    std::vector<std::uint32_t> low_;
    std::vector<std::uint32_t> stack_;
    std::vector<Frame> frames_;
};

}  // namespace relax

#endif
