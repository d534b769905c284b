#ifndef RELAX_SEARCH_SEARCH_OPTIONS_HPP
#define RELAX_SEARCH_SEARCH_OPTIONS_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/worth.hpp"
#include "relax/heuristics/heuristic.hpp"
#include "relax/progression/progression.hpp"

// What each search is asked for. Switches have the names that they have in Python (core/switches.py); to leave a
// refinement out changes the effort and never the optimum.

namespace relax {

// What nodes are bounded by before a heuristic is asked.
struct BoundSwitches {
    bool tdg_bound = true;  // the decomposition graph
    bool inherit_h = true;  // a node's h is at least its parent's less the cost of the step
};

// A* by admissible heuristics, or weighted A*.
struct FindPlansOptions : ProgressionSwitches, BoundSwitches {
    // Asked one by one, where those before leave f as it is.
    std::vector<const HeuristicInfo*> heuristics = {&heuristic_named("lmcut")};
    double weight = 1.0;              // of h; at least 1, and 1 for A*
    std::optional<Cost> upper_bound;  // only plans that cost less are wanted
    bool selective = true;            // ask an admissible heuristic rarely while it exceeds the cheap bounds rarely
    bool endings = true;              // leave out networks in partial order whose last actions cannot be executed
    bool merge_sequences = true;      // networks of one form count as one (TaskNetworks::form)
    bool learn_branching = true;      // decompose the task that has led to the fewest expansions so far
    bool follow_forced = true;        // pass through nodes with a single successor
};

struct GreedyOptions : ProgressionSwitches {
    const HeuristicInfo* heuristic = &heuristic_named("lmcut");
    std::optional<Cost> upper_bound;                // only plans that cost less are wanted
    bool in_sequence = false;                       // tasks without an order come in that of the domain
    bool when_due = false;                          // methods that begin with an action wait for it
    bool explores = true;                           // take every other node from the type-based list
    std::optional<std::uint64_t> most_evaluations;  // give up after so many without a plan
};

// Networks alone, without states: the heuristic has no model.
struct PlanBasedOptions {
    const HeuristicInfo* heuristic = &heuristic_named("tdg");
    std::optional<Worth> upper_bound;  // only plans that are worth less are wanted
    double tolerance = 0;              // see `better_than`
    bool branches_over_all = false;    // try every compound task of a network, not one
    bool checks_preconditions = true;  // leave out networks with a precondition that cannot be met
};

using StepwiseOptions = std::variant<FindPlansOptions, GreedyOptions>;

// Searches that take turns, each a sequence of stages, of which a later one begins when an earlier one has given up.
struct PortfolioOptions {
    std::vector<std::vector<StepwiseOptions>> members;
    std::optional<Cost> upper_bound;  // only plans that cost less are wanted, whatever the members say
};

using SearchOptions = std::variant<FindPlansOptions, GreedyOptions, PlanBasedOptions, PortfolioOptions>;

// When two plans are different: as sequences of actions, or by which actions they have and how many of each.
enum class Distinct : std::uint8_t { Sequence, Multiset };

struct LabelSearchOptions : ProgressionSwitches, BoundSwitches {     // stubborn sets are for multisets
    std::size_t count = 1;                                           // of plans that are wanted
    Distinct distinct = Distinct::Sequence;                          // where several are
    const HeuristicInfo* heuristic = &heuristic_named("potential");  // admissible
    std::optional<Worth> upper_bound;                                // only plans that are worth less are wanted
    double tolerance = 0;                                            // see `better_than`
    bool follow_forced = true;                                       // pass through nodes with a single successor
    bool selective = true;      // ask the heuristic rarely while it exceeds the cheap bounds rarely
    bool limits_labels = true;  // leave out labels where as many as plans are wanted are as good

    bool tells_sequences() const { return count > 1 && distinct == Distinct::Sequence; }
};

}  // namespace relax

#endif
