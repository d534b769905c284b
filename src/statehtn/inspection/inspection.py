"""All that can be said about a model, in order."""

from __future__ import annotations

from dataclasses import dataclass
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
from statehtn.limits import ENDINGS, Limits, watched
from statehtn.model import Problem

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
    inspection = inspected(domain, problem, limits)
    if inspection.ending is not None:
        raise inspection.ending
    return inspection.findings


@dataclass(frozen=True, slots=True)
class Inspection:
    """What was found, and what ended that before it was done.

    Args:
        findings: in order.
        ending: a limit that was reached, or Ctrl-C; None where all was looked at.
    """

    findings: list[Finding]
    ending: BaseException | None = None


def inspected(domain: str, problem: str | None, limits: Limits) -> Inspection:
    """Return what is wrong or suspicious in files; as `check`, but what was found before a limit, too."""
    said: list[Finding] = []
    own: list[Finding] = []
    try:
        with watched(limits):
            reading = read_whole_hddl(domain, problem, limits)
            said += refusals(reading)
            subject = _subject(reading)
            if subject is not None:
                for family in FAMILIES:
                    own += family(subject)
        if subject is not None and subject.problem is not None:
            own = _with_grounding(subject, subject.problem, own, limits)
    except ENDINGS as ending:
        return Inspection(in_order((*said, *own)), ending)
    return Inspection(in_order((*said, *own)))


def _with_grounding(subject: Subject, problem: Problem, own: list[Finding], limits: Limits) -> list[Finding]:
    """Return findings with those that grounding tells."""
    try:
        found = reached(problem, limits)
    except StateHtnError as error:
        return [*own, ungrounded(error)]
    findings = [*own, *check_reachability(subject, found, limits)]
    return findings if found.reason is None else list(with_causes(findings, found.reason))


def _subject(reading: Reading) -> Subject | None:
    """Return what has been read, if all of it has."""
    if not reading.is_whole or reading.domain is None or reading.places is None:
        return None
    return Subject(reading.domain, reading.problem, reading.places)
