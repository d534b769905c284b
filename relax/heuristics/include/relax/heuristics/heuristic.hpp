#ifndef RELAX_HEURISTICS_HEURISTIC_HPP
#define RELAX_HEURISTICS_HEURISTIC_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/node_view.hpp"

namespace relax {

enum class HeuristicKind : std::uint8_t { Blind, Tdg, HMax, LmCut, Potential, PotentialHMax, Add, Ff };

// An admissible heuristic never estimates more than is true.
constexpr bool is_admissible(HeuristicKind kind) { return kind != HeuristicKind::Add && kind != HeuristicKind::Ff; }

class Heuristic {
public:
    virtual ~Heuristic() = default;

    // Estimate the cost that is still to come; nothing where the node is a dead end.
    virtual std::optional<Cost> evaluate(const NodeView& node) = 0;
    // How many operators it has looked at so far, again and again; 0 where that is not worth counting.
    virtual std::uint64_t work() const { return 0; }
    // How many landmark cuts it has made so far.
    virtual std::uint64_t rounds() const { return 0; }
    // The size of the model that it works on, in bytes; 0 where there is none.
    virtual std::size_t model_bytes() const { return 0; }
    // Whether the latest evaluation's relaxed plan uses the method, if there is one.
    virtual bool is_preferred(MethodId /*method*/) const { return false; }
};

// All kinds say dead end only where it is true. When a limit is reached, an evaluation ends early
// with a weaker estimate, or throws Stopped, as this function does.
std::unique_ptr<Heuristic> make_heuristic(HeuristicKind kind, const PricedProblem& priced, Limits& limits);

}  // namespace relax

#endif
