// A search without Python, for sanitizer builds: a hand-made problem, solved with every heuristic and algorithm.

#include <chrono>
#include <cstdio>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "relax/search/label_search.hpp"
#include "relax/search/search.hpp"
#include "relax/valuations/price_sums.hpp"

namespace {

using Numbers = std::initializer_list<std::uint32_t>;

template <typename Index>
std::vector<Index> ids_of(Numbers numbers) {
    return {numbers.begin(), numbers.end()};
}

class Builder {
public:
    relax::TaskId action(Numbers needs, Numbers adds, Numbers deletes) {
        problem.preconditions.add_row(ids_of<relax::FactId>(needs));
        problem.negative_preconditions.finish_row();
        problem.effect_conditions.finish_row();
        problem.effect_negative_conditions.finish_row();
        problem.effect_adds.add_row(ids_of<relax::FactId>(adds));
        problem.effect_deletes.add_row(ids_of<relax::FactId>(deletes));
        problem.effects.share_out(problem.effect_adds.size());
        problem.action_schema.push_back(static_cast<std::uint32_t>(problem.action_schema.size()));
        problem.action_arguments.finish_row();
        problem.action_cost_blocks.finish_row();
        problem.cost_parts.share_out(0);
        return static_cast<relax::TaskId>(problem.action_schema.size() - 1);
    }

    void facts(std::uint32_t count) {
        for (std::uint32_t fact = 0; fact < count; ++fact) {
            problem.fact_predicate.push_back(fact);
            problem.fact_arguments.finish_row();
        }
    }

    void method(relax::TaskId task, const std::vector<relax::TaskId>& subtasks, bool ordered) {
        problem.method_task.push_back(task);
        problem.method_parts.share_out(problem.method_task.size());
        problem.method_subtasks.add_row(subtasks);
        for (std::uint32_t position = 0; position < subtasks.size(); ++position) {
            problem.method_positions.push({0, position});
            for (std::uint32_t later = position + 1; ordered && later < subtasks.size(); ++later) {
                problem.method_ordering.push({position, later});
            }
        }
        problem.method_positions.finish_row();
        problem.method_ordering.finish_row();
    }

    void compounds(std::uint32_t count) {
        for (std::uint32_t compound = 0; compound < count; ++compound) {
            problem.compound_schema.push_back(compound);
            problem.compound_is_chance.push_back(false);
            problem.compound_arguments.finish_row();
            for (const relax::MethodId id : problem.methods()) {
                if (problem.method_task[id] == problem.action_count() + compound) {
                    problem.compound_methods.push(id);
                }
            }
            problem.compound_methods.finish_row();
        }
    }

    relax::GroundProblem problem;
};

// top -> A C nothing A (ordered or not); A -> make | make A; C -> use done; `use` needs and spends what `make` makes.
relax::GroundProblem make_problem(bool ordered) {
    Builder builder;
    builder.facts(2);
    const auto make = builder.action({}, {0}, {});
    const auto use = builder.action({0}, {1}, {0});
    const auto done = builder.action({1}, {}, {});
    const relax::TaskId top{3};
    const relax::TaskId a{4};
    const relax::TaskId c{5};
    const relax::TaskId nothing{6};
    builder.method(top, {a, c, nothing, a}, ordered);
    builder.method(a, {make}, true);
    builder.method(a, {make, a}, true);
    builder.method(nothing, {}, true);
    builder.method(c, {use, done}, true);
    builder.compounds(4);
    builder.problem.initial_task = top;
    return builder.problem;
}

// The cheapest plan costs 15. Only exact searches need find it.
bool solve(bool ordered, std::string_view name, const relax::SearchOptions& options, bool is_exact) {
    const relax::AnalysedProblem problem(make_problem(ordered));
    const relax::PricedProblem priced(problem, {{3, 5, 4}, {}});
    relax::Limits limits;
    relax::SearchStatistics statistics;
    const relax::SearchResult result = relax::search(priced, options, limits, statistics);
    const bool optimal = result.status == relax::SearchStatus::Optimal && result.cost == relax::Cost{15};
    const bool solved = !is_exact && result.cost && *result.cost >= 15;
    const bool good = (optimal || solved) && !result.plan.empty() && statistics.lower_bound.value_or(99) <= 15;
    if (!good) {
        std::printf("wrong: ordered %d, %.*s\n", ordered, static_cast<int>(name.size()), name.data());
    }
    return good;
}

relax::FindPlansOptions best_first(std::vector<const relax::HeuristicInfo*> heuristics, double weight = 1.0) {
    relax::FindPlansOptions options;
    options.heuristics = std::move(heuristics);
    options.weight = weight;
    return options;
}

template <typename Options>
Options with(const relax::HeuristicInfo& heuristic) {
    Options options;
    options.heuristic = &heuristic;
    return options;
}

// What the planner does where nothing else is asked for.
relax::PortfolioOptions by_turns() {
    std::vector<const relax::HeuristicInfo*> several;
    for (const char* const name : {"potential-hmax", "potential", "lmcut"}) {
        several.push_back(&relax::heuristic_named(name));
    }
    relax::PortfolioOptions options;
    options.members = {{best_first({&relax::heuristic_named("tdg")})},
                       {best_first({&relax::heuristic_named("lmcut")})},
                       {best_first(several)}};
    return options;
}

// Searches in two threads share what is made once for a problem and its prices.
bool solve_in_two_threads(bool ordered) {
    const relax::AnalysedProblem problem(make_problem(ordered));
    const relax::PricedProblem priced(problem, {{3, 5, 4}, {}});
    std::optional<relax::Cost> found;
    std::optional<relax::Cost> found_by_other;
    const auto search = [&priced](std::optional<relax::Cost>& cost) {
        relax::Limits limits;
        relax::SearchStatistics statistics;
        cost = relax::search(priced, by_turns(), limits, statistics).cost;
    };
    std::thread other([&] { search(found_by_other); });
    search(found);
    other.join();
    const bool good = found == relax::Cost{15} && found_by_other == found;
    if (!good) {
        std::printf("wrong: two threads, ordered %d\n", ordered);
    }
    return good;
}

// The four best plans; every action is its own label.
bool solve_for_several(bool ordered, relax::Distinct distinct, const std::vector<relax::Cost>& expected) {
    const relax::AnalysedProblem problem(make_problem(ordered));
    const relax::PricedProblem priced(problem, {{3, 5, 4}, {}});
    relax::LabelSearchOptions options;
    options.count = 4;
    options.distinct = distinct;
    relax::Limits limits;
    relax::LabelStatistics statistics;
    relax::PriceSums sums(priced);
    const std::vector<std::optional<relax::ActionName>> names{0, 1, 2};
    const relax::LabelSearchResult result = relax::label_search(problem, sums, names, options, limits, statistics);
    std::vector<relax::Cost> costs;
    for (const relax::SearchResult& plan : result.plans) {
        costs.push_back(plan.cost.value_or(0));
    }
    const bool good = costs == expected && statistics.proven == 4 && !result.is_all;
    if (!good) {
        std::printf("wrong: the best plans, ordered %d, distinct %d\n", ordered, static_cast<int>(distinct));
    }
    return good;
}

// A limit that was reached leaves a little more time for what is put together then, and is reached again after that.
bool gives_grace() {
    relax::Limits limits;
    limits.deadline = relax::Limits::Clock::now() - std::chrono::seconds(1);
    bool good = limits.check() == relax::StopReason::TimeLimit;
    {
        const relax::Limits::Grace grace(limits);
        good = good && !limits.check();
    }
    return good && limits.check() == relax::StopReason::TimeLimit;
}

}  // namespace

int main() {
    int passed = 0;
    int failed = 0;
    for (const bool ordered : {true, false}) {
        for (const relax::HeuristicInfo& heuristic : relax::heuristics()) {
            const std::string_view name = heuristic.name;
            ++(solve(ordered, name, with<relax::GreedyOptions>(heuristic), false) ? passed : failed);
            if (heuristic.is_admissible) {
                ++(solve(ordered, name, best_first({&heuristic}), true) ? passed : failed);
                ++(solve(ordered, name, best_first({&heuristic}, 2.0), false) ? passed : failed);
            }
            if (!heuristic.has_model) {
                ++(solve(ordered, name, with<relax::PlanBasedOptions>(heuristic), true) ? passed : failed);
            }
        }
        ++(solve(ordered, "by turns", by_turns(), true) ? passed : failed);
        ++(solve_in_two_threads(ordered) ? passed : failed);
    }
    ++(solve_for_several(true, relax::Distinct::Sequence, {15, 18, 18, 21}) ? passed : failed);
    ++(solve_for_several(false, relax::Distinct::Sequence, {15, 15, 15, 18}) ? passed : failed);
    for (const bool ordered : {true, false}) {
        ++(solve_for_several(ordered, relax::Distinct::Multiset, {15, 18, 21, 24}) ? passed : failed);
    }
    ++(gives_grace() ? passed : failed);
    std::printf("%d passed, %d failed\n", passed, failed);
    return failed == 0 ? 0 : 1;
}
