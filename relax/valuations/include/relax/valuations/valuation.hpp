#ifndef RELAX_VALUATIONS_VALUATION_HPP
#define RELAX_VALUATIONS_VALUATION_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/worth.hpp"
#include "relax/networks/task_network.hpp"

namespace relax {

// What a way through the search space has cost so far, as its valuation knows it: one sum or several, a law.
using ValueId = Id<struct ValueTag>;

// What is known of the cost of completing a node.
struct CostToCome {
    NetworkId network;
    std::span<const Cost> least;  // by the valuation's prices: it costs at least so much; `kInfinity` for a dead end

    bool is_dead_end() const {
        return std::ranges::any_of(least, [](Cost cost) { return cost >= kInfinity; });
    }
};

// How a label search values plans: by the sum of what their actions cost, in a form that the valuation knows. Sums are
// commutative, and determine the worth of each completion. All lower bounds are rounded down.
class Valuation {
public:
    Valuation() = default;
    virtual ~Valuation() = default;
    Valuation(const Valuation&) = delete;
    Valuation& operator=(const Valuation&) = delete;

    // The vectors of prices at which it is to be told what is still to come. They stay.
    virtual std::span<const PricedProblem* const> prices() const = 0;
    // At so many of them, the first, a heuristic is worth its time; at the others bounds that come for nothing will do.
    virtual std::size_t asked() const { return prices().size(); }
    // By ActionId: those that cost nothing at any of them, whatever the state is.
    std::vector<bool> free_actions() const;
    // Before all that follows: the networks that the search will make. Throws Stopped.
    virtual void begin(const TaskNetworks& /*networks*/, Limits& /*limits*/) {}

    virtual ValueId start() = 0;
    // What the way has cost after an action, where these parts of its cost were due. Throws Stopped.
    virtual ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) = 0;
    // What a plan is worth; `kNoWorth` if it is not wanted.
    virtual Worth worth(ValueId value) = 0;

    // A lower bound of the worth of all completions, `kNoWorth` where none is wanted. Later stages, of `stages` in all,
    // take longer and are asked where those before have not put the way off.
    virtual std::uint32_t stages() const { return 1; }
    virtual Worth bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) = 0;
    // Where bounds are equal, ways come by this first.
    virtual Cost tie_break(ValueId value, const CostToCome& to_come) = 0;

    // Whether each completion makes the one way worth at most as much as the other, and is wanted with the one where it
    // is with the other. `to_come`: of both, a node's.
    virtual bool is_as_good(ValueId one, ValueId other, const CostToCome& to_come) = 0;
    // Whether that holds of each completion and some one of these ways, which may be another one each time.
    virtual bool are_as_good(std::span<const ValueId> ways, ValueId other, const CostToCome& to_come) {
        return std::ranges::any_of(ways, [&](ValueId one) { return is_as_good(one, other, to_come); });
    }
    // Whether of two ways to a node one is as good as the other, always: the one with the lower worth.
    virtual bool is_total_order() const { return false; }

    // Plans from this worth on are not told from each other.
    virtual Worth most() const { return kNoWorth; }
    // From now on only plans are wanted that are worth less.
    virtual void set_cutoff(Worth /*cutoff*/) {}
};

}  // namespace relax

#endif
