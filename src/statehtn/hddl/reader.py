"""The entry points of the reader."""

from __future__ import annotations

from os import PathLike

from statehtn.collector import without_collector
from statehtn.errors import UsageError
from statehtn.expected import expect, file_name
from statehtn.hddl.dead_ends import warn_of_dead_ends
from statehtn.hddl.diagnostics import Diagnostics, Reporter
from statehtn.hddl.domain_reader import DomainReader
from statehtn.hddl.problem_reader import ProblemReader
from statehtn.hddl.tokens import Source, read_text
from statehtn.hddl.vocabulary import Vocabulary
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

    Names are compared without case, and are spelt as in their declarations. docs/hddl.md says what is accepted,
    docs/hddl-costs.md how costs are written.

    Args:
        domain_path: the domain's file.
        problem_path: the problem's file.
        strict: raise an error for whatever would be an `HddlWarning` otherwise.
        limits: time and memory for reading.

    Raises:
        InputError: a file is missing, malformed or contradicts itself; names the file, line and column.
        UnsupportedError: a file uses something that this planner does not do.
        LimitReached: a limit was reached.
    """
    domain_file, problem_file = (
        _file(path, what) for path, what in ((domain_path, "domain"), (problem_path, "problem"))
    )
    diagnostics = Diagnostics(strict)
    try:
        return _read(
            (read_text(domain_file, limits), domain_file),
            (read_text(problem_file, limits), problem_file),
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
        domain_text: the domain.
        problem_text: the problem.
        strict: raise an error for whatever would be an `HddlWarning` otherwise.
        limits: time and memory for reading.
        domain_file: the name of the domain in messages.
        problem_file: the name of the problem in messages.
    """
    for text, what in ((domain_text, "domain"), (problem_text, "problem")):
        expect(text, str, f"the {what} must be a text in HDDL", "statehtn.read_hddl reads files")
    diagnostics = Diagnostics(strict)
    try:
        return _read((domain_text, str(domain_file)), (problem_text, str(problem_file)), diagnostics, limits)
    finally:
        diagnostics.emit(2)


def _file(path: str | PathLike[str], what: str) -> str:
    """Return the name of a file.

    Raises:
        UsageError: it is none; the text of one, say.
    """
    name = file_name(path, f"the {what}")
    if "(define" in name:
        raise UsageError(f"the {what} must be the name of a file, found a text; statehtn.read_hddl_text reads texts")
    return name


def _read(domain: tuple[str, str], problem: tuple[str, str], diagnostics: Diagnostics, limits: Limits) -> Problem:
    """Read the declarations of both files first, as the domain may name objects of the problem, then the rest."""
    vocabulary = Vocabulary()
    with without_collector():
        domain_reader = DomainReader(Reporter(Source(*domain, limits), diagnostics), vocabulary)
        source = Source(*problem, limits)
        problem_reader = ProblemReader(Reporter(source, diagnostics), vocabulary)
        whole = problem_reader.read(domain_reader.read(problem_reader.objects))
        warn_of_dead_ends(whole, vocabulary, source, diagnostics)
        return whole
