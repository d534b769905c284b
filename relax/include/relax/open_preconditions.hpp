#ifndef RELAX_OPEN_PRECONDITIONS_HPP
#define RELAX_OPEN_PRECONDITIONS_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "relax/canonical_order.hpp"
#include "relax/ground_problem.hpp"
#include "relax/ids.hpp"
#include "relax/state.hpp"

namespace relax {

// A test on task networks that says without a state that no decomposition of them can be executed: a precondition of a
// primitive task that nothing can make true in time. What could is the initial state, or a task that is not ordered
// after it and may have the effect, itself or by its decompositions; unless the precondition is certainly made false
// again in between. (The question of causal links and their threats, as in partial-order causal-link planning.)
class OpenPreconditions {
public:
    explicit OpenPreconditions(const GroundProblem& problem);

    // False only if the network has no executable decomposition.
    bool can_be_met(const OrderedTasks& network);

private:
    // A literal: 2 * fact, plus 1 for its negation.
    using Literal = std::uint32_t;

    struct Profile {
        bool is_known = false;
        std::vector<Literal> needed;         // by every case of a primitive task; none of a compound one
        std::vector<std::uint64_t> may;      // literals that it may make true, as bits
        std::vector<std::uint64_t> certain;  // literals that it makes false whatever the state; likewise
    };

    const Profile& profile(TaskId task);
    Profile of_action(ActionId action) const;
    bool can_be_met(const OrderedTasks& network, std::size_t task, Literal literal);
    void list_successors(const OrderedTasks& network);

    const GroundProblem& problem_;
    StateBits initial_state_;
    std::size_t literal_words_;
    std::vector<Profile> profiles_;          // by TaskId, made when first asked for
    std::vector<const Profile*> occurring_;  // by occurrence of the network looked at
    std::vector<std::uint64_t> successors_;  // rows of bits by occurrence, likewise
    std::vector<std::uint64_t> threats_;     // a row
};

}  // namespace relax

#endif
