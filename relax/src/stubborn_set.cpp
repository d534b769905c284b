#include "relax/stubborn_set.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>

namespace relax {

namespace {

bool has(std::span<const std::uint64_t> row, std::size_t index) { return (row[index / 64] >> (index % 64) & 1U) != 0; }
void add(std::span<std::uint64_t> row, std::size_t index) { row[index / 64] |= std::uint64_t{1} << (index % 64); }

bool is_true(std::span<const std::uint64_t> state, Literal literal) {
    return holds(state, literal / 2) == (literal % 2 == 0);
}

}  // namespace

std::optional<std::span<const Occurrence>> StubbornSet::find(const OrderedTasks& network,
                                                             std::span<const std::uint64_t> state,
                                                             std::span<const Occurrence> unconstrained) {
    turn_round(network, successors_);
    occurring_.clear();
    for (const TaskId task : network.tasks) {
        occurring_.push_back(&profiles_[task]);
    }
    is_open_.assign(network.words, 0);
    is_compound_.assign(network.words, 0);
    is_applicable_.assign(network.words, 0);
    for (const Occurrence& occurrence : unconstrained) {
        add(is_open_, occurrence.index);
        if (!problem_.is_primitive(occurrence.task)) {
            add(is_compound_, occurrence.index);
        } else if (transition_.is_applicable(occurrence.task, state)) {
            add(is_applicable_, occurrence.index);
        }
    }
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    std::vector<std::uint64_t> best;
    for (const Occurrence& seed : unconstrained) {
        if (has(is_compound_, seed.index) || !close(network, state, seed.index)) {
            continue;
        }
        const auto count = static_cast<std::size_t>(
            std::ranges::count_if(members_, [this](std::uint32_t member) { return has(is_applicable_, member); }));
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
        return has(best, occurrence.index) && has(is_applicable_, occurrence.index);
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
        const std::uint32_t member = members_[next];
        for (std::uint32_t other = 0; other < network.tasks.size(); ++other) {
            if (has(is_member_, other) || has(is_after_, other) || !concerns(*occurring_[other], member, state)) {
                continue;
            }
            std::uint32_t first = other;
            if (!has(is_open_, other)) {
                // Something unconstrained is before it and not a member, else it would be after one or unconstrained.
                const auto row = network.row(other);
                for (std::size_t word = 0; word < row.size(); ++word) {
                    if (const std::uint64_t bits = row[word] & is_open_[word]) {
                        first =
                            static_cast<std::uint32_t>(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
                        break;
                    }
                }
            }
            if (has(is_compound_, first)) {
                return false;
            }
            put(first);
        }
    }
    return true;
}

void StubbornSet::put(std::uint32_t index) {
    members_.push_back(index);
    add(is_member_, index);
    for (std::size_t word = 0; word < is_after_.size(); ++word) {
        is_after_[word] |= successors_.row(index)[word];
    }
}

// Whether executing the other task before the member may bar, enable or change the member, or the reverse.
bool StubbornSet::concerns(const TaskProfile& other, std::uint32_t member, std::span<const std::uint64_t> state) const {
    const TaskProfile& action = *occurring_[member];
    if (!has(is_applicable_, member)) {
        // One precondition that is false is enough: nobody else makes it true.
        const auto open =
            std::ranges::find_if(action.preconditions, [state](Literal literal) { return !is_true(state, literal); });
        return other.makes.contains(*open);
    }
    return std::ranges::any_of(action.read_list,
                               [&](Literal literal) { return other.makes.contains(negation(literal)); }) ||
           std::ranges::any_of(action.made_list, [&](Literal literal) {
               return other.reads.contains(negation(literal)) || other.makes.contains(negation(literal));
           });
}

}  // namespace relax
