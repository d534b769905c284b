#include "emission.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace relax {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

bool comes_before(const TaskInstance& left, const TaskInstance& right) {
    return left.task != right.task ? left.task < right.task : left.tuple < right.tuple;
}

template <typename Value>
void sort_unique(std::vector<Value>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

class Emitter {
public:
    Emitter(const Reachability& reachability, const CaseBuilder& facts, std::vector<ActionCase> cases,
            const Pruned& pruned)
        : reachability_(reachability),
          lifted_(reachability.problem()),
          facts_(facts),
          cases_(std::move(cases)),
          pruned_(pruned) {}

    GroundProblem run() {
        if (!pruned_.solvable) {
            out_.effect_begin.push_back(0);
            out_.solvable = false;
            return std::move(out_);
        }
        keep_living_cases();
        number_facts();
        number_tasks();
        for (const ActionCase& one : cases_) {
            emit_action(one);
        }
        out_.effect_begin.push_back(static_cast<EffectId>(out_.effect_adds.size()));
        emit_compounds();
        return std::move(out_);
    }

private:
    // Sort the cases by instance; simplify them; drop doubles, and all cases of artificial actions that are always
    // applicable.
    void keep_living_cases() {
        std::vector<ActionCase> living;
        for (std::size_t index = 0; index < cases_.size(); ++index) {
            if (pruned_.case_lives[index]) {
                living.push_back(simplified(std::move(cases_[index])));
            }
        }
        std::stable_sort(living.begin(), living.end(), [](const ActionCase& left, const ActionCase& right) {
            return comes_before(left.instance, right.instance);
        });
        cases_.clear();
        for (std::size_t begin = 0; begin < living.size();) {
            std::size_t end = begin;
            bool is_trivial = false;
            while (end < living.size() && living[end].instance == living[begin].instance) {
                is_trivial = is_trivial || living[end].precondition.empty();
                ++end;
            }
            const std::size_t first = cases_.size();
            const bool is_dropped = is_trivial && lifted_.actions[living[begin].instance.task].is_artificial;
            for (; begin < end; ++begin) {
                const bool is_double = std::any_of(cases_.begin() + static_cast<std::ptrdiff_t>(first), cases_.end(),
                                                   [&](const ActionCase& other) {
                                                       return other.precondition == living[begin].precondition &&
                                                              other.cost_parts == living[begin].cost_parts;
                                                   });
                if (!is_dropped && !is_double) {
                    cases_.push_back(std::move(living[begin]));
                }
            }
        }
    }

    ActionCase simplified(ActionCase one) const {
        const auto is_certain = [this](Literal literal) { return pruned_.is_certain(literal); };
        std::erase_if(one.precondition, is_certain);
        std::vector<FactId> always;
        for (ActionCase::Effect& effect : one.effects) {
            const bool happens = std::all_of(effect.condition.begin(), effect.condition.end(),
                                             [this](Literal literal) { return pruned_.can_hold[literal]; });
            std::erase_if(effect.condition, is_certain);
            std::erase_if(effect.adds, [&](FactId fact) { return !happens || is_certain(literal(fact, false)); });
            std::erase_if(effect.deletes, [&](FactId fact) { return !happens || is_certain(literal(fact, true)); });
            if (effect.condition.empty()) {
                always.insert(always.end(), effect.adds.begin(), effect.adds.end());
            }
        }
        sort_unique(always);
        ActionCase::Effect unconditional;
        std::vector<ActionCase::Effect> conditional;
        for (ActionCase::Effect& effect : one.effects) {
            std::erase_if(effect.deletes,
                          [&](FactId fact) { return std::binary_search(always.begin(), always.end(), fact); });
            if (effect.condition.empty()) {
                unconditional.deletes.insert(unconditional.deletes.end(), effect.deletes.begin(), effect.deletes.end());
            } else {
                conditional.push_back(std::move(effect));
            }
        }
        unconditional.adds = std::move(always);
        one.effects.assign(1, std::move(unconditional));
        std::move(conditional.begin(), conditional.end(), std::back_inserter(one.effects));
        return one;
    }

    // Only facts that some precondition or condition reads.
    void number_facts() {
        fact_number_.assign(facts_.fact_count(), kNone);
        const auto read = [this](const Cube& cube) {
            for (const Literal literal : cube) {
                fact_number_[fact_of(literal)] = 0;
            }
        };
        for (ActionCase& one : cases_) {
            read(one.precondition);
        }
        // A condition counts only if its effect does; effects on facts that nothing reads must not keep others alive.
        for (bool changed = true; changed;) {
            changed = false;
            for (const ActionCase& one : cases_) {
                for (const ActionCase::Effect& effect : one.effects) {
                    const auto is_read = [this](FactId fact) { return fact_number_[fact] != kNone; };
                    if (std::any_of(effect.adds.begin(), effect.adds.end(), is_read) ||
                        std::any_of(effect.deletes.begin(), effect.deletes.end(), is_read)) {
                        changed = changed || !std::all_of(effect.condition.begin(), effect.condition.end(),
                                                          [&](Literal literal) { return is_read(fact_of(literal)); });
                        read(effect.condition);
                    }
                }
            }
        }
        for (FactId fact = 0; fact < facts_.fact_count(); ++fact) {
            if (fact_number_[fact] == kNone) {
                continue;
            }
            fact_number_[fact] = static_cast<FactId>(out_.fact_predicate.size());
            out_.fact_predicate.push_back(facts_.predicate(fact));
            out_.fact_arguments.add_row(facts_.arguments(fact));
            if (facts_.is_initial(fact)) {
                out_.initial_state.push_back(fact_number_[fact]);
            }
        }
    }

    // Numbers of actions with one case, of choices, and of compound tasks.
    void number_tasks() {
        for (std::uint32_t task = 0; task < lifted_.actions.size() + lifted_.tasks.size(); ++task) {
            task_number_.emplace_back(reachability_.instances(task).size(), kNone);
        }
        std::vector<TaskInstance> compounds;
        for (std::size_t method = 0; method < reachability_.methods().size(); ++method) {
            if (pruned_.method_lives[method]) {
                compounds.push_back(reachability_.methods()[method].task);
            }
        }
        std::sort(compounds.begin(), compounds.end(), comes_before);
        compounds.erase(std::unique(compounds.begin(), compounds.end()), compounds.end());
        const auto action_count = static_cast<TaskId>(cases_.size());
        for (const TaskInstance& compound : compounds) {
            task_number_[compound.task][compound.tuple] = action_count + static_cast<TaskId>(compounds_.size());
            compounds_.push_back(compound);
        }
        for (TaskId action = 0; action < action_count; ++action) {
            const TaskInstance& instance = cases_[action].instance;
            const bool first = action == 0 || !(cases_[action - 1].instance == instance);
            const bool last = action + 1 == action_count || !(cases_[action + 1].instance == instance);
            TaskId& number = task_number_[instance.task][instance.tuple];
            if (first && last) {
                number = action;
            } else if (first) {
                number = action_count + static_cast<TaskId>(compounds_.size());
                compounds_.push_back(instance);
            }
        }
    }

    void emit_action(const ActionCase& one) {
        const auto emit_cube = [this](const Cube& cube, Rows<FactId>& positive, Rows<FactId>& negative) {
            for (const Literal literal : cube) {
                (is_negated(literal) ? negative : positive).push(fact_number_[fact_of(literal)]);
            }
            positive.finish_row();
            negative.finish_row();
        };
        out_.action_schema.push_back(one.instance.task);
        out_.action_arguments.add_row(arguments(one.instance));
        out_.action_cost_parts.add_row(one.cost_parts);
        emit_cube(one.precondition, out_.preconditions, out_.negative_preconditions);
        out_.effect_begin.push_back(static_cast<EffectId>(out_.effect_adds.size()));
        for (const ActionCase::Effect& effect : one.effects) {
            const auto adds = read_facts(effect.adds);
            const auto deletes = read_facts(effect.deletes);
            if (!adds.empty() || !deletes.empty()) {
                emit_cube(effect.condition, out_.effect_conditions, out_.effect_negative_conditions);
                out_.effect_adds.add_row(adds);
                out_.effect_deletes.add_row(deletes);
            }
        }
    }

    std::vector<FactId> read_facts(const std::vector<FactId>& facts) const {
        std::vector<FactId> numbers;
        for (const FactId fact : facts) {
            if (fact_number_[fact] != kNone) {
                numbers.push_back(fact_number_[fact]);
            }
        }
        sort_unique(numbers);
        return numbers;
    }

    void emit_compounds() {
        std::vector<std::vector<std::size_t>> methods_of(compounds_.size());
        const auto action_count = static_cast<TaskId>(cases_.size());
        for (std::size_t method = 0; method < reachability_.methods().size(); ++method) {
            if (pruned_.method_lives[method]) {
                methods_of[number(reachability_.methods()[method].task) - action_count].push_back(method);
            }
        }
        for (TaskId compound = 0; compound < compounds_.size(); ++compound) {
            out_.compound_schema.push_back(compounds_[compound].task);
            out_.compound_arguments.add_row(arguments(compounds_[compound]));
            if (compounds_[compound].task < lifted_.actions.size()) {
                emit_choice(compound);
            }
            for (const std::size_t method : methods_of[compound]) {
                emit_method(reachability_.methods()[method]);
            }
            out_.compound_methods.finish_row();
        }
        out_.initial_task = number({lifted_.initial_task, 0});
    }

    void begin_method(TaskId task, std::uint32_t schema, bool is_choice) {
        out_.compound_methods.push(static_cast<MethodId>(out_.method_count()));
        out_.method_task.push_back(task);
        out_.method_schema.push_back(schema);
        out_.method_is_choice.push_back(is_choice);
    }

    void emit_choice(TaskId compound) {
        const auto first = std::lower_bound(
            cases_.begin(), cases_.end(), compounds_[compound],
            [](const ActionCase& one, const TaskInstance& wanted) { return comes_before(one.instance, wanted); });
        for (auto one = first; one != cases_.end() && one->instance == compounds_[compound]; ++one) {
            begin_method(static_cast<TaskId>(cases_.size()) + compound, compounds_[compound].task, true);
            out_.method_arguments.finish_row();
            out_.method_subtasks.add_row(std::vector{static_cast<TaskId>(one - cases_.begin())});
            out_.method_positions.add_row(std::vector{0U});
            out_.method_ordering.finish_row();
        }
    }

    void emit_method(const MethodInstance& method) {
        begin_method(number(method.task), method.schema, false);
        out_.method_arguments.add_row(method.arguments);
        std::vector<std::uint32_t> place(method.subtasks.size(), kNone);  // by position in the lifted method
        std::uint32_t count = 0;
        for (std::uint32_t position = 0; position < method.subtasks.size(); ++position) {
            const TaskId subtask = number(method.subtasks[position]);
            if (subtask != kNone) {  // else an artificial action that is always applicable
                place[position] = count++;
                out_.method_subtasks.push(subtask);
                out_.method_positions.push(position);
            }
        }
        out_.method_subtasks.finish_row();
        out_.method_positions.finish_row();
        for (const auto& [earlier, later] : closed_ordering(method.schema)) {
            if (place[earlier] != kNone && place[later] != kNone) {
                out_.method_ordering.push({place[earlier], place[later]});
            }
        }
        out_.method_ordering.finish_row();
    }

    // The transitive closure of a lifted method's ordering, sorted.
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& closed_ordering(std::uint32_t schema) {
        closed_.resize(lifted_.methods.size());
        is_closed_.resize(lifted_.methods.size(), false);
        if (!is_closed_[schema]) {
            is_closed_[schema] = true;
            const std::size_t count = lifted_.methods[schema].subtasks.size();
            std::vector<std::vector<bool>> before(count, std::vector<bool>(count, false));
            for (const auto& [earlier, later] : lifted_.methods[schema].ordering) {
                before[earlier][later] = true;
            }
            for (std::size_t middle = 0; middle < count; ++middle) {
                for (std::size_t earlier = 0; earlier < count; ++earlier) {
                    for (std::size_t later = 0; before[earlier][middle] && later < count; ++later) {
                        before[earlier][later] = before[earlier][later] || before[middle][later];
                    }
                }
            }
            for (std::uint32_t earlier = 0; earlier < count; ++earlier) {
                for (std::uint32_t later = 0; later < count; ++later) {
                    if (before[earlier][later]) {
                        closed_[schema].emplace_back(earlier, later);
                    }
                }
            }
        }
        return closed_[schema];
    }

    TaskId number(const TaskInstance& instance) const { return task_number_[instance.task][instance.tuple]; }
    std::span<const ObjectId> arguments(const TaskInstance& instance) const {
        return reachability_.instances(instance.task)[instance.tuple];
    }

    const Reachability& reachability_;
    const LiftedProblem& lifted_;
    const CaseBuilder& facts_;
    std::vector<ActionCase> cases_;
    const Pruned& pruned_;
    std::vector<FactId> fact_number_;               // by fact of the case builder
    std::vector<std::vector<TaskId>> task_number_;  // by lifted task, by tuple
    std::vector<TaskInstance> compounds_;           // by compound task, choices last
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> closed_;
    std::vector<bool> is_closed_;
    GroundProblem out_;
};

}  // namespace

GroundProblem emit(const Reachability& reachability, const CaseBuilder& facts, std::vector<ActionCase> cases,
                   const Pruned& pruned) {
    return Emitter(reachability, facts, std::move(cases), pruned).run();
}

}  // namespace relax
