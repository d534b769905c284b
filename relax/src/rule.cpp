#include "rule.hpp"

#include <algorithm>
#include <cmath>

namespace relax {

Domains::Domains(const LiftedProblem& problem) : lists_(problem.domains) {
    for (const auto& list : lists_) {
        std::vector<bool> members(problem.object_count, false);
        for (const ObjectId object : list) {
            members[object] = true;
        }
        members_.push_back(std::move(members));
    }
}

JoinPlan::JoinPlan(const Rule& rule, std::vector<bool> bound, std::optional<std::size_t> done,
                   std::vector<Relation>& relations, const Domains& domains)
    : rule_(rule), relations_(relations), domains_(domains), filter_used_(rule.filters.size(), false) {
    std::vector<bool> used(rule.body.size(), false);
    if (done) {
        used[*done] = true;
    }
    first_filters_ = ready_filters(bound);
    for (auto left = std::count(used.begin(), used.end(), false); left > 0; --left) {
        const std::size_t next = choose_next(bound, used);
        used[next] = true;
        add_step(next, bound);
    }
    for (std::uint32_t slot = 0; slot < rule.parameters.size(); ++slot) {
        if (!bound[slot]) {
            bound[slot] = true;
            free_.push_back({slot, ready_filters(bound)});
        }
    }
}

// The atom with the fewest expected matches: each bound position is taken to divide the relation evenly.
std::size_t JoinPlan::choose_next(const std::vector<bool>& bound, const std::vector<bool>& used) const {
    std::optional<std::size_t> best;
    double fewest = 0;
    for (std::size_t atom = 0; atom < rule_.body.size(); ++atom) {
        if (used[atom]) {
            continue;
        }
        const auto& terms = rule_.body[atom].terms;
        const auto fixed = std::count_if(terms.begin(), terms.end(),
                                         [&](Term term) { return term < 0 || bound[static_cast<std::size_t>(term)]; });
        const double size = std::max<double>(2, static_cast<double>(relations_[rule_.body[atom].relation].size()));
        const double open = terms.empty() ? 0 : 1 - static_cast<double>(fixed) / static_cast<double>(terms.size());
        const double expected = std::pow(size, open);
        if (!best || expected < fewest) {
            best = atom;
            fewest = expected;
        }
    }
    return *best;
}

void JoinPlan::add_step(std::size_t atom, std::vector<bool>& bound) {
    Step step;
    step.relation = rule_.body[atom].relation;
    const auto& terms = rule_.body[atom].terms;
    std::vector<std::uint32_t> positions;
    const std::vector<bool> before = bound;
    for (std::uint32_t position = 0; position < terms.size(); ++position) {
        const Term term = terms[position];
        const auto slot = static_cast<std::uint32_t>(term);
        if (term < 0 || before[slot]) {
            positions.push_back(position);
            step.key.push_back(term);
        } else if (bound[slot]) {
            step.repeats.emplace_back(position, slot);
        } else {
            bound[slot] = true;
            step.binds.emplace_back(position, slot);
        }
    }
    step.index = relations_[step.relation].index_on(positions);
    step.filters = ready_filters(bound);
    steps_.push_back(std::move(step));
}

std::vector<std::size_t> JoinPlan::ready_filters(const std::vector<bool>& bound) {
    std::vector<std::size_t> ready;
    for (std::size_t filter = 0; filter < rule_.filters.size(); ++filter) {
        const auto& slots = rule_.filters[filter].slots;
        if (!filter_used_[filter] &&
            std::all_of(slots.begin(), slots.end(), [&](std::uint32_t slot) { return bound[slot]; })) {
            filter_used_[filter] = true;
            ready.push_back(filter);
        }
    }
    return ready;
}

bool JoinPlan::run(Binding& binding, const Visitor& visit) const {
    return !pass(first_filters_, binding) || run_step(0, binding, visit);
}

bool JoinPlan::pass(const std::vector<std::size_t>& filters, const Binding& binding) const {
    return std::all_of(filters.begin(), filters.end(),
                       [&](std::size_t filter) { return rule_.filters[filter].holds(binding); });
}

bool JoinPlan::run_step(std::size_t number, Binding& binding, const Visitor& visit) const {
    if (number == steps_.size()) {
        return run_free(0, binding, visit);
    }
    const Step& step = steps_[number];
    std::vector<ObjectId> key;
    key.reserve(step.key.size());
    for (const Term term : step.key) {
        key.push_back(value_of(term, binding));
    }
    bool go_on = true;
    relations_[step.relation].for_each_match(step.index, key, [&](TupleId id) {
        if (!go_on) {
            return;
        }
        const auto tuple = relations_[step.relation][id];
        bool fits = true;
        for (const auto& [position, slot] : step.binds) {
            binding[slot] = tuple[position];
            fits = fits && domains_.contains(rule_.parameters[slot], tuple[position]);
        }
        for (const auto& [position, slot] : step.repeats) {
            fits = fits && binding[slot] == tuple[position];
        }
        if (fits && pass(step.filters, binding)) {
            go_on = run_step(number + 1, binding, visit);
        }
    });
    for (const auto& [position, slot] : step.binds) {
        binding[slot] = kUnbound;
    }
    return go_on;
}

bool JoinPlan::run_free(std::size_t index, Binding& binding, const Visitor& visit) const {
    if (index == free_.size()) {
        return visit(binding);
    }
    const Free& free = free_[index];
    for (const ObjectId object : domains_.objects(rule_.parameters[free.slot])) {
        binding[free.slot] = object;
        if (pass(free.filters, binding) && !run_free(index + 1, binding, visit)) {
            binding[free.slot] = kUnbound;
            return false;
        }
    }
    binding[free.slot] = kUnbound;
    return true;
}

bool unify(std::span<const Term> terms, std::span<const ObjectId> tuple, const Rule& rule, const Domains& domains,
           Binding& binding) {
    for (std::size_t position = 0; position < terms.size(); ++position) {
        const ObjectId object = tuple[position];
        if (terms[position] < 0) {
            if (value_of(terms[position], binding) != object) {
                return false;
            }
            continue;
        }
        const auto slot = static_cast<std::size_t>(terms[position]);
        if (binding[slot] == kUnbound) {
            if (!domains.contains(rule.parameters[slot], object)) {
                return false;
            }
            binding[slot] = object;
        } else if (binding[slot] != object) {
            return false;
        }
    }
    return true;
}

}  // namespace relax
