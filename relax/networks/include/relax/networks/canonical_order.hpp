#ifndef RELAX_NETWORKS_CANONICAL_ORDER_HPP
#define RELAX_NETWORKS_CANONICAL_ORDER_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/networks/ordered_tasks.hpp"

namespace relax {

// Finds an order of the occurrences that depends on the network's structure alone, as far as colour refinement with
// individualisation can tell (as in McKay's nauty, 1981, but only along one branch): by number of predecessors, then by
// colour. The order refines the network's, since predecessors have fewer predecessors.
//
// Nothing but work depends on how canonical it is. Two networks are taken for the same only if, each in its order, they
// are equal task by task and pair by pair, which is an isomorphism. Isomorphic ones that come in different orders
// (equal colours that are no automorphism, or two colours with one hash) are two networks, and are searched twice.
class CanonicalOrder {
public:
    explicit CanonicalOrder(Limits& limits) : limits_(limits) {}

    // Returns the old index for each new one; valid until the next call. Throws Stopped.
    std::span<const std::uint32_t> of(const OrderedTasks& network);

    // How many occurrences, pairs of the order and words of it have been looked at so far, with repetitions.
    std::uint64_t work() const { return work_; }

private:
    void colour(const OrderedTasks& network);
    void refine(const OrderedTasks& network);
    void sort();
    bool are_twins(const OrderedTasks& network, std::uint32_t left, std::uint32_t right);

    Limits& limits_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> predecessor_count_;
    std::vector<std::uint64_t> colours_;
    std::vector<std::uint64_t> from_predecessors_;
    std::vector<std::uint64_t> from_successors_;
    std::vector<std::uint64_t> sorted_;
    OrderedTasks successors_;        // the network's order turned round
    bool knows_successors_ = false;  // they are made for the first pair that needs them
    std::uint64_t work_ = 0;
};

}  // namespace relax

#endif
