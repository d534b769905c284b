"""Every file of the planning competition that is at hand is read, and written and read again."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

import pytest

from statehtn.hddl import HddlWarning, read_hddl, read_hddl_text, write_hddl

FOLDER = os.environ.get("STATEHTN_IPC", "")
DOMAINS = sorted(path for path in Path(FOLDER).glob("*/*") if path.is_dir()) if FOLDER else []

pytestmark = pytest.mark.skipif(not FOLDER, reason="STATEHTN_IPC does not name the folder of the IPC's benchmarks")


def problems(folder: Path) -> list[tuple[Path, Path]]:
    """Return pairs of a domain and a problem file; a domain belongs to one problem or to the whole folder."""
    found = []
    for problem in sorted(folder.glob("*.hddl")):
        if not problem.name.endswith("domain.hddl"):
            own = problem.with_name(f"{problem.stem}-domain.hddl")
            found.append((own if own.exists() else folder / "domain.hddl", problem))
    return found


@pytest.mark.parametrize("folder", DOMAINS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_every_problem_of_the_competition_is_read(folder: Path) -> None:
    pairs = problems(folder)
    assert pairs
    for domain, problem in pairs:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HddlWarning)  # a few name another domain, or an object twice
            read = read_hddl(domain, problem)
        assert read.network.subtasks
        assert read.domain.methods
        written = write_hddl(read)
        again = read_hddl_text(*written, strict=True)
        assert again == read
        assert write_hddl(again) == written
