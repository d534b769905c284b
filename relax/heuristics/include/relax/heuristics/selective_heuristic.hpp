#ifndef RELAX_HEURISTICS_SELECTIVE_HEURISTIC_HPP
#define RELAX_HEURISTICS_SELECTIVE_HEURISTIC_HPP

#include <cstdint>
#include <memory>
#include <utility>

#include "relax/heuristics/heuristic.hpp"

namespace relax {

// A heuristic, and whether asking it pays. Its answers are judged by windows of some nodes each: as long as the work
// that they save (by raising h) is less than the work that they take, more and more nodes pass without being asked
// about before the next window. Whatever it decides, bounds stay bounds: a node without an answer keeps its cheaper
// ones.
class SelectiveHeuristic {
public:
    // `asks_always`: whether to ask for every node all the same.
    SelectiveHeuristic(std::unique_ptr<Heuristic> heuristic, bool asks_always)
        : heuristic_(std::move(heuristic)), asks_always_(asks_always) {}

    Heuristic& operator*() const { return *heuristic_; }
    Heuristic* operator->() const { return heuristic_.get(); }

    // Whether the heuristic should be asked about the next node.
    bool is_worth_asking();
    // Tell whether the answer told more than was known, and what a node costs that needs not be expanded, in units of
    // `Heuristic::work`.
    void note_answer(bool told_more, std::uint64_t work_saved);

private:
    std::unique_ptr<Heuristic> heuristic_;
    bool asks_always_;
    // Of the present window: how many answers there were, and the work they saved; then how many nodes still go
    // unasked, and how many will the next time.
    std::uint32_t answers_ = 0;
    std::uint64_t window_start_ = 0;  // of its work
    std::uint64_t saved_ = 0;
    std::uint32_t unasked_nodes_ = 0;
    std::uint32_t pause_ = 0;
};

}  // namespace relax

#endif
