#include "relax/progression/ending.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace relax {

namespace {

constexpr std::uint32_t kMostSteps = 64;
constexpr std::uint64_t kFirst = 200;  // networks, which it is asked about in any case
constexpr std::uint64_t kOneIn = 50;

}  // namespace

bool Ending::is_possible(const OrderedTasks& network) {
    is_left_.assign(network.tasks.size(), true);
    steps_ = 0;
    const bool is_possible = can_end(network, MacroActions::kNothing);
    ++asked_;
    impossible_ += is_possible ? 0 : 1;
    return is_possible;
}

bool Ending::is_worth_asking() {
    ++networks_;
    return asked_ < kFirst || impossible_ * kOneIn >= asked_ || networks_ % kOneIn == 0;
}

// Whether what is left can be executed before the last actions, as far as one can see.
bool Ending::can_end(const OrderedTasks& network, MacroId last) {
    const std::size_t count = network.tasks.size();
    is_before_.assign(network.words, 0);
    work_ += network.tasks.size() + network.predecessors.size();
    for (std::size_t index = 0; index < count; ++index) {
        for (std::size_t word = 0; is_left_[index] && word < network.words; ++word) {
            is_before_[word] |= network.row(index)[word];
        }
    }
    const std::size_t first = candidates_.size();
    for (std::uint32_t index = 0; index < count; ++index) {
        if (is_left_[index] && !has_bit(is_before_, index)) {
            candidates_.push_back(index);
        }
    }
    const auto may_be_anything = [&](std::uint32_t index) {
        const TaskId task = network.tasks[index];
        return !problem_.is_primitive(task) || !macros_.fits(problem_.action_of(task));
    };
    const std::size_t end = candidates_.size();
    bool is_possible = first == end || std::ranges::any_of(std::span(candidates_).subspan(first), may_be_anything);
    for (std::size_t at = first; at < end && !is_possible; ++at) {
        const std::uint32_t index = candidates_[at];
        const auto longer = macros_.prepend(problem_.action_of(network.tasks[index]), last);
        if (++steps_ > kMostSteps) {
            is_possible = true;
        } else if (longer) {
            is_left_[index] = false;
            is_possible = can_end(network, *longer);
            is_left_[index] = true;
        }
    }
    candidates_.resize(first);
    return is_possible;
}

}  // namespace relax
