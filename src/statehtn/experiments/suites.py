"""Suites: the problems that belong together, and what each of them is run with."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from statehtn.compatible import SOLVERS
from statehtn.errors import InputError, UsageError
from statehtn.experiments.instances import find_instances
from statehtn.experiments.run import Grid, Instance, Run
from statehtn.experiments.suite_file import Part, read_suite
from statehtn.risk import Neutral, agents_of

DEFAULTS = Grid(repeat=1, time_limit=60.0, memory_limit=4000.0)
"""What holds where neither the user nor the suite says anything."""
AV_AGENTS = (Neutral(), *agents_of(("averse", "seeking"), (0.1,)), *agents_of(("averse", "seeking"), (0.9,)))
"""The agents of the paper's table on vehicles."""
SATELLITE_AGENTS = agents_of(("neutral", "averse", "seeking"), (0.5,))
"""The agents of the paper's table on satellites."""
OTHER_SATELLITE_AGENTS = AV_AGENTS[1:]
"""Those of its further experiments: the same problems, other intensities (section "Open Issues")."""
AV_PROBLEMS = ("p1", "p2", "p3", "p4", "p5")
SATELLITE_PROBLEMS = tuple(
    f"RA-{name}mod"
    for name in (
        *("3obs-1sat-3", "4obs-1sat-3", "4obs-1sat-4", "5obs-1sat-3", "5obs-1sat-4", "5obs-2sat-3", "5obs-2sat-4"),
        *("5obs-2sat-5", "6obs-2sat-3", "6obs-2sat-4", "7obs-2sat-4", "7obs-2sat-5", "7obs-2sat-6"),
        *("7obs-3sat-4", "7obs-3sat-5", "7obs-3sat-6"),
    )
)


def ipc(root: Path | None) -> list[Part]:
    """Every problem below a folder, such as a checkout of the competition's benchmarks, for a neutral agent.

    Raises:
        UsageError: no folder is given.
        InputError: there is no such folder, or no problem in it.
    """
    if root is None:
        raise UsageError("the suite 'ipc' needs the folder of the benchmarks (--root)")
    if not root.is_dir():
        raise InputError(f"cannot read '{root}': there is no such folder")
    instances = find_instances(root)
    if not instances:
        raise InputError(f"there is no HDDL problem (*.hddl) in '{root}' or the folders below it")
    return [(Grid(), instances)]


def paper(root: Path | None) -> list[Part]:
    """The runs that the paper reports (section "Experimental Evaluation"), by all solvers.

    Five vehicle problems with five agents; sixteen satellite problems with three, and with four more at other
    intensities, of which it tells in words.

    Raises:
        InputError: the problems are not there.
    """
    domains = _own_domains(root)
    vehicle = [_instance(domains, "av", name) for name in AV_PROBLEMS]
    satellite = [_instance(domains, "satellite", name) for name in SATELLITE_PROBLEMS]
    return [
        (Grid(objectives=AV_AGENTS, solvers=tuple(SOLVERS)), vehicle),
        (Grid(objectives=SATELLITE_AGENTS + OTHER_SATELLITE_AGENTS, solvers=tuple(SOLVERS)), satellite),
    ]


def satellite_large(root: Path | None) -> list[Part]:
    """Satellite problems of the size at which the paper's planner had no memory left: one satellite, by all solvers.

    Raises:
        InputError: the problems are not there.
    """
    domains = _own_domains(root)
    names = sorted(path.stem for path in (domains / "satellite/large").glob("*.hddl"))
    if not names:
        raise InputError(f"there is no problem in '{domains / 'satellite/large'}'")
    instances = [_instance(domains, "satellite", f"large/{name}") for name in names]
    return [(Grid(objectives=SATELLITE_AGENTS, solvers=tuple(SOLVERS)), instances)]


def _own_domains(root: Path | None) -> Path:
    """Return the folder `domains` of the repository: the one given, one here, or that beside this package's sources."""
    places = [Path("domains"), Path(__file__).parents[3] / "domains"] if root is None else [root]
    for place in places:
        if (place / "av/domain.hddl").is_file():
            return place
    where = "here or beside the package" if root is None else f"in '{root}'"
    raise InputError(
        f"this suite's problems are not {where}: no 'av/domain.hddl'; give the folder 'domains' of a checkout of "
        "statehtn's repository (--root)"
    )


def _instance(domains: Path, domain: str, problem: str) -> Instance:
    files = domains / domain / "domain.hddl", domains / domain / f"{problem}.hddl"
    for file in files:
        if not file.is_file():
            raise InputError(f"'{file}' is missing; '{domains}' is not the folder 'domains' of this version")
    return Instance(domain, problem, *map(str, files))


Suite = Callable[[Path | None], list[Part]]
SUITES: Mapping[str, Suite] = MappingProxyType({"paper": paper, "satellite-large": satellite_large, "ipc": ipc})
"""What each suite runs where the user asks for nothing else, given the folder of its files, if it has one."""
SUITE_FILE = ".toml"
"""The ending of the name of a suite that is a file."""


def runs_of(suite: str, asked: Grid, root: Path | None = None) -> list[Run]:
    """Return the runs of a suite, a name from `SUITES` or a TOML file, with what was asked for in place of its own.

    All are there once before one is there again, so that a noisy hour does not fall on one of them alone. Warns of
    combinations that are left out because the solver does not know them.

    Raises:
        UsageError: the suite, or what was asked for, makes no sense.
        InputError: its files are not there, or are wrong.
    """
    parts = [(asked.or_else(own).or_else(DEFAULTS), instances) for own, instances in _parts(suite, root)]
    _warn_of_missing([grid for grid, _ in parts])
    runs: dict[tuple[str, ...], Run] = {}
    for run in (run for grid, instances in parts for run in grid.runs(instances)):
        if runs.setdefault(run.key, run) != run:
            raise InputError(
                f"the suite '{suite}' has two runs that only their files or limits tell apart: {' '.join(run.key)}; "
                "give its domains different names"
            )
    return sorted(runs.values(), key=lambda run: run.repeat)


def _parts(suite: str, root: Path | None) -> list[Part]:
    if suite in SUITES:
        return SUITES[suite](root)
    if not suite.endswith(SUITE_FILE):
        raise UsageError(f"unknown suite '{suite}'; there are {', '.join(SUITES)}, and files *{SUITE_FILE}")
    if root is not None:
        raise UsageError("the paths in a suite's file are relative to the file; leave out --root")
    return read_suite(Path(suite))


def _warn_of_missing(grids: Sequence[Grid]) -> None:
    """Warn of what these grids leave out.

    Raises:
        UsageError: nothing is left of one.
    """
    texts: dict[str, str] = {}
    for grid in grids:
        missing = {one.label: one.mismatch for one in grid.combinations() if one.mismatch is not None}
        texts |= missing
        if all(one.mismatch is not None for one in grid.combinations()):
            raise UsageError(f"none of these settings exists: {', '.join(texts)}; {'; '.join(set(texts.values()))}")
    for reason in dict.fromkeys(texts.values()):
        settings = ", ".join(name for name, text in texts.items() if text == reason)
        warnings.warn(f"left out: {settings} ({reason})", stacklevel=3)
