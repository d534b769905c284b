#ifndef RELAX_POLICIES_POLICY_EVALUATION_HPP
#define RELAX_POLICIES_POLICY_EVALUATION_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/base/strong_components.hpp"
#include "relax/policies/envelope.hpp"
#include "relax/policies/linear_component.hpp"
#include "relax/policies/recursion.hpp"

namespace relax {

// A spectral radius that differs from 1 by no more is not told from 1.
inline constexpr double kRadiusMargin = 1e-9;

// What the policy of an envelope is worth at each of its nodes, exactly but for rounding: component by component of its
// graph, those first that others lead to. A component with a loop is a system of linear equations, in the worths
// themselves or in their exponentials.
//
// Exponentials are taken relative to the largest path: let Y(n) be the largest sum of weights on a path from n out of
// the component, and of the worth there. Then e^(weight + Y(n') - Y(n)) is at most 1, so that nothing overflows; and
// the solution relative to e^Y is at least 1, so that nothing underflows. There is such a Y unless weights sum to more
// than 0 around a cycle; the spectral radius is above 1 then. Scaling rows and columns leaves the radius as it is.
class PolicyEvaluation {
public:
    explicit PolicyEvaluation(Limits& limits) : limits_(limits) {}

    // Replace the worths by those of the policy. Where it has none (an averse agent's loop that costs more than can be
    // expected, and all that may lead there), the worth is kNever. Returns the worst that came up. Throws Stopped.
    LinearOutcome evaluate(Envelope& envelope, Recursion kind);
    // The same for the places from `first` to before `end`, which contain each component that they have a part of. The
    // whole envelope was evaluated before.
    LinearOutcome evaluate(Envelope& envelope, Recursion kind, std::uint32_t first, std::uint32_t end);

private:
    LinearOutcome evaluate_component(Envelope& envelope, Recursion kind, std::span<const std::uint32_t> component);
    LinearOutcome solve_expected(Envelope& envelope, Recursion kind, std::span<const std::uint32_t> component);
    LinearOutcome solve_exponential(Envelope& envelope, Recursion kind, std::span<const std::uint32_t> component);
    void find_potentials(const Envelope& envelope, std::span<const std::uint32_t> component);

    Limits& limits_;
    StrongComponents components_;
    LinearComponent linear_;
    std::vector<std::uint32_t> index_;  // by place: in its component; kElsewhere outside the present one
    std::vector<double> exits_;         // by index: ln of what leaves the component
    std::vector<double> potentials_;    // by index: Y
};

}  // namespace relax

#endif
