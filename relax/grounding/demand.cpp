#include "demand.hpp"

#include <algorithm>
#include <array>

#include "formulas.hpp"

namespace relax::grounding {

namespace {

std::vector<ObjectSet> parameter_domains(const Knowledge& knowledge, const std::vector<std::uint32_t>& parameters) {
    std::vector<ObjectSet> sets;
    for (const std::uint32_t domain : parameters) {
        sets.push_back(knowledge.domains[domain]);
    }
    return sets;
}

// The values of one column of a relation's present tuples.
ObjectSet column(const Knowledge& knowledge, RelationId id, std::size_t position) {
    ObjectSet values(knowledge.problem.object_count);
    const Relation& relation = knowledge.relations[id];
    for (TupleId tuple = 0; tuple < relation.size(); ++tuple) {
        values.add(relation[tuple][position]);
    }
    return values;
}

// Narrow the sets of the parameters (slots 0, 1, ..) by a conjunct about one
// variable.
void narrow(const Knowledge& knowledge, const Formula& conjunct, std::vector<ObjectSet>& sets) {
    const auto is_parameter = [&](Term term) { return term >= 0 && static_cast<std::size_t>(term) < sets.size(); };
    if (conjunct.kind == FormulaKind::Atom && !knowledge.grows[conjunct.symbol]) {
        for (std::size_t position = 0; position < conjunct.terms.size(); ++position) {
            if (is_parameter(conjunct.terms[position])) {
                ObjectSet& set = sets[static_cast<std::size_t>(conjunct.terms[position])];
                set.intersect(column(knowledge, conjunct.symbol, position));
            }
        }
    } else if (conjunct.kind == FormulaKind::InDomain && is_parameter(conjunct.terms[0])) {
        sets[static_cast<std::size_t>(conjunct.terms[0])].intersect(knowledge.domains[conjunct.symbol]);
    } else if (conjunct.kind == FormulaKind::Equals) {
        for (const auto& [variable, value] :
             {std::pair(conjunct.terms[0], conjunct.terms[1]), std::pair(conjunct.terms[1], conjunct.terms[0])}) {
            if (is_parameter(variable) && value < 0) {
                const auto object = static_cast<ObjectId>(~value);
                sets[static_cast<std::size_t>(variable)].keep_if([&](ObjectId other) { return other == object; });
            }
        }
    }
}

void narrow_by_formula(const Knowledge& knowledge, const Formula& formula, std::vector<ObjectSet>& sets) {
    std::vector<Formula> conjuncts;
    split_conjunction(normal_form(knowledge, formula), conjuncts);
    for (const Formula& conjunct : conjuncts) {
        narrow(knowledge, conjunct, sets);
    }
}

// Narrow the slots by what a task with these terms as arguments allows. Returns
// false where nothing is left.
bool narrow_by_task(const std::vector<Term>& terms, const std::vector<ObjectSet>& allowed,
                    std::vector<ObjectSet>& slots) {
    for (std::size_t position = 0; position < terms.size(); ++position) {
        const Term term = terms[position];
        if (term < 0) {
            if (!allowed[position].contains(static_cast<ObjectId>(~term))) {
                return false;
            }
            continue;
        }
        ObjectSet& slot = slots[static_cast<std::size_t>(term)];
        slot.intersect(allowed[position]);
        if (slot.empty()) {
            return false;
        }
    }
    return true;
}

// Tasks with more parameters than this get no pairs: these would grow with the square of the parameters.
constexpr std::size_t kMostPaired = 40;

class DemandFinder {
public:
    DemandFinder(const Knowledge& knowledge, const ArgumentSets& possible, Limits& limits)
        : knowledge_(knowledge), limits_(limits) {
        const LiftedProblem& problem = knowledge.problem;
        methods_of_.resize(knowledge.task_count());
        for (std::uint32_t task = 0; task < knowledge.task_count(); ++task) {
            const std::size_t arity = knowledge.task_parameters(task).size();
            demand_.arguments.emplace_back(arity, ObjectSet(problem.object_count));
            demand_.pairs.emplace_back(arity <= kMostPaired ? arity * arity : 0);
        }
        demand_.is_demanded.assign(knowledge.task_count(), false);
        demand_.is_method_demanded.assign(problem.methods.size(), false);
        for (const LiftedMethod& method : problem.methods) {
            limits.stop_if_reached();
            methods_of_[method.task].push_back(static_cast<std::uint32_t>(ceilings_.size()));
            std::vector<ObjectSet>& slots = ceilings_.emplace_back(parameter_domains(knowledge, method.parameters));
            narrow_by_formula(knowledge, method.constraints, slots);
            bool is_possible = std::ranges::none_of(slots, &ObjectSet::empty);
            for (const LiftedSubtask& subtask : method.subtasks) {
                is_possible = is_possible && narrow_by_task(subtask.arguments, possible[subtask.task], slots);
            }
            is_possible_.push_back(is_possible);
        }
        demand_.method_slots.resize(problem.methods.size());
    }

    Demand find() {
        demand_.is_demanded[knowledge_.problem.initial_task] = true;
        std::vector<std::uint32_t> pending{knowledge_.problem.initial_task};
        std::vector<bool> is_pending(knowledge_.task_count(), false);
        while (!pending.empty()) {
            const std::uint32_t task = pending.back();
            pending.pop_back();
            is_pending[task] = false;
            for (const std::uint32_t method : methods_of_[task]) {
                limits_.stop_if_reached();
                if (!is_possible_[method] || !enter(method)) {
                    continue;
                }
                for (const LiftedSubtask& subtask : knowledge_.problem.methods[method].subtasks) {
                    limits_.stop_if_reached();
                    if (hand_down(method, subtask) && !is_pending[subtask.task]) {
                        is_pending[subtask.task] = true;
                        pending.push_back(subtask.task);
                    }
                }
            }
        }
        return std::move(demand_);
    }

private:
    // Find the objects that the method's slots may have now. Returns false where
    // it cannot be used.
    bool enter(std::uint32_t method) {
        const LiftedMethod& lifted = knowledge_.problem.methods[method];
        std::vector<ObjectSet> slots = ceilings_[method];
        if (!narrow_by_task(lifted.task_arguments, demand_.arguments[lifted.task], slots)) {
            return false;
        }
        demand_.is_method_demanded[method] = true;
        demand_.method_slots[method] = std::move(slots);
        return true;
    }

    // Returns whether the subtask's task gets something new.
    bool hand_down(std::uint32_t method, const LiftedSubtask& subtask) {
        bool is_new = !demand_.is_demanded[subtask.task];
        demand_.is_demanded[subtask.task] = true;
        for (std::size_t position = 0; position < subtask.arguments.size(); ++position) {
            ObjectSet& set = demand_.arguments[subtask.task][position];
            const Term term = subtask.arguments[position];
            if (term < 0) {
                is_new |= set.add(static_cast<ObjectId>(~term));
                continue;
            }
            for (const ObjectId object : demand_.method_slots[method][static_cast<std::size_t>(term)].members()) {
                is_new |= set.add(object);
            }
        }
        for (std::size_t second = 1; demand_.has_pairs(subtask.task) && second < subtask.arguments.size(); ++second) {
            for (std::size_t first = 0; first < second; ++first) {
                limits_.stop_if_reached();
                is_new |= hand_down_pairs(method, subtask, first, second);
            }
        }
        return is_new;
    }

    // The same for two arguments at once, as long as few pairs of objects are asked for.
    bool hand_down_pairs(std::uint32_t method, const LiftedSubtask& subtask, std::size_t first, std::size_t second) {
        constexpr std::size_t kMostPairs = std::size_t{1} << 17;
        PairSet& target = demand_.pairs_of(subtask.task, first, second);
        if (target.is_open) {
            return false;
        }
        const std::size_t before = target.pairs.size();
        const auto add = [&](ObjectId left, ObjectId right) { target.pairs.add(std::array{left, right}); };
        const Term left = subtask.arguments[first];
        const Term right = subtask.arguments[second];
        const auto slot = [&](Term term) -> const ObjectSet& {
            return demand_.method_slots[method][static_cast<std::size_t>(term)];
        };
        if (left < 0 && right < 0) {
            add(static_cast<ObjectId>(~left), static_cast<ObjectId>(~right));
        } else if (left < 0 || right < 0 || left == right) {
            for (const ObjectId object : slot(std::max(left, right)).members()) {
                add(left < 0 ? static_cast<ObjectId>(~left) : object,
                    right < 0 ? static_cast<ObjectId>(~right) : object);
            }
        } else if (const auto [source, is_swapped] = given_pairs(method, left, right); source != nullptr) {
            const std::size_t count = source->pairs.size();  // source and target may be the same
            for (TupleId pair = 0; pair < count; ++pair) {
                limits_.stop_if_reached();
                const ObjectId one = source->pairs[pair][is_swapped ? 1 : 0];
                const ObjectId other = source->pairs[pair][is_swapped ? 0 : 1];
                if (slot(left).contains(one) && slot(right).contains(other)) {
                    add(one, other);
                }
            }
        } else {
            target.is_open = true;
        }
        target.is_open = target.is_open || target.pairs.size() > kMostPairs;
        return target.is_open || target.pairs.size() > before;
    }

    // The pairs of objects that two variables of a method get from the task that it decomposes, and whether they are
    // its arguments in the opposite order; none if they are not both arguments of the task, or its pairs are not
    // restricted.
    std::pair<const PairSet*, bool> given_pairs(std::uint32_t method, Term left, Term right) const {
        const LiftedMethod& lifted = knowledge_.problem.methods[method];
        if (!demand_.has_pairs(lifted.task)) {
            return {nullptr, false};
        }
        const auto left_at = std::ranges::find(lifted.task_arguments, left);
        const auto right_at = std::ranges::find(lifted.task_arguments, right);
        if (left_at == lifted.task_arguments.end() || right_at == lifted.task_arguments.end()) {
            return {nullptr, false};
        }
        const auto first = static_cast<std::size_t>(std::min(left_at, right_at) - lifted.task_arguments.begin());
        const auto second = static_cast<std::size_t>(std::max(left_at, right_at) - lifted.task_arguments.begin());
        const PairSet& pairs = demand_.pairs_of(lifted.task, first, second);
        return {pairs.is_open ? nullptr : &pairs, right_at < left_at};
    }

    const Knowledge& knowledge_;
    Limits& limits_;
    std::vector<std::vector<std::uint32_t>> methods_of_;  // by task
    std::vector<std::vector<ObjectSet>> ceilings_;        // by method, parameter: what it can have at all
    std::vector<bool> is_possible_;
    Demand demand_;
};

}  // namespace

ArgumentSets possible_arguments(const Knowledge& knowledge, Limits& limits) {
    ArgumentSets sets;
    for (std::uint32_t task = 0; task < knowledge.task_count(); ++task) {
        limits.stop_if_reached();
        sets.push_back(parameter_domains(knowledge, knowledge.task_parameters(task)));
        if (knowledge.is_action(task)) {
            narrow_by_formula(knowledge, knowledge.problem.actions[task].precondition, sets.back());
        }
    }
    return sets;
}

ArgumentSets reached_arguments(const Knowledge& knowledge, Limits& limits) {
    ArgumentSets sets;
    for (std::uint32_t task = 0; task < knowledge.task_count(); ++task) {
        if (knowledge.is_action(task)) {
            std::vector<ObjectSet>& columns = sets.emplace_back();
            for (std::size_t position = 0; position < knowledge.task_parameters(task).size(); ++position) {
                limits.stop_if_reached();
                columns.push_back(column(knowledge, knowledge.task_relation(task), position));
            }
        } else {
            sets.push_back(parameter_domains(knowledge, knowledge.task_parameters(task)));
        }
    }
    return sets;
}

Demand find_demand(const Knowledge& knowledge, const ArgumentSets& possible, Limits& limits) {
    return DemandFinder(knowledge, possible, limits).find();
}

void add_pair_relations(Knowledge& knowledge, Demand& demand) {
    demand.pair_relations.resize(knowledge.task_count());
    for (std::uint32_t task = 0; task < knowledge.task_count(); ++task) {
        const std::vector<ObjectSet>& sets = demand.arguments[task];
        for (std::uint32_t second = 1; demand.is_demanded[task] && demand.has_pairs(task) && second < sets.size();
             ++second) {
            for (std::uint32_t first = 0; first < second; ++first) {
                PairSet& set = demand.pairs_of(task, first, second);
                if (!set.is_open && 2 * set.pairs.size() <= sets[first].size() * sets[second].size()) {
                    demand.pair_relations[task].push_back(
                        {static_cast<RelationId>(knowledge.relations.size()), first, second});
                    knowledge.relations.push_back(std::move(set.pairs));
                }
            }
        }
    }
    demand.pairs.clear();
}

}  // namespace relax::grounding
