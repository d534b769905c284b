#ifndef RELAX_POLICIES_SURE_REGION_HPP
#define RELAX_POLICIES_SURE_REGION_HPP

#include <cstdint>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/policies/envelope.hpp"

namespace relax {

// From which nodes of an envelope something can be reached with probability 1 that is not worth kNever: a node outside,
// or one where it is allowed to stop. It is read off the graph and never off worths: a seeking agent's is finite where
// it is done with probability 1/2, and that of a dead end whose loops cost something rises for ever.
//
// The sure region W is the largest set of nodes from each of which there is a way out by decisions that cannot leave W
// but to where it is wanted (de Alfaro 1997): begin with all nodes; drop those without such a way; repeat. In W, let a
// node choose a decision by which it came nearer to a way out (the attractor): from each node the way is then followed
// to its end with a positive probability, and W is never left, so that, W being finite, it is followed to its end with
// probability 1. Conversely, a policy that succeeds with probability 1 visits no node without such a way.
class SureRegion {
public:
    explicit SureRegion(Limits& limits) : limits_(limits) {}

    // Make the envelope's policy proper: a run ends with probability 1, where it is wanted. Nodes from which it already
    // does keep their choice. Those from which there is no such policy become worth kNever, and stop. Throws Stopped.
    void make_proper(Envelope& envelope);

private:
    struct Arrival {
        std::uint32_t from;
        DecisionId decision;
    };

    void find_arrivals(const Envelope& envelope);
    void find_proper(const Envelope& envelope);
    bool ends_well(const Envelope& envelope, std::uint32_t place, bool& fails) const;
    void spread(const Envelope& envelope, std::vector<bool>& reached, bool follows_choices);
    bool shrink(Envelope& envelope);
    bool stays(const Envelope& envelope, DecisionId decision, bool& leads_out) const;

    Limits& limits_;
    std::vector<std::uint32_t> ends_;  // of the rows of arrivals, by place
    std::vector<Arrival> arrivals_;
    std::vector<bool> is_proper_;  // by place, as all that follows: the policy does not need to change
    std::vector<bool> is_in_;      // W
    std::vector<bool> reaches_;
    std::vector<std::uint32_t> queue_;
};

}  // namespace relax

#endif
