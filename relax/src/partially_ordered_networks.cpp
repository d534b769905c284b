#include "relax/partially_ordered_networks.hpp"

#include <algorithm>
#include <utility>

#include "relax/tdg_bound.hpp"

namespace relax {

namespace {

std::size_t row_words(std::size_t count) { return (count + 63) / 64; }
std::size_t form_words(std::size_t count) { return count * row_words(count) + (count + 1) / 2; }

}  // namespace

PartiallyOrderedNetworks::PartiallyOrderedNetworks(const GroundProblem& problem, std::vector<Cost> task_bounds)
    : problem_(problem), task_bounds_(std::move(task_bounds)) {}

NetworkId PartiallyOrderedNetworks::initial() {
    draft_.reset(1);
    draft_.tasks[0] = problem_.initial_task;
    draft_origins_.assign(1, {true, 0});
    return intern(nullptr);
}

void PartiallyOrderedNetworks::unconstrained(NetworkId network, std::vector<Occurrence>& occurrences) const {
    const Record& record = records_[network];
    const std::size_t words = row_words(record.size);
    // The canonical order starts with the occurrences without predecessors.
    for (std::uint32_t index = 0; index < record.size; ++index) {
        const std::uint64_t* row = record.words + index * words;
        if (std::any_of(row, row + words, [](std::uint64_t word) { return word != 0; })) {
            break;
        }
        occurrences.push_back({index, task(record, index)});
    }
}

void PartiallyOrderedNetworks::tasks(NetworkId network, std::vector<TaskId>& tasks) const {
    const Record& record = records_[network];
    for (std::uint32_t index = 0; index < record.size; ++index) {
        tasks.push_back(task(record, index));
    }
}

std::span<const std::uint64_t> PartiallyOrderedNetworks::predecessors(NetworkId network) const {
    const Record& record = records_[network];
    return {record.words, record.size * row_words(record.size)};
}

void PartiallyOrderedNetworks::ordered_tasks(NetworkId network, OrderedTasks& ordered) const {
    const Record& record = records_[network];
    ordered.reset(record.size);
    std::copy(record.words, record.words + ordered.predecessors.size(), ordered.predecessors.begin());
    for (std::uint32_t index = 0; index < record.size; ++index) {
        ordered.tasks[index] = task(record, index);
    }
}

NetworkId PartiallyOrderedNetworks::progress(NetworkId network, std::uint32_t index, std::vector<Origin>* origins) {
    replace(network, index, std::nullopt);
    return intern(origins);
}

NetworkId PartiallyOrderedNetworks::decompose(NetworkId network, std::uint32_t index, MethodId method,
                                              std::vector<Origin>* origins) {
    replace(network, index, method);
    return intern(origins);
}

TaskId PartiallyOrderedNetworks::task(const Record& record, std::uint32_t index) const {
    const std::uint64_t* tasks = record.words + record.size * row_words(record.size);
    return static_cast<TaskId>(tasks[index / 2] >> (index % 2 * 32));
}

// Draft the network without an occurrence, and with the method's subtasks, where one is given, in its place.
void PartiallyOrderedNetworks::replace(NetworkId network, std::uint32_t index, std::optional<MethodId> method) {
    const Record& record = records_[network];
    const auto subtasks = method ? problem_.method_subtasks[*method] : std::span<const TaskId>{};
    const std::uint32_t kept = record.size - 1;
    const std::size_t words = row_words(record.size);
    draft_.reset(kept + subtasks.size());
    draft_origins_.clear();
    const auto moved = [index](std::size_t old) { return old < index ? old : old - 1; };
    const auto row_of = [&](std::uint32_t old) { return std::span(record.words + old * words, words); };
    for (std::uint32_t old = 0; old < record.size; ++old) {
        if (old == index) {
            continue;
        }
        draft_.tasks[moved(old)] = task(record, old);
        draft_origins_.push_back({false, old});
        for_each_bit(row_of(old), [&](std::size_t earlier) {
            if (earlier != index) {
                draft_.put_before(moved(earlier), moved(old));
                return;
            }
            for (std::size_t subtask = 0; subtask < subtasks.size(); ++subtask) {
                draft_.put_before(kept + subtask, moved(old));
            }
        });
    }
    for_each_bit(row_of(index), [&](std::size_t earlier) {
        for (std::size_t subtask = 0; subtask < subtasks.size(); ++subtask) {
            draft_.put_before(moved(earlier), kept + subtask);
        }
    });
    for (std::uint32_t subtask = 0; subtask < subtasks.size(); ++subtask) {
        draft_.tasks[kept + subtask] = subtasks[subtask];
        draft_origins_.push_back({true, subtask});
    }
    if (method) {
        for (const auto& [earlier, later] : problem_.method_ordering[*method]) {
            draft_.put_before(kept + earlier, kept + later);
        }
    }
}

// Bring the draft into its canonical form and keep it, unless it is there already.
NetworkId PartiallyOrderedNetworks::intern(std::vector<Origin>* origins) {
    const std::size_t count = draft_.tasks.size();
    const std::size_t words = row_words(count);
    const auto order = canonical_.of(draft_);
    place_.resize(count);
    for (std::size_t index = 0; index < count; ++index) {
        place_[order[index]] = static_cast<std::uint32_t>(index);
    }
    form_.assign(form_words(count), 0);
    Cost bound = 0;
    for (std::size_t index = 0; index < count; ++index) {
        for_each_bit(draft_.row(order[index]), [&](std::size_t earlier) {
            form_[index * words + place_[earlier] / 64] |= std::uint64_t{1} << (place_[earlier] % 64);
        });
        const TaskId task = draft_.tasks[order[index]];
        form_[count * words + index / 2] |= std::uint64_t{task} << (index % 2 * 32);
        bound = add_bounds(bound, task_bounds_[task]);
    }
    if (origins != nullptr) {
        origins->clear();
        for (const std::uint32_t old : order) {
            origins->push_back(draft_origins_[old]);
        }
    }
    const std::uint64_t hash = hash_values(form_);
    const auto known = table_.find(hash, [&](NetworkId id) {
        return records_[id].size == count && std::equal(form_.begin(), form_.end(), records_[id].words);
    });
    if (known) {
        return *known;
    }
    const auto id = static_cast<NetworkId>(records_.size());
    const auto run = words_.allocate(form_.size());
    std::copy(form_.begin(), form_.end(), run.begin());
    records_.push_back({run.data(), bound, static_cast<std::uint32_t>(count)});
    table_.add(hash, id, [this](NetworkId other) {
        return hash_values(std::span(records_[other].words, form_words(records_[other].size)));
    });
    return id;
}

}  // namespace relax
