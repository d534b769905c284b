"""The class that unified-planning (UP) instantiates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import IO, Any

from unified_planning.engines import Credits, Engine, LogMessage, PlanGenerationResult, ValidationResult
from unified_planning.engines.mixins import AnytimePlannerMixin, OneshotPlannerMixin, PlanValidatorMixin
from unified_planning.engines.mixins.anytime_planner import AnytimeGuarantee
from unified_planning.engines.mixins.oneshot_planner import OptimalityGuarantee
from unified_planning.engines.results import LogLevel, ValidationResultStatus
from unified_planning.exceptions import UPUsageError
from unified_planning.model import ProblemKind
from unified_planning.plans import PlanKind

from statehtn.engine.kind import SUPPORTED_KIND
from statehtn.engine.parameters import NAME, Parameters, warn_of
from statehtn.engine.runs import results
from statehtn.errors import InputError, StateHtnError, UsageError
from statehtn.interop.conversion import Conversion
from statehtn.interop.costs import CostParts
from statehtn.interop.metric import metric_value
from statehtn.risk import Attitude, ObjectiveLike
from statehtn.settings import KeepLike
from statehtn.validation import validate


class StateHtnEngine(Engine, OneshotPlannerMixin, AnytimePlannerMixin, PlanValidatorMixin):
    """Plans for hierarchical problems, optimally where there is a metric, and validates hierarchical plans.

    Args:
        objective: what plans are compared by, as for `statehtn.plan`, such as `cvar 0.95`.
        attitude: neutral, averse or seeking: with alpha a short form of an objective; neutral where neither is given.
        alpha: how much an averse or a seeking agent cares about risk: positive, per unit of cost.
        keep: budgets that plans have to keep with a probability, such as `25 0.95`.
        heuristic: one of `statehtn.engine.ADMISSIBLE`; without it what is best in general.
        cost_distributions: uncertain costs by action or name of an action, as for `statehtn.from_unified_planning`; the
            best plan by the objective is then the optimal one. The validator leaves them out.
        memory_limit: resident memory of the whole process in MB (10^6 bytes).

    Raises:
        UPUsageError: a parameter is out of its range. Unknown ones are warned of and have no effect.
    """

    def __init__(
        self,
        *,
        objective: ObjectiveLike | None = None,
        attitude: Attitude | str | None = None,
        alpha: float | str | None = None,
        keep: KeepLike | Iterable[KeepLike] = (),
        heuristic: str | None = None,
        cost_distributions: Mapping[Any, CostParts] | None = None,
        memory_limit: float | str | None = None,
        **unknown: Any,
    ) -> None:
        Engine.__init__(self)
        OneshotPlannerMixin.__init__(self)
        AnytimePlannerMixin.__init__(self)
        warn_of(unknown, "the unknown parameter")
        self._parameters = Parameters.of(objective, attitude, alpha, keep, heuristic, cost_distributions, memory_limit)

    @property
    def name(self) -> str:
        """The engine's name in UP."""
        return NAME

    @staticmethod
    def supported_kind() -> ProblemKind:
        """Return what problems may have."""
        return SUPPORTED_KIND.clone()

    @staticmethod
    def supports(problem_kind: ProblemKind) -> bool:
        """Tell whether the engine is one for problems of a kind."""
        return bool(problem_kind <= SUPPORTED_KIND)

    @staticmethod
    def supports_plan(plan_kind: PlanKind) -> bool:
        """Tell whether the engine validates plans of a kind."""
        return plan_kind is PlanKind.HIERARCHICAL_PLAN

    @staticmethod
    def satisfies(optimality_guarantee: OptimalityGuarantee) -> bool:
        """Tell whether the engine guarantees plans of this quality: the best for the metric, where there is one."""
        return optimality_guarantee in (OptimalityGuarantee.SATISFICING, OptimalityGuarantee.SOLVED_OPTIMALLY)

    @staticmethod
    def ensures(anytime_guarantee: AnytimeGuarantee) -> bool:
        """Tell what the plans of `get_solutions` are: better and better; not all optimal."""
        return anytime_guarantee is AnytimeGuarantee.INCREASING_QUALITY

    @staticmethod
    def get_credits(**_: Any) -> Credits:
        """Return what UP prints when it chooses the engine."""
        return Credits(
            name=NAME,
            author="the authors of statehtn",
            contact="",
            website="",
            license="Apache-2.0",
            short_description="Optimal hierarchical planning under risk",
            long_description="A* progression search for hierarchical problems whose actions have uncertain costs.",
        )

    def _solve(
        self, problem: Any, heuristic: Any = None, timeout: float | None = None, output_stream: IO[str] | None = None
    ) -> PlanGenerationResult:
        return self._solve_with_params(problem, heuristic, timeout, output_stream)

    def _solve_with_params(
        self,
        problem: Any,
        heuristic: Any = None,
        timeout: float | None = None,
        output_stream: IO[str] | None = None,
        **others: Any,
    ) -> PlanGenerationResult:
        warn_of(_given({"heuristic": heuristic, **others}), "the argument")
        (result,) = results(problem, self._parameters, timeout, output_stream, every_plan=False)
        return result

    def _get_solutions(
        self, problem: Any, timeout: float | None = None, output_stream: IO[str] | None = None
    ) -> Iterator[PlanGenerationResult]:
        return self._get_solutions_with_params(problem, timeout, output_stream)

    def _get_solutions_with_params(
        self, problem: Any, timeout: float | None = None, output_stream: IO[str] | None = None, **others: Any
    ) -> Iterator[PlanGenerationResult]:
        warn_of(_given(others), "the argument")
        return results(problem, self._parameters, timeout, output_stream, every_plan=True)

    def _validate(self, problem: Any, plan: Any) -> ValidationResult:
        """Judge a plan by `statehtn.validate`; for a valid one also by the metric."""
        try:
            conversion = Conversion.from_up(problem)
        except StateHtnError as error:
            return _judged(ValidationResultStatus.UNKNOWN, [str(error)])
        try:
            ours = conversion.plan_from_up(plan)
        except InputError as error:
            return _judged(ValidationResultStatus.INVALID, [str(error)])
        except UsageError as error:
            raise UPUsageError(f"{NAME}: {error}") from None
        validation = validate(conversion.problem, ours)
        if not validation:
            return _judged(ValidationResultStatus.INVALID, validation.reasons)
        result = _judged(ValidationResultStatus.VALID, ())
        result.metric_evaluations = {
            metric: metric_value(conversion.problem, ours) for metric in problem.quality_metrics
        } or None
        return result


def _given(arguments: Mapping[str, Any]) -> list[str]:
    return [name for name, value in arguments.items() if value is not None]


def _judged(status: ValidationResultStatus, reasons: Any) -> ValidationResult:
    messages = [LogMessage(LogLevel.INFO, reason) for reason in reasons]
    return ValidationResult(status, NAME, log_messages=messages)
