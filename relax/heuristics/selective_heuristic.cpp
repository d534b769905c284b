#include "relax/heuristics/selective_heuristic.hpp"

#include <algorithm>

namespace relax {

namespace {

constexpr std::uint32_t kWindow = 32;
constexpr std::uint32_t kLongestPause = 4096;
constexpr std::uint64_t kNodesBelow = 20;  // that are not expanded either, where one is not: a guess

}  // namespace

bool SelectiveHeuristic::is_worth_asking() {
    if (asks_always_ || unasked_nodes_ == 0) {
        return true;
    }
    --unasked_nodes_;
    return false;
}

void SelectiveHeuristic::note_answer(bool told_more, std::uint64_t work_saved) {
    ++answers_;
    saved_ += told_more ? work_saved : 0;
    if (answers_ == kWindow) {
        const std::uint64_t spent = heuristic_->work() - window_start_;
        pause_ = saved_ > 0 && kNodesBelow * (saved_ / kWindow) >= spent / kWindow
                     ? 0
                     : std::clamp(2 * pause_, kWindow, kLongestPause);
        unasked_nodes_ = pause_;
        answers_ = 0;
        saved_ = 0;
        window_start_ = heuristic_->work();
    }
}

}  // namespace relax
