#include "relax/portfolio.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "relax/tdg_bound.hpp"

namespace relax {

namespace {

constexpr std::uint64_t kFirstTurn = 1'000'000;  // of work
constexpr std::uint64_t kLaggardsShare = 8;      // one part in so many
constexpr std::uint64_t kPreparation = 100;      // of a relaxed model, for each action and method

}  // namespace

Portfolio::Portfolio(const GroundProblem& problem, Prices prices, const SearchOptions& options, Limits& limits,
                     SearchStatistics& statistics)
    : problem_(problem), prices_(std::move(prices)), options_(options), limits_(limits), statistics_(statistics) {
    members_.push_back({HeuristicKind::Tdg, {}, {}, nullptr});
    members_.push_back({HeuristicKind::LmCut, {}, {}, nullptr});
    members_.push_back({HeuristicKind::PotentialHMax, {HeuristicKind::Potential, HeuristicKind::LmCut}, {}, nullptr});
}

SearchResult Portfolio::run() {
    // Whoever watches sees all searches together.
    limits_.poll = [this, poll = std::move(limits_.poll)] {
        add_up();
        return poll && poll();
    };
    const std::uint64_t preparation = kPreparation * (problem_.action_count() + problem_.method_count());
    for (std::uint64_t work = kFirstTurn;; work *= 2) {
        for (Member& member : members_) {
            if (member.heuristic != HeuristicKind::Tdg && work < preparation) {
                continue;
            }
            if (take_turn(member, lags(member, work) ? work / kLaggardsShare : work)) {
                return gather(member);
            }
        }
    }
}

// Let the member search until it has done so much in all. Returns whether that is the end of all.
bool Portfolio::take_turn(Member& member, std::uint64_t work) {
    if (!member.search) {
        SearchOptions options = options_;
        options.algorithm = SearchAlgorithm::AStar;
        options.heuristic = member.heuristic;
        options.more_heuristics = member.more_heuristics;
        try {
            member.search = std::make_unique<FindPlans>(problem_, prices_, options, limits_, member.statistics);
        } catch (const Stopped& stopped) {
            stop_ = stopped.reason;
        } catch (const std::bad_alloc&) {
            stop_ = StopReason::MemoryLimit;
        }
        if (stop_) {
            return true;
        }
        share_bounds();
    }
    const bool is_done = member.search->advance(work);
    share_bounds();
    return is_done || (statistics_.best && statistics_.lower_bound >= statistics_.best);
}

// Another one has proven more, and has not done more.
bool Portfolio::lags(const Member& member, std::uint64_t work) const {
    return std::ranges::any_of(members_, [&](const Member& other) {
        return member.search && other.search && other.search->lower_bound() > member.search->lower_bound() &&
               other.search->work() <= std::max(work, member.search->work());
    });
}

void Portfolio::add_up() {
    statistics_.expanded = statistics_.generated = statistics_.evaluated = 0;
    statistics_.dead_ends = statistics_.cuts = 0;
    for (const Member& member : members_) {
        const SearchStatistics& own = member.statistics;
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

// A plan that one has found is the upper bound of the others.
void Portfolio::share_bounds() {
    add_up();
    if (statistics_.best) {
        for (const Member& member : members_) {
            if (member.search && member.statistics.best != statistics_.best) {
                member.search->set_upper_bound(*statistics_.best);
            }
        }
    }
}

// Put together what is known when the last search has ended: its result, with the best plan and bound of all.
SearchResult Portfolio::gather(Member& ended) {
    Member& last = ended.search ? ended : members_.front();
    if (!last.search) {
        throw Stopped{*stop_};
    }
    SearchResult result = last.search->result();
    Cost bound =
        result.statistics.lower_bound.value_or(result.status == SearchStatus::Unsolvable ? kNoDecomposition : 0);
    const std::optional<StopReason> stop = result.stop ? result.stop : stop_;
    for (Member& member : members_) {
        if (!member.search || &member == &last) {
            continue;
        }
        bound = std::max(bound, member.search->lower_bound());
        if (member.search->best() && (!result.cost || *member.search->best() < *result.cost)) {
            result = member.search->result();
        }
    }
    add_up();
    result.stop = stop;
    statistics_.best = result.cost;
    if (result.cost) {
        statistics_.lower_bound = std::min(bound, *result.cost);
        result.status = bound >= *result.cost ? SearchStatus::Optimal : SearchStatus::Solved;
    } else if (result.status != SearchStatus::Unsolvable) {
        statistics_.lower_bound = bound;
        result.status = stop_ ? status_of(*stop_) : result.status;
    } else {
        statistics_.lower_bound.reset();
    }
    result.statistics = statistics_;
    return result;
}

}  // namespace relax
