#ifndef RELAX_POLICIES_ENVELOPE_HPP
#define RELAX_POLICIES_ENVELOPE_HPP

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "relax/base/flat_array.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/base/strong_components.hpp"
#include "relax/policies/decision_graph.hpp"
#include "relax/policies/recursion.hpp"

namespace relax {

// What nodes outside an envelope are worth.
enum class Outside : std::uint8_t {
    Lower,    // their lower worths, so that what comes of it is a lower worth, too
    Stopped,  // what it is worth to stop there, so that a policy of the envelope is one of the whole graph
    Reached,  // nothing at all (in the unit of a logarithm, -infinity), but kNever where nothing can be reached
    Given,    // numbers that are given by node, or else 0
};

// Some expanded nodes, and a policy on them with what its decisions make them worth. Members have places: strongly
// connected components by all decisions follow each other, those first that others lead to, and within one its members
// in the order in which they were given, best with successors first. The nodes outside to which decisions lead have the
// places after these.
class Envelope {
public:
    explicit Envelope(const DecisionGraph& graph) : graph_(graph) {}

    // Take other members, none of them done, with their choices in the graph.
    void assign(std::span<const PolicyNodeId> members, Outside outside);
    // The same members, as if stopping anywhere were worth so much.
    void set_outside(Outside outside, const SegmentedArray<double>* given = nullptr);
    Outside outside() const { return outside_; }
    void set_stops(double worth) { stops_.assign(size(), worth); }
    void set_stop(std::uint32_t place, double worth) { stops_[place] = worth; }
    void restore_stops();

    const DecisionGraph& graph() const { return graph_; }
    std::uint32_t size() const { return static_cast<std::uint32_t>(members_.size()); }
    // The places after the last one of each component.
    std::span<const std::uint32_t> component_ends() const { return component_ends_; }
    // Whether some decision may lead from a place to itself.
    bool has_loop(std::uint32_t place) const;
    PolicyNodeId node(std::uint32_t place) const { return members_[place]; }
    // At least `size()` for nodes outside.
    std::uint32_t place(PolicyNodeId node) const { return node < places_.size() ? places_[node] : kOutside; }

    double worth(std::uint32_t place) const { return worths_[place]; }
    void set_worth(std::uint32_t place, double worth) { worths_[place] = worth; }
    double stop(std::uint32_t place) const { return stops_[place]; }
    DecisionId choice(std::uint32_t place) const { return choices_[place]; }
    void choose(std::uint32_t place, DecisionId decision) { choices_[place] = decision; }

    double worth_of(PolicyNodeId node) const {
        const std::uint32_t at = place(node);
        return at < worths_.size() ? worths_[at] : worth_outside(node);
    }
    double worth_outside(PolicyNodeId node) const {
        switch (outside_) {
            case Outside::Lower:
                return graph_[node].lower;
            case Outside::Stopped:
                return graph_[node].stop;
            case Outside::Reached:
                return graph_[node].lower == kNever ? kNever : -kNever;
            default:
                return given_ == nullptr ? 0 : (*given_)[node];
        }
    }
    // Of a decision, and of stopping.
    double worth_by(std::uint32_t place, Recursion kind, DecisionId decision) const {
        return decision == kStop ? stops_[place]
                                 : worth_of_decision(graph_, kind, decision, targets(place, decision),
                                                     [this](std::uint32_t to) { return worths_[to]; });
    }

    // Decisions that are not to be taken.
    void bar(std::uint32_t place, DecisionId decision);
    bool is_barred(std::uint32_t place, DecisionId decision) const {
        return !barred_.empty() && barred_[first_[place] + (decision - graph_[members_[place]].first)];
    }

    // The places to which the choice leads; from `size()` on they are outside.
    std::span<const std::uint32_t> next(std::uint32_t place) const {
        return choices_[place] == kStop ? std::span<const std::uint32_t>{} : targets(place, choices_[place]);
    }
    std::span<const PolicyNodeId> successors(DecisionId decision) const {
        return decision == kStop ? std::span<const PolicyNodeId>{} : graph_.successors(decision);
    }

private:
    static constexpr std::uint32_t kOutside = std::numeric_limits<std::uint32_t>::max();

    std::span<const std::uint32_t> targets(std::uint32_t place, DecisionId decision) const {
        const std::size_t begin = first_target_[place] + (graph_.first_outcome(decision) - first_outcome_[place]);
        return {targets_.data() + begin, graph_.weights(decision).size()};
    }
    // Where any decision leads from there.
    std::span<const std::uint32_t> targets(std::uint32_t place) const {
        return {targets_.data() + first_target_[place], first_target_[place + 1] - first_target_[place]};
    }
    void take(std::span<const PolicyNodeId> members);
    void find_components();

    const DecisionGraph& graph_;
    Outside outside_ = Outside::Lower;
    const SegmentedArray<double>* given_ = nullptr;
    FlatArray<std::uint32_t> places_;  // by node; kOutside where no decision leads to it either
    std::vector<PolicyNodeId> members_;
    std::vector<PolicyNodeId> around_;        // nodes outside, in the order of their places
    std::vector<double> worths_;              // also of those
    std::vector<std::uint32_t> targets_;      // by outcome of a member's decisions
    std::vector<std::size_t> first_target_;   // by place, and at the end the number of all
    std::vector<std::size_t> first_outcome_;  // by place, in the graph
    std::vector<double> stops_;
    std::vector<DecisionId> choices_;
    std::vector<bool> barred_;  // by decision of a member; empty while none is
    std::vector<std::uint32_t> first_;
    StrongComponents components_;
    std::vector<std::uint32_t> component_ends_;
    std::vector<PolicyNodeId> ordered_;  // members, component by component
};

}  // namespace relax

#endif
