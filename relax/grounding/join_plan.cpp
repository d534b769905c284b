#include <algorithm>
#include <limits>

#include "formulas.hpp"
#include "join.hpp"

namespace relax::grounding {

namespace {

class Planner {
public:
    Planner(Knowledge& knowledge, const std::vector<bool>& grows, const Rule& rule,
            std::optional<std::uint32_t> trigger, Limits& limits)
        : knowledge_(knowledge),
          grows_(grows),
          rule_(rule),
          trigger_(trigger),
          limits_(limits),
          bound_(rule.slot_count, false),
          pattern_done_(rule.patterns.size(), false),
          test_done_(rule.tests.size(), false) {}

    JoinPlan plan() {
        if (trigger_) {
            add_lookup(*trigger_);
        }
        decide_tests();
        while (const auto cheapest = cheapest_pattern()) {
            add_lookup(*cheapest);
            decide_tests();
        }
        while (const auto slot = smallest_unbound_slot()) {
            JoinStep step;
            step.kind = JoinStep::Kind::Enumerate;
            step.slot = *slot;
            plan_.steps.push_back(std::move(step));
            bound_[*slot] = true;
            decide_tests();
        }
        return std::move(plan_);
    }

private:
    bool is_bound(Term term) const { return term < 0 || bound_[static_cast<std::size_t>(term)]; }

    std::optional<std::uint32_t> cheapest_pattern() {
        std::optional<std::uint32_t> cheapest;
        double least = std::numeric_limits<double>::infinity();
        for (std::uint32_t pattern = 0; pattern < rule_.patterns.size(); ++pattern) {
            limits_.stop_if_reached();
            if (!pattern_done_[pattern]) {
                const double estimate = estimated_matches(rule_.patterns[pattern]);
                if (!cheapest || estimate < least) {
                    least = estimate;
                    cheapest = pattern;
                }
            }
        }
        return cheapest;
    }

    // How many tuples fit what is bound: from column statistics where the
    // relation is complete, otherwise from domains.
    double estimated_matches(const Pattern& pattern) {
        constexpr double kDensity = 0.5;  // of relations that are yet to grow
        constexpr double kUnknownDomain = 100.0;
        double complete = static_cast<double>(knowledge_.relations[pattern.relation].size());
        double growing = kDensity;
        for (std::uint32_t position = 0; position < pattern.terms.size(); ++position) {
            const Term term = pattern.terms[position];
            if (!is_bound(term)) {
                const ObjectSet* domain = rule_.domains[static_cast<std::size_t>(term)];
                growing *= domain == nullptr ? kUnknownDomain : static_cast<double>(domain->size());
            } else if (!grows_[pattern.relation] && complete > 0) {
                complete /= static_cast<double>(knowledge_.relations[pattern.relation].distinct_values(position));
            }
        }
        return grows_[pattern.relation] ? growing : complete;
    }

    void add_lookup(std::uint32_t number) {
        const Pattern& pattern = rule_.patterns[number];
        const bool is_trigger = trigger_ == number;
        JoinStep step;
        step.pattern = number;
        step.only_older = trigger_ && number < *trigger_ && pattern.relation == rule_.patterns[*trigger_].relation;
        pattern_done_[number] = true;
        if (!is_trigger && std::ranges::all_of(pattern.terms, [&](Term term) { return is_bound(term); })) {
            step.kind = JoinStep::Kind::Member;
            step.key = pattern.terms;
            plan_.steps.push_back(std::move(step));
            return;
        }
        std::vector<std::uint32_t> positions;
        std::vector<std::uint32_t> slots;  // bound by this step
        for (std::uint32_t position = 0; position < pattern.terms.size(); ++position) {
            const Term term = pattern.terms[position];
            if (is_bound(term) && !is_trigger) {
                positions.push_back(position);
                step.key.push_back(term);
            } else if (term < 0 || std::ranges::count(slots, static_cast<std::uint32_t>(term)) > 0) {
                step.same.emplace_back(position, term);
            } else {
                slots.push_back(static_cast<std::uint32_t>(term));
                step.binds.emplace_back(position, slots.back());
            }
        }
        for (const std::uint32_t slot : slots) {
            bound_[slot] = true;
        }
        if (!is_trigger) {
            step.index = knowledge_.relations[pattern.relation].index_on(positions, limits_);
        }
        plan_.steps.push_back(std::move(step));
    }

    // Stop as early as possible where the result is already known.
    void check_result() {
        if (!is_result_checked_ && rule_.result &&
            std::ranges::all_of(rule_.result->terms, [&](Term term) { return is_bound(term); })) {
            is_result_checked_ = true;
            JoinStep step;
            step.kind = JoinStep::Kind::IsNew;
            step.key = rule_.result->terms;
            plan_.steps.push_back(std::move(step));
        }
    }

    // Add every test whose variables are bound; an equality with one side bound
    // binds the other.
    void decide_tests() {
        check_result();
        for (bool changed = true; changed;) {
            changed = false;
            for (std::uint32_t number = 0; number < rule_.tests.size(); ++number) {
                if (!test_done_[number] && (add_test(number) || add_assignment(number))) {
                    check_result();
                    changed = true;
                }
            }
        }
    }

    bool add_test(std::uint32_t number) {
        std::vector<std::uint32_t> slots;
        free_slots(rule_.tests[number], slots);
        if (!std::ranges::all_of(slots, [&](std::uint32_t slot) { return bound_[slot]; })) {
            return false;
        }
        JoinStep step;
        step.kind = JoinStep::Kind::Test;
        step.test = number;
        plan_.steps.push_back(std::move(step));
        test_done_[number] = true;
        return true;
    }

    bool add_assignment(std::uint32_t number) {
        const Formula& test = rule_.tests[number];
        if (test.kind != FormulaKind::Equals || is_bound(test.terms[0]) == is_bound(test.terms[1])) {
            return false;
        }
        const bool first_is_bound = is_bound(test.terms[0]);
        JoinStep step;
        step.kind = JoinStep::Kind::Assign;
        step.slot = static_cast<std::uint32_t>(test.terms[first_is_bound ? 1 : 0]);
        step.key.push_back(test.terms[first_is_bound ? 0 : 1]);
        bound_[step.slot] = true;
        plan_.steps.push_back(std::move(step));
        test_done_[number] = true;
        return true;
    }

    std::optional<std::uint32_t> smallest_unbound_slot() const {
        std::optional<std::uint32_t> smallest;
        for (const std::uint32_t slot : rule_.head) {
            if (!bound_[slot] && (!smallest || rule_.domains[slot]->size() < rule_.domains[*smallest]->size())) {
                smallest = slot;
            }
        }
        return smallest;
    }

    Knowledge& knowledge_;
    const std::vector<bool>& grows_;
    const Rule& rule_;
    std::optional<std::uint32_t> trigger_;
    Limits& limits_;
    std::vector<bool> bound_;  // by slot
    std::vector<bool> pattern_done_;
    std::vector<bool> test_done_;
    bool is_result_checked_ = false;
    JoinPlan plan_;
};

}  // namespace

JoinPlan plan_join(Knowledge& knowledge, const std::vector<bool>& grows, const Rule& rule, std::uint32_t number,
                   std::optional<std::uint32_t> trigger, Limits& limits) {
    JoinPlan plan = Planner(knowledge, grows, rule, trigger, limits).plan();
    plan.rule = number;
    return plan;
}

}  // namespace relax::grounding
