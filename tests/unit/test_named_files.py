"""What pages name is there: files, modules, and in the tables from the paper to the code functions, too."""

from __future__ import annotations

import pkgutil
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from statehtn.compatible import SWITCHES
from tests.pages import ROOT

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
PAGES += sorted(path for folder in ("docs", "domains") for path in (ROOT / folder).rglob("*.md"))
FOLDERS = (ROOT, ROOT / "src" / "statehtn", ROOT / "relax")  # that paths in pages start from
TABLES = {ROOT / "README.md": 40, ROOT / "docs" / "paper-map.md": 60}  # the fewest names in each page's tables
FILE = r"[\w./-]*\w\.(?:py|hpp|cpp)"
_CODE = re.compile(r"`([^`]+)`")


def missing(page: str) -> list[str]:
    """The files and modules that a page names and that are not there. A name without a folder may be in any."""
    files = re.findall(rf"`({FILE})[`:]", page)
    gone = [name for name in files if not any((folder / name).is_file() for folder in FOLDERS)]
    gone = [name for name in gone if "/" in name or not any(True for part in FOLDERS[1:] for _ in part.rglob(name))]
    for name in re.findall(r"\bstatehtn(?:\.\w+)+", page):
        try:
            pkgutil.resolve_name(name)
        except (AttributeError, ModuleNotFoundError):
            gone.append(name)
    return gone


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_files_and_modules_are_there(page: Path) -> None:
    assert not missing(page.read_text(encoding="utf-8"))


def test_what_is_missing_is_found() -> None:
    page = (
        "`core/search.py`, `core/gone.py: f`, `search.py`, `gone.py`, statehtn.plan, `statehtn.core.gone`, statehtn.gon"
    )
    assert missing(page) == ["core/gone.py", "gone.py", "statehtn.core.gone", "statehtn.gon"]


def test_how_it_works_says_where() -> None:
    """Names without an ending, behind bold headings or in a middle column, are of files in relax/ or switches."""
    page = (ROOT / "docs" / "how-it-works.md").read_text(encoding="utf-8")
    places = re.findall(r"^\*\*.*?\*\* \((.*?)\)", page, re.MULTILINE) + re.findall(
        r"^\| .*?\|(.*?)\|", page, re.MULTILINE
    )
    stems = [name for place in places for name in _CODE.findall(place) if "/" not in name]
    assert len(stems) >= 30
    unknown = [stem for stem in stems if stem not in SWITCHES and not any((ROOT / "relax").rglob(f"{stem}.*pp"))]
    assert not unknown


def named(page: str) -> Iterator[tuple[Path, str | None]]:
    """Yield the files of a page's tables, and the names that stand behind each.

    A column's head says in which folder its files are: `folder/`. In its cells a file is followed by names.
    """
    folders: list[str | None] = []
    for line in page.splitlines():
        if not line.startswith("|"):
            folders = []
            continue
        cells = line.strip("|").split("|")
        if not folders:
            folders = [next((code for code in _CODE.findall(cell) if code.endswith("/")), None) for cell in cells]
            continue
        for folder, cell in zip(folders, cells, strict=True):
            path = None
            for code in _CODE.findall(cell) if folder is not None else ():
                if re.fullmatch(FILE, code):
                    path = ROOT / str(folder) / code
                    yield path, None
                elif path is not None:
                    yield path, code


@pytest.mark.parametrize("page", TABLES, ids=lambda path: path.name)
def test_tables_lead_from_the_paper_to_the_code(page: Path) -> None:
    found = list(named(page.read_text(encoding="utf-8")))
    assert len(found) >= TABLES[page]
    for path, name in found:
        assert path.is_file(), f"there is no {path.relative_to(ROOT)}"
        text = path.read_text(encoding="utf-8")
        for part in re.split(r"::|\.", name or ""):
            assert re.search(rf"\b{part}\b", text), f"{path.relative_to(ROOT)} has no {part}"


def test_files_and_names_are_read_from_tables() -> None:
    page = "| a | here: `tests/` |\n|---|---|\n| `x.py` | `pages.py`: `run_page`, `nothing`; `gone.py` |\n"
    tests = ROOT / "tests"
    files = [(tests / "pages.py", None), (tests / "pages.py", "run_page"), (tests / "pages.py", "nothing")]
    assert list(named(page)) == [*files, (tests / "gone.py", None)]
