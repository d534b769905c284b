#ifndef RELAX_HEURISTICS_HEURISTIC_HPP
#define RELAX_HEURISTICS_HEURISTIC_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/node_view.hpp"

namespace relax {

class Heuristic {
public:
    virtual ~Heuristic() = default;

    // Estimate the cost that is still to come; nothing where the node is a dead end.
    virtual std::optional<Cost> evaluate(const NodeView& node) = 0;
    // How many operators it has looked at so far, again and again; 0 where that is not worth counting.
    virtual std::uint64_t work() const { return 0; }
    // How many landmark cuts it has made so far.
    virtual std::uint64_t rounds() const { return 0; }
    // Whether the latest evaluation's relaxed plan uses the method, if there is one.
    virtual bool is_preferred(MethodId /*method*/) const { return false; }
};

// What is known of a heuristic, and how it is made. When a limit is reached, an evaluation ends early with a weaker
// estimate, or throws Stopped, as `make` does.
struct HeuristicInfo {
    std::string_view name;
    std::string_view description;
    bool is_admissible = true;  // it never estimates more than is true
    bool is_consistent = true;  // along a step it falls by at most the step's cost
    bool is_safe = true;        // what it calls a dead end is one
    bool is_blind = false;      // it knows nothing, and no bound is to be taken in its place
    bool has_model = true;      // making it takes long
    std::unique_ptr<Heuristic> (*make)(const PricedProblem& priced, Limits& limits);
};

// All there are.
std::span<const HeuristicInfo> heuristics();

// Throws std::invalid_argument where there is none of this name.
const HeuristicInfo& heuristic_named(std::string_view name);

}  // namespace relax

#endif
