#ifndef RELAX_BASE_IDS_HPP
#define RELAX_BASE_IDS_HPP

#include <cassert>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <ranges>
#include <type_traits>

namespace relax {

// A number in one index space. It indexes arrays and is compared with counts as a number is, but it is made of a number
// only where that is written, and never made of, or compared with, an id of another space.
template <typename Tag>
class Id {
public:
    constexpr Id() = default;
    template <std::integral Number>
    constexpr explicit Id(Number number) : number_(static_cast<std::uint32_t>(number)) {
        assert(static_cast<Number>(number_) == number);
    }

    constexpr operator std::uint32_t() const { return number_; }

    constexpr Id& operator++() {
        ++number_;
        return *this;
    }
    constexpr Id operator++(int) { return Id(number_++); }

    friend constexpr bool operator==(Id, Id) = default;
    friend constexpr std::strong_ordering operator<=>(Id, Id) = default;

private:
    std::uint32_t number_ = 0;
};

template <typename One, typename Other>
    requires(!std::same_as<One, Other>)
bool operator==(Id<One>, Id<Other>) = delete;
template <typename One, typename Other>
    requires(!std::same_as<One, Other>)
std::strong_ordering operator<=>(Id<One>, Id<Other>) = delete;

// The ids from one number up to another, in order.
template <typename Index>
auto ids_between(std::uint32_t begin, std::uint32_t end) {
    return std::views::iota(begin, end) | std::views::transform([](std::uint32_t number) { return Index(number); });
}

// All ids of a space of so many.
template <typename Index>
auto all_ids(std::size_t count) {
    return ids_between<Index>(0, static_cast<std::uint32_t>(count));
}

// Index spaces. Each is dense and starts at 0.
using ObjectId = Id<struct ObjectTag>;
using FactId = Id<struct FactTag>;
using ActionId = Id<struct ActionTag>;
using EffectId = Id<struct EffectTag>;
using CostPartId = Id<struct CostPartTag>;
using AlternativeId = Id<struct AlternativeTag>;  // of the condition of a cost part
using MethodId = Id<struct MethodTag>;
using PartId = Id<struct PartTag>;  // of a method
// Of actions and compound tasks. An action is the task of the same number; compound tasks follow the actions.
using TaskId = Id<struct TaskTag>;

constexpr TaskId task_of(ActionId action) { return TaskId(std::uint32_t{action}); }

static_assert(sizeof(FactId) == sizeof(std::uint32_t) && std::is_trivially_copyable_v<FactId>);

// Fixed-point cost: the unit is chosen per problem, so that sums are exact.
using Cost = std::int64_t;

}  // namespace relax

template <typename Tag>
struct std::hash<relax::Id<Tag>> {
    std::size_t operator()(relax::Id<Tag> id) const { return std::hash<std::uint32_t>{}(id); }
};

#endif
