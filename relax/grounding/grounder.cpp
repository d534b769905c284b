#include "relax/grounding/grounder.hpp"

#include <new>
#include <utility>

#include "assembly.hpp"
#include "impossible.hpp"
#include "pruning.hpp"

namespace relax {

namespace {

using namespace grounding;

GroundProblem unsolvable() {
    GroundProblem problem;
    problem.solvable = false;
    return problem;
}

std::vector<bool> initial_truth(const Expander& expander, std::uint32_t predicate_count) {
    std::vector<bool> is_true(expander.fact_count(), false);
    for (std::uint32_t predicate = 0; predicate < predicate_count; ++predicate) {
        for (std::uint32_t fact = expander.fact_begin()[predicate]; fact < expander.fact_begin()[predicate + 1];
             ++fact) {
            is_true[fact] = expander.is_initially_true(predicate, fact - expander.fact_begin()[predicate]);
        }
    }
    return is_true;
}

// Fewer demanded actions leave more predicates static, which may narrow the
// demand further.
Demand first_demand(Knowledge& knowledge, Limits& limits) {
    std::vector<bool> is_demanded(knowledge.task_count(), true);
    while (true) {
        classify_predicates(knowledge, is_demanded);
        Demand demand = find_demand(knowledge, possible_arguments(knowledge, limits), limits);
        if (demand.is_demanded == is_demanded) {
            return demand;
        }
        is_demanded = demand.is_demanded;
    }
}

std::unique_ptr<AnalysedProblem> ground_or_throw(Knowledge& knowledge, const GroundingOptions& options,
                                                 Limits& limits) {
    const LiftedProblem& lifted = knowledge.problem;
    Demand coarse = first_demand(knowledge, limits);
    add_pair_relations(knowledge, coarse);
    const Dependents dependents = reach_actions(knowledge, coarse, limits);
    Demand demand = find_demand(knowledge, reached_arguments(knowledge, limits), limits);
    add_pair_relations(knowledge, demand);
    reach_tasks(knowledge, demand, limits);
    if (knowledge.relations[knowledge.task_relation(lifted.initial_task)].size() == 0) {
        return std::make_unique<AnalysedProblem>(unsolvable());
    }
    TaskGraph graph = expand_methods(knowledge, demand, limits);
    const Expander expander(knowledge, limits);
    Cases cases = make_cases(knowledge, expander, graph, dependents, limits);
    const std::vector<bool> is_initially_true = initial_truth(expander, lifted.predicate_count);
    const std::vector<bool> is_literal_reached = prune(graph, cases, is_initially_true, limits);
    if (!graph.is_node_alive[graph.initial]) {
        return std::make_unique<AnalysedProblem>(unsolvable());
    }
    GroundProblem problem = assemble(
        {knowledge, graph, cases, expander.fact_begin(), is_initially_true, is_literal_reached, options, limits});
    if (!options.ask_mutexes) {
        return std::make_unique<AnalysedProblem>(std::move(problem));
    }
    auto analysed = without_impossible(std::move(problem), limits);
    return analysed->solvable ? std::move(analysed) : std::make_unique<AnalysedProblem>(unsolvable());
}

}  // namespace

std::variant<std::unique_ptr<AnalysedProblem>, StopReason, TooManyCasesOf> ground(const LiftedProblem& problem,
                                                                                  const GroundingOptions& options,
                                                                                  Limits& limits) {
    Knowledge knowledge(problem);
    try {
        return ground_or_throw(knowledge, options, limits);
    } catch (const Stopped& stopped) {
        return stopped.reason;
    } catch (const TooManyCases& error) {
        const auto arguments = knowledge.relations[knowledge.task_relation(error.action)][error.instance];
        return TooManyCasesOf{error.action, {arguments.begin(), arguments.end()}, error.is_about_outcomes};
    } catch (const std::bad_alloc&) {
        return StopReason::MemoryLimit;
    }
}

}  // namespace relax
