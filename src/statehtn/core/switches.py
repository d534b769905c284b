"""Refinements of the searches that can be left out: they change the effort, never the optimum.

The core's options have fields of the same names; what a search does not have is no field of its switches.
"""

from __future__ import annotations

from dataclasses import dataclass, fields


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgressionSwitches:
    """Refinements of every search over states and task networks."""

    skip_dead_methods: bool = True
    """Leave out methods whose first task would come next and cannot be executed."""
    stubborn_sets: bool = True
    """Leave out actions that can wait: their order with the others makes no difference."""
    forget_facts: bool = True
    """States keep only the facts that something still to be done may read."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PolicySwitches:
    """Refinements of the search for a policy."""

    follow_forced: bool = True
    """Let decisions go on through all steps that must come after them."""
    forget_unreachable: bool = True
    """States keep only the facts that actions read which are still within reach."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BoundSwitches(ProgressionSwitches):
    """Refinements of every search by f: what nodes are bounded by before the heuristic is asked."""

    tdg_bound: bool = True
    """Bound every node by the decomposition graph before the heuristic is asked (not with `blind`)."""
    inherit_h: bool = True
    """A node's h is at least its parent's less the cost of the step between them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TopSwitches(BoundSwitches):
    """Refinements of the search for the best plans; stubborn sets are for plans that are multisets."""

    follow_forced: bool = True
    """Pass through nodes with a single successor."""
    selective: bool = True
    """Ask the heuristic rarely while it rarely exceeds the cheap bounds."""
    limits_labels: bool = True
    """Keep at most k labels at every node."""


@dataclass(frozen=True, kw_only=True)
class LawSwitches:
    """Refinements of the search by an objective that needs the law of the cost."""

    stochastic_order: bool = True
    """Leave out a way where no cost is exceeded with a higher probability by another one."""
    convex_order: bool = True
    """Leave out a way where no cost is exceeded by more in the mean by another one, if the objective shuns risk."""
    pairwise: bool = True
    """Compare ways only as far as the objective tells costs apart, for what is still to come."""
    least_bound: bool = True
    """Bound what is to come by its least cost."""
    mean_bound: bool = True
    """Bound what is to come by its expected cost, if the objective shuns risk."""
    graph_bound: bool = True
    """Bound what is to come by the graph of laws: a law for every task."""
    graph_parts: bool = True
    """Count in that graph what the conditional parts of a cost come to in whatever state."""


@dataclass(frozen=True, kw_only=True)
class ScenarioSwitches:
    """Refinements of the search where costs hang together."""

    compare_scenarios: bool = True
    """Leave out a way where another one is as good in each scenario."""
    decided_scenarios: bool = True
    """Compare no scenario in which a way cannot but cost more than the objective tells apart."""
    ideal_bound: bool = True
    """Bound what is to come in each scenario by itself."""
    tangent_bound: bool = True
    """Bound what is to come by tangents of the objective, if it shuns risk: they are for all scenarios together."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LabelSwitches(TopSwitches, LawSwitches, ScenarioSwitches):
    """Refinements of the search by an objective whose label is not one price; each family has its own."""

    # Of labels that are several sums.
    one_price_first: bool = True
    """Search with tangents of the objective for prices first; they often prove a plan without any label search."""
    bound_mixes: bool = True
    """Bound labels at mixes of the prices, too."""
    compare_boxes: bool = True
    """Compare two labels by all completions that there may be, not sum by sum."""
    compare_envelopes: bool = True
    """Leave out a label for several others, of which one is as good with each completion."""
    use_cutoff: bool = True
    """Leave completions out of comparisons that lead to no better plan than the best known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchSwitches(BoundSwitches):
    """Refinements of the search for one plan; greedy search has those of every search alone."""

    selective: bool = True
    """Ask an admissible heuristic rarely while it rarely exceeds the cheap bounds."""
    endings: bool = True
    """Leave out networks in partial order whose last actions cannot be executed in any order."""
    merge_sequences: bool = True
    """Networks in total order count as one if they differ only in consecutive actions that need and change the same."""
    learn_branching: bool = True
    """Decompose the compound task that has led to the fewest expansions so far, not that with the fewest methods."""
    follow_forced: bool = True
    """Pass through nodes with a single successor, as long as f does not rise."""


def set_switches(
    options: object,
    switches: ProgressionSwitches,
    kind: type[ProgressionSwitches] | type[LawSwitches] | type[ScenarioSwitches] | None = None,
) -> None:
    """Hand switches over to options of the core; of a kind of them only, if it is said."""
    for switch in fields(kind or switches):
        setattr(options, switch.name, getattr(switches, switch.name))
