"""A planning run for unified-planning (UP): its problem in, its results out."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import IO, Any

from unified_planning.engines import LogMessage, PlanGenerationResult
from unified_planning.engines.results import LogLevel, PlanGenerationResultStatus
from unified_planning.exceptions import UPUsageError

from statehtn.core.progress import Progress
from statehtn.counted import counted
from statehtn.engine.parameters import NAME, Parameters
from statehtn.errors import InternalError, StateHtnError, UsageError
from statehtn.interop.conversion import Conversion
from statehtn.limits import Limits
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.session import Session
from statehtn.settings import Settings
from statehtn.sweeps import solutions

SHORTEST_SECONDS = 1e-3  # what is left to the search where converting the problem took all the time

STATUSES = {
    Status.OPTIMAL: PlanGenerationResultStatus.SOLVED_OPTIMALLY,
    Status.SOLVED: PlanGenerationResultStatus.SOLVED_SATISFICING,
    Status.UNSOLVABLE: PlanGenerationResultStatus.UNSOLVABLE_PROVEN,
    Status.GAVE_UP: PlanGenerationResultStatus.UNSOLVABLE_INCOMPLETELY,
    Status.TIME_LIMIT: PlanGenerationResultStatus.TIMEOUT,
    Status.MEMORY_LIMIT: PlanGenerationResultStatus.MEMOUT,
}


def results(
    problem: Any, parameters: Parameters, timeout: float | None, output_stream: IO[str] | None, every_plan: bool
) -> Iterator[PlanGenerationResult]:
    """Yield better and better plans, if `every_plan`, and how the run ended.

    A problem that cannot be solved for what it has is a value, with the reason in its log.

    Raises:
        UPUsageError: a cost distribution is none, or the time is not positive.
    """
    start = time.monotonic()
    try:
        conversion = Conversion.from_up(problem, parameters.cost_distributions)
        if timeout is not None and timeout > 0:
            timeout = max(timeout - (time.monotonic() - start), SHORTEST_SECONDS)
        run = _Run(conversion, parameters, timeout, output_stream)
        yield from run.every_plan() if every_plan and run.optimises else run.one_plan()
    except UsageError as error:
        raise UPUsageError(f"{NAME}: {error}") from None
    except StateHtnError as error:
        yield _without_plan(PlanGenerationResultStatus.UNSUPPORTED_PROBLEM, str(error))
    except InternalError as error:
        yield _without_plan(PlanGenerationResultStatus.INTERNAL_ERROR, str(error))


def _without_plan(status: PlanGenerationResultStatus, reason: str) -> PlanGenerationResult:
    return PlanGenerationResult(status, None, NAME, log_messages=[LogMessage(LogLevel.ERROR, reason)])


class _Run:
    def __init__(
        self, conversion: Conversion, parameters: Parameters, timeout: float | None, output_stream: IO[str] | None
    ) -> None:
        self.conversion = conversion
        self.has_metric = bool(conversion.up_problem.quality_metrics)
        self.optimises = self.has_metric or bool(parameters.cost_distributions)
        self.parameters = parameters
        self.start = time.monotonic()
        self.limits = Limits.starting_now(timeout, parameters.memory_limit)
        self.progress = None if output_stream is None else progress_writer(output_stream)

    def one_plan(self) -> Iterator[PlanGenerationResult]:
        """Yield an optimal plan, or any plan where nothing is to be optimised."""
        asks_more = self.parameters.heuristic or self.parameters.keep
        for result in self.search("astar" if self.optimises or asks_more else "greedy"):
            yield self.final(result)

    def search(self, search: str, every_plan: bool = False) -> Iterator[Result]:
        """Search for a plan; yield better and better ones, if `every_plan`, and last how the run ended."""
        known = self.parameters
        settings = Settings.of(known.objective, heuristic=known.heuristic, search=search, keep=known.keep)
        return solutions(Session(self.conversion.problem), settings, self.limits, self.progress, every_plan)

    def every_plan(self) -> Iterator[PlanGenerationResult]:
        """Yield every plan when it is found, and the last one with the final status."""
        latest: Result | None = None
        for result in self.search("anytime", every_plan=True):
            if result.status is Status.SOLVED and (latest is None or result.plan != latest.plan):
                yield self.with_status(result, PlanGenerationResultStatus.INTERMEDIATE)
            latest = result
        assert latest is not None
        yield self.final(latest)

    def final(self, result: Result) -> PlanGenerationResult:
        """Return the result that a run ended with.

        Raises:
            KeyboardInterrupt: it was interrupted.
        """
        if result.stopped is Status.INTERRUPTED:
            raise KeyboardInterrupt
        status = STATUSES[result.status]
        if result.status is Status.OPTIMAL and not self.has_metric:
            status = PlanGenerationResultStatus.SOLVED_SATISFICING  # UP proves optimality for metrics alone
        elif result.status is Status.SOLVED and self.optimises and result.stopped is not None:  # before the proof
            status = STATUSES[result.stopped]
        return self.with_status(result, status)

    def with_status(self, result: Result, status: PlanGenerationResultStatus) -> PlanGenerationResult:
        """Return a result with its plan and its numbers in UP's form."""
        found = None if result.plan is None else self.conversion.plan_to_up(result.plan)
        return PlanGenerationResult(status, found, NAME, self.metrics(result))

    def metrics(self, result: Result) -> dict[str, str]:
        """Return what is known of the plan, costs in the metric's unit and positive, and the effort."""
        statistics = result.statistics
        numbers = {
            "engine_internal_time": time.monotonic() - self.start,
            "expected_cost": result.expected_cost,
            "risk_cost": result.risk_cost,
            "value": result.value,
            "expected_utility": result.expected_utility,
            "lower_bound": result.lower_bound,
            "expanded": statistics.expanded,
            "generated": statistics.generated,
            "evaluated": statistics.evaluated,
        }
        return {name: str(number) for name, number in numbers.items() if number is not None}


def progress_writer(stream: IO[str]) -> Callable[[Progress], None]:
    """Return a callback that writes a line whenever the bound or the best plan changes."""
    last: list[tuple[float | None, float | None]] = []

    def write(progress: Progress) -> None:
        now = (progress.lower_bound, progress.best)
        if last != [now]:
            last[:] = [now]
            bound, best = ("-" if number is None else f"{number:g}" for number in now)
            nodes = counted(progress.expanded, "node")
            stream.write(f"{progress.seconds:.1f} s: {nodes}, bound {bound}, best plan {best}\n")

    return write
