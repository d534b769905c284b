#include "assembly.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "composition.hpp"
#include "outcomes.hpp"
#include "relax/base/id_table.hpp"

namespace relax::grounding {

namespace {

// Precondition actions by their preconditions. They have no effects, so that of equal ones any will do.
class Tests {
public:
    // Returns the first action with these cases, which may be this one.
    NodeId find_or_add(NodeId node, const std::vector<RemainingCase>& cases) {
        std::vector<Conjunction> conditions;
        for (const RemainingCase& one : cases) {
            conditions.push_back(one.condition);
        }
        std::ranges::sort(conditions);
        std::vector<Literal> content;
        for (const Conjunction& condition : conditions) {
            content.insert(content.end(), condition.begin(), condition.end());
            content.push_back(kEnd);
        }
        const std::uint64_t hash = hash_values(content);
        if (const auto known =
                table_.find(hash, [&](std::uint32_t test) { return std::ranges::equal(contents_[test], content); })) {
            return nodes_[*known];
        }
        table_.add(hash, static_cast<std::uint32_t>(nodes_.size()));
        contents_.add_row(content);
        nodes_.push_back(node);
        return node;
    }

private:
    static constexpr Literal kEnd = static_cast<Literal>(-1);  // of a case

    Rows<Literal> contents_;
    std::vector<NodeId> nodes_;
    IdTable<> table_;
};

class Assembly {
public:
    explicit Assembly(const Remains& remains)
        : remains_(remains),
          is_written_(remains.graph.action_node_count, false),
          is_trivial_(remains.graph.action_node_count, false),
          stands_for_(remains.graph.is_node_alive.size()),
          task_of_node_(remains.graph.is_node_alive.size()) {
        std::iota(stands_for_.begin(), stands_for_.end(), 0U);
    }

    GroundProblem run() {
        find_cases();
        composition_.emplace(lifted(), remains_.graph, is_trivial_, stands_for_, remains_.options, remains_.limits);
        number_facts();
        write_actions();
        write_compounds();
        write_methods();
        write_choices();
        write_methods_by_task();
        problem_.initial_task = *task_of_node_[remains_.graph.initial];
        return std::move(problem_);
    }

private:
    struct Case {
        ActionId first_outcome;
        std::uint32_t outcome_count;
        TaskId task;  // the action, or a chance task
    };

    const LiftedProblem& lifted() const { return remains_.knowledge.problem; }

    template <typename Visit>
    void for_each_living_node(std::uint32_t task, Visit visit) {
        for (NodeId node = remains_.graph.task_begin[task]; node < remains_.graph.task_begin[task + 1]; ++node) {
            if (remains_.graph.is_node_alive[node]) {
                remains_.limits.stop_if_reached();
                visit(node);
            }
        }
    }

    std::span<const ObjectId> arguments_of(std::uint32_t task, NodeId node) const {
        return remains_.knowledge
            .relations[remains_.knowledge.task_relation(task)][node - remains_.graph.task_begin[task]];
    }

    // Decide which actions are written, and which precondition actions stand for equal ones. What remains of an action
    // is computed again when it is written, since all of it together takes several times the memory of what is written.
    void find_cases() {
        Tests tests;
        for (std::uint32_t action = 0; action < lifted().actions.size(); ++action) {
            for_each_living_node(action, [&](NodeId node) {
                is_written_[node] = true;
                if (lifted().actions[action].is_precondition) {
                    const std::vector<RemainingCase> cases = remaining_cases(remains_, node);
                    is_trivial_[node] = cases[0].condition.empty();
                    if (!is_trivial_[node] && remains_.options.merge_equal) {
                        stands_for_[node] = tests.find_or_add(node, cases);
                    }
                    is_written_[node] = !is_trivial_[node] && stands_for_[node] == node;
                }
            });
        }
    }

    void number_facts() {
        const std::vector<bool> is_read = read_facts(remains_, is_written_);
        number_of_fact_.resize(is_read.size());
        for (std::uint32_t predicate = 0; predicate < lifted().predicate_count; ++predicate) {
            for (std::uint32_t fact = remains_.fact_begin[predicate]; fact < remains_.fact_begin[predicate + 1];
                 ++fact) {
                if (is_read[fact]) {
                    const auto number = static_cast<FactId>(problem_.fact_count());
                    number_of_fact_[fact] = number;
                    problem_.fact_predicate.push_back(predicate);
                    problem_.fact_arguments.add_row(
                        remains_.knowledge.relations[predicate][fact - remains_.fact_begin[predicate]]);
                    if (remains_.is_initially_true[fact]) {
                        problem_.initial_state.push_back(number);
                    }
                }
            }
        }
    }

    // An action node with several cases becomes a choice, and a case with several outcomes a chance task; they are
    // numbered after the compound tasks.
    void write_actions() {
        for (std::uint32_t action = 0; action < lifted().actions.size(); ++action) {
            for_each_living_node(action, [&](NodeId node) {
                if (!is_written_[node]) {
                    return;
                }
                std::vector<Case> cases;
                for (RemainingCase& one : remaining_cases(remains_, node)) {
                    cases.push_back(write_case(action, node, one));
                }
                if (cases.size() > 1 || cases[0].outcome_count > 1) {
                    choices_.push_back({action, node, std::move(cases)});
                } else {
                    task_of_node_[node] = cases[0].task;
                }
            });
        }
    }

    Case write_case(std::uint32_t action, NodeId node, RemainingCase& one) {
        const auto outcomes = outcomes_of(remains_, lifted().actions[action], one, number_of_fact_);
        if (!outcomes) {
            throw TooManyCases{action, node - remains_.graph.task_begin[action], true};
        }
        const auto first = static_cast<ActionId>(problem_.action_count());
        for (const RemainingOutcome& outcome : *outcomes) {
            write_action(one.condition, outcome, number_of_fact_, problem_);
            problem_.action_schema.push_back(action);
            problem_.action_arguments.add_row(arguments_of(action, node));
        }
        return {first, static_cast<std::uint32_t>(outcomes->size()), task_of(first)};
    }

    void write_compounds() {
        const auto add = [&](std::uint32_t task, NodeId node, bool is_chance = false) {
            const auto number = static_cast<TaskId>(problem_.task_count());
            problem_.compound_schema.push_back(task);
            problem_.compound_is_chance.push_back(is_chance);
            problem_.compound_arguments.add_row(arguments_of(task, node));
            return number;
        };
        for (auto task = static_cast<std::uint32_t>(lifted().actions.size()); task < remains_.knowledge.task_count();
             ++task) {
            for_each_living_node(task, [&](NodeId node) {
                if (composition_->is_kept(node)) {
                    task_of_node_[node] = add(task, node);
                }
            });
        }
        for (Choice& choice : choices_) {
            if (choice.cases.size() > 1) {
                task_of_node_[choice.node] = add(choice.action, choice.node);
            }
            for (Case& one : choice.cases) {
                if (one.outcome_count > 1) {
                    one.task = add(choice.action, choice.node, true);
                }
            }
            if (choice.cases.size() == 1) {
                task_of_node_[choice.node] = choice.cases[0].task;
            }
        }
    }

    void write_methods() {
        const TaskGraph& graph = remains_.graph;
        for (MethodInstanceId method = 0; method < graph.method_task.size(); ++method) {
            if (graph.is_method_alive[method] && composition_->is_kept(graph.method_task[method])) {
                remains_.limits.stop_if_reached();
                problem_.method_task.push_back(*task_of_node_[graph.method_task[method]]);
                write_network(composition_->compose(method));
            }
        }
    }

    void write_network(const ComposedNetwork& network) {
        for (const ComposedNetwork::Part& part : network.parts) {
            problem_.part_schema.push_back(remains_.graph.method_schema[part.method]);
            problem_.part_arguments.add_row(remains_.graph.method_arguments[part.method]);
            problem_.part_origin.emplace_back(part.parent, part.position);
        }
        problem_.method_parts.share_out(problem_.part_schema.size());
        for (const ComposedNetwork::Subtask& subtask : network.subtasks) {
            problem_.method_subtasks.push(*task_of_node_[subtask.node]);
            problem_.method_positions.push({subtask.part, subtask.position});
        }
        problem_.method_subtasks.finish_row();
        problem_.method_positions.finish_row();
        problem_.method_ordering.add_row(network.ordering);
    }

    // The agent chooses the case, and nature the outcome.
    void write_choices() {
        const auto add_method = [&](TaskId task, TaskId subtask) {
            problem_.method_task.push_back(task);
            problem_.method_parts.share_out(problem_.part_schema.size());
            problem_.method_subtasks.push(subtask);
            problem_.method_subtasks.finish_row();
            problem_.method_positions.push({0, 0});
            problem_.method_positions.finish_row();
            problem_.method_ordering.finish_row();
        };
        for (const Choice& choice : choices_) {
            for (const Case& one : choice.cases) {
                if (choice.cases.size() > 1) {
                    add_method(*task_of_node_[choice.node], one.task);
                }
                for (std::uint32_t outcome = 0; one.outcome_count > 1 && outcome < one.outcome_count; ++outcome) {
                    add_method(one.task, TaskId(one.first_outcome + outcome));
                }
            }
        }
    }

    void write_methods_by_task() {
        std::vector<std::vector<MethodId>> methods_of(problem_.compound_count());
        for (const MethodId method : problem_.methods()) {
            methods_of[problem_.method_task[method] - problem_.action_count()].push_back(method);
        }
        for (const std::vector<MethodId>& methods : methods_of) {
            problem_.compound_methods.add_row(methods);
        }
    }

    // An action node with several cases or outcomes.
    struct Choice {
        std::uint32_t action;
        NodeId node;
        std::vector<Case> cases;
    };

    const Remains& remains_;
    std::vector<bool> is_written_;    // by action node
    std::vector<bool> is_trivial_;    // by action node: a precondition action without a condition
    std::vector<NodeId> stands_for_;  // by node: itself, or an equal one
    std::optional<Composition> composition_;
    std::vector<std::optional<FactId>> number_of_fact_;  // by fact
    std::vector<std::optional<TaskId>> task_of_node_;
    std::vector<Choice> choices_;
    GroundProblem problem_;
};

}  // namespace

GroundProblem assemble(const Remains& remains) { return Assembly(remains).run(); }

}  // namespace relax::grounding
