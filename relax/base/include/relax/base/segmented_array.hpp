#ifndef RELAX_BASE_SEGMENTED_ARRAY_HPP
#define RELAX_BASE_SEGMENTED_ARRAY_HPP

#include <bit>
#include <cassert>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace relax {

// An array that only grows, in segments of equal size: no element ever moves and growing never doubles the memory.
template <typename Value, std::size_t SegmentSize = (std::size_t{1} << 14)>
class SegmentedArray {
    static_assert(std::has_single_bit(SegmentSize));  // so that finding an element takes no division

public:
    std::size_t size() const { return size_; }

    Value& operator[](std::size_t index) {
        assert(index < size_);
        return segments_[index / SegmentSize][index % SegmentSize];
    }
    const Value& operator[](std::size_t index) const {
        assert(index < size_);
        return segments_[index / SegmentSize][index % SegmentSize];
    }

    void push_back(const Value& value) {
        if (size_ == segments_.size() * SegmentSize) {
            segments_.push_back(std::make_unique_for_overwrite<Value[]>(SegmentSize));
        }
        (*this)[size_++] = value;
    }

private:
    std::vector<std::unique_ptr<Value[]>> segments_;
    std::size_t size_ = 0;
};

// Runs of words of any length, each contiguous and never moved.
template <typename Value, std::size_t SegmentSize = (std::size_t{1} << 16)>
class RunArena {
    static_assert(std::is_trivially_copyable_v<Value>);

public:
    std::span<Value> allocate(std::size_t count) {
        if (count > SegmentSize / 4) {
            large_.push_back(std::make_unique_for_overwrite<Value[]>(count));
            return {large_.back().get(), count};
        }
        if (segments_.empty() || used_ + count > SegmentSize) {
            segments_.push_back(std::make_unique_for_overwrite<Value[]>(SegmentSize));
            used_ = 0;
        }
        const std::span<Value> run{segments_.back().get() + used_, count};
        used_ += count;
        assert(used_ <= SegmentSize);
        return run;
    }

private:
    std::vector<std::unique_ptr<Value[]>> segments_;
    std::vector<std::unique_ptr<Value[]>> large_;
    std::size_t used_ = 0;
};

}  // namespace relax

#endif
