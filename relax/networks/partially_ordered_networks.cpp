#include "relax/networks/partially_ordered_networks.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "relax/base/cost.hpp"

namespace relax {

namespace {

std::uint64_t hash_step(ComponentId component, std::uint32_t index, MethodId method) {
    return combine((std::uint64_t{component} << 32) | index, method);
}

}  // namespace

PartiallyOrderedNetworks::PartiallyOrderedNetworks(const GroundProblem& problem, Limits& limits)
    : problem_(problem), limits_(limits), components_(limits) {}

NetworkId PartiallyOrderedNetworks::initial() {
    draft_.reset(1);
    draft_.tasks[0] = problem_.initial_task;
    list_.assign(1, components_.intern(draft_, nullptr));
    return intern(list_);
}

void PartiallyOrderedNetworks::unconstrained(NetworkId network, std::vector<Occurrence>& occurrences) const {
    std::uint32_t begin = 0;
    for (const ComponentId id : components(network)) {
        for (std::uint32_t index = 0; index < components_.unconstrained(id); ++index) {
            occurrences.push_back({begin + index, components_.task(id, index)});
        }
        begin += components_.size(id);
    }
}

void PartiallyOrderedNetworks::tasks(NetworkId network, std::vector<TaskId>& tasks) const {
    for (const ComponentId id : components(network)) {
        for (std::uint32_t index = 0; index < components_.size(id); ++index) {
            tasks.push_back(components_.task(id, index));
        }
    }
}

void PartiallyOrderedNetworks::ordered_tasks(NetworkId network, OrderedTasks& ordered) const {
    ordered.reset(size(network));
    std::size_t begin = 0;
    for (const ComponentId id : components(network)) {
        for (std::uint32_t index = 0; index < components_.size(id); ++index) {
            ordered.tasks[begin + index] = components_.task(id, index);
            for_each_bit(components_.row(id, index),
                         [&](std::size_t earlier) { ordered.put_before(begin + earlier, begin + index); });
        }
        begin += components_.size(id);
    }
}

NetworkId PartiallyOrderedNetworks::progress(NetworkId network, std::uint32_t index, std::vector<Origin>* origins) {
    return step(network, index, kExecuted, origins);
}

NetworkId PartiallyOrderedNetworks::decompose(NetworkId network, std::uint32_t index, MethodId method,
                                              std::vector<Origin>* origins) {
    return step(network, index, method, origins);
}

NetworkId PartiallyOrderedNetworks::step(NetworkId network, std::uint32_t index, MethodId method,
                                         std::vector<Origin>* origins) {
    assert(index < size(network));
    const auto old = components(network);
    work_ += old.size();
    std::size_t changed = 0;
    std::uint32_t begin = 0;
    while (index >= begin + components_.size(old[changed])) {
        begin += components_.size(old[changed++]);
    }
    const auto made = change(old[changed], index - begin, method);
    list_.clear();
    std::merge(old.begin(), old.begin() + static_cast<std::ptrdiff_t>(changed), made.begin(), made.end(),
               std::back_inserter(list_));
    const auto middle = static_cast<std::ptrdiff_t>(list_.size());
    list_.insert(list_.end(), old.begin() + static_cast<std::ptrdiff_t>(changed) + 1, old.end());
    std::inplace_merge(list_.begin(), list_.begin() + middle, list_.end());
    const NetworkId result = intern(list_);
    if (origins != nullptr) {
        trace(network, changed, begin, index - begin, method, *origins);
    }
    return result;
}

// Returns the components, sorted, that a component falls into by a step.
std::span<const ComponentId> PartiallyOrderedNetworks::change(ComponentId component, std::uint32_t index,
                                                              MethodId method) {
    const std::uint64_t hash = hash_step(component, index, method);
    const auto known = transition_table_.find(hash, [&](std::uint32_t id) {
        const Transition& transition = transitions_[id];
        return transition.from == component && transition.index == index && transition.method == method;
    });
    if (known) {
        return {transitions_[*known].to, transitions_[*known].count};
    }
    replace(component, index, method);
    split(parts_);
    const auto to = lists_.allocate(parts_.size());
    std::ranges::transform(parts_, to.begin(), &Part::id);
    std::ranges::sort(to);
    transitions_.push_back({component, index, method, static_cast<std::uint32_t>(to.size()), to.data()});
    transition_table_.add(hash, static_cast<std::uint32_t>(transitions_.size() - 1));
    return to;
}

// Draft the component without a task, and with the method's subtasks, where one is given, in its place. Origins are as
// if the component were a network.
void PartiallyOrderedNetworks::replace(ComponentId component, std::uint32_t index, MethodId method) {
    const auto subtasks = method == kExecuted ? std::span<const TaskId>{} : problem_.method_subtasks[method];
    const std::uint32_t size = components_.size(component);
    assert(index < size);
    assert(method == kExecuted || components_.task(component, index) == problem_.method_task[method]);
    const std::uint32_t kept = size - 1;
    draft_.reset(kept + subtasks.size());
    draft_origins_.clear();
    const auto moved = [index](std::size_t old) { return old < index ? old : old - 1; };
    for (std::uint32_t old = 0; old < size; ++old) {
        if (old == index) {
            continue;
        }
        draft_.tasks[moved(old)] = components_.task(component, old);
        draft_origins_.push_back({false, old});
        for_each_bit(components_.row(component, old), [&](std::size_t earlier) {
            if (earlier != index) {
                draft_.put_before(moved(earlier), moved(old));
                return;
            }
            for (std::size_t subtask = 0; subtask < subtasks.size(); ++subtask) {
                draft_.put_before(kept + subtask, moved(old));
            }
        });
    }
    for_each_bit(components_.row(component, index), [&](std::size_t earlier) {
        for (std::size_t subtask = 0; subtask < subtasks.size(); ++subtask) {
            draft_.put_before(moved(earlier), kept + subtask);
        }
    });
    for (std::uint32_t subtask = 0; subtask < subtasks.size(); ++subtask) {
        draft_.tasks[kept + subtask] = subtasks[subtask];
        draft_origins_.push_back({true, subtask});
    }
    if (method != kExecuted) {
        for (const auto& [earlier, later] : problem_.method_ordering[method]) {
            draft_.put_before(kept + earlier, kept + later);
        }
    }
}

// Part the draft by its order, and keep the parts.
void PartiallyOrderedNetworks::split(std::vector<Part>& parts) {
    const std::size_t count = draft_.tasks.size();
    part_of_.resize(count);
    work_ += 4 * draft_.predecessors.size();
    std::iota(part_of_.begin(), part_of_.end(), 0U);
    const auto root = [this](std::uint32_t index) {
        while (part_of_[index] != index) {
            index = part_of_[index] = part_of_[part_of_[index]];
        }
        return index;
    };
    for (std::uint32_t later = 0; later < count; ++later) {
        for_each_bit(draft_.row(later),
                     [&](std::size_t earlier) { part_of_[root(static_cast<std::uint32_t>(earlier))] = root(later); });
    }
    parts.clear();
    place_.resize(count);
    std::vector<std::uint32_t> members;
    for (std::uint32_t leader = 0; leader < count; ++leader) {
        if (root(leader) != leader) {
            continue;
        }
        limits_.stop_if_reached();
        members.clear();
        for (std::uint32_t index = 0; index < count; ++index) {
            if (root(index) == leader) {
                place_[index] = static_cast<std::uint32_t>(members.size());
                members.push_back(index);
            }
        }
        part_.reset(members.size());
        for (const std::uint32_t index : members) {
            part_.tasks[place_[index]] = draft_.tasks[index];
            for_each_bit(draft_.row(index),
                         [&](std::size_t earlier) { part_.put_before(place_[earlier], place_[index]); });
        }
        Part part{components_.intern(part_, &order_), {}};
        for (const std::uint32_t place : order_) {
            part.origins.push_back(draft_origins_[members[place]]);
        }
        parts.push_back(std::move(part));
    }
}

// Tell where the occurrences come from in the network that a step from this one leads to: the components that stay, and
// the parts of the changed one, in the order of their numbers.
void PartiallyOrderedNetworks::trace(NetworkId network, std::size_t changed, std::uint32_t begin, std::uint32_t index,
                                     MethodId method, std::vector<Origin>& origins) {
    replace(components(network)[changed], index, method);
    split(parts_);
    assert(parts_.size() == change(components(network)[changed], index, method).size());
    for (Part& part : parts_) {
        for (Origin& origin : part.origins) {
            origin.index += origin.is_subtask ? 0 : begin;
        }
    }
    std::uint32_t here = 0;
    const auto old = components(network);
    for (std::size_t at = 0; at < old.size(); ++at) {
        const std::uint32_t size = components_.size(old[at]);
        if (at != changed) {
            parts_.push_back({old[at], {}});
            for (std::uint32_t place = 0; place < size; ++place) {
                parts_.back().origins.push_back({false, here + place});
            }
        }
        here += size;
    }
    std::ranges::stable_sort(parts_, {}, &Part::id);
    origins.clear();
    for (const Part& part : parts_) {
        origins.insert(origins.end(), part.origins.begin(), part.origins.end());
    }
    assert(old.size() > 0 && here == size(network));
}

Cost PartiallyOrderedNetworks::bound(NetworkId network, std::span<const Cost> task_bounds,
                                     const SegmentedArray<Cost>& /*by_network*/,
                                     SegmentedArray<Cost>& by_component) const {
    Cost sum = 0;
    for (const ComponentId id : components(network)) {
        while (id >= by_component.size()) {
            by_component.push_back(components_.bound(static_cast<ComponentId>(by_component.size()), task_bounds));
        }
        sum = add_bounds(sum, by_component[id]);
    }
    return sum;
}

NetworkId PartiallyOrderedNetworks::intern(std::span<const ComponentId> list) {
    assert(std::ranges::is_sorted(list));
    const std::uint64_t hash = hash_values(list);
    const auto known = table_.find(hash, [&](NetworkId id) { return std::ranges::equal(list, components(id)); });
    if (known) {
        return *known;
    }
    Record record{nullptr, static_cast<std::uint32_t>(list.size()), 0};
    for (const ComponentId id : list) {
        record.size += components_.size(id);
    }
    const auto run = lists_.allocate(list.size());
    std::ranges::copy(list, run.begin());
    record.components = run.data();
    const auto id = static_cast<NetworkId>(records_.size());
    records_.push_back(record);
    table_.add(hash, id);
    return id;
}

}  // namespace relax
