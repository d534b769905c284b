#include "relax/valuations/law_bounds.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "relax/valuations/law_orders.hpp"

namespace relax {

LawId highest_of(LawTable& table, LawId one, LawId other) {
    const Law& left = table[one];
    const Law& right = table[other];
    if (one == other || is_never_more(left, right)) {
        return one;
    }
    if (is_never_more(right, left)) {
        return other;
    }
    std::vector<double> at;
    std::vector<double> probability;
    double above = 1.0;
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < left.size() || j < right.size()) {
        const double next =
            j == right.size() || (i < left.size() && left.at[i] <= right.at[j]) ? left.at[i] : right.at[j];
        i += i < left.size() && left.at[i] == next ? 1 : 0;
        j += j < right.size() && right.at[j] == next ? 1 : 0;
        const double lower = std::min(left.above_of(i), right.above_of(j));
        if (lower < above) {
            at.push_back(next);
            probability.push_back(above - lower);
            above = lower;
        }
    }
    return table.add(at, probability);
}

LawId lifted(LawTable& table, LawId id, double probability) {
    const Law& law = table[id];
    if (law.size() == 1) {
        return id;
    }
    std::vector<double> at(law.at.begin(), law.at.end());
    std::vector<double> left(law.probability.begin(), law.probability.end());
    double moved = 0.0;
    while (moved < probability && at.size() > 1) {
        const double taken = std::min(left.back(), probability - moved);
        moved += taken;
        if (taken < left.back()) {
            left.back() -= taken;
            break;
        }
        at.pop_back();
        left.pop_back();
    }
    left.front() += moved;
    return table.add(at, left);
}

}  // namespace relax
