"""The entry points of the reader."""

from __future__ import annotations

from os import PathLike, fspath

from statehtn.hddl.diagnostics import Diagnostics
from statehtn.hddl.domain_reader import read_domain
from statehtn.hddl.problem_reader import read_problem
from statehtn.hddl.tokens import Source, read_text
from statehtn.limits import Limits
from statehtn.model import Problem

NO_LIMITS = Limits()


def read_hddl(
    domain_path: str | PathLike[str],
    problem_path: str | PathLike[str],
    *,
    strict: bool = False,
    limits: Limits = NO_LIMITS,
) -> Problem:
    """Read a problem and its domain from two HDDL files.

    All names are turned into lower case, as HDDL does not distinguish it. Costs of actions are described in
    docs/hddl-costs.md.

    Args:
        strict: raise an error for whatever would be an `HddlWarning` otherwise.
        limits: time and memory for reading.

    Raises:
        InputError: a file is missing, malformed or contradicts itself; names the file, line and column.
        UnsupportedError: a file uses something that this planner does not do.
        LimitReached: a limit was reached.
    """
    diagnostics = Diagnostics(strict)
    try:
        return _read(
            (fspath(domain_path), read_text(domain_path)),
            (fspath(problem_path), read_text(problem_path)),
            diagnostics,
            limits,
        )
    finally:
        diagnostics.emit(2)


def read_hddl_text(
    domain_text: str,
    problem_text: str,
    *,
    strict: bool = False,
    limits: Limits = NO_LIMITS,
    domain_file: str = "domain",
    problem_file: str = "problem",
) -> Problem:
    """Read a problem and its domain from strings; as `read_hddl`.

    Args:
        domain_file: the name of the domain in messages.
        problem_file: the name of the problem in messages.
    """
    diagnostics = Diagnostics(strict)
    try:
        return _read((domain_file, domain_text), (problem_file, problem_text), diagnostics, limits)
    finally:
        diagnostics.emit(2)


def _read(domain: tuple[str, str], problem: tuple[str, str], diagnostics: Diagnostics, limits: Limits) -> Problem:
    file, text = domain
    read, vocabulary = read_domain(Source(text, file, limits), diagnostics, limits)
    file, text = problem
    return read_problem(Source(text, file, limits), read, vocabulary, diagnostics, limits)
