#include "relax/search/portfolio.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "relax/base/cost.hpp"
#include "relax/search/find_plans.hpp"
#include "relax/search/greedy_search.hpp"

namespace relax {

namespace {

constexpr std::uint64_t kFirstTurn = 1'000'000;  // of work
constexpr std::uint64_t kLaggardsShare = 8;      // one part in so many
constexpr std::uint64_t kPreparation = 100;      // of a relaxed model, for each action and method
constexpr std::uint64_t kHeadStart = 8'000'000;  // of a greedy search
constexpr std::uint64_t kNoEnd = std::numeric_limits<std::uint64_t>::max();

// How many models it takes to begin with these options.
std::uint64_t models_of(const StepwiseOptions& options) {
    if (const auto* const greedy = std::get_if<GreedyOptions>(&options)) {
        return greedy->heuristic->has_model ? 1 : 0;
    }
    const auto& heuristics = std::get<FindPlansOptions>(options).heuristics;
    return static_cast<std::uint64_t>(std::ranges::count_if(heuristics, &HeuristicInfo::has_model));
}

std::unique_ptr<StepwiseSearch> make_search(const PricedProblem& priced, const FindPlansOptions& options,
                                            Limits& limits, SearchStatistics& statistics) {
    return std::make_unique<FindPlans>(priced, options, limits, statistics);
}

std::unique_ptr<StepwiseSearch> make_search(const PricedProblem& priced, const GreedyOptions& options, Limits& limits,
                                            SearchStatistics& statistics) {
    return std::make_unique<GreedySearch>(priced, options, limits, statistics);
}

}  // namespace

Portfolio::Portfolio(const PricedProblem& priced, const PortfolioOptions& options, Limits& limits,
                     SearchStatistics& statistics)
    : priced_(priced),
      limits_(limits),
      statistics_(statistics),
      poll_(std::move(limits.poll)),
      upper_bound_(options.upper_bound) {
    const std::uint64_t model = kPreparation * (priced.problem.action_count() + priced.problem.method_count());
    for (const std::vector<StepwiseOptions>& stages : options.members) {
        members_.push_back({stages, models_of(stages.front()) * model, {}, nullptr});
    }
    for (Member& member : members_) {
        greedy_ = member.is_greedy() ? &member : greedy_;
    }
    // Whoever watches sees all searches together.
    limits_.poll = [this] {
        add_up();
        return poll_ && poll_();
    };
}

Portfolio::~Portfolio() { limits_.poll = std::move(poll_); }

SearchResult Portfolio::run() {
    bool is_done = find_plan();
    for (std::uint64_t work = kFirstTurn; !is_done; work *= 2) {
        for (Member& member : members_) {
            if (&member == greedy_ || work < member.preparation) {
                continue;
            }
            is_done = take_turn(member, member.preparation + (lags(member, work) ? work / kLaggardsShare : work)) ||
                      (greedy_ != nullptr && statistics_.best) || find_plan();
            if (is_done) {
                break;
            }
        }
    }
    return gather();
}

// Let the greedy search, if there is one, do as much work as all others have done, or end once it has a plan. Returns
// whether the portfolio ends with that.
bool Portfolio::find_plan() {
    if (greedy_ == nullptr) {
        return false;
    }
    std::uint64_t others = 0;
    for (const Member& member : members_) {
        others += &member == greedy_ ? 0 : member.work();
    }
    return take_turn(*greedy_, std::max(kHeadStart, others)) ||
           (greedy_->search && greedy_->search->best() && take_turn(*greedy_, kNoEnd));
}

// Let the member search until it has done so much work in all. Returns whether the portfolio ends with that.
bool Portfolio::take_turn(Member& member, std::uint64_t work) {
    while (member.work() < work && !member.has_given_up) {
        if (!member.search && !begin_stage(member)) {
            return true;
        }
        const bool is_done = member.search->advance(work - std::min(work, member.done + member.preparation));
        share_bounds();
        if (!is_done) {
            break;
        }
        ended_ = &member;
        const bool gave_up = !member.search->best() && member.search->result().status == SearchStatus::GaveUp;
        if (!gave_up) {
            return true;
        }
        member.has_given_up = member.statistics.size() == member.stages.size();
        if (member.has_given_up && &member != greedy_) {
            return true;
        }
        member.done = member.work();
        member.search.reset();
    }
    const bool is_proven = statistics_.best && statistics_.lower_bound >= statistics_.best;
    ended_ = is_proven ? &member : ended_;
    return is_proven;
}

// Prepare the member's next stage. False: a limit was reached.
bool Portfolio::begin_stage(Member& member) {
    StepwiseOptions stage = member.stages[member.statistics.size()];
    SearchStatistics& statistics = member.statistics.emplace_back();
    stop_ = run_within_limits([&]() -> std::optional<StopReason> {
        member.search = std::visit(
            [&](auto& options) {
                options.upper_bound = upper_bound_;
                return make_search(priced_, options, limits_, statistics);
            },
            stage);
        return std::nullopt;
    });
    share_bounds();
    return !stop_;
}

// Another member has proven more, with no more work.
bool Portfolio::lags(const Member& member, std::uint64_t work) const {
    return std::ranges::any_of(members_, [&](const Member& other) {
        return &other != greedy_ && member.search && other.search &&
               other.search->lower_bound() > member.search->lower_bound() &&
               other.search->work() <= std::max(work, member.search->work());
    });
}

void Portfolio::add_up() {
    statistics_.expanded = statistics_.generated = statistics_.evaluated = 0;
    statistics_.dead_ends = statistics_.cuts = 0;
    for (const Member& member : members_) {
        for (const SearchStatistics& own : member.statistics) {
            statistics_.expanded += own.expanded;
            statistics_.generated += own.generated;
            statistics_.evaluated += own.evaluated;
            statistics_.dead_ends += own.dead_ends;
            statistics_.cuts += own.cuts;
            if (own.lower_bound) {
                statistics_.lower_bound = std::max(statistics_.lower_bound.value_or(0), *own.lower_bound);
            }
            if (own.best && (!statistics_.best || *own.best < *statistics_.best)) {
                statistics_.best = own.best;
            }
        }
    }
}

// A plan that one has found is the upper bound of the others.
void Portfolio::share_bounds() {
    add_up();
    if (statistics_.best) {
        for (const Member& member : members_) {
            if (member.search && member.search->best() != statistics_.best) {
                member.search->set_upper_bound(*statistics_.best);
            }
        }
    }
}

// Put together what is known at the end: the result of the member that has ended all, with the best plan and the best
// bound of all.
SearchResult Portfolio::gather() {
    SearchResult result;
    Cost bound = 0;
    if (ended_ != nullptr && ended_->search) {
        result = ended_->search->result();
        bound = result.statistics.lower_bound.value_or(result.status == SearchStatus::Unsolvable ? kInfinity : 0);
    } else {
        result.status = SearchStatus::GaveUp;
    }
    std::optional<StopReason> stop = result.stop ? result.stop : stop_;
    for (Member& member : members_) {
        if (!member.search || &member == ended_) {
            continue;
        }
        bound = std::max(bound, member.search->lower_bound());
        if (member.search->best() && (!result.cost || *member.search->best() < *result.cost)) {
            result = member.search->result();
            stop = stop ? stop : result.stop;
        }
    }
    add_up();
    result.stop = stop;
    if (result.cost) {
        statistics_.best = result.cost;
    } else if (statistics_.best) {
        bound = std::min(bound, *statistics_.best);  // there is a plan, though there was no time to trace it
    }
    if (result.cost) {
        statistics_.lower_bound = std::min(bound, *result.cost);
        result.status = bound >= *result.cost ? SearchStatus::Optimal : SearchStatus::Solved;
    } else if (result.status != SearchStatus::Unsolvable) {
        statistics_.lower_bound = bound;
        result.status = stop ? status_of(*stop) : result.status;
    } else {
        statistics_.lower_bound.reset();
    }
    result.statistics = statistics_;
    return result;
}

}  // namespace relax
