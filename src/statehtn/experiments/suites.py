"""The suites of runs that have a name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from statehtn.errors import InputError, UsageError
from statehtn.experiments.instances import find_instances
from statehtn.experiments.run import Grid, Run


def ipc(grid: Grid, root: Path | None) -> list[Run]:
    """Every problem below a folder, such as a checkout of the competition's benchmarks, for a neutral agent.

    Raises:
        UsageError: no folder is given, or the grid makes no sense.
        InputError: there is no such folder, or no problem in it.
    """
    if root is None:
        raise UsageError("the suite 'ipc' needs the folder of the benchmarks (--root)")
    if not root.is_dir():
        raise InputError(f"cannot read '{root}': there is no such folder")
    instances = find_instances(root)
    if not instances:
        raise InputError(f"there is no HDDL problem (*.hddl) in '{root}' or the folders below it")
    return grid.runs(instances)


Suite = Callable[[Grid, Path | None], list[Run]]
SUITES: Mapping[str, Suite] = MappingProxyType({"ipc": ipc})
"""What each suite runs, given what the user varies and the folder of its files, if it has one."""
