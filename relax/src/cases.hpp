#ifndef RELAX_CASES_HPP
#define RELAX_CASES_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "reachability.hpp"
#include "rule.hpp"

namespace relax {

// A fact or its negation: twice the fact's number, plus one if it is negated.
using Literal = std::uint32_t;
// A conjunction: sorted, without repetitions or contradictions.
using Cube = std::vector<Literal>;
// A disjunction of conjunctions: none is false, the empty one is true.
using Cases = std::vector<Cube>;

inline Literal literal(FactId fact, bool negated) { return 2 * fact + (negated ? 1 : 0); }
inline FactId fact_of(Literal literal) { return literal / 2; }
inline bool is_negated(Literal literal) { return literal % 2 == 1; }

// Drop repeated cases and cases that another one contains.
void simplify(Cases& cases);
Cases conjunction(const Cases& left, const Cases& right);

// An instance of an action in one of its cases: one conjunctive precondition, one cost law.
struct ActionCase {
    struct Effect {
        Cube condition;
        std::vector<FactId> adds;
        std::vector<FactId> deletes;
    };

    TaskInstance instance;
    Cube precondition;
    std::vector<std::uint32_t> cost_parts;  // see GroundProblem::action_cost_parts
    std::vector<Effect> effects;
};

// Thrown when a precondition falls into more cases than anyone could want.
struct TooManyCases {
    TaskInstance instance;
};

// Turns preconditions, effects and cost conditions of reachable action instances into cases over numbered facts.
// Facts are the reachable tuples of the predicates that some action changes.
class CaseBuilder {
public:
    explicit CaseBuilder(Reachability& reachability);

    std::size_t fact_count() const { return fact_begin_.back(); }
    // By fact: whether it holds initially; its predicate; its tuple there.
    bool is_initial(FactId fact) const;
    std::uint32_t predicate(FactId fact) const;
    std::span<const ObjectId> arguments(FactId fact) const;

    // Append the cases of an action instance; none if it can never be applied.
    void build(const TaskInstance& instance, std::vector<ActionCase>& cases);

private:
    Cases cases_of(const Formula& formula, Binding& binding, bool negated) const;
    Cases cases_of_atom(const Formula& formula, const Binding& binding, bool negated) const;
    std::vector<ActionCase::Effect> effects(const LiftedAction& action, Binding& binding) const;
    void split_by_cost(const LiftedAction& action, Binding& binding, std::vector<ActionCase>& cases) const;

    Reachability& reachability_;
    std::vector<FactId> fact_begin_;  // by predicate, and one more: the total
};

}  // namespace relax

#endif
