"""All that can be said about a model, in order."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike

from statehtn.errors import StateHtnError
from statehtn.expected import file_name
from statehtn.hddl.whole_reader import Reading, read_whole_hddl
from statehtn.inspection.conditions import check_conditions
from statehtn.inspection.costs import check_costs
from statehtn.inspection.finding import Finding, in_order
from statehtn.inspection.names import check_names
from statehtn.inspection.orderings import check_orderings
from statehtn.inspection.parameters import check_parameters
from statehtn.inspection.reachability import check_reachability, reached, ungrounded, with_causes
from statehtn.inspection.refusals import refusals
from statehtn.inspection.subject import Subject
from statehtn.inspection.tasks import check_tasks
from statehtn.limits import Limits, watched

FAMILIES = (check_tasks, check_conditions, check_costs, check_parameters, check_orderings, check_names)
"""What looks at a model that has been read, each for slips of one kind."""


def check(
    domain: str | PathLike[str],
    problem: str | PathLike[str] | None = None,
    *,
    time_limit: float | None = None,
    memory_limit: float | None = None,
) -> list[Finding]:
    """Return what is wrong or suspicious in a domain, or in a domain and a problem.

    Without a problem nothing is said that a problem could decide. What a problem merely does not use is a note.

    Args:
        domain: the file of the domain, in HDDL.
        problem: the file of a problem of it.
        time_limit: seconds.
        memory_limit: resident memory of the whole process in MB (10^6 bytes).

    Returns:
        The findings: errors, then warnings, then notes; causes before what may follow from them. Where something is
        refused, what the reader says of the files, and nothing else.

    Raises:
        UsageError: an argument is out of its range.
        InputError: a file cannot be read at all.
        LimitReached: a limit was reached.
    """
    limits = Limits.starting_now(time_limit, memory_limit)
    domain = file_name(domain, "the domain")
    problem = None if problem is None else file_name(problem, "the problem")
    return inspected(domain, problem, limits)


def inspected(domain: str, problem: str | None, limits: Limits) -> list[Finding]:
    """Return what is wrong or suspicious in files; as `check`."""
    with watched(limits):
        reading = read_whole_hddl(domain, problem, limits)
        subject = _subject(reading)
        own = [finding for family in FAMILIES for finding in family(subject)] if subject is not None else []
    if subject is None or subject.problem is None:
        return in_order((*refusals(reading), *own))
    try:
        found = reached(subject.problem, limits)
    except StateHtnError as error:
        return in_order((*refusals(reading), *own, ungrounded(error)))
    findings: Iterable[Finding] = (*own, *check_reachability(subject, found, limits))
    if found.reason is not None:
        findings = with_causes(findings, found.reason)
    return in_order((*refusals(reading), *findings))


def _subject(reading: Reading) -> Subject | None:
    """Return what has been read, if all of it has."""
    if not reading.is_whole or reading.domain is None or reading.places is None:
        return None
    return Subject(reading.domain, reading.problem, reading.places)
