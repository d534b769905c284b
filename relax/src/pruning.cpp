#include "pruning.hpp"

#include <algorithm>

namespace relax {

namespace {

class Pruner {
public:
    Pruner(const Reachability& reachability, const CaseBuilder& facts, const std::vector<ActionCase>& cases)
        : reachability_(reachability),
          facts_(facts),
          cases_(cases),
          action_count_(reachability.problem().actions.size()) {
        pruned_.case_lives.assign(cases.size(), true);
        pruned_.method_lives.assign(reachability.methods().size(), true);
        TupleId offset = 0;
        for (std::uint32_t task = 0; task < action_count_ + reachability.problem().tasks.size(); ++task) {
            offsets_.push_back(offset);
            offset += static_cast<TupleId>(reachability.instances(task).size());
        }
        instance_count_ = offset;
    }

    Pruned run() {
        bool changed = true;
        while (changed) {
            changed = drop_unreachable_cases();
            changed = keep_finite_and_needed() || changed;
        }
        return std::move(pruned_);
    }

private:
    std::size_t number(const TaskInstance& instance) const { return offsets_[instance.task] + instance.tuple; }

    // Relaxed reachability over literals of both signs: a case's effects happen once its precondition and their
    // condition can.
    bool drop_unreachable_cases() {
        auto& can_hold = pruned_.can_hold;
        can_hold.assign(2 * facts_.fact_count(), false);
        std::vector<std::vector<std::uint32_t>> waiting(can_hold.size());      // by Literal: nodes that need it
        std::vector<std::uint32_t> missing;                                    // by node: literals not yet reached
        std::vector<std::pair<std::size_t, const ActionCase::Effect*>> nodes;  // a case, or one of its effects
        std::vector<std::uint32_t> ready;
        std::vector<Literal> queue;
        std::vector<bool> reached(cases_.size(), false);

        const auto reach = [&](Literal literal) {
            if (!can_hold[literal]) {
                can_hold[literal] = true;
                queue.push_back(literal);
            }
        };
        const auto add_node = [&](std::size_t index, const ActionCase::Effect* effect) {
            const auto node = static_cast<std::uint32_t>(nodes.size());
            nodes.emplace_back(index, effect);
            missing.push_back(0);
            const auto need_all = [&](const Cube& cube) {
                for (const Literal literal : cube) {
                    waiting[literal].push_back(node);
                    ++missing[node];
                }
            };
            need_all(cases_[index].precondition);
            if (effect != nullptr) {
                need_all(effect->condition);
            }
            if (missing[node] == 0) {
                ready.push_back(node);
            }
        };
        for (std::size_t index = 0; index < cases_.size(); ++index) {
            if (pruned_.case_lives[index]) {
                add_node(index, nullptr);
                for (const ActionCase::Effect& effect : cases_[index].effects) {
                    add_node(index, &effect);
                }
            }
        }
        for (FactId fact = 0; fact < facts_.fact_count(); ++fact) {
            reach(literal(fact, !facts_.is_initial(fact)));
        }
        while (!queue.empty() || !ready.empty()) {
            if (!ready.empty()) {
                const auto [index, effect] = nodes[ready.back()];
                ready.pop_back();
                reached[index] = true;
                if (effect != nullptr) {
                    for (const FactId fact : effect->adds) {
                        reach(literal(fact, false));
                    }
                    for (const FactId fact : effect->deletes) {
                        reach(literal(fact, true));
                    }
                }
                continue;
            }
            const Literal next = queue.back();
            queue.pop_back();
            for (const std::uint32_t node : waiting[next]) {
                if (--missing[node] == 0) {
                    ready.push_back(node);
                }
            }
        }
        bool changed = false;
        for (std::size_t index = 0; index < cases_.size(); ++index) {
            if (pruned_.case_lives[index] && !reached[index]) {
                pruned_.case_lives[index] = false;
                changed = true;
            }
        }
        return changed;
    }

    // Keep methods whose subtasks all have finite decompositions, and of these what the initial task leads to.
    bool keep_finite_and_needed() {
        const auto& methods = reachability_.methods();
        std::vector<bool> finite(instance_count_, false);
        std::vector<std::vector<std::size_t>> waiting(
            instance_count_);  // by instance: methods, once for each occurrence
        std::vector<std::size_t> missing(methods.size(), 0);
        std::vector<std::size_t> queue;
        const auto finish = [&](std::size_t instance) {
            if (!finite[instance]) {
                finite[instance] = true;
                queue.push_back(instance);
            }
        };
        for (std::size_t method = 0; method < methods.size(); ++method) {
            if (!pruned_.method_lives[method]) {
                continue;
            }
            for (const TaskInstance& subtask : methods[method].subtasks) {
                waiting[number(subtask)].push_back(method);
                ++missing[method];
            }
            if (missing[method] == 0) {
                finish(number(methods[method].task));
            }
        }
        for (std::size_t index = 0; index < cases_.size(); ++index) {
            if (pruned_.case_lives[index]) {
                finish(number(cases_[index].instance));
            }
        }
        while (!queue.empty()) {
            const std::size_t instance = queue.back();
            queue.pop_back();
            for (const std::size_t method : waiting[instance]) {
                if (--missing[method] == 0) {
                    finish(number(methods[method].task));
                }
            }
        }
        return keep_needed(missing, finite);
    }

    bool keep_needed(const std::vector<std::size_t>& missing, const std::vector<bool>& finite) {
        const auto& methods = reachability_.methods();
        const TaskInstance initial{reachability_.problem().initial_task, 0};
        pruned_.solvable = !reachability_.needed().empty() && finite[number(initial)];
        std::vector<bool> needed(instance_count_, false);
        if (pruned_.solvable) {
            std::vector<std::vector<std::size_t>> methods_of(instance_count_);
            for (std::size_t method = 0; method < methods.size(); ++method) {
                if (pruned_.method_lives[method] && missing[method] == 0) {
                    methods_of[number(methods[method].task)].push_back(method);
                }
            }
            std::vector<std::size_t> pending{number(initial)};
            needed[pending.front()] = true;
            while (!pending.empty()) {
                const std::size_t instance = pending.back();
                pending.pop_back();
                for (const std::size_t method : methods_of[instance]) {
                    for (const TaskInstance& subtask : methods[method].subtasks) {
                        if (!needed[number(subtask)]) {
                            needed[number(subtask)] = true;
                            pending.push_back(number(subtask));
                        }
                    }
                }
            }
        }
        bool changed = false;
        const auto keep = [&changed](std::vector<bool>& lives, std::size_t index, bool keeps) {
            changed = changed || (lives[index] && !keeps);
            lives[index] = lives[index] && keeps;
        };
        for (std::size_t method = 0; method < methods.size(); ++method) {
            keep(pruned_.method_lives, method, missing[method] == 0 && needed[number(methods[method].task)]);
        }
        for (std::size_t index = 0; index < cases_.size(); ++index) {
            keep(pruned_.case_lives, index, needed[number(cases_[index].instance)]);
        }
        return changed;
    }

    const Reachability& reachability_;
    const CaseBuilder& facts_;
    const std::vector<ActionCase>& cases_;
    std::size_t action_count_;
    std::vector<TupleId> offsets_;  // by task
    std::size_t instance_count_ = 0;
    Pruned pruned_;
};

}  // namespace

Pruned prune(const Reachability& reachability, const CaseBuilder& facts, const std::vector<ActionCase>& cases) {
    return Pruner(reachability, facts, cases).run();
}

}  // namespace relax
