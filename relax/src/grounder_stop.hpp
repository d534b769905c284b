#ifndef RELAX_SRC_GROUNDER_STOP_HPP
#define RELAX_SRC_GROUNDER_STOP_HPP

#include "relax/limits.hpp"

namespace relax::grounding {

// Thrown inside the grounder where a limit is reached; `ground` turns it into a
// value.
struct Stopped {
    StopReason reason;
};

inline void check(Limits& limits) {
    if (const auto reason = limits.check()) {
        throw Stopped{*reason};
    }
}

}  // namespace relax::grounding

#endif
