#ifndef RELAX_RULE_HPP
#define RELAX_RULE_HPP

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "relation.hpp"
#include "relax/lifted_problem.hpp"

namespace relax {

// Objects by slot; kUnbound where a variable has none yet.
using Binding = std::vector<ObjectId>;
inline constexpr ObjectId kUnbound = std::numeric_limits<ObjectId>::max();

inline ObjectId value_of(Term term, std::span<const ObjectId> binding) {
    return term < 0 ? static_cast<ObjectId>(~term) : binding[static_cast<std::size_t>(term)];
}

// A conjunctive query over relations: all bindings of the parameters, each from its domain, for which the body's atoms
// are in their relations and no filter objects.
struct Rule {
    struct Atom {
        std::uint32_t relation;
        std::vector<Term> terms;
    };
    // A condition on a binding, asked as soon as its slots are bound.
    struct Filter {
        std::vector<std::uint32_t> slots;
        std::function<bool(std::span<const ObjectId>)> holds;
    };

    std::vector<std::uint32_t> parameters;  // domains of slots 0, 1, ..
    std::uint32_t slot_count = 0;
    std::vector<Atom> body;
    std::vector<Filter> filters;
};

// Objects of each domain, as lists and as sets.
class Domains {
public:
    explicit Domains(const LiftedProblem& problem);
    std::span<const ObjectId> objects(std::uint32_t domain) const { return lists_[domain]; }
    bool contains(std::uint32_t domain, ObjectId object) const { return members_[domain][object]; }

private:
    const std::vector<std::vector<ObjectId>>& lists_;
    std::vector<std::vector<bool>> members_;
};

// An order of joining a rule's atoms, given which slots are bound at the start.
class JoinPlan {
public:
    // `done`: the atom that is already matched, if any. Creates the indexes that it needs.
    JoinPlan(const Rule& rule, std::vector<bool> bound, std::optional<std::size_t> done,
             std::vector<Relation>& relations, const Domains& domains);

    // Visit every solution that extends the binding; false from the visitor ends the search. The binding is restored.
    using Visitor = std::function<bool(std::span<const ObjectId>)>;
    bool run(Binding& binding, const Visitor& visit) const;

private:
    struct Step {
        std::uint32_t relation;
        std::uint32_t index;
        std::vector<Term> key;                                         // for the index's positions
        std::vector<std::pair<std::uint32_t, std::uint32_t>> binds;    // position, slot
        std::vector<std::pair<std::uint32_t, std::uint32_t>> repeats;  // position, slot bound earlier in the same atom
        std::vector<std::size_t> filters;
    };
    struct Free {
        std::uint32_t slot;
        std::vector<std::size_t> filters;
    };

    std::size_t choose_next(const std::vector<bool>& bound, const std::vector<bool>& used) const;
    void add_step(std::size_t atom, std::vector<bool>& bound);
    std::vector<std::size_t> ready_filters(const std::vector<bool>& bound);
    bool pass(const std::vector<std::size_t>& filters, const Binding& binding) const;
    bool run_step(std::size_t step, Binding& binding, const Visitor& visit) const;
    bool run_free(std::size_t index, Binding& binding, const Visitor& visit) const;

    const Rule& rule_;
    std::vector<Relation>& relations_;
    const Domains& domains_;
    std::vector<bool> filter_used_;
    std::vector<std::size_t> first_filters_;
    std::vector<Step> steps_;
    std::vector<Free> free_;
};

// Bind the slots of an atom's terms to a tuple. False if constants, repeated variables, values already bound or domains
// disagree; what was bound before the call is then undefined.
bool unify(std::span<const Term> terms, std::span<const ObjectId> tuple, const Rule& rule, const Domains& domains,
           Binding& binding);

}  // namespace relax

#endif
