#ifndef RELAX_GROUNDING_TRUTH_HPP
#define RELAX_GROUNDING_TRUTH_HPP

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "facts.hpp"
#include "relax/base/limits.hpp"

namespace relax::grounding {

// Tell whether the formula (in normal form) is true where everything reached so far is true, and everything that can
// become false is false. Every free variable must be bound; slots of quantified variables are overwritten.
bool is_relaxed_true(const Knowledge& knowledge, Limits& limits, const Formula& formula, Bindings& bindings);

// Finds bindings of a quantifier's variables that may make a difference: for `exists` those under which each atom that
// its body demands has been reached; for `forall` those under which each atom that its body needs false has been
// reached. Under all others the body is false, or true, whatever the state is. (With reached facts being all that can
// ever hold, that is so in the ground problem as well as in the relaxed one.)
class Matcher {
public:
    Matcher(const Knowledge& knowledge, Limits& limits, const Formula& quantifier);

    // Call `visit` for each such binding, until it returns true. Returns whether it did.
    template <typename Visit>
    bool any(Bindings& bindings, const Visit& visit) {
        return any(variables_, bindings, visit);
    }

private:
    using Variables = std::vector<LiftedVariable>;

    // How to bind more variables: as the tuples of a relation that fit, or one to an object or any of its domain.
    struct Choice {
        const Formula* atom = nullptr;
        IndexId index = 0;
        std::optional<TupleId> first;
        LiftedVariable variable{};
        std::span<const ObjectId> objects;
    };

    Choice choose(const Variables& unbound, const Bindings& bindings);
    // Bind the atom's unbound variables as in the tuple, and return those that stay unbound; nothing where it does not
    // fit.
    std::optional<Variables> bind(const Formula& atom, std::span<const ObjectId> tuple, const Variables& unbound,
                                  Bindings& bindings) const;

    template <typename Visit>
    bool any(const Variables& unbound, Bindings& bindings, const Visit& visit) {
        limits_.stop_if_reached();
        if (unbound.empty()) {
            return visit();
        }
        const Choice choice = choose(unbound, bindings);
        if (choice.atom == nullptr) {
            Variables rest = unbound;
            std::erase_if(rest, [&](LiftedVariable other) { return other.slot == choice.variable.slot; });
            for (const ObjectId object : choice.objects) {
                bindings[choice.variable.slot] = object;
                if (any(rest, bindings, visit)) {
                    return true;
                }
            }
            return false;
        }
        const Relation& relation = knowledge_.relations[choice.atom->symbol];
        for (auto tuple = choice.first; tuple; tuple = relation.next(choice.index, *tuple)) {
            limits_.stop_if_reached();
            const auto rest = bind(*choice.atom, relation[*tuple], unbound, bindings);
            if (rest && any(*rest, bindings, visit)) {
                return true;
            }
        }
        return false;
    }

    const Knowledge& knowledge_;
    Limits& limits_;
    Variables variables_;
    std::vector<const Formula*> guides_;  // atoms
    std::vector<std::uint32_t> positions_;
    std::vector<ObjectId> key_;
};

}  // namespace relax::grounding

#endif
