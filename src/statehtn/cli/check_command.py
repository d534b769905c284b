"""`statehtn check`: say what is wrong or suspicious in a domain, or in a domain and a problem."""

from __future__ import annotations

import argparse
import json
from collections import Counter

from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import emit, emit_lines
from statehtn.counted import counted
from statehtn.errors import one_line
from statehtn.inspection.finding import Finding, Level
from statehtn.inspection.inspection import inspected
from statehtn.limits import Limits, status_of
from statehtn.model.status import Status

_ANNOTATIONS = {Level.ERROR: "error", Level.WARNING: "warning", Level.NOTE: "notice"}


def run_check(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: a file cannot be read at all.
        LimitReached: a limit was reached; what was found before is printed.
    """
    limits = Limits.starting_now(options.time_limit, options.memory_limit)
    inspection = inspected(options.domain, options.problem, limits)
    findings, ending = inspection.findings, inspection.ending
    stopped = None if ending is None else status_of(ending)
    let_finish()
    match options.format:
        case "json":
            emit(json.dumps(_as_object(findings, options, stopped), allow_nan=False))
        case "github":
            emit_lines(map(_annotation, findings))
        case _:
            emit_lines([*(one_line(str(finding)) for finding in findings), _summary(findings, stopped)])
    if stopped is not None and options.format == "json":
        return EXIT_CODES[stopped]
    if ending is not None:
        raise ending
    is_clean = all(finding.level == Level.NOTE for finding in findings)
    return ExitCode.SUCCESS if is_clean else ExitCode.FINDINGS


def _summary(findings: list[Finding], stopped: Status | None) -> str:
    """Return the last line: how many findings there are of each level."""
    counts = Counter(finding.level for finding in findings)
    told = ", ".join(counted(counts[level], str(level)) for level in Level)
    if stopped is not None:
        return f"not all was looked at: {told} until then"
    return told if findings else "nothing to say: no errors, no warnings, no notes"


def _as_object(findings: list[Finding], options: argparse.Namespace, stopped: Status | None) -> dict[str, object]:
    counts = Counter(finding.level for finding in findings)
    return {
        "domain": options.domain,
        "problem": options.problem,
        **{f"{level}s": counts[level] for level in Level},
        "findings": [finding.to_dict() for finding in findings],
        "stopped": None if stopped is None else stopped.value,
    }


def _annotation(finding: Finding) -> str:
    """Return a finding as a workflow command of GitHub Actions, which shows it beside the line."""
    place = finding.place
    advice = f"; {finding.advice}" if finding.advice else ""
    where = f"file={_property(place.file)},line={place.line},col={place.column},title={finding.code}"
    return f"::{_ANNOTATIONS[finding.level]} {where}::{_data(finding.message + advice)}"


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
