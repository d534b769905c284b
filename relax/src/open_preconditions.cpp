#include "relax/open_preconditions.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace relax {

namespace {

using Bits = std::vector<std::uint64_t>;

bool has(const Bits& bits, std::size_t index) { return (bits[index / 64] >> (index % 64) & 1U) != 0; }
void add(Bits& bits, std::size_t index) { bits[index / 64] |= std::uint64_t{1} << (index % 64); }

bool intersect(std::span<const std::uint64_t> left, std::span<const std::uint64_t> right) {
    for (std::size_t word = 0; word < left.size(); ++word) {
        if ((left[word] & right[word]) != 0) {
            return true;
        }
    }
    return false;
}

}  // namespace

OpenPreconditions::OpenPreconditions(const GroundProblem& problem)
    : problem_(problem),
      initial_state_(StateTransition(problem).initial_state()),
      literal_words_((2 * problem.fact_count() + 63) / 64),
      profiles_(problem.task_count()) {}

bool OpenPreconditions::can_be_met(const OrderedTasks& network) {
    occurring_.clear();
    for (const TaskId task : network.tasks) {
        occurring_.push_back(&profile(task));
    }
    list_successors(network);
    for (std::size_t task = 0; task < network.tasks.size(); ++task) {
        for (const Literal literal : occurring_[task]->needed) {
            if (!can_be_met(network, task, literal)) {
                return false;
            }
        }
    }
    return true;
}

bool OpenPreconditions::can_be_met(const OrderedTasks& network, std::size_t task, Literal literal) {
    threats_.assign(network.words, 0);
    bool is_threatened = false;
    for (std::size_t earlier = 0; earlier < network.tasks.size(); ++earlier) {
        if (network.is_before(earlier, task) && has(occurring_[earlier]->certain, literal)) {
            add(threats_, earlier);
            is_threatened = true;
        }
    }
    if (!is_threatened && holds(initial_state_, literal / 2) == (literal % 2 == 0)) {
        return true;
    }
    for (std::size_t maker = 0; maker < network.tasks.size(); ++maker) {
        if (maker != task && has(occurring_[maker]->may, literal) && !network.is_before(task, maker) &&
            !intersect(std::span(successors_).subspan(maker * network.words, network.words), threats_)) {
            return true;
        }
    }
    return false;
}

void OpenPreconditions::list_successors(const OrderedTasks& network) {
    successors_.assign(network.predecessors.size(), 0);
    for (std::size_t later = 0; later < network.tasks.size(); ++later) {
        for (std::size_t earlier = 0; earlier < network.tasks.size(); ++earlier) {
            if (network.is_before(earlier, later)) {
                successors_[earlier * network.words + later / 64] |= std::uint64_t{1} << (later % 64);
            }
        }
    }
}

const OpenPreconditions::Profile& OpenPreconditions::profile(TaskId task) {
    if (profiles_[task].is_known) {
        return profiles_[task];
    }
    Profile result;
    if (problem_.is_primitive(task)) {
        result = of_action(task);
    } else {
        // What any action that it can be decomposed into may do.
        result.may.assign(literal_words_, 0);
        result.certain.assign(literal_words_, 0);
        std::vector<bool> is_seen(problem_.task_count(), false);
        std::vector<TaskId> pending{task};
        is_seen[task] = true;
        while (!pending.empty()) {
            const TaskId next = pending.back();
            pending.pop_back();
            if (problem_.is_primitive(next)) {
                const Bits& may = profile(next).may;
                for (std::size_t word = 0; word < literal_words_; ++word) {
                    result.may[word] |= may[word];
                }
                continue;
            }
            for (const MethodId method : problem_.methods_of(next)) {
                for (const TaskId subtask : problem_.method_subtasks[method]) {
                    if (!is_seen[subtask]) {
                        is_seen[subtask] = true;
                        pending.push_back(subtask);
                    }
                }
            }
        }
    }
    result.is_known = true;
    return profiles_[task] = std::move(result);
}

OpenPreconditions::Profile OpenPreconditions::of_action(ActionId action) const {
    Profile result;
    for (const FactId fact : problem_.preconditions[action]) {
        result.needed.push_back(2 * fact);
    }
    for (const FactId fact : problem_.negative_preconditions[action]) {
        result.needed.push_back(2 * fact + 1);
    }
    result.may.assign(literal_words_, 0);
    result.certain.assign(literal_words_, 0);
    for (EffectId effect = problem_.effect_begin[action]; effect < problem_.effect_begin[action + 1]; ++effect) {
        const bool is_certain =
            problem_.effect_conditions[effect].empty() && problem_.effect_negative_conditions[effect].empty();
        for (const FactId fact : problem_.effect_adds[effect]) {
            add(result.may, 2 * fact);
            if (is_certain) {
                add(result.certain, 2 * fact + 1);
            }
        }
        for (const FactId fact : problem_.effect_deletes[effect]) {
            add(result.may, 2 * fact + 1);
            if (is_certain) {
                add(result.certain, 2 * fact);
            }
        }
    }
    // What it may make true it does not certainly make false: adding wins over deleting.
    for (std::size_t word = 0; word < literal_words_; ++word) {
        const std::uint64_t positive = 0x5555555555555555ULL;
        result.certain[word] &= ~(result.may[word] & positive);
    }
    return result;
}

}  // namespace relax
