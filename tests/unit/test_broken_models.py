"""Models with one mistake each, as beginners make them: the first finding names it."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import pytest

from statehtn.inspection import check
from tests.pages import ROOT

FOLDER = ROOT / "tests" / "broken"


@dataclass(frozen=True)
class Broken:
    """An entry of the corpus; corpus.toml says what its keys mean."""

    name: str
    file: str
    old: str
    new: str
    code: str
    names: str
    line: str = ""
    where: str = ""
    alone: bool = False

    @property
    def text(self) -> str:
        sound = (FOLDER / f"{self.file.replace(' ', '-')}.hddl").read_text(encoding="utf-8")
        assert sound.count(self.old) == 1, sound.count(self.old)
        return sound.replace(self.old, self.new)


CORPUS = [Broken(**entry) for entry in tomllib.loads((FOLDER / "corpus.toml").read_text(encoding="utf-8"))["model"]]


@pytest.mark.parametrize("model", ["delivery", "kitchen"])
def test_the_models_themselves_are_sound(model: str) -> None:
    domain, problem = FOLDER / f"{model}-domain.hddl", FOLDER / f"{model}-problem.hddl"
    assert [str(finding) for finding in check(domain)] == []
    assert [str(finding) for finding in check(domain, problem)] == []


def test_there_are_many() -> None:
    assert len({broken.name for broken in CORPUS}) == len(CORPUS) >= 60


@pytest.mark.parametrize("broken", CORPUS, ids=lambda broken: broken.name)
def test_the_first_finding_names_the_mistake(broken: Broken, tmp_path: Path) -> None:
    model, kind = broken.file.split()
    for other in ("domain", "problem"):
        text = (FOLDER / f"{model}-{other}.hddl").read_text(encoding="utf-8")
        (tmp_path / f"{other}.hddl").write_text(broken.text if other == kind else text, encoding="utf-8")
    findings = check(tmp_path / "domain.hddl", None if broken.alone else tmp_path / "problem.hddl")
    shown = "\n".join(map(str, findings))
    assert findings
    first = findings[0]
    assert first.code == broken.code, shown
    assert broken.names in first.message, shown
    if broken.line:
        file = tmp_path / f"{broken.where or kind}.hddl"
        line = file.read_text(encoding="utf-8").splitlines()[first.place.line - 1]
        assert first.place.file == str(file), shown
        assert broken.line.strip() in line, shown
