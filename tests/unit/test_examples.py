"""The examples run, and do what they say."""

from __future__ import annotations

import runpy
import subprocess
import sys
from pathlib import Path

import statehtn
from tests.pages import blocks

ROOT = Path(__file__).parents[2]


def test_the_vehicle_from_python_is_the_vehicle_from_hddl() -> None:
    built = runpy.run_path(str(ROOT / "examples" / "vehicle.py"))["vehicle"]()
    read = statehtn.read_hddl(ROOT / "domains" / "av" / "domain.hddl", ROOT / "domains" / "av" / "p1.hddl")
    assert built == read
    assert statehtn.read_hddl_text(*statehtn.write_hddl(built), strict=True) == read


def test_the_vehicle_plans_for_three_agents() -> None:
    run = subprocess.run(
        [sys.executable, str(ROOT / "examples" / "vehicle.py")], capture_output=True, text=True, check=True, timeout=120
    )
    assert run.stdout.count("status: optimal") == 3
    in_all = [line.split()[2:] for line in run.stdout.splitlines() if "in all" in line]
    assert in_all == [["19.4", "19.4"], ["18.35", "18.35"], ["22.8", "10.16777339"]]
    assert run.stderr == ""


def test_the_demo_is_what_the_readme_shows() -> None:
    av = ROOT / "domains" / "av"
    run = subprocess.run(
        [sys.executable, str(ROOT / "examples" / "demo.py"), str(av / "domain.hddl"), str(av / "p1.hddl")],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    shown = next(block.text for block in blocks(readme) if "for averse 0.9" in block.text)
    printed = run.stdout.split("\n\n")
    start, end = shown.split("\n\n...\n")
    assert start == "\n\n".join(printed[:2])
    assert end == "\n\n".join(printed[-2:])
