"""Whatever is done to a file, `check` has an answer, and its findings stand in the file."""

from __future__ import annotations

import re
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn.errors import InputError
from statehtn.inspection import CODES, check
from statehtn.limits import LimitReached
from tests.pages import ROOT

FOLDER = ROOT / "tests" / "broken"
TOKEN = re.compile(r"[()]|[^\s()]+|\s+")


@st.composite
def spoilt(draw: st.DrawFn, text: str) -> str:
    """A text with up to three of its words dropped, doubled, or replaced by other ones of it."""
    tokens = TOKEN.findall(text)
    for _ in range(draw(st.integers(1, 3))):
        place, other = draw(st.integers(0, len(tokens) - 1)), draw(st.integers(0, len(tokens) - 1))
        match draw(st.sampled_from(("drop", "double", "replace", "swap"))):
            case "drop":
                tokens[place] = ""
            case "double":
                tokens[place] = f"{tokens[place]} {tokens[place]}"
            case "replace":
                tokens[place] = tokens[other]
            case _:
                tokens[place], tokens[other] = tokens[other], tokens[place]
    return "".join(tokens)


@pytest.mark.parametrize("model", ["delivery", "kitchen"])
@given(data=st.data())
def test_there_is_an_answer(model: str, data: st.DataObject) -> None:
    texts = {kind: (FOLDER / f"{model}-{kind}.hddl").read_text(encoding="utf-8") for kind in ("domain", "problem")}
    kind = data.draw(st.sampled_from(("domain", "problem")))
    texts[kind] = data.draw(spoilt(texts[kind]))
    with TemporaryDirectory() as folder:
        files = {kind: Path(folder) / f"{kind}.hddl" for kind in texts}
        for each, text in texts.items():
            files[each].write_text(text, encoding="utf-8")
        try:
            findings = check(files["domain"], files["problem"], time_limit=20)
        except (InputError, LimitReached):
            return
    for finding in findings:
        assert finding.code in CODES
        assert finding.message
        lines = texts[Path(finding.place.file).stem].splitlines()
        assert 1 <= finding.place.line <= max(1, len(lines))
