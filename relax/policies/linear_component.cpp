#include "relax/policies/linear_component.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace relax {

namespace {

constexpr std::uint64_t kMostWork = 30000000;  // of elimination, in entries: a part of a second
constexpr std::uint32_t kMostSolutionSweeps = 1000000;
constexpr double kPrecision = 1e-13;  // of iteration, relative to the largest value

}  // namespace

void LinearComponent::begin(std::size_t size, bool is_stochastic, double margin) {
    is_stochastic_ = is_stochastic;
    margin_ = margin;
    entries_.clear();
    ends_.clear();
    constants_.clear();
    leaks_.clear();
    ends_.reserve(size);
    constants_.reserve(size);
    leaks_.reserve(size);
}

void LinearComponent::finish_row(double constant, double leak) {
    ends_.push_back(entries_.size());
    constants_.push_back(constant);
    leaks_.push_back(leak);
}

LinearOutcome LinearComponent::solve(Limits& limits) {
    take_rows();
    LinearOutcome outcome = LinearOutcome::Solved;
    if (!eliminate_all(outcome, limits)) {
        return iterate(limits);
    }
    if (outcome == LinearOutcome::Solved) {
        substitute();
    }
    return outcome;
}

void LinearComponent::take_rows() {
    const std::size_t size = ends_.size();
    if (rows_.size() < size) {
        rows_.resize(size);
        columns_.resize(size);
        place_.resize(size, 0);
    }
    self_.assign(size, 0);
    pivots_.assign(size, 0);
    is_gone_.assign(size, false);
    rest_ = constants_;
    out_ = leaks_;
    order_.clear();
    for (std::size_t row = 0; row < size; ++row) {
        rows_[row].clear();
        columns_[row].clear();
    }
    std::size_t at = 0;
    for (std::uint32_t row = 0; row < size; ++row) {
        auto& entries = rows_[row];
        for (; at < ends_[row]; ++at) {
            const auto [column, weight] = entries_[at];
            if (column == row) {
                self_[row] += weight;
            } else if (place_[column] != 0) {
                entries[place_[column] - 1].weight += weight;
            } else if (weight > 0) {
                entries.push_back({column, weight});
                columns_[column].push_back(row);
                place_[column] = static_cast<std::uint32_t>(entries.size());
            }
        }
        for (const Entry& entry : entries) {
            place_[entry.column] = 0;
        }
    }
}

// False where that takes too long.
bool LinearComponent::eliminate_all(LinearOutcome& outcome, Limits& limits) {
    using Ranked = std::pair<std::size_t, std::uint32_t>;
    std::priority_queue<Ranked, std::vector<Ranked>, std::greater<>> queue;
    const auto rank = [this](std::uint32_t row) { return rows_[row].size() * columns_[row].size(); };
    for (std::uint32_t row = 0; row < ends_.size(); ++row) {
        queue.emplace(rank(row), row);
    }
    work_ = 0;
    while (!queue.empty()) {
        limits.stop_if_reached();
        const auto [ranked, row] = queue.top();
        queue.pop();
        if (rank(row) > ranked) {
            queue.emplace(rank(row), row);
            continue;
        }
        outcome = eliminate(row);
        if (outcome != LinearOutcome::Solved) {
            return true;
        }
        if (work_ > kMostWork) {
            return false;
        }
    }
    return true;
}

double LinearComponent::pivot_of(std::uint32_t row) const {
    if (!is_stochastic_) {
        return 1 - self_[row];
    }
    double sum = out_[row];
    for (const Entry& entry : rows_[row]) {
        sum += entry.weight;
    }
    return sum;
}

LinearOutcome LinearComponent::eliminate(std::uint32_t pivot_row) {
    const double pivot = pivot_of(pivot_row);
    if (!(pivot > (is_stochastic_ ? 0 : margin_))) {
        return !is_stochastic_ && pivot > -margin_ ? LinearOutcome::Undecided : LinearOutcome::Infinite;
    }
    pivots_[pivot_row] = pivot;
    is_gone_[pivot_row] = true;
    order_.push_back(pivot_row);
    for (const std::uint32_t row : columns_[pivot_row]) {
        if (is_gone_[row]) {
            continue;
        }
        auto& entries = rows_[row];
        const auto found = std::ranges::find(entries, pivot_row, &Entry::column);
        if (found == entries.end()) {
            continue;
        }
        const double factor = found->weight / pivot;
        *found = entries.back();
        entries.pop_back();
        add_row(pivot_row, row, factor);
    }
    return LinearOutcome::Solved;
}

void LinearComponent::add_row(std::uint32_t pivot_row, std::uint32_t row, double factor) {
    auto& entries = rows_[row];
    work_ += entries.size() + rows_[pivot_row].size();
    for (std::size_t at = 0; at < entries.size(); ++at) {
        place_[entries[at].column] = static_cast<std::uint32_t>(at + 1);
    }
    for (const auto [column, weight] : rows_[pivot_row]) {
        if (column == row) {
            self_[row] += factor * weight;
        } else if (place_[column] != 0) {
            entries[place_[column] - 1].weight += factor * weight;
        } else {
            entries.push_back({column, factor * weight});
            columns_[column].push_back(row);
            place_[column] = static_cast<std::uint32_t>(entries.size());
        }
    }
    for (const Entry& entry : entries) {
        place_[entry.column] = 0;
    }
    rest_[row] += factor * rest_[pivot_row];
    out_[row] += factor * out_[pivot_row];
}

void LinearComponent::substitute() {
    solution_.assign(ends_.size(), 0);
    for (auto row = order_.rbegin(); row != order_.rend(); ++row) {
        double sum = rest_[*row];
        for (const auto [column, weight] : rows_[*row]) {
            sum += weight * solution_[column];
        }
        solution_[*row] = sum / pivots_[*row];
    }
}

// One round of Gauss-Seidel for x or, with 1 for each constant, for s. Returns the largest change in a row.
double LinearComponent::sweep(std::vector<double>& values, bool counts_steps) const {
    double largest = 0;
    for (std::size_t row = ends_.size(); row-- > 0;) {  // what leads out comes late
        double sum = counts_steps ? 1 : constants_[row];
        double self = 0;
        double elsewhere = leaks_[row];
        for (std::size_t at = row == 0 ? 0 : ends_[row - 1]; at < ends_[row]; ++at) {
            const auto [column, weight] = entries_[at];
            if (column == row) {
                self += weight;
            } else {
                sum += weight * values[column];
                elsewhere += weight;
            }
        }
        const double value = sum / (is_stochastic_ ? elsewhere : 1 - self);
        largest = std::max(largest, std::abs(value - values[row]));
        values[row] = value;
    }
    return largest;
}

bool LinearComponent::is_near(double largest) const {
    double residual = 0;
    double most_steps = 0;
    std::size_t at = 0;
    for (std::uint32_t row = 0; row < ends_.size(); ++row) {
        double sum = constants_[row] - solution_[row];
        double steps = steps_[row];
        for (; at < ends_[row]; ++at) {
            sum += entries_[at].weight * solution_[entries_[at].column];
            steps -= entries_[at].weight * steps_[entries_[at].column];
        }
        if (!(steps >= 0.5)) {
            return false;
        }
        residual = std::max(residual, std::abs(sum));
        most_steps = std::max(most_steps, steps_[row]);
    }
    return 2 * most_steps * residual <= std::max(kPrecision, 4e-16 * most_steps) * largest;
}

LinearOutcome LinearComponent::iterate(Limits& limits) {
    solution_.assign(ends_.size(), 0);
    steps_.assign(ends_.size(), 0);
    constexpr std::uint32_t kSweepsUntilLook = 16;
    for (std::uint32_t count = 1; count <= kMostSolutionSweeps; ++count) {
        limits.stop_if_reached();
        sweep(solution_, false);
        sweep(steps_, true);
        if (count % kSweepsUntilLook != 0) {
            continue;
        }
        const double largest = std::abs(*std::ranges::max_element(solution_, {}, [](double x) { return std::abs(x); }));
        if (!std::isfinite(largest) || !std::isfinite(steps_.front())) {
            return LinearOutcome::Infinite;
        }
        if (is_near(largest)) {
            return LinearOutcome::Solved;
        }
    }
    return LinearOutcome::Undecided;
}

}  // namespace relax
