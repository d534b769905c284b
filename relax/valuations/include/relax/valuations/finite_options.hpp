#ifndef RELAX_VALUATIONS_FINITE_OPTIONS_HPP
#define RELAX_VALUATIONS_FINITE_OPTIONS_HPP

namespace relax {

// What valuations by several sums may leave out: it changes the effort, never the optimum.
struct FiniteOptions {
    bool bound_mixes = true;        // bound ways at mixes of the prices, too
    bool compare_boxes = true;      // compare ways by all completions that there may be; else sum by sum
    bool compare_envelopes = true;  // compare a way with several others at once
    bool use_cutoff = true;         // completions are bounded by the best plan
};

}  // namespace relax

#endif
