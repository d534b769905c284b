#ifndef RELAX_GROUNDING_LITERALS_HPP
#define RELAX_GROUNDING_LITERALS_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "facts.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/literal.hpp"

namespace relax::grounding {

// A reached fact of a predicate that can change. Those that something reads become the facts of the ground problem.
using ReachedFactId = Id<struct ReachedFactTag>;
using Literal = Id<LiteralOf<ReachedFactId>>;

// Sorted, without repetitions and contradictions; empty: true.
using Conjunction = std::vector<Literal>;
// Any of them; empty: false.
using Disjunction = std::vector<Conjunction>;

inline bool is_true(const Disjunction& cases) { return cases.size() == 1 && cases[0].empty(); }

// Thrown where a formula falls into too many cases.
struct CaseLimitExceeded {};

inline void check_case_count(std::size_t cases) {
    constexpr std::size_t kMostCases = std::size_t{1} << 16;
    if (cases > kMostCases) {
        throw CaseLimitExceeded{};
    }
}

// Sort and check; nothing if the literals contradict each other.
std::optional<Conjunction> normalized(Conjunction literals);

// All of the disjunctions at once.
Disjunction conjoin(std::vector<Disjunction> parts);
Disjunction negate(const Disjunction& cases);
// Drop every case that another one contains, among the first few hundred.
void drop_subsumed(Disjunction& cases);

// Turns formulas of ground instances into cases. Facts are numbered by
// predicate, then by tuple.
class Expander {
public:
    Expander(const Knowledge& knowledge, Limits& limits);

    std::uint32_t fact_count() const { return begin_.back(); }
    // The first fact of each predicate that can change; one more entry than there
    // are predicates.
    const std::vector<std::uint32_t>& fact_begin() const { return begin_; }
    bool is_initially_true(std::uint32_t predicate, TupleId tuple) const {
        return tuple < knowledge_.initial_count[predicate];
    }
    // The number of a fact that is reached and of a predicate that can change.
    std::optional<ReachedFactId> fact(std::uint32_t predicate, const std::vector<Term>& terms,
                                      const Bindings& bindings) const;

    // Expects normal form. What nothing can change vanishes. Slots of
    // quantified variables are overwritten. Throws CaseLimitExceeded
    // and Stopped.
    Disjunction expand(const Formula& formula, Bindings& bindings) const;

private:
    Disjunction expand_atom(const Formula& atom, bool negated, const Bindings& bindings) const;

    const Knowledge& knowledge_;
    Limits& limits_;
    std::vector<std::uint32_t> begin_;
};

}  // namespace relax::grounding

#endif
