#ifndef RELAX_VALUATIONS_COVER_HPP
#define RELAX_VALUATIONS_COVER_HPP

#include <algorithm>

#include "relax/base/infinite.hpp"

namespace relax {

// Which numbers of an interval are in one of several sets, each of which is everything from a number on, or up to one.
class Cover {
public:
    void add_from(double number) { from_ = std::min(from_, number); }
    void add_up_to(double number) { up_to_ = std::max(up_to_, number); }
    void add_all() { from_ = -kInfinite; }
    bool covers(double low, double high) const { return from_ <= std::max(low, up_to_) || up_to_ >= high; }

private:
    double from_ = kInfinite;
    double up_to_ = -kInfinite;
};

}  // namespace relax

#endif
