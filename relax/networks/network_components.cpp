#include "relax/networks/network_components.hpp"

#include <algorithm>
#include <cassert>

#include "relax/base/cost.hpp"

namespace relax {

ComponentId NetworkComponents::intern(const OrderedTasks& draft, std::vector<std::uint32_t>* order_of_it) {
    const std::size_t count = draft.tasks.size();
    const std::size_t words = words_for(count);
    const auto order = canonical_.of(draft);
    assert(count > 0 && order.size() == count);
    place_.resize(count);
    for (std::size_t index = 0; index < count; ++index) {
        place_[order[index]] = static_cast<std::uint32_t>(index);
    }
    form_.assign(form_words(count), 0);
    work_ += 2 * form_.size();
    std::uint32_t unconstrained = 0;
    for (std::size_t index = 0; index < count; ++index) {
        bool is_unconstrained = true;
        for_each_bit(draft.row(order[index]), [&](std::size_t earlier) {
            set_bit(std::span(form_).subspan(index * words, words), place_[earlier]);
            is_unconstrained = false;
        });
        unconstrained += is_unconstrained ? 1 : 0;
        const TaskId task = draft.tasks[order[index]];
        form_[count * words + index / 2] |= std::uint64_t{task} << (index % 2 * 32);
    }
    if (order_of_it != nullptr) {
        order_of_it->assign(order.begin(), order.end());
    }
    const std::uint64_t hash = hash_values(form_);
    const auto known = table_.find(hash, [&](ComponentId id) {
        return records_[id].size == count && std::equal(form_.begin(), form_.end(), records_[id].words);
    });
    if (known) {
        return *known;
    }
    const auto id = static_cast<ComponentId>(records_.size());
    const auto run = words_.allocate(form_.size());
    std::copy(form_.begin(), form_.end(), run.begin());
    records_.push_back({run.data(), static_cast<std::uint32_t>(count), unconstrained});
    table_.add(hash, id);
    return id;
}

Cost NetworkComponents::bound(ComponentId id, std::span<const Cost> task_bounds) const {
    Cost sum = 0;
    for (std::uint32_t index = 0; index < size(id); ++index) {
        sum = add_bounds(sum, task_bounds[task(id, index)]);
    }
    return sum;
}

}  // namespace relax
