#include "relax/valuations/price_sums.hpp"

namespace relax {

Worth PriceSums::bound(ValueId value, const CostToCome& to_come, std::uint32_t /*stage*/) {
    const Cost f = add_bounds(sums_[value], to_come.least.front());
    return f < kInfinity ? f : kNoWorth;
}

ValueId PriceSums::intern(Cost sum) {
    const std::uint64_t hash = mix(static_cast<std::uint64_t>(sum));
    if (const auto known = table_.find(hash, [&](ValueId id) { return sums_[id] == sum; })) {
        return *known;
    }
    const auto id = static_cast<ValueId>(sums_.size());
    sums_.push_back(sum);
    table_.add(hash, id);
    return id;
}

}  // namespace relax
