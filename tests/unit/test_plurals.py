"""One step is not `1 steps`."""

from __future__ import annotations

import logging
import re
from pathlib import Path

import pytest

import statehtn
from statehtn.cli import main


def test_one_thing_is_no_plural(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    """One step, one node, one plan, one action, one task, one method, one fact."""
    domain = "(define (domain d) (:predicates (home)) (:task t :parameters ()) "
    domain += "(:method m :parameters () :task (t) :ordered-subtasks (and (go))) "
    domain += "(:action go :parameters () :precondition (home) :effect (not (home))))"
    text = "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (t))) (:init (home)))"
    files = tmp_path / "domain.hddl", tmp_path / "problem.hddl"
    for file, content in zip(files, (domain, text), strict=True):
        file.write_text(content)
    caplog.set_level(logging.INFO, "statehtn")
    problem = statehtn.read_hddl(*files)
    result, best = statehtn.plan(problem), statehtn.top_plans(problem, 1)
    names = [str(file) for file in files]
    assert main(["plan", *names]) == 0
    assert main(["plan", *names, "--solver", "plan"]) == 0
    assert main(["top", "1", *names]) == 0
    assert main(["graph", *names, "--output", str(tmp_path / "graph.dot")]) == 0
    printed = capsys.readouterr().out
    shown = (
        repr(result),
        repr(result.plan),
        str(best),
        repr(best),
        repr(best[0]),
        repr(statehtn.validate(problem, result.plan)),
    )
    whole = "\n".join((printed, caplog.text, *shown))
    assert re.findall(r"\b1 (?:\w+ )?\w+s\b", whole) == []
    for words in ("1 action, 1 task", "1 node expanded", "<plan of 1 step: (go)>", "<1 plan for", ", 1 plan, "):
        assert words in whole
