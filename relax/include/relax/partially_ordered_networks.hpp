#ifndef RELAX_PARTIALLY_ORDERED_NETWORKS_HPP
#define RELAX_PARTIALLY_ORDERED_NETWORKS_HPP

#include <optional>
#include <span>
#include <vector>

#include "relax/canonical_order.hpp"
#include "relax/id_table.hpp"
#include "relax/segmented_array.hpp"
#include "relax/task_network.hpp"

namespace relax {

// Occurrences with a transitively closed order, brought into a canonical order before they are kept. Two networks get
// the same number only if their canonical forms are equal to the letter, which is a verified isomorphism; that
// isomorphic networks always meet in one form is not promised, and nothing but work depends on it.
class PartiallyOrderedNetworks final : public TaskNetworks {
public:
    PartiallyOrderedNetworks(const GroundProblem& problem, std::vector<Cost> task_bounds);

    NetworkId initial() override;
    void unconstrained(NetworkId network, std::vector<Occurrence>& occurrences) const override;
    void tasks(NetworkId network, std::vector<TaskId>& tasks) const override;
    bool are_totally_ordered() const override { return false; }
    std::span<const std::uint64_t> predecessors(NetworkId network) const override;
    void ordered_tasks(NetworkId network, OrderedTasks& ordered) const override;
    NetworkId progress(NetworkId network, std::uint32_t index, std::vector<Origin>* origins) override;
    NetworkId decompose(NetworkId network, std::uint32_t index, MethodId method, std::vector<Origin>* origins) override;
    Cost bound(NetworkId network) const override { return records_[network].bound; }
    std::uint32_t size(NetworkId network) const override { return records_[network].size; }

private:
    // `words`: first the predecessor rows, then the tasks, two to a word.
    struct Record {
        const std::uint64_t* words;
        Cost bound;
        std::uint32_t size;
    };

    TaskId task(const Record& record, std::uint32_t index) const;
    void replace(NetworkId network, std::uint32_t index, std::optional<MethodId> method);
    NetworkId intern(std::vector<Origin>* origins);

    const GroundProblem& problem_;
    std::vector<Cost> task_bounds_;
    RunArena<std::uint64_t> words_;
    SegmentedArray<Record> records_;
    IdTable table_;

    // The network being built.
    OrderedTasks draft_;
    std::vector<Origin> draft_origins_;
    CanonicalOrder canonical_;
    std::vector<std::uint32_t> place_;  // in the canonical order, by index in the draft
    std::vector<std::uint64_t> form_;
};

}  // namespace relax

#endif
