"""`statehtn check`: say what is wrong or suspicious in a domain, or in a domain and a problem."""

from __future__ import annotations

import argparse
import json
from collections import Counter

from statehtn.cli.exit_codes import ExitCode
from statehtn.cli.streams import emit, emit_lines
from statehtn.counted import counted
from statehtn.errors import one_line
from statehtn.inspection.finding import Finding, Level
from statehtn.inspection.inspection import inspected
from statehtn.limits import Limits

_ANNOTATIONS = {Level.ERROR: "error", Level.WARNING: "warning", Level.NOTE: "notice"}


def run_check(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: a file cannot be read at all.
        LimitReached: a limit was reached.
    """
    limits = Limits.starting_now(options.time_limit, options.memory_limit)
    findings = inspected(options.domain, options.problem, limits)
    match options.format:
        case "json":
            emit(json.dumps(_as_object(findings, options), allow_nan=False))
        case "github":
            emit_lines(map(_annotation, findings))
        case _:
            emit_lines([*(one_line(str(finding)) for finding in findings), _summary(findings)])
    is_clean = all(finding.level == Level.NOTE for finding in findings)
    return ExitCode.SUCCESS if is_clean else ExitCode.FINDINGS


def _summary(findings: list[Finding]) -> str:
    """Return the last line: how many findings there are of each level."""
    if not findings:
        return "nothing to say: no errors, no warnings, no notes"
    counts = Counter(finding.level for finding in findings)
    return ", ".join(counted(counts[level], str(level)) for level in Level)


def _as_object(findings: list[Finding], options: argparse.Namespace) -> dict[str, object]:
    counts = Counter(finding.level for finding in findings)
    return {
        "domain": options.domain,
        "problem": options.problem,
        **{f"{level}s": counts[level] for level in Level},
        "findings": [finding.to_dict() for finding in findings],
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
