#ifndef RELAX_POLICIES_LINEAR_COMPONENT_HPP
#define RELAX_POLICIES_LINEAR_COMPONENT_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/limits.hpp"

namespace relax {

enum class LinearOutcome : std::uint8_t {
    Solved,
    Infinite,   // the spectral radius is at least 1: the sum of the powers of M has no end
    Undecided,  // it is too near to 1 for floating point to tell
};

// x = M x + b for a matrix of weights that are not negative, whose graph is strongly connected: what a policy is worth
// on a component of its graph. The solution that is meant is the sum of M^k b, which exists where the spectral radius
// of M is below 1.
//
// Solved by elimination of one unknown after the other, those of few neighbours first. I - M is an M-matrix if and only
// if all pivots are positive (Berman and Plemmons 1994, theorem 6.2.3), so that pivots decide the radius; nothing but
// pivots is found by a subtraction. Where weights are probabilities, not even these: a pivot is the sum of what leads
// elsewhere, for which each row knows what leaves the component (Grassmann, Taksar and Heyman 1985). So a solution is
// good to some digits less than double precision, however rarely the component is left.
//
// Where elimination fills the matrix up, Gauss-Seidel from below takes its place, until an error bound is small: let s
// satisfy s - M s >= 1/2 in each row; then x is off by at most 2 max(s) times the largest residual. Such an s exists if
// and only if the radius is below 1, and the sum of M^k is one.
class LinearComponent {
public:
    // Begin with so many unknowns. `is_stochastic`: weights and leaks of a row sum to 1. Otherwise pivots that differ
    // from 0 by no more than `margin` do not decide.
    void begin(std::size_t size, bool is_stochastic, double margin);
    // Rows are given in order.
    void add(std::uint32_t column, double weight) { entries_.push_back({column, weight}); }
    // `leak`: the weight that leaves the component; matters where rows are stochastic.
    void finish_row(double constant, double leak);

    // Throws Stopped.
    LinearOutcome solve(Limits& limits);
    std::span<const double> solution() const { return solution_; }

private:
    struct Entry {
        std::uint32_t column;
        double weight;
    };

    void take_rows();
    bool eliminate_all(LinearOutcome& outcome, Limits& limits);
    LinearOutcome eliminate(std::uint32_t pivot_row);
    void add_row(std::uint32_t pivot_row, std::uint32_t row, double factor);
    double pivot_of(std::uint32_t row) const;
    void substitute();
    LinearOutcome iterate(Limits& limits);
    double sweep(std::vector<double>& values, bool counts_steps) const;
    bool is_near(double largest) const;

    bool is_stochastic_ = false;
    double margin_ = 0;
    std::vector<Entry> entries_;  // as they were given
    std::vector<std::size_t> ends_;
    std::vector<double> constants_;  // as they were given; by row, as all that follows
    std::vector<double> leaks_;
    // While unknowns are eliminated: of each row what leads to others than itself, and to itself.
    std::vector<std::vector<Entry>> rows_;
    std::vector<std::vector<std::uint32_t>> columns_;  // rows that may have an entry in the column
    std::vector<double> self_;
    std::vector<double> rest_;  // constants
    std::vector<double> out_;   // leaks
    std::vector<double> pivots_;
    std::vector<bool> is_gone_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> place_;  // by column, in the row that is added to: one more than its index, or 0
    std::uint64_t work_ = 0;
    std::vector<double> solution_;
    std::vector<double> steps_;  // s above
};

}  // namespace relax

#endif
