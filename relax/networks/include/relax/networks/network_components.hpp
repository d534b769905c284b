#ifndef RELAX_NETWORKS_NETWORK_COMPONENTS_HPP
#define RELAX_NETWORKS_NETWORK_COMPONENTS_HPP

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/canonical_order.hpp"

namespace relax {

using ComponentId = Id<struct ComponentTag>;

// Tasks that the order ties together, each such component kept once in a canonical form. Two components get the same
// number only if their forms are equal to the letter, which is a verified isomorphism; that isomorphic components
// always meet in one form is not promised, and nothing but work depends on it.
class NetworkComponents {
public:
    explicit NetworkComponents(Limits& limits) : canonical_(limits) {}

    // Bring a component into its canonical form and keep it. `order`, where given, gets for each index there the one in
    // `draft`. Throws Stopped.
    ComponentId intern(const OrderedTasks& draft, std::vector<std::uint32_t>* order);

    // As `CanonicalOrder::work`.
    std::uint64_t work() const { return canonical_.work() + work_; }

    std::uint32_t size(ComponentId id) const { return records_[id].size; }
    // How many have no predecessors: they come first.
    std::uint32_t unconstrained(ComponentId id) const { return records_[id].unconstrained; }
    // The sum of the tasks' bounds.
    Cost bound(ComponentId id, std::span<const Cost> task_bounds) const;
    TaskId task(ComponentId id, std::uint32_t index) const {
        const Record& record = records_[id];
        assert(index < record.size);
        const std::uint64_t* tasks = record.words + record.size * words_for(record.size);
        return TaskId(static_cast<std::uint32_t>(tasks[index / 2] >> (index % 2 * 32)));
    }
    // The predecessors of a task, as bits.
    std::span<const std::uint64_t> row(ComponentId id, std::uint32_t index) const {
        assert(index < records_[id].size);
        const std::size_t words = words_for(records_[id].size);
        return {records_[id].words + index * words, words};
    }

private:
    // `words`: first the predecessor rows, then the tasks, two to a word.
    struct Record {
        const std::uint64_t* words;
        std::uint32_t size;
        std::uint32_t unconstrained;
    };

    static std::size_t form_words(std::size_t count) { return count * words_for(count) + (count + 1) / 2; }

    RunArena<std::uint64_t> words_;
    SegmentedArray<Record> records_;
    IdTable<ComponentId> table_;
    CanonicalOrder canonical_;
    std::vector<std::uint32_t> place_;  // in the canonical order, by index in the draft
    std::vector<std::uint64_t> form_;
    std::uint64_t work_ = 0;  // besides finding orders
};

}  // namespace relax

#endif
