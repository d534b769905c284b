#ifndef RELAX_GROUNDING_JOIN_HPP
#define RELAX_GROUNDING_JOIN_HPP

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "facts.hpp"
#include "relax/base/limits.hpp"

namespace relax::grounding {

// Tuples of a relation that fit terms.
struct Pattern {
    RelationId relation;
    std::vector<Term> terms;
};

// All bindings of the head's slots for which each pattern has a tuple and each
// test is true.
struct Rule {
    std::uint32_t slot_count = 0;
    std::vector<const ObjectSet*> domains;  // by slot; null where the patterns restrict it enough
    std::vector<std::uint32_t> head;        // slots
    std::vector<Pattern> patterns;
    std::vector<Formula> tests;     // in normal form; their truth never changes
    std::optional<Pattern> result;  // what `emit` adds, if nothing else: then one
                                    // binding for each tuple is enough
};

// One step of a join: it binds slots or checks bound ones.
struct JoinStep {
    enum class Kind : std::uint8_t { Lookup, Member, Enumerate, Assign, Test, IsNew };
    Kind kind = Kind::Lookup;
    std::uint32_t pattern = 0;                                   // Lookup, Member
    IndexId index = 0;                                           // Lookup
    std::vector<Term> key;                                       // Lookup: at the index's positions; Member, IsNew: the
                                                                 // whole tuple; Assign: the value
    std::vector<std::pair<std::uint32_t, std::uint32_t>> binds;  // Lookup: position, slot
    std::vector<std::pair<std::uint32_t, Term>> same;            // Lookup: position, and the term that it must equal
    bool only_older = false;                                     // Lookup, Member: not the tuple that triggered the
                                                                 // join, which another pattern takes as its own
    std::uint32_t slot = 0;                                      // Enumerate, Assign
    std::uint32_t test = 0;                                      // Test
};

struct JoinPlan {
    std::uint32_t rule = 0;
    std::vector<JoinStep> steps;  // of a triggered plan the first is a Lookup whose tuple is given
};

// Order a rule's patterns greedily, cheapest first, each test as early as
// possible; `trigger` is the pattern that comes first.
JoinPlan plan_join(Knowledge& knowledge, const std::vector<bool>& grows, const Rule& rule, std::uint32_t number,
                   std::optional<std::uint32_t> trigger, Limits& limits);

// Gets the rule's number and a full binding; may add tuples to growing
// relations.
using Emit = std::function<void(std::uint32_t rule, Bindings& bindings)>;

// Carries out join plans, one at a time.
class Joiner {
public:
    Joiner(const Knowledge& knowledge, Limits& limits, Emit emit)
        : knowledge_(knowledge), limits_(limits), emit_(std::move(emit)) {}

    // `given`: the tuple for the first step of a triggered plan.
    void run(const Rule& rule, const JoinPlan& plan, std::optional<TupleId> given);

private:
    void join(std::size_t at);
    void lookup(const JoinStep& step, std::size_t next);
    void enumerate(const JoinStep& step, std::size_t next);
    std::optional<TupleId> find(RelationId relation, const JoinStep& step);
    bool fits(const JoinStep& step, std::span<const ObjectId> tuple);
    bool is_excluded(const JoinStep& step, TupleId tuple) const { return step.only_older && tuple == given_; }

    const Knowledge& knowledge_;
    Limits& limits_;
    Emit emit_;
    // The join under way.
    const JoinPlan* plan_ = nullptr;
    const Rule* rule_ = nullptr;
    std::optional<TupleId> given_;
    Bindings bindings_;
    std::vector<ObjectId> key_;
    bool is_done_ = false;  // the result is there: go back to where it was found new
};

// Semi-naive evaluation of rules: every new tuple triggers the joins that can
// use it, so that each binding is found once.
class JoinEngine {
public:
    // `grows`: by RelationId, whether `emit` may add tuples. The others are
    // complete.
    JoinEngine(Knowledge& knowledge, std::vector<bool> grows, Limits& limits, Emit emit);

    // Add all rules before the first run; they are numbered in order.
    void add_rule(Rule rule) { rules_.push_back(std::move(rule)); }
    // Go on until every tuple has been used.
    void run();

private:
    void plan();

    Knowledge& knowledge_;
    std::vector<bool> grows_;
    Limits& limits_;
    Joiner joiner_;
    std::vector<Rule> rules_;
    bool is_planned_ = false;
    std::vector<std::vector<JoinPlan>> triggered_;  // by relation
};

}  // namespace relax::grounding

#endif
