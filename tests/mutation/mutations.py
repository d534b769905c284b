"""Conditions on which optimality hangs, and how to break each: data for `tests.mutation.run`.

A text that stands once in a file is replaced by another. Where the code changes, so does the text here; a condition
that is no longer there needs another one in its place.
"""

from __future__ import annotations

from dataclasses import dataclass

BRUTE_FORCE = "tests/differential/test_core_against_brute_force.py"
FEW_ACTIONS = "tests/differential/test_few_actions.py"
TOTAL = f"{BRUTE_FORCE}::test_optimum_of_totally_ordered_problems"
PARTIAL = f"{BRUTE_FORCE}::test_optimum_of_partially_ordered_problems"
ADMISSIBLE = "tests/differential/test_heuristics_admissible.py"
BEST_PLANS = "tests/differential/test_best_plans.py"
PLAN_BASED = "tests/differential/test_plan_based.py"
WALKS = "tests/differential/test_merged_sequences.py"
RECURSION = "tests/differential/test_forced_recursion.py"
POLICY_PROGRESSION = "tests/differential/test_policy_progression.py"
POLICIES = "tests/differential/test_policies.py"
POLICY_CHORD = "tests/differential/test_policy_chord.py"
GROUND_OUTCOMES = "tests/property/test_grounding_outcomes.py"
PRECISION = "tests/differential/test_optimal_is_optimal.py"
FINITE = "tests/differential/test_finite_objectives.py"
FINITE_ALONE = f"{FINITE}::test_label_search_alone"
FINITE_SEVERAL = f"{FINITE}::test_several_plans"
LAWS = "tests/differential/test_law_objectives.py"
CORRELATED = "tests/differential/test_correlated_costs.py"
LABELS = "tests/differential/test_label_search.py"
OBJECTIVES = "tests/differential/test_objectives.py"
EXPONENTIALS = "tests/property/test_exponential_sums.py"
DEVIATIONS = "tests/property/test_mean_deviation_sums.py"
LAWS_ALONE = "tests/property/test_laws_on_a_grid.py"
GRAPH_OF_LAWS = f"{LAWS}::test_no_plan_is_below_the_graph_of_laws"
LABEL_RULES = "tests/unit/test_label_rules.py"
BUDGETS = (LABEL_RULES, f"{LAWS}::test_budgets_are_kept", f"{OBJECTIVES}::test_the_best_plan_that_keeps_budgets")
SCENARIOS_ALONE = f"{CORRELATED}::test_the_label_search_finds_the_best_plan_by_itself"


@dataclass(frozen=True)
class Mutation:
    """`old` becomes `new` in a file; `tests`, as pytest takes them, should notice, the likeliest and fastest first."""

    name: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...] = (FEW_ACTIONS, PARTIAL, TOTAL, BRUTE_FORCE)


MUTATIONS = [
    Mutation(
        "stubborn sets: actions with contradictory effects are in no order",
        "relax/progression/stubborn_set.cpp",
        "return other.reads.contains(negation(literal)) || other.makes.contains(negation(literal));",
        "return other.reads.contains(negation(literal));",
    ),
    Mutation(
        "stubborn sets: no other task makes an action applicable",
        "relax/progression/stubborn_set.cpp",
        "return other.makes.contains(*open);",
        "return false && other.makes.contains(*open);",
    ),
    Mutation(
        "stubborn sets: conditions of costs are not read",
        "relax/analysis/task_profiles.cpp",
        "            read_either_way(problem_.cost_conditions[alternative]);\n",
        "",
    ),
    Mutation(
        "within reach: facts that actions make are out of it",
        "relax/progression/reachable_reads.cpp",
        "for (const FactId fact : problem_.effect_adds[effect]) {",
        "for (const FactId fact : problem_.effect_conditions[effect]) {",
        (f"{POLICIES}::test_parts_out_of_reach",),
    ),
    Mutation(
        "forgotten facts: conditions of costs are not read",
        "relax/analysis/task_reads.cpp",
        "            add(problem.cost_conditions[alternative]);\n",
        "",
    ),
    Mutation(
        "canonical forms: networks are the same if their tasks are, in whatever order",
        "relax/networks/network_components.cpp",
        "            set_bit(std::span(form_).subspan(index * words, words), place_[earlier]);\n",
        "            static_cast<void>(earlier);\n",
    ),
    Mutation(
        "macro-actions: what later actions need is forgotten",
        "relax/networks/macro_actions.cpp",
        "if (!has(first.made, literal)) {",
        "if (false) {",
        (FEW_ACTIONS, WALKS, TOTAL, BRUTE_FORCE),
    ),
    Mutation(
        "macro-actions: actions whose cost depends on the state are put together, too",
        "relax/networks/macro_actions.cpp",
        "if (!problem_.cost_parts[action].empty()) {",
        "if (false) {",
    ),
    Mutation(
        "dead methods: a first action is next although other tasks are unconstrained",
        "relax/progression/progression.cpp",
        "add_methods(compound_->task, unconstrained_.size() == 1, state, live_methods_);",
        "add_methods(compound_->task, true, state, live_methods_);",
    ),
    Mutation(
        "dead methods: only the first group of a task's methods is looked at",
        "relax/progression/first_actions.cpp",
        "for (const Group& group : groups_[groups]) {",
        "for (const Group& group : std::span(groups_[groups]).first(1)) {",
        ("tests/unit/test_many_methods.py",),
    ),
    Mutation(
        "potential: a list of tasks starts with its last one",
        "relax/heuristics/relaxed_task.cpp",
        "starts_.push_back(model_.may_start(tasks.front()));",
        "starts_.push_back(model_.may_start(tasks.back()));",
        (ADMISSIBLE,),
    ),
    Mutation(
        "potential: a task in partial order starts when it has ended itself",
        "relax/heuristics/relaxed_task.cpp",
        "needed_.push_back(model_.reached(node.tasks[earlier]));",
        "needed_.push_back(model_.reached(node.tasks[earlier == at ? earlier : at]));",
        (ADMISSIBLE,),
    ),
    Mutation(
        "re-opening: the first way to a node is the best",
        "relax/search/include/relax/search/search_space.hpp",
        "return is_as_good(nodes_[*known], network, g) ?",
        "return g >= 0 || is_as_good(nodes_[*known], network, g) ?",
        (FEW_ACTIONS, WALKS, TOTAL, BRUTE_FORCE),
    ),
    Mutation(
        "inherited h: the cost of the step is not taken off",
        "relax/search/include/relax/search/cheap_bound.hpp",
        "std::max(by_graph, parent_h - step_cost)",
        "std::max(by_graph, parent_h - 0 * step_cost)",
    ),
    Mutation(
        "inherited h: that of a network whose place another one of its form takes is kept",
        "relax/search/include/relax/search/search_space.hpp",
        "nodes_[id].h += bounds_[network] - bounds_[nodes_[old].network];",
        "nodes_[id].h += 0;",
        (FEW_ACTIONS, WALKS, TOTAL, BRUTE_FORCE),
    ),
    Mutation(
        "forced steps: one of two ways is enough",
        "relax/progression/progression.cpp",
        "if (live_methods_.size() + to_execute_.size() > 1) {",
        "if (live_methods_.size() + to_execute_.size() > 2) {",
    ),
    Mutation(
        "forced cycle: whatever the state is",
        "relax/search/forced_cycle.cpp",
        "nodes[before].state == nodes[node].state && ",
        "",
        (RECURSION, FEW_ACTIONS, PARTIAL, BRUTE_FORCE),
    ),
    Mutation(
        "endings and macro-actions: what an action needs must be made just before it",
        "relax/networks/macro_actions.cpp",
        "if (has(first.made, negation(literal))) {",
        "if (!has(first.made, literal)) {",
        ("tests/differential/test_endings.py", FEW_ACTIONS, PARTIAL, BRUTE_FORCE),
    ),
    Mutation(
        "mutexes: actions without preconditions are executed once",
        "relax/analysis/mutexes.cpp",
        "return reached_tick_ >= since;",
        "return since == 0;",
        ("tests/differential/test_mutexes.py",),
    ),
    Mutation(
        "decomposition bound: a method costs what its most expensive subtask does, twice",
        "relax/analysis/tdg_bound.cpp",
        "sum[method] = add_bounds(sum[method], value);",
        "sum[method] = add_bounds(value, value);",
        (ADMISSIBLE,),
    ),
    Mutation(
        "landmark cuts: a cut misses operators that lead into the goal zone",
        "relax/heuristics/lm_cut.cpp",
        "for (const OperatorId op : entrances_) {",
        "for (const OperatorId op : std::span(entrances_).first(entrances_.empty() ? 0 : 1)) {",
        (ADMISSIBLE,),
    ),
    Mutation(
        "hmax: goals add up",
        "relax/heuristics/hmax.cpp",
        "            most_expensive = cost(goal);\n",
        "            most_expensive = add_bounds(most_expensive, cost(goal));\n",
        (ADMISSIBLE,),
    ),
    Mutation(
        "shifted costs: the price of the first part, not the least, is due in every state",
        "relax/analysis/cost_shifting.cpp",
        "least = std::min(least, prices.parts[part]);",
        "least = least == std::numeric_limits<Cost>::max() ? prices.parts[part] : least;",
        ("tests/property/test_cost_shifting.py", ADMISSIBLE),
    ),
    Mutation(
        "plan-based: the first network that can be executed is the best",
        "relax/search/plan_based.cpp",
        "if (solution_ && cutoff() <= open_.top().priority) {",
        "if (solution_) {",
        (PLAN_BASED,),
    ),
    Mutation(
        "best plans: a node keeps one label",
        "relax/search/label_space.cpp",
        "if (limits_labels_ && kept.size() > count_) {",
        "if (limits_labels_ && kept.size() > 1) {",
        (BEST_PLANS,),
    ),
    Mutation(
        "best plans: a list of actions that is reached at less cost is not taken up",
        "relax/search/label_space.cpp",
        "if (valuation_.worth(same->value) <= worth) {",
        "if (valuation_.worth(same->value) != kNoWorth) {",
        ("tests/unit/test_top_plans.py", BEST_PLANS),
    ),
    Mutation(
        "prices: those beyond the cap of a scale cost as much as it",
        "src/statehtn/core/scale.py",
        "most, exponent = self.cap + 1, self.exponent",
        "most, exponent = self.cap // 4, self.exponent",
        (PRECISION,),
    ),
    Mutation(
        "bounds: prices are rounded up",
        "src/statehtn/core/scale.py",
        "min(math.floor(math.ldexp(price, exponent)), most)",
        "min(math.ceil(math.ldexp(price, exponent)), most)",
        ("tests/unit/test_precision.py", PRECISION),
    ),
    Mutation(
        "labels: inherited bounds of what is to come are not less by what the step costs",
        "relax/search/label_search.cpp",
        "to[price] = std::max(to[price], from[price] - edge.costs[price]);",
        "to[price] = std::max(to[price], from[price]);",
        (LABELS, FINITE, LAWS),
    ),
    Mutation(
        "labels: where several plans are wanted, one way that is as good makes another superfluous",
        "relax/search/label_space.cpp",
        "if (limits_labels_ && lists_.size() == count_) {",
        "if (limits_labels_ && lists_.size() == 1) {",
        (FINITE_SEVERAL, OBJECTIVES),
    ),
    Mutation(
        "labels: what a new one makes superfluous goes, whether it is so with several plans wanted or not",
        "relax/search/label_space.cpp",
        "            if (is_superfluous(other, kept, known)) {\n",
        "            if (is_superfluous(other, kept, known) || count_ > 1) {\n",
        (FINITE_SEVERAL, OBJECTIVES),
    ),
    Mutation(
        "vectors of sums: a way with a lower first sum is as good",
        "relax/valuations/include/relax/valuations/sum_vectors.hpp",
        "return std::ranges::equal((*this)[one], (*this)[other], std::less_equal<>());",
        "return (*this)[one].front() <= (*this)[other].front();",
        (FINITE_ALONE, FINITE, OBJECTIVES),
    ),
    Mutation(
        "sums of a line and an exponential: ways are compared for the least cost to come alone",
        "relax/valuations/exponential_sums.cpp",
        "return cover.covers(low, std::max(low, most_log(sums, to_come.least, 0) - log));",
        "return cover.covers(low, low);",
        (LABEL_RULES, EXPONENTIALS, FINITE_ALONE, OBJECTIVES),
    ),
    Mutation(
        "sums of exponentials: the rising ones are compared for the least cost to come alone",
        "relax/valuations/exponential_sums.cpp",
        "            log = std::max(log, most_log(right, to_come.least, j));\n",
        "",
        (LABEL_RULES, EXPONENTIALS, FINITE_ALONE, OBJECTIVES),
    ),
    Mutation(
        "mean and deviation: ways are compared for the least variance to come alone",
        "relax/valuations/mean_deviation.cpp",
        "return cover.covers(low, std::max(low, high));",
        "return cover.covers(low, std::min(low, high));",
        (DEVIATIONS, FINITE_ALONE, OBJECTIVES),
    ),
    Mutation(
        "laws: the increasing convex order is enough for every objective",
        "relax/valuations/law_valuation.cpp",
        "if (options.convex_order && objective.is_concave()) {",
        "if (options.convex_order) {",
        (LABEL_RULES, LAWS_ALONE, LAWS, OBJECTIVES),
    ),
    Mutation(
        "laws: the stochastic order is asked about the least cost alone",
        "relax/valuations/law_orders.cpp",
        "        if (one.above_of(from) > other.above[j] + kProbabilityTolerance) {\n",
        "        if (j == 0 && one.above_of(from) > other.above[j] + kProbabilityTolerance) {\n",
        (LABEL_RULES, LAWS_ALONE, LAWS, OBJECTIVES),
    ),
    Mutation(
        "bounds by laws: what is to come costs its mean for every objective",
        "relax/valuations/include/relax/valuations/law_valuation.hpp",
        "return options_.mean_bound && objective_->is_concave();",
        "return options_.mean_bound;",
        (LAWS, OBJECTIVES),
    ),
    Mutation(
        "bounds by laws: beside the graph of laws what is to come costs its mean, too",
        "relax/valuations/law_valuation.cpp",
        "return std::max(least, graph != nullptr ? floor_for_mean(*graph, mean) : mean);",
        "return std::max(least, graph != nullptr ? std::max(floor_for_mean(*graph, mean), mean) : mean);",
        (LAWS, OBJECTIVES),
    ),
    Mutation(
        "graph of laws: a task has the law of its first method",
        "relax/valuations/graph_of_laws.cpp",
        "law = is_known ? highest_of(table_, law, sum) : sum;",
        "law = is_known ? law : sum;",
        (GRAPH_OF_LAWS, LAWS, OBJECTIVES),
    ),
    Mutation(
        "budgets: of two ways the probability to exceed what is left of the budget is compared, at that point alone",
        "relax/valuations/budgets.cpp",
        "return is_never_more(left, right, budget.steps - least);",
        "return left.above_cost(budget.steps - least) <= right.above_cost(budget.steps - least);",
        BUDGETS,
    ),
    Mutation(
        "budgets: those that a way keeps so far are kept",
        "relax/valuations/budgets.cpp",
        "return keeps_all ? inner_.worth(values_[value].inner) : kNoWorth;",
        "return keeps_all || true ? inner_.worth(values_[value].inner) : kNoWorth;",
        BUDGETS,
    ),
    Mutation(
        "scenarios: a way is as good as another one if its law is in the first scenario",
        "relax/valuations/scenario_laws.cpp",
        "if (laws(one)[k] == laws(other)[k]) {",
        "if (k > 0 || laws(one)[k] == laws(other)[k]) {",
        (SCENARIOS_ALONE, CORRELATED),
    ),
    Mutation(
        "scenarios: a way is as good as another one if its total is in the last scenario",
        "relax/valuations/scenario_totals.cpp",
        "if (ones[k] > others[k] && !is_decided) {",
        "if (k + 1 == ones.size() && ones[k] > others[k] && !is_decided) {",
        (SCENARIOS_ALONE, CORRELATED),
    ),
    Mutation(
        "scenarios: with the least costs to come, all are over",
        "relax/valuations/scenario_totals.cpp",
        "options().decided_scenarios && static_cast<double>(add_bounds(others[k], least[k])) > last_;",
        "options().decided_scenarios && static_cast<double>(add_bounds(others[k], least[k])) > last_ / 2;",
        (LABEL_RULES, SCENARIOS_ALONE, CORRELATED),
    ),
    Mutation(
        "policies: the choice of a method waits for nothing",
        "relax/progression/policy_progression.cpp",
        "return other != occurrence.index && !ordered.is_before(occurrence.index, other);",
        "return false && other != occurrence.index && !ordered.is_before(occurrence.index, other);",
        (POLICY_PROGRESSION,),
    ),
    Mutation(
        "policies: costs tell nothing",
        "relax/progression/policy_progression.cpp",
        "const bool is_seen = !seen.actions.empty() && seen.actions[action];",
        "const bool is_seen = false && !seen.actions.empty() && seen.actions[action];",
        (POLICY_PROGRESSION,),
    ),
    Mutation(
        "policies: what compound tasks lead to is certain",
        "relax/progression/policy_progression.cpp",
        "            mark(problem.method_task[method]);\n",
        "            if (problem.is_chance(problem.method_task[method])) mark(problem.method_task[method]);\n",
        (POLICY_PROGRESSION,),
    ),
    Mutation(
        "policies: stubborn sets leave out uncertain actions",
        "relax/progression/stubborn_set.cpp",
        "!(is_kept_out(network.tasks[other]) || concerns(*occurring_[other], member, state))",
        "!concerns(*occurring_[other], member, state)",
        (POLICY_PROGRESSION,),
    ),
    Mutation(
        "policies: an action that commutes comes at once, even where failing has a price",
        "relax/progression/policy_progression.cpp",
        "(only_done_runs_pay_ ? 1 : 0)",
        "1",
        (POLICY_PROGRESSION,),
    ),
    Mutation(
        "policies: chance tasks make what their first outcome makes",
        "relax/analysis/task_profiles.cpp",
        "        list(outcome.made_list, result.makes, result.made_list);\n",
        "        result.made_list = result.made_list.empty() ? outcome.made_list : result.made_list;\n",
        (POLICY_PROGRESSION,),
    ),
    Mutation(
        "grounding: outcomes that change the same are one, whatever the conditions of their costs",
        "relax/grounding/outcomes.cpp",
        "const std::size_t number = is_mixed && mixture ? *mixture : outcomes_.size();",
        "const std::size_t number = mixture ? *mixture : outcomes_.size();",
        ("tests/unit/test_grounded_outcomes.py", GROUND_OUTCOMES),
    ),
    Mutation(
        "grounding: where outcomes are, the second block of an action always takes its first branch",
        "relax/grounding/outcomes.cpp",
        "chosen_[at] = (chosen_[at] + 1) % instances_[at].branches.size();",
        "chosen_[at] = at > 0 ? 0 : (chosen_[at] + 1) % instances_[at].branches.size();",
        (GROUND_OUTCOMES,),
    ),
    Mutation(
        "policies: lines below all policies do not count how unlikely it is what an averse agent sees",
        "relax/policies/policy_chord.cpp",
        "draft.cost -= prices_.high * divergence;",
        "",
        (POLICY_CHORD,),
    ),
    Mutation(
        "policies: lines below all policies take open nodes to be worth more than is known of them",
        "relax/policies/policy_chord.cpp",
        "copy_nodes(lines_, prices_.explored);",
        "copy_nodes(lines_, prices_.explored * 1.5);",
        (POLICY_CHORD,),
    ),
]
