#ifndef RELAX_BASE_ON_DEMAND_HPP
#define RELAX_BASE_ON_DEMAND_HPP

#include <atomic>
#include <memory>
#include <utility>

namespace relax {

// A value that is made when it is first asked for, and then shared by all threads. Nobody waits for another one who
// makes it, perhaps under wider limits: where two make it at the same time, that of the first to be done is kept.
template <typename Value>
class OnDemand {
public:
    explicit OnDemand(std::unique_ptr<const Value> value = nullptr) : value_(value.release()) {}
    ~OnDemand() { delete value_.load(); }
    OnDemand(const OnDemand&) = delete;
    OnDemand& operator=(const OnDemand&) = delete;

    // The value is what `make` returns, which may throw: it will then be made the next time.
    template <typename Make>
    const Value& get(Make make) const {
        const Value* value = value_.load(std::memory_order_acquire);
        if (value == nullptr) {
            std::unique_ptr<const Value> made(new Value(make()));
            if (value_.compare_exchange_strong(value, made.get(), std::memory_order_acq_rel)) {
                value = made.release();
            }
        }
        return *value;
    }
    bool is_made() const { return value_.load(std::memory_order_acquire) != nullptr; }

private:
    mutable std::atomic<const Value*> value_;
};

}  // namespace relax

#endif
