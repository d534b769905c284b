"""Plans that are found in time, but have too many tasks to be put together before a limit."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import statehtn
from statehtn.cli import main
from statehtn.core.grounding import ground
from statehtn.core.trace import UNITS, TraceReader
from statehtn.limits import LimitReached, Limits
from statehtn.model.status import Status
from tests.counted_limits import CountedLimits

ENDINGS: list[tuple[Callable[[], BaseException], Status]] = [
    (lambda: LimitReached(Status.TIME_LIMIT), Status.TIME_LIMIT),
    (MemoryError, Status.MEMORY_LIMIT),
    (KeyboardInterrupt, Status.INTERRUPTED),
]
HEAD = "(define (domain d) (:requirements :hierarchy) (:predicates (never)) (:functions (total-cost))\n"
WALK = (
    HEAD
    + """
  (:task go :parameters ())
  (:method by-bus :parameters () :task (go) :ordered-subtasks (and (ride)))
  (:method on-foot :parameters () :task (go) :ordered-subtasks (and (step)))
  (:action ride :parameters () :effect (increase (total-cost) 7))
  (:action step :parameters () :effect (increase (total-cost) 5)))
"""
)
PROBLEM = "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (go))) (:init))"


def doubling(levels: int) -> str:
    """Return a domain in which every task is decomposed to twice the next one."""
    tasks = "".join(f"(:task t{level} :parameters ())\n" for level in range(levels + 1))
    methods = "".join(
        f"(:method m{level} :parameters () :task (t{level}) :ordered-subtasks (and (t{level + 1}) (t{level + 1})))\n"
        for level in range(levels)
    )
    top = "(:task go :parameters ()) (:method go :parameters () :task (go) :ordered-subtasks (and (t0)))\n"
    last = f"(:method end :parameters () :task (t{levels}) :ordered-subtasks (and)))"
    return HEAD + tasks + top + methods + last


@pytest.fixture
def read(tmp_path: Path) -> Callable[[str], statehtn.Problem]:
    def from_text(domain: str) -> statehtn.Problem:
        (tmp_path / "d.hddl").write_text(domain)
        (tmp_path / "p.hddl").write_text(PROBLEM)
        return statehtn.read_hddl(tmp_path / "d.hddl", tmp_path / "p.hddl")

    return from_text


def test_reading_a_plan_looks_at_the_limits_every_thousand_tasks(
    read: Callable[[str], statehtn.Problem], monkeypatch: pytest.MonkeyPatch
) -> None:
    traces = []
    original = TraceReader.read
    monkeypatch.setattr(TraceReader, "read", lambda *args: traces.append(args) or original(*args))
    problem = read(doubling(14))
    assert statehtn.plan(problem).status is Status.OPTIMAL
    trace = traces[-1][1]
    reader = TraceReader(ground(problem))
    limits = CountedLimits()
    plan = original(reader, trace, limits)
    tasks = sum(1 for _ in plan.decompositions())
    assert tasks == 2**15
    assert len(limits.looks) >= tasks / (2 * UNITS)
    with pytest.raises(LimitReached):
        original(reader, trace, CountedLimits(last=5))


@pytest.mark.parametrize(("ending", "stopped"), ENDINGS)
def test_a_plan_that_cannot_be_read_in_time_is_told_of(
    ending: Callable[[], BaseException],
    stopped: Status,
    read: Callable[[str], statehtn.Problem],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    problem = read(WALK)

    def end(*_: object) -> None:
        raise ending()

    monkeypatch.setattr(TraceReader, "read", end)
    result = statehtn.plan(problem)
    assert (result.status, result.stopped, result.plan, result.unread) == (stopped, stopped, None, True)
    assert result.lower_bound == 5
    assert result.to_dict()["unread"] is True
    plans = statehtn.top_plans(problem, 2)
    assert (plans.status, plans.stopped, len(plans), plans.unread) == (stopped, stopped, 0, True)
    files = [str(tmp_path / "d.hddl"), str(tmp_path / "p.hddl")]
    assert main(["plan", *files]) in (20, 21, 130)
    out = capsys.readouterr().out
    assert "a plan, but too many tasks to put together before the run ended" in out
    assert "before a plan was found" not in out
    assert main(["top", "2", *files]) in (20, 21, 130)
    assert "plans, but too many tasks to put together" in capsys.readouterr().out


def test_the_core_may_be_unable_to_trace_a_plan_in_time(
    read: Callable[[str], statehtn.Problem], monkeypatch: pytest.MonkeyPatch
) -> None:
    from statehtn import _relax

    class Untraced:
        """A result as the core returns it when a limit comes before the plan was traced."""

        def __init__(self, found: Any) -> None:
            self.cost, self.status, self.stop = None, _relax.SearchStatus.TimeLimit, _relax.StopReason.TimeLimit
            self.statistics = found.statistics

    find_plans = _relax.find_plans
    monkeypatch.setattr(_relax, "find_plans", lambda *args: Untraced(find_plans(*args)))
    result = statehtn.plan(read(WALK))
    assert (result.status, result.plan, result.unread) == (Status.TIME_LIMIT, None, True)
    assert result.lower_bound == pytest.approx(5)


def test_the_best_plan_that_was_read_stays(
    read: Callable[[str], statehtn.Problem], monkeypatch: pytest.MonkeyPatch
) -> None:
    original = TraceReader.read
    is_over: Iterator[bool] = iter([False, True])

    def once(*args: Any) -> Any:
        if next(is_over):
            raise LimitReached(Status.TIME_LIMIT)
        return original(*args)

    problem = read(WALK.replace("(increase (total-cost) 5)", "(increase (total-cost) 9)"))
    monkeypatch.setattr(TraceReader, "read", once)
    plans = statehtn.top_plans(problem, 2)
    assert [plan.risk_cost for plan in plans] == [7]
    assert (plans.status, plans.stopped, plans.unread) == (Status.SOLVED, Status.TIME_LIMIT, True)
    assert not plans.is_all
    assert plans.lower_bound is None or plans.lower_bound <= 7


def test_after_an_interruption_the_rest_is_bounded_too() -> None:
    assert Limits().with_grace(1).deadline is None
    begin = time.monotonic()
    deadline = Limits(deadline=begin + 100).with_grace(1, is_over=True).deadline
    assert deadline is not None
    assert deadline <= time.monotonic() + 1
    deadline = Limits(deadline=begin - 5).with_grace(1).deadline
    assert deadline is not None
    assert deadline >= begin + 1


def test_a_plan_of_millions_of_tasks_does_not_overrun_the_limit(read: Callable[[str], statehtn.Problem]) -> None:
    problem = read(doubling(22))
    begin = time.process_time()
    result = statehtn.plan(problem, time_limit=1)
    assert result.status is Status.TIME_LIMIT
    assert time.process_time() - begin < 12  # to read all takes half a minute
