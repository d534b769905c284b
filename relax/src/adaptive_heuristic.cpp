#include "relax/adaptive_heuristic.hpp"

#include <algorithm>

namespace relax {

namespace {

constexpr std::uint32_t kWindow = 32;
constexpr std::uint32_t kLongestPause = 4096;

}  // namespace

bool AdaptiveHeuristic::is_worth_asking() {
    if (asks_always_ || unasked_nodes_ == 0) {
        return true;
    }
    --unasked_nodes_;
    return false;
}

void AdaptiveHeuristic::note_answer(bool told_more) {
    ++answers_;
    useful_answers_ += told_more ? 1 : 0;
    if (answers_ == kWindow) {
        pause_ = useful_answers_ > 0 ? 0 : std::clamp(2 * pause_, kWindow, kLongestPause);
        unasked_nodes_ = pause_;
        answers_ = 0;
        useful_answers_ = 0;
    }
}

}  // namespace relax
