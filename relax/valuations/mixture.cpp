#include "relax/valuations/mixture.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace relax {

const Law& Mixture::law() {
    assert(!outcomes_.empty());
    std::ranges::sort(outcomes_);
    at_.clear();
    probability_.clear();
    for (const auto& [cost, probability] : outcomes_) {
        if (!at_.empty() && at_.back() == cost) {
            probability_.back() += probability;
        } else {
            at_.push_back(cost);
            probability_.push_back(probability);
        }
    }
    above_.assign(at_.size(), 0.0);
    excess_.assign(at_.size(), 0.0);
    for (std::size_t i = at_.size() - 1; i-- > 0;) {
        above_[i] = above_[i + 1] + probability_[i + 1];
        excess_[i] = excess_[i + 1] + above_[i] * (at_[i + 1] - at_[i]);
    }
    law_ = {at_, probability_, above_, excess_};
    return law_;
}

}  // namespace relax
