#include "relax/networks/canonical_order.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "relax/base/id_table.hpp"

namespace relax {

std::span<const std::uint32_t> CanonicalOrder::of(const OrderedTasks& network) {
    knows_successors_ = false;
    colour(network);
    refine(network);
    sort();
    // Individualise: give one of several occurrences of the same colour a colour of its own, and refine again. Twins,
    // which exchange places by an automorphism, may stay in any order.
    for (std::size_t at = 0; at + 1 < order_.size();) {
        const std::uint32_t here = order_[at];
        std::size_t end = at + 1;
        bool all_twins = true;
        for (; end < order_.size() && colours_[order_[end]] == colours_[here] &&
               predecessor_count_[order_[end]] == predecessor_count_[here];
             ++end) {
            limits_.stop_if_reached();
            all_twins = all_twins && are_twins(network, here, order_[end]);
        }
        if (all_twins) {
            at = end;
            continue;
        }
        colours_[here] = mix(colours_[here] ^ 0x5bd1e995ULL);
        refine(network);
        sort();
        at = 0;
    }
    return order_;
}

void CanonicalOrder::colour(const OrderedTasks& network) {
    const std::size_t count = network.tasks.size();
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0U);
    predecessor_count_.assign(count, 0);
    colours_.resize(count);
    work_ += network.predecessors.size();
    for (std::size_t index = 0; index < count; ++index) {
        for (const std::uint64_t word : network.row(index)) {
            predecessor_count_[index] += static_cast<std::uint32_t>(std::popcount(word));
        }
        colours_[index] = combine(network.tasks[index], predecessor_count_[index]);
    }
}

// Give each occurrence a colour made of its own and its neighbours', until no more colours appear.
void CanonicalOrder::refine(const OrderedTasks& network) {
    const std::size_t count = network.tasks.size();
    const auto count_colours = [&] {
        sorted_ = colours_;
        work_ += count;
        std::sort(sorted_.begin(), sorted_.end());
        return static_cast<std::size_t>(std::unique(sorted_.begin(), sorted_.end()) - sorted_.begin());
    };
    for (std::size_t colours = count_colours(); colours < count;) {
        from_predecessors_.assign(count, 0);
        from_successors_.assign(count, 0);
        for (std::size_t later = 0; later < count; ++later) {
            limits_.stop_if_reached();
            for_each_bit(network.row(later), [&](std::size_t earlier) {
                from_predecessors_[later] += mix(colours_[earlier]);
                from_successors_[earlier] += mix(colours_[later]);
                ++work_;
            });
        }
        for (std::size_t index = 0; index < count; ++index) {
            colours_[index] = combine(combine(colours_[index], from_predecessors_[index]), from_successors_[index]);
        }
        const std::size_t more = count_colours();
        if (more <= colours) {
            break;
        }
        colours = more;
    }
}

void CanonicalOrder::sort() {
    work_ += order_.size();
    std::sort(order_.begin(), order_.end(), [this](std::uint32_t left, std::uint32_t right) {
        if (predecessor_count_[left] != predecessor_count_[right]) {
            return predecessor_count_[left] < predecessor_count_[right];
        }
        return colours_[left] != colours_[right] ? colours_[left] < colours_[right] : left < right;
    });
}

// Same task, same predecessors, same successors.
bool CanonicalOrder::are_twins(const OrderedTasks& network, std::uint32_t left, std::uint32_t right) {
    work_ += network.words;
    if (network.tasks[left] != network.tasks[right] || !std::ranges::equal(network.row(left), network.row(right))) {
        return false;
    }
    if (!knows_successors_) {
        turn_round(network, successors_);
        knows_successors_ = true;
        work_ += network.predecessors.size();
    }
    return std::ranges::equal(successors_.row(left), successors_.row(right));
}

}  // namespace relax
