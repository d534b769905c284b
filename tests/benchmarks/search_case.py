"""One search for an optimal plan in a process of its own: what `search`, `ablation` and `growth` measure.

Reading and grounding have `PREPARATION_SECONDS` together. The limit of a case is for what comes after them, the
preparation of heuristics included, and so are `search_seconds`. Memory is limited for the whole process.
"""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
import time
import warnings
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from statehtn.effort import peak_memory_mb
from statehtn.errors import StateHtnError
from statehtn.limits import LimitReached, Limits

PREPARATION_SECONDS = 60.0
MEMORY_MB = 8000.0
GRACE = 15.0  # seconds after the limits when a process is ended from outside


@dataclass(frozen=True)
class Case:
    """What to search for, how, and for how many seconds at most. `without`: names of fields of `SearchSwitches`."""

    domain: str
    problem: str
    seconds: float
    heuristic: str = "auto"
    without: tuple[str, ...] = ()


@dataclass(frozen=True)
class Row:
    """What came out: seconds, MB (10^6 bytes), costs in the domain's unit; `baseline_`: another planner's, likewise.

    `actions` and `methods` are the ground problem's. `base_memory_mb` is what the process holds before the search.
    `model_bytes`: the size of the relaxed model of the heuristic; of `lmcut`'s, where several take turns.
    """

    domain: str
    problem: str
    status: str
    cost: float | None = None
    lower_bound: float | None = None
    search_seconds: float | None = None
    expanded: int | None = None
    generated: int | None = None
    evaluated: int | None = None
    cuts: int | None = None
    model_bytes: int | None = None
    actions: int | None = None
    methods: int | None = None
    peak_memory_mb: float | None = None
    base_memory_mb: float | None = None
    baseline_cost: float | None = None
    baseline_seconds: float | None = None
    baseline_expanded: int | None = None
    baseline_generated: int | None = None
    baseline_memory_mb: float | None = None
    message: str = ""

    @property
    def name(self) -> str:
        return f"{self.domain} {self.problem}"

    @property
    def solved(self) -> bool:
        return self.status in ("optimal", "unsolvable")

    @property
    def search_memory_mb(self) -> float | None:
        """What the search took beyond the ground problem."""
        if self.peak_memory_mb is None or self.base_memory_mb is None:
            return None
        return self.peak_memory_mb - self.base_memory_mb


def measure(case: Case) -> dict[str, Any]:
    """Search in a process of its own, and return fields of a `Row`."""
    command = [sys.executable, "-m", "tests.benchmarks.search_case", json.dumps(asdict(case))]
    seconds = PREPARATION_SECONDS + case.seconds + GRACE
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=seconds, check=True)
        found: dict[str, Any] = json.loads(run.stdout)
    except subprocess.TimeoutExpired:
        return {"status": "killed", "message": f"still running {GRACE:g} s after the limits"}
    except subprocess.CalledProcessError as error:
        return {"status": "crashed", "message": (error.stderr.strip() or str(error)).splitlines()[-1]}
    return found


def search(case: Case) -> dict[str, Any]:
    """Search in this process, and return fields of a `Row`."""
    from statehtn.core.grounding import ground
    from statehtn.core.heuristics import PORTFOLIO, HeuristicEvaluator
    from statehtn.core.search import find_plans
    from statehtn.core.switches import SearchSwitches
    from statehtn.hddl import HddlWarning, read_hddl
    from statehtn.risk import utility_for

    utility = utility_for("neutral", None)
    switches = SearchSwitches(**dict.fromkeys(case.without, False))
    limits = Limits.starting_now(PREPARATION_SECONDS, MEMORY_MB)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HddlWarning)
            lifted = read_hddl(case.domain, case.problem, limits=limits)
        grounding = ground(lifted, limits)
    except LimitReached as reached:
        return {"status": reached.status.value, "message": "while reading or grounding"}
    except StateHtnError as error:
        return {"status": "error", "message": str(error)}
    forget_peak()
    found: dict[str, Any] = {"base_memory_mb": peak_memory_mb()}
    found |= {"actions": grounding.handle.action_count, "methods": grounding.method_count}
    limits = Limits.starting_now(case.seconds, MEMORY_MB)
    start = time.perf_counter()
    outcome = find_plans(grounding, utility, heuristic=case.heuristic, limits=limits, switches=switches)
    found["search_seconds"] = time.perf_counter() - start
    found["peak_memory_mb"] = peak_memory_mb()
    found |= {"status": outcome.status.value, "lower_bound": outcome.lower_bound}
    found |= {name: getattr(outcome.effort, name) for name in ("cuts", "expanded", "generated", "evaluated")}
    if outcome.plan is not None:
        found["cost"] = outcome.lower_bound
    heuristic = "lmcut" if case.heuristic == PORTFOLIO else case.heuristic
    found["model_bytes"] = HeuristicEvaluator(grounding, utility, heuristic).model_bytes
    return found


def forget_peak() -> None:
    """Let the process's peak memory be what it holds now, where the system can do that (Linux)."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")


if __name__ == "__main__":
    print(json.dumps(search(Case(**json.loads(sys.argv[1])))))
