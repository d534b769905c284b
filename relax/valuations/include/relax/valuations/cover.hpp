#ifndef RELAX_VALUATIONS_COVER_HPP
#define RELAX_VALUATIONS_COVER_HPP

#include <algorithm>
#include <limits>

namespace relax {

// Which numbers of an interval are in one of several sets, each of which is everything from a number on, or up to one.
class Cover {
public:
    void add_from(double number) { from_ = std::min(from_, number); }
    void add_up_to(double number) { up_to_ = std::max(up_to_, number); }
    void add_all() { from_ = -std::numeric_limits<double>::infinity(); }
    bool covers(double low, double high) const { return from_ <= std::max(low, up_to_) || up_to_ >= high; }

private:
    double from_ = std::numeric_limits<double>::infinity();
    double up_to_ = -std::numeric_limits<double>::infinity();
};

}  // namespace relax

#endif
