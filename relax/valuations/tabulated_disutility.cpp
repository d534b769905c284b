#include "relax/valuations/tabulated_disutility.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace relax {

TabulatedDisutility::TabulatedDisutility(std::vector<double> table) : table_(std::move(table)) {
    assert(!table_.empty() && std::ranges::is_sorted(table_));
    last_ = static_cast<double>(table_.size() - 1);
    rounding_ = kLawRounding * std::max(std::abs(table_.front()), std::abs(table_.back()));
}

double TabulatedDisutility::expectation(const Law& law, double more) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < law.size(); ++i) {
        sum += law.probability[i] * at(law.at[i] + more);
    }
    return sum;
}

double TabulatedDisutility::bound_of_sum(const Law& law, FlooredLaw& other) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < law.size(); ++i) {
        sum += law.probability[i] * other.expectation([&](double cost) { return at(law.at[i] + cost); });
    }
    return sum - rounding_;
}

}  // namespace relax
