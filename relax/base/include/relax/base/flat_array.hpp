#ifndef RELAX_BASE_FLAT_ARRAY_HPP
#define RELAX_BASE_FLAT_ARRAY_HPP

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <new>
#include <type_traits>
#include <utility>

namespace relax {

// An array of plain values that grows in place where the system can do that: it moves pages instead of copying values,
// and what is not yet used takes no memory. A `std::vector` holds everything twice for a moment whenever it grows,
// which is what a limit of memory would be missed by.
template <typename Value>
class FlatArray {
    static_assert(std::is_trivially_copy_constructible_v<Value> && std::is_trivially_destructible_v<Value>);

public:
    FlatArray() = default;
    FlatArray(const FlatArray& other) { append(other.data_, other.data_ + other.size_); }
    FlatArray(FlatArray&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)),
          size_(std::exchange(other.size_, 0)),
          capacity_(std::exchange(other.capacity_, 0)) {}
    FlatArray& operator=(FlatArray other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
        return *this;
    }
    ~FlatArray() { std::free(data_); }

    std::size_t size() const { return size_; }
    const Value* data() const { return data_; }
    Value& operator[](std::size_t index) {
        assert(index < size_);
        return data_[index];
    }
    const Value& operator[](std::size_t index) const {
        assert(index < size_);
        return data_[index];
    }

    void push_back(const Value& value) {
        const Value copy = value;  // which may stand in this array
        make_room(1);
        data_[size_++] = copy;
    }

    // The values must not stand in this array.
    template <typename Iterator>
    void append(Iterator begin, Iterator end) {
        make_room(static_cast<std::size_t>(std::distance(begin, end)));
        for (; begin != end; ++begin) {
            data_[size_++] = *begin;
        }
    }

    // Fill up with a value, or cut off.
    void resize(std::size_t size, const Value& value) {
        if (size > size_) {
            make_room(size - size_);
            for (std::size_t at = size_; at < size; ++at) {
                data_[at] = value;
            }
        }
        size_ = size;
    }

    void clear() { size_ = 0; }

private:
    void make_room(std::size_t count) {
        if (size_ + count <= capacity_) {
            return;
        }
        constexpr std::size_t kLeast = 16;
        const std::size_t capacity = size_ + count > 2 * capacity_ ? std::max(size_ + count, kLeast) : 2 * capacity_;
        void* const grown = std::realloc(static_cast<void*>(data_), capacity * sizeof(Value));
        if (grown == nullptr) {
            throw std::bad_alloc();
        }
        data_ = static_cast<Value*>(grown);
        capacity_ = capacity;
        assert(size_ + count <= capacity_);
    }

    Value* data_ = nullptr;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

}  // namespace relax

#endif
