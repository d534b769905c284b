// Actions with several outcomes without Python, for sanitizer builds: ground problems with chance tasks, and what
// agents that see outcomes and costs may decide.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "relax/grounding/grounder.hpp"
#include "relax/progression/policy_progression.hpp"
#include "relax/progression/policy_space.hpp"

namespace {

using relax::ActionId;
using relax::Formula;
using relax::FormulaKind;

Formula atom(std::uint32_t predicate) { return {FormulaKind::Atom, {}, predicate, {}, {}}; }
Formula negation(Formula operand) { return {FormulaKind::Not, {std::move(operand)}, 0, {}, {}}; }

relax::LiftedEffect effect(std::uint32_t predicate, std::uint32_t block, std::uint32_t branch) {
    return {{}, {}, predicate, {}, true, relax::LiftedBranch{block, branch}};
}

relax::LiftedMethod method(std::uint32_t task, const std::vector<std::uint32_t>& subtasks, bool is_ordered = false) {
    relax::LiftedMethod result;
    result.task = task;
    for (const std::uint32_t subtask : subtasks) {
        result.subtasks.push_back({subtask, {}});
    }
    for (std::uint32_t later = 1; is_ordered && later < subtasks.size(); ++later) {
        result.ordering.emplace_back(later - 1, later);
    }
    return result;
}

std::unique_ptr<relax::AnalysedProblem> grounded(const relax::LiftedProblem& problem) {
    relax::Limits limits;
    auto result = relax::ground(problem, {}, limits);
    auto* const found = std::get_if<std::unique_ptr<relax::AnalysedProblem>>(&result);
    return found == nullptr ? nullptr : std::move(*found);
}

// Two tasks without an order: C is done by c1, which costs 0 or 6, or by c2 for 20; D by d1 for 5, or by d2 for 0 or 9;
// all with probability 1/2. Which method of D is best depends on what c1 cost.
relax::LiftedProblem two_choices(bool is_swapped) {
    relax::LiftedProblem problem;
    problem.actions.resize(4);
    problem.tasks.resize(3);
    problem.methods = {method(4, {0}), method(4, {1}), method(5, {2}), method(5, {3}),
                       is_swapped ? method(6, {5, 4}) : method(6, {4, 5})};
    problem.initial_task = 6;
    return problem;
}

// The least probability of a total cost above 8.
double late(const relax::AnalysedProblem& problem, const relax::PolicySpace& space, std::uint32_t node, int spent) {
    const std::vector<std::vector<int>> costs{{0, 6}, {20, 20}, {5, 5}, {0, 9}};
    if (space.decisions(node).empty()) {
        return spent > 8 ? 1 : 0;
    }
    double least = 1;
    for (const relax::PolicySpace::Decision& decision : space.decisions(node)) {
        double sum = 0;
        for (const relax::PolicySpace::Outcome& outcome : decision.outcomes) {
            const auto& law = outcome.action ? costs[problem.action_schema[*outcome.action]] : std::vector<int>{0, 0};
            for (const int cost : law) {
                sum += late(problem, space, outcome.node, spent + cost) / 2;
            }
        }
        least = std::min(least, sum);
    }
    return least;
}

// The same where the agent's decisions are those of one that sees costs, or does not look.
double late(bool is_swapped, bool are_seen) {
    const auto problem = grounded(two_choices(is_swapped));
    relax::Limits limits;
    const std::vector<bool> free(problem->action_count(), false);
    std::vector<bool> uncertain;
    for (const ActionId action : problem->actions()) {
        uncertain.push_back(problem->action_schema[action] % 3 == 0);
    }
    const relax::SeenCosts costs = are_seen ? relax::SeenCosts{uncertain, {}} : relax::SeenCosts{};
    relax::PolicyProgression progression(*problem, free, costs, {}, limits);
    const relax::PolicySpace space(progression, 1000, limits);
    return late(*problem, space, 0, 0);
}

// If nothing is thought to be seen, one task is decomposed first: the wrong one, in one of the two orders.
bool waits_for_costs() {
    const auto is_near = [](double one, double other) { return std::abs(one - other) < 1e-12; };
    return is_near(late(false, true), 0.25) && is_near(late(true, true), 0.25) &&
           is_near(std::max(late(false, false), late(true, false)), 0.5);
}

// T is done where p holds, or tries a, which makes p true in the first of its two outcomes, and then T again.
bool tries_again() {
    relax::LiftedProblem problem;
    problem.predicate_count = 1;
    problem.actions.resize(2);
    problem.actions[0].precondition = negation(atom(0));
    problem.actions[0].effects = {effect(0, 0, 0)};
    problem.actions[0].outcome_blocks = {{0, 2}};
    problem.actions[1].precondition = atom(0);
    problem.actions[1].is_precondition = true;
    problem.tasks.resize(2);
    problem.methods = {method(2, {1}), method(2, {0, 2}, true), method(3, {2})};
    problem.initial_task = 3;
    const auto ground = grounded(problem);
    if (ground == nullptr || !ground->has_outcomes() || ground->action_count() != 3) {
        return false;
    }
    relax::Limits limits;
    relax::PolicyProgression progression(*ground, {true, true, true}, {}, {}, limits);
    const relax::PolicySpace space(progression, 1000, limits);
    int done = 0;
    int chances = 0;
    for (std::uint32_t node = 0; node < space.node_count(); ++node) {
        done += progression.is_done(space.network(node)) ? 1 : 0;
        for (const relax::PolicySpace::Decision& decision : space.decisions(node)) {
            chances += decision.outcomes.size() == 2 ? 1 : 0;
        }
    }
    return !space.stop() && done == 1 && chances == 1;
}

// An action with seven independent outcomes of two: too many, unless nothing reads what they change.
bool counts_outcomes(bool are_read) {
    constexpr std::uint32_t kBlocks = 7;
    relax::LiftedProblem problem;
    problem.predicate_count = kBlocks;
    problem.actions.resize(2);
    for (std::uint32_t block = 0; block < kBlocks; ++block) {
        problem.actions[0].effects.push_back(effect(block, block, 0));
        problem.actions[0].outcome_blocks.push_back({0, 2});
        if (are_read) {
            problem.actions[1].precondition.operands.push_back(atom(block));
        }
    }
    problem.actions[1].is_precondition = true;
    problem.tasks.resize(1);
    problem.methods = {method(2, {0, 1}, true)};
    problem.initial_task = 2;
    relax::Limits limits;
    const auto result = relax::ground(problem, {}, limits);
    if (const auto* const many = std::get_if<relax::TooManyCasesOf>(&result)) {
        return are_read && many->is_about_outcomes && many->action == 0;
    }
    const auto* const found = std::get_if<std::unique_ptr<relax::AnalysedProblem>>(&result);
    return !are_read && found != nullptr && !(*found)->has_outcomes() && (*found)->action_count() == 1;
}

}  // namespace

int main() {
    int passed = 0;
    int failed = 0;
    for (const bool result : {waits_for_costs(), tries_again(), counts_outcomes(true), counts_outcomes(false)}) {
        ++(result ? passed : failed);
    }
    std::printf("%d passed, %d failed\n", passed, failed);
    return failed == 0 ? 0 : 1;
}
