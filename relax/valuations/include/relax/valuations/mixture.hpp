#ifndef RELAX_VALUATIONS_MIXTURE_HPP
#define RELAX_VALUATIONS_MIXTURE_HPP

#include <utility>
#include <vector>

#include "relax/valuations/law.hpp"

namespace relax {

// The law of a cost over all scenarios, put together from that in each of them.
class Mixture {
public:
    void clear() { outcomes_.clear(); }
    void add(double cost, double probability) { outcomes_.emplace_back(cost, probability); }
    // Of all that was added; until the next call of `clear`.
    const Law& law();

private:
    std::vector<std::pair<double, double>> outcomes_;
    std::vector<double> at_;
    std::vector<double> probability_;
    std::vector<double> above_;
    std::vector<double> excess_;
    Law law_;
};

}  // namespace relax

#endif
