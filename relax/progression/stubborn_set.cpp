#include "relax/progression/stubborn_set.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <iterator>
#include <limits>

namespace relax {

std::optional<std::span<const Occurrence>> StubbornSet::find(const OrderedTasks& network,
                                                             std::span<const std::uint64_t> state,
                                                             std::span<const Occurrence> unconstrained,
                                                             bool is_certain) {
    assert(state.size() == transition_.word_count());
    is_certain_ = is_certain;
    turn_round(network, successors_);
    work_ += network.tasks.size() + network.predecessors.size();
    occurring_.clear();
    for (const TaskId task : network.tasks) {
        occurring_.push_back(&problem_.profile(task, limits_));
    }
    is_open_.assign(network.words, 0);
    is_applicable_.assign(network.words, 0);
    compounds_.reads.clear();
    compounds_.makes.clear();
    are_compounds_kept_out_ = false;
    for (const Occurrence& occurrence : unconstrained) {
        if (!is_action(occurrence.task)) {
            are_compounds_kept_out_ = are_compounds_kept_out_ || is_kept_out(occurrence.task);
            compounds_.reads.insert_all(occurring_[occurrence.index]->reads);
            compounds_.makes.insert_all(occurring_[occurrence.index]->makes);
            continue;
        }
        set_bit(is_open_, occurrence.index);
        if (transition_.is_applicable(problem_.any_outcome(occurrence.task), state)) {
            set_bit(is_applicable_, occurrence.index);
        }
    }
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    std::vector<std::uint64_t> best;
    for (const Occurrence& seed : unconstrained) {
        // Two occurrences of one task lead to similar sets, as a rule: one is enough.
        const bool is_tried = std::any_of(unconstrained.data(), &seed,
                                          [&](const Occurrence& earlier) { return earlier.task == seed.task; });
        if (is_tried || !is_action(seed.task) || !close(network, state, seed.index)) {
            continue;
        }
        const auto count = static_cast<std::size_t>(
            std::ranges::count_if(members_, [this](std::uint32_t member) { return has_bit(is_applicable_, member); }));
        if (count < fewest) {
            fewest = count;
            best = is_member_;
        }
        if (fewest <= 1) {
            break;
        }
    }
    if (best.empty()) {
        return std::nullopt;
    }
    found_.clear();
    std::ranges::copy_if(unconstrained, std::back_inserter(found_), [&](const Occurrence& occurrence) {
        return has_bit(best, occurrence.index) && has_bit(is_applicable_, occurrence.index);
    });
    return found_;
}

// Make the smallest set with this member. False if a compound task would have to be in it.
bool StubbornSet::close(const OrderedTasks& network, std::span<const std::uint64_t> state, std::uint32_t seed) {
    members_.clear();
    is_member_.assign(network.words, 0);
    is_after_.assign(network.words, 0);
    put(seed);
    for (std::size_t next = 0; next < members_.size(); ++next) {
        limits_.stop_if_reached();
        const std::uint32_t member = members_[next];
        // Sooner than the loop below would find it.
        if (are_compounds_kept_out_ || concerns(compounds_, member, state)) {
            return false;
        }
        work_ += network.tasks.size();
        for (std::uint32_t other = 0; other < network.tasks.size(); ++other) {
            if (has_bit(is_member_, other) || has_bit(is_after_, other) ||
                !(is_kept_out(network.tasks[other]) || concerns(*occurring_[other], member, state))) {
                continue;
            }
            if (has_bit(is_open_, other)) {
                put(other);
                continue;
            }
            // It is constrained, so that something unconstrained is before it; and that is no member, or it would be
            // after a member.
            const std::optional<std::uint32_t> first = open_before(network, other);
            if (!first) {
                return false;
            }
            put(*first);
        }
    }
    return true;
}

// An unconstrained action before the task, if there is one.
std::optional<std::uint32_t> StubbornSet::open_before(const OrderedTasks& network, std::uint32_t task) const {
    const auto row = network.row(task);
    for (std::size_t word = 0; word < row.size(); ++word) {
        if (const std::uint64_t bits = row[word] & is_open_[word]) {
            return static_cast<std::uint32_t>(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
        }
    }
    return std::nullopt;
}

void StubbornSet::put(std::uint32_t index) {
    assert(!has_bit(is_member_, index) && has_bit(is_open_, index));
    members_.push_back(index);
    set_bit(is_member_, index);
    for (std::size_t word = 0; word < is_after_.size(); ++word) {
        is_after_[word] |= successors_.row(index)[word];
    }
}

// Whether the other task violates (1) or (2) for this member.
bool StubbornSet::concerns(const TaskProfile& other, std::uint32_t member, std::span<const std::uint64_t> state) const {
    const TaskProfile& action = *occurring_[member];
    if (!has_bit(is_applicable_, member)) {
        // The particular precondition of (2): the first that is false.
        const auto open =
            std::ranges::find_if(action.preconditions, [state](Literal literal) { return !holds(state, literal); });
        assert(open != action.preconditions.end());
        return other.makes.contains(*open);
    }
    return std::ranges::any_of(action.read_list,
                               [&](Literal literal) { return other.makes.contains(negation(literal)); }) ||
           std::ranges::any_of(action.made_list, [&](Literal literal) {
               return other.reads.contains(negation(literal)) || other.makes.contains(negation(literal));
           });
}

}  // namespace relax
