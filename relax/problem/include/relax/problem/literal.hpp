#ifndef RELAX_PROBLEM_LITERAL_HPP
#define RELAX_PROBLEM_LITERAL_HPP

#include "relax/base/ids.hpp"

namespace relax {

// A fact or its negation: twice the fact's number, plus one for the negation.
template <typename Fact>
struct LiteralOf;
using Literal = Id<LiteralOf<FactId>>;

template <typename Fact>
constexpr Id<LiteralOf<Fact>> literal_of(Fact fact, bool is_negated = false) {
    return Id<LiteralOf<Fact>>(2 * fact + (is_negated ? 1 : 0));
}
template <typename Fact>
constexpr Fact fact_of(Id<LiteralOf<Fact>> literal) {
    return Fact(literal / 2);
}
template <typename Fact>
constexpr bool is_negated(Id<LiteralOf<Fact>> literal) {
    return literal % 2 != 0;
}
template <typename Fact>
constexpr Id<LiteralOf<Fact>> negation(Id<LiteralOf<Fact>> literal) {
    return Id<LiteralOf<Fact>>(literal ^ 1U);
}

}  // namespace relax

#endif
