"""Colours on terminals, in pipes, and where the environment asks for them or against them."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from statehtn.display.terminal import Summary, rendered

FILES = [str(Path(__file__).parents[2] / "domains" / "av" / name) for name in ("domain.hddl", "p1.hddl")]
COLOUR = re.compile(r"\x1b\[(?:\d+;)*3[0-7](?:;\d+)*m")
STYLE = re.compile(r"\x1b\[[\d;]*m")
VARIABLES = ("NO_COLOR", "FORCE_COLOR", "TERM", "COLORTERM", "TTY_COMPATIBLE")


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("is_terminal", "variables", "has_colours", "has_styles"),
    [
        (True, {}, True, True),
        (True, {"NO_COLOR": "1"}, False, True),
        (True, {"NO_COLOR": ""}, True, True),
        (True, {"TERM": "dumb"}, False, False),
        (True, {"TERM": "dumb", "FORCE_COLOR": "1"}, False, False),
        (False, {}, False, False),
        (False, {"FORCE_COLOR": "1"}, True, True),
        (False, {"FORCE_COLOR": ""}, False, False),
        (False, {"FORCE_COLOR": "1", "NO_COLOR": "1"}, False, True),
    ],
)
def test_the_environment_has_its_say(
    is_terminal: bool,
    variables: dict[str, str],
    has_colours: bool,
    has_styles: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    for name, value in {"TERM": "xterm-256color", **variables}.items():
        monkeypatch.setenv(name, value)
    parts = [Summary([("status", "optimal"), ("cost", "5")], "bold green")]
    text = rendered(parts, stream=Terminal() if is_terminal else io.StringIO())
    assert bool(COLOUR.search(text)) == has_colours
    assert bool(STYLE.search(text)) == has_styles
    assert STYLE.sub("", text).splitlines() == ["status  optimal", "cost    5"]


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo-terminals")
@pytest.mark.parametrize("variables", [{}, {"NO_COLOR": "1"}])
def test_a_plan_on_a_terminal(variables: dict[str, str]) -> None:
    import pty

    environment = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "statehtn", "plan", *FILES]
    run = {"env": {**environment, "TERM": "xterm-256color", **variables}, "stdin": subprocess.DEVNULL}
    with subprocess.Popen(command, stdout=theirs, stderr=subprocess.DEVNULL, **run) as process:  # type: ignore[call-overload]
        os.close(theirs)
        text = b""
        while piece := _read(ours):
            text += piece
        assert process.wait(60) == 0
    os.close(ours)
    shown = text.decode()
    assert "optimal" in shown
    assert bool(COLOUR.search(shown)) == (not variables)


def _read(descriptor: int) -> bytes:
    """Return what comes from a pseudo-terminal; nothing once its other end is closed."""
    try:
        return os.read(descriptor, 1 << 16)
    except OSError:
        return b""
