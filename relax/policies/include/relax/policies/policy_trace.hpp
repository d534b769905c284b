#ifndef RELAX_POLICIES_POLICY_TRACE_HPP
#define RELAX_POLICIES_POLICY_TRACE_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/base/rows.hpp"
#include "relax/policies/network_source.hpp"
#include "relax/policies/policy_search.hpp"
#include "relax/search/search_result.hpp"

namespace relax {

// Why a run of a policy is over at a node.
enum class PolicyEnd : std::uint8_t { GoesOn, Done, NothingLeft, GivesUp };

// A policy in flat arrays: nodes, of which the first is where runs begin, and for each the branches of its decision.
// There is a node for each step.
struct PolicyTrace {
    std::vector<NetworkNodes::Node> nodes;
    std::vector<PolicyEnd> ends;        // by node
    std::vector<SearchStep> steps;      // by node; of no meaning at an end
    std::vector<std::uint32_t> first;   // by node, of its branches; and at the end the number of all
    std::vector<double> probabilities;  // by branch
    std::vector<std::optional<ActionId>> actions;
    Rows<CostPartId> due_parts;
    std::vector<std::uint32_t> successors;  // nodes here
};

// Work out a policy that was found, as far as runs come: its graph may have nodes that only its bounds need. Throws
// Stopped.
PolicyTrace trace_policy(PlanningSource& source, const DecisionGraph& graph, const FoundPolicy& policy, Limits& limits);

// Write the plan of a run of the policy, as branches from the first node on, and its decomposition tree. The outcome of
// a chance task is there as a method of it.
void trace_run(const PricedProblem& priced, PlanningSource& source, const PolicyTrace& trace,
               std::span<const std::uint32_t> branches, Limits& limits, SearchResult& result);

}  // namespace relax

#endif
