#include "relax/networks/totally_ordered_networks.hpp"

#include <cassert>
#include <utility>

#include "relax/base/cost.hpp"

namespace relax {

namespace {

std::uint64_t hash_cell(std::uint32_t first, std::uint32_t rest) { return mix((std::uint64_t{first} << 32) | rest); }

}  // namespace

TotallyOrderedNetworks::TotallyOrderedNetworks(const AnalysedProblem& problem, bool use_macros, Limits& limits)
    : problem_(problem), sequences_(problem.sequences(limits)) {
    if (use_macros) {
        macros_.emplace(problem, limits);
    }
    cells_.push_back({});
    forms_.push_back({});
}

bool TotallyOrderedNetworks::fits(const GroundProblem& problem) {
    for (const MethodId method : problem.methods()) {
        const std::size_t count = problem.method_subtasks[method].size();
        if (count > 1 && problem.method_ordering[method].size() != count * (count - 1) / 2) {
            return false;
        }
    }
    return true;
}

NetworkId TotallyOrderedNetworks::initial() { return intern(problem_.initial_task, kEmpty); }

void TotallyOrderedNetworks::unconstrained(NetworkId network, std::vector<Occurrence>& occurrences) const {
    if (network != kEmpty) {
        occurrences.push_back({0, cells_[network].first});
    }
}

void TotallyOrderedNetworks::tasks(NetworkId network, std::vector<TaskId>& tasks) const {
    for (; network != kEmpty; network = cells_[network].rest) {
        tasks.push_back(cells_[network].first);
    }
}

void TotallyOrderedNetworks::ordered_tasks(NetworkId network, OrderedTasks& ordered) const {
    ordered.reset(cells_[network].size);
    for (std::size_t index = 0; network != kEmpty; network = cells_[network].rest, ++index) {
        ordered.tasks[index] = cells_[network].first;
        for (std::size_t earlier = 0; earlier < index; ++earlier) {
            ordered.put_before(earlier, index);
        }
    }
}

NetworkId TotallyOrderedNetworks::progress(NetworkId network, std::uint32_t /*index*/, std::vector<Origin>* origins) {
    assert(network != kEmpty);
    const Cell& cell = cells_[network];
    if (origins != nullptr) {
        origins->clear();
        for (std::uint32_t index = 1; index < cell.size; ++index) {
            origins->push_back({false, index});
        }
    }
    return cell.rest;
}

NetworkId TotallyOrderedNetworks::decompose(NetworkId network, std::uint32_t index, MethodId method,
                                            std::vector<Origin>* origins) {
    const std::uint32_t size = cells_[network].size;
    assert(index < size);
    earlier_.clear();
    for (; earlier_.size() < index; network = cells_[network].rest) {
        earlier_.push_back(cells_[network].first);
    }
    const auto sequence = sequences_[method];
    const auto subtasks = problem_.method_subtasks[method];
    assert(cells_[network].first == problem_.method_task[method]);
    NetworkId result = cells_[network].rest;
    for (std::size_t place = sequence.size(); place-- > 0;) {
        result = intern(subtasks[sequence[place]], result);
    }
    for (std::size_t place = index; place-- > 0;) {
        result = intern(earlier_[place], result);
    }
    if (origins != nullptr) {
        origins->clear();
        for (std::uint32_t old = 0; old < size; ++old) {
            if (old != index) {
                origins->push_back({false, old});
                continue;
            }
            for (const std::uint32_t subtask : sequence) {
                origins->push_back({true, subtask});
            }
        }
    }
    return result;
}

NetworkId TotallyOrderedNetworks::intern(TaskId first, NetworkId rest) {
    const std::uint64_t hash = hash_cell(first, rest);
    const auto known =
        table_.find(hash, [&](NetworkId id) { return cells_[id].first == first && cells_[id].rest == rest; });
    if (known) {
        return *known;
    }
    const auto id = static_cast<NetworkId>(cells_.size());
    cells_.push_back({first, rest, cells_[rest].size + 1, macros_ ? form_of(first, cells_[rest].form) : kEmptyForm});
    table_.add(hash, id);
    return id;
}

FormId TotallyOrderedNetworks::form_of(TaskId first, FormId rest) {
    assert(macros_);
    if (rest == kImpossible) {
        return kImpossible;
    }
    if (!problem_.is_primitive(first) || !macros_->fits(problem_.action_of(first))) {
        return intern_form(first, rest);
    }
    const auto tasks = static_cast<std::uint32_t>(problem_.task_count());
    const bool continues = rest != kEmptyForm && forms_[rest].first >= tasks;
    const auto macro = macros_->prepend(problem_.action_of(first),
                                        continues ? MacroId(forms_[rest].first - tasks) : MacroActions::kNothing);
    if (!macro) {
        return kImpossible;
    }
    const FormId after = continues ? forms_[rest].rest : rest;
    return *macro == MacroActions::kNothing ? after : intern_form(tasks + *macro, after);
}

FormId TotallyOrderedNetworks::intern_form(std::uint32_t first, FormId rest) {
    const std::uint64_t hash = hash_cell(first, rest);
    const auto known =
        form_table_.find(hash, [&](FormId id) { return forms_[id].first == first && forms_[id].rest == rest; });
    if (known) {
        return *known;
    }
    const auto id = static_cast<FormId>(forms_.size());
    forms_.push_back({first, rest});
    form_table_.add(hash, id);
    return id;
}

}  // namespace relax
