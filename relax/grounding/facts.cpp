#include "facts.hpp"

#include <algorithm>

namespace relax::grounding {

Knowledge::Knowledge(const LiftedProblem& lifted)
    : problem(lifted), grows(lifted.predicate_count, false), shrinks(lifted.predicate_count, false) {
    for (const std::vector<ObjectId>& members : problem.domains) {
        ObjectSet& domain = domains.emplace_back(problem.object_count);
        for (const ObjectId object : members) {
            domain.add(object);
        }
    }
    std::vector<std::optional<std::size_t>> arities(problem.predicate_count);
    for (const std::vector<std::uint32_t>& fact : problem.initial_state) {
        arities[fact[0]] = fact.size() - 1;
    }
    for (const LiftedAction& action : problem.actions) {
        for (const LiftedEffect& effect : action.effects) {
            arities[effect.predicate] = effect.arguments.size();
        }
    }
    for (const std::optional<std::size_t>& arity : arities) {
        relations.emplace_back(arity.value_or(0));  // an empty relation's arity does not matter
    }
    for (const std::vector<std::uint32_t>& fact : problem.initial_state) {
        relations[fact[0]].add(std::vector<ObjectId>(fact.begin() + 1, fact.end()));
    }
    for (const Relation& relation : relations) {
        initial_count.push_back(relation.size());
    }
    for (std::uint32_t task = 0; task < task_count(); ++task) {
        relations.emplace_back(task_parameters(task).size());
    }
}

}  // namespace relax::grounding
