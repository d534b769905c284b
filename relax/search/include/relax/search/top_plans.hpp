#ifndef RELAX_SEARCH_TOP_PLANS_HPP
#define RELAX_SEARCH_TOP_PLANS_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/heuristics/heuristic.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/action_lists.hpp"
#include "relax/search/open_list.hpp"
#include "relax/search/search_node.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_result.hpp"

namespace relax {

struct TopPlansStatistics : SearchStatistics {  // `lower_bound` is that of all plans that are not among those found
    std::size_t found = 0;
    std::size_t proven = 0;  // the first so many of them are the best there are
};

struct TopPlansResult {
    std::optional<StopReason> stop;  // why the search ended before it was done
    bool is_all = false;             // there are no other plans
    TopPlansStatistics statistics;
    std::vector<SearchResult> plans;  // the cheapest first; of each its cost, decomposition and plan
};

// The cheapest plans that differ in their actions: A* over states, task networks and the actions so far.
//
// Actions of the domain have names; precondition actions have none and do not count, nor do different decompositions. A
// node is a state and a network. A label is a node with the list of the named actions on a path to it, as a sequence or
// as a multiset. Two paths to a node with equal lists have the same label, at the lower cost of the two (only multisets
// can have two costs, where those depend on the state). Every label has its own g; all labels of a node have one h.
//
// Of each node only the k cheapest labels are kept: what completes a more expensive one to a plan completes each of
// those to another plan, different and not more expensive. So there are finitely many labels where there are finitely
// many nodes, whatever cycles cost nothing. By the same argument every plan that is cheaper than both the k-th plan
// found and the least f of all open labels has been found: else take the cheapest plan that was not, with the fewest
// steps to go from a label on its path that was kept and expanded. The next label was generated, and is not open, since
// its f is too low; so it is kept and expanded, against the choice, or k others were preferred to it. These, completed
// likewise, are k plans as cheap as it is: not all were found, and one that was not has fewer steps to go.
//
// The order of actions makes no difference between multisets: there stubborn sets are allowed (moving an action to the
// front changes neither its own case nor that of another, so that the cost stays the same), and executing an action at
// once that costs and changes nothing. Between sequences it does: there only actions without a name come at once.
class TopPlans {
public:
    // `names`: by ActionId. `statistics` is kept up to date for whoever watches from
    // `limits.poll`. Throws Stopped.
    TopPlans(const PricedProblem& priced, std::vector<std::optional<ActionName>> names, const TopPlansOptions& options,
             Limits& limits, TopPlansStatistics& statistics);

    TopPlansResult run();

private:
    using LabelId = Id<struct LabelTag>;

    // A state and a network, and the labels that are kept.
    struct Node {
        StateId state;
        NetworkId network;
        Cost h;                       // a lower bound of the cost to come
        bool is_evaluated;            // `h` includes the heuristic
        std::vector<LabelId> labels;  // a heap, the most expensive first
    };
    struct Label {
        Cost g;
        NodeId node;
        ActionListId actions;
        LabelId parent;  // itself for the root
        SearchStep step;
        bool is_kept;
        bool is_expanded;  // at its present g
    };

    std::optional<StopReason> search();
    bool evaluate(Node& node);
    void expand(LabelId id);
    void generate(LabelId parent, const Successor& successor);
    void add_plan(LabelId id);
    bool keep(LabelId id);
    ActionListId list_after(LabelId label, std::optional<ActionId> action);
    NodeId find_node(StateId state, NetworkId network);
    std::optional<LabelId> find_label(NodeId node, ActionListId actions) const;
    LabelId add_label(const Label& label);
    Cost priority(const Label& label) const { return label.g + nodes_[label.node].h; }
    Cost cutoff() const;
    void note_proven(Cost bound);
    void push(LabelId id);
    bool is_cheaper(LabelId left, LabelId right) const;
    SearchResult trace(LabelId goal);

    const PricedProblem& priced_;
    const AnalysedProblem& problem_;
    std::vector<std::optional<ActionName>> names_;
    TopPlansOptions options_;
    Limits& limits_;
    TopPlansStatistics& statistics_;
    Progression progression_;
    NetworkBounds bounds_;
    std::unique_ptr<Heuristic> heuristic_;
    ActionLists lists_;
    SegmentedArray<Node> nodes_;
    IdTable<NodeId> node_table_;
    SegmentedArray<Label> labels_;
    IdTable<LabelId> label_table_;
    OpenList<LabelId> open_;
    std::vector<LabelId> plans_;   // the cheapest that were found, the cheapest first
    bool has_pruned_ = false;      // there may be more plans than those ...
    bool has_overflowed_ = false;  // ... that cost `kMostCost` or more
    std::vector<Successor> successors_;
};

// Make and run it; a limit that is reached while it is being made is a result, too.
TopPlansResult top_plans(const PricedProblem& priced, std::vector<std::optional<ActionName>> names,
                         const TopPlansOptions& options, Limits& limits, TopPlansStatistics& statistics);

}  // namespace relax

#endif
