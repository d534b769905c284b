#ifndef RELAX_VALUATIONS_BUDGETS_HPP
#define RELAX_VALUATIONS_BUDGETS_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/valuations/cost_laws.hpp"
#include "relax/valuations/law_options.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

// A budget that is to be kept with at least a probability.
struct Budget {
    double steps;  // whole
    double probability;
};

// Another valuation, of those plans only that keep budgets. Beside the other's value a way has the law of its cost.
//
// No completion is wanted where none keeps a budget: what is to come costs at least h and is stochastically at least G
// (see LawValuation). A way is as good as another one if it is by the other valuation, and no cost up to b - h is
// exceeded with a higher probability, for each budget b: then each completion keeps the budget with at least the other
// way's probability. One way at a time: that of two ways each keeps what the other does not makes neither as good.
class Budgets final : public Valuation {
public:
    // `least`: see LawsToCome. `inner` must live longer.
    Budgets(Valuation& inner, const PricedProblem& least, const CostLaws& costs, std::vector<Budget> budgets,
            const LawOptions& options);

    std::span<const PricedProblem* const> prices() const override { return prices_; }
    std::size_t asked() const override { return own_prices_ + inner_.asked(); }
    void begin(const TaskNetworks& networks, Limits& limits) override;
    ValueId start() override { return intern({inner_.start(), LawTable::kFree}); }
    ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) override;
    Worth worth(ValueId value) override;
    std::uint32_t stages() const override;
    Worth bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) override;
    Cost tie_break(ValueId value, const CostToCome& to_come) override;
    bool is_as_good(ValueId one, ValueId other, const CostToCome& to_come) override;
    Worth most() const override { return inner_.most(); }
    void set_cutoff(Worth cutoff) override { inner_.set_cutoff(cutoff); }

private:
    struct Value {
        ValueId inner;
        LawId law;
        bool operator==(const Value&) const = default;
    };

    ValueId intern(Value value);
    CostToCome of_inner(const CostToCome& to_come) const {
        return {to_come.network, to_come.least.subspan(own_prices_)};
    }
    double least_to_come(const CostToCome& to_come) const { return static_cast<double>(to_come.least[least_index_]); }
    bool can_keep_all(const Law& law, double least) const;
    bool can_keep_all(const Law& law, FlooredLaw& to_come) const;

    Valuation& inner_;
    std::vector<const PricedProblem*> prices_;
    std::size_t own_prices_;  // which come before those of the other valuation
    std::size_t least_index_;
    std::vector<Budget> budgets_;
    LawOptions options_;
    LawsSoFar so_far_;
    LawsToCome to_come_;
    SegmentedArray<Value> values_;
    IdTable<ValueId> table_;
    Limits no_limits_;
    Limits* limits_ = &no_limits_;
};

}  // namespace relax

#endif
