#include "relax/valuations/evar.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace relax {

namespace {

constexpr int kMostRounds = 200;
constexpr double kAccuracy = 0x1p-40;  // of a divergence, relative
constexpr double kEvarRounding = 4 * kLawRounding;

// A law seen through the weights e^(a (X - most)).
struct Tilted {
    double logarithm = 0.0;  // ln E e^(a (X - most))
    double gap = 0.0;        // the mean of most - X under the weights
    double variance = 0.0;   // likewise
};

Tilted tilted(const FlooredLaw& law, double a) {
    const double most = law.most();
    double whole = 0.0;
    double first = 0.0;
    double second = 0.0;
    law.for_each([&](double probability, double cost) {
        const double gap = most - cost;
        const double weight = gap > 0 ? probability * std::exp(-a * gap) : probability;
        whole += weight;
        first += weight * gap;
        second += weight * gap * gap;
    });
    const double gap = first / whole;
    return {std::log(whole), gap, std::max(second / whole - gap * gap, 0.0)};
}

struct Evar {
    double below = 0.0;  // at most the entropic value at risk, in steps
    double near = 0.0;   // nearer to it, and not below
    double scale = 0.0;  // 1 / a
};

// Of the sum of independent costs: logarithms, means and variances of tilted laws add up, and no convolution is needed.
//
// The divergence of the tilted law from the law, a K'(a) - K(a) with K = ln E e^(a C), rises with a. Where it is c the
// mean of the tilted law is the value, by both definitions; below, this mean is less (the law is near enough), and
// (K + c) / a is more (it is one of those of which the least is taken), off by the square of what the divergence is
// off.
Evar evar_of(std::initializer_list<const FlooredLaw*> laws, double c) {
    double most = 0.0;
    double least = 0.0;
    double at_most = 0.0;  // minus the logarithm of the probability of the largest sum
    for (const FlooredLaw* law : laws) {
        most += law->most();
        least += law->least();
        double probability = 0.0;
        law->for_each([&](double p, double cost) { probability += cost == law->most() ? p : 0.0; });
        at_most -= std::log(probability);
    }
    if (least == most || at_most <= c) {
        return {most, most, 0.0};  // all the probability may be where the largest cost is
    }
    Evar found{least, most, 0.0};
    double low = 0.0;
    double high = 0.0;  // 0: not known yet
    double a = 1.0 / (most - least);
    for (int round = 0; round < kMostRounds; ++round) {
        Tilted sum;
        for (const FlooredLaw* law : laws) {
            const Tilted part = tilted(*law, a);
            sum = {sum.logarithm + part.logarithm, sum.gap + part.gap, sum.variance + part.variance};
        }
        const double missing = c + a * sum.gap + sum.logarithm;  // of the divergence
        if (const double near = most + (sum.logarithm + c) / a; near < found.near) {
            found.near = near;
            found.scale = 1.0 / a;
        }
        if (missing >= 0) {
            low = a;
            found.below = std::max(found.below, most - sum.gap);
            if (missing <= kAccuracy * c) {
                break;
            }
        } else {
            high = a;
        }
        // Newton's step, to a little less than c, so that it ends on the side where the bound is.
        const double step = (missing - kAccuracy / 2 * c) / (a * sum.variance);
        const double top = high > 0 ? high : 8 * a;
        const double next = a + step;
        a = next > low && next < top ? next : high > 0 ? low + (high - low) / 2 : top;
        if (a == low || a == high) {
            break;
        }
    }
    return found;
}

double rounded_down(const Evar& found, double more) {
    const double steps = found.below + more;
    return steps - kEvarRounding * (steps + found.scale);
}

}  // namespace

double EvarOfLaw::value(const Law& law) const {
    const FlooredLaw whole(law, law.least());
    return step_ * evar_of({&whole}, divergence_).near;
}

double EvarOfLaw::bound(const Law& law, double more) const {
    const FlooredLaw whole(law, law.least());
    return step_ * rounded_down(evar_of({&whole}, divergence_), more);
}

double EvarOfLaw::bound_of_sum(const Law& law, FlooredLaw& other) const {
    const FlooredLaw whole(law, law.least());
    return step_ * rounded_down(evar_of({&whole, &other}, divergence_), 0.0);
}

}  // namespace relax
