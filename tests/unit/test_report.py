"""`statehtn report`: what the page says, what is left out, and how it says what is wrong."""

from __future__ import annotations

import json
import re
import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from statehtn.cli import main
from statehtn.experiments.report import tables
from statehtn.experiments.report.cases import best_of, cases_of, contradictions
from statehtn.experiments.report.paper_tables import agrees
from statehtn.experiments.report.results import printable, read_outcomes
from tests.regression.paper_tables import problem
from tests.results import invented, planned, record, write

pytest.importorskip("matplotlib", reason="the report draws")
pytest.importorskip("jinja2", reason="the report needs it")

Capture = pytest.CaptureFixture[str]
AGENTS = ["averse 0.9", "averse 0.1", "neutral", "seeking 0.1", "seeking 0.9"]
PAIR = [("state", "auto"), ("plan", "tdg")]
DASH, MINUS = tables.NOTHING, tables.MINUS


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What both solvers say about the paper's P1."""
    results = tmp_path_factory.mktemp("vehicle") / "results.csv"
    p1 = problem("av", "p1")
    return write(results, [planned(p1, "av", "p1", agent, solver=s) for agent in AGENTS for s in ("state", "plan")])


@pytest.fixture(scope="module")
def vehicle(results: Path) -> str:
    """The page about it."""
    return report(results)


def report(results: Path) -> str:
    output = results.with_suffix(".html")
    assert main(["report", str(results), "--output", str(output)]) == 0
    return output.read_text(encoding="utf-8")


def body(page: str) -> Element:
    """Parse the page's body, which is well-formed as XML, too, but for its script."""
    return ElementTree.fromstring(page[page.index("<body>") : page.index("<script>")] + "</body>")


def text(element: Element) -> str:
    return " ".join("".join(element.itertext()).split()).replace(MINUS, "-")


def section(page: str, name: str) -> Element:
    (found,) = (element for element in body(page).iter("section") if element.get("id") == name)
    return found


def sections(page: str) -> list[str | None]:
    return [element.get("id") for element in body(page).iter("section")]


def table(page: Element, label: str) -> list[list[str]]:
    """Return the cells of the table whose box has this label; the columns' headings first."""
    (box,) = (element for element in page.iter("div") if label in (element.get("aria-label") or ""))
    rows = [[text(cell) for cell in row] for row in box.iter("tr")]
    widest = max(map(len, rows))
    return [row for row in rows if len(row) == widest]


def test_the_paper_beside_ours(vehicle: str) -> None:
    page = section(vehicle, "paper")
    headings, *rows = table(page, "Autonomous vehicles")
    assert headings == [
        *("#P", "attitude", *["paper", "ours"] * 4),
        *("paper", "state auto", "plan tdg", "remark on the print"),
    ]
    by_agent = {row[1]: row for row in rows}
    assert by_agent["RA (0.9)"][:10] == [
        *("P1", "RA (0.9)", "-42514702.52", "-42514702.52", "-7.629", "-7.629", "-44.08", "-19.40", "9", "9")
    ]
    assert by_agent["RS (0.9)"][2:4] == ["0.117905e-3", "1.179045e-4"]
    assert by_agent["RN"][4:6] == [DASH, DASH]
    assert by_agent["RA (0.9)"][10] == "4.55"
    assert re.fullmatch(r"0\.\d{3}", by_agent["RA (0.9)"][11])
    # the misprint, and it alone unless the neutral agent has a longer plan of the same cost
    marked = [text(cell) for cell in page.iter("td") if cell.get("class") == "differs"]
    assert marked in (["-19.40"], ["-19.40", "9"])
    assert f"{19 - len(marked)} of 19 printed numbers agree" in text(page)
    assert "Satellite" not in text(page)


def test_what_is_not_proven_is_not_compared_with_the_paper(tmp_path: Path) -> None:
    records = [invented("av", "p1", status="solved", lower_bound=1.0), invented("av", "p2")]
    page = section(report(write(tmp_path / "r.csv", records)), "paper")
    assert [text(cell) for cell in page.iter("td") if cell.get("class") == "unproven"] == ["-3.40", "-3.40", "1"]
    assert [row[:4] for row in table(page, "Autonomous vehicles")[1:]] == [
        ["P1", "RN", "-18.35", "-3.40"],
        ["P2", "RN", "-25.41", "-3.40"],
    ]
    assert "agree with ours" not in text(page)


def test_a_picture_of_what_attitude_means(vehicle: str) -> None:
    costs = section(vehicle, "costs")
    (figure,) = costs.iter("figure")
    headings, *rows = table(figure, "p1")
    assert headings == ["agent", "expected", "value", "least", "5 %", "median", "95 %", "most"]
    assert [row[0] for row in rows] == ["averse 0.9", "averse 0.1", "neutral", "seeking 0.1", "seeking 0.9"]
    assert rows[0][1:] == ["19.4"] * 7  # certain
    assert rows[4][1:4] == ["22.8", "10.17", "5.5"]
    assert rows[4][-1] == "32"
    (plot,) = (svg for svg in figure.iter("svg") if svg.get("class") == "plot")
    assert "averse 0.9 from 19.4 to 19.4" in (plot.get("aria-label") or "")
    curves = [path.get("style") or "" for path in plot.iter("path")]
    assert sum("var(--averse-1)" in style for style in curves) == 1
    assert sum("var(--seeking-1)" in style for style in curves) == 1


def test_plans_by_objectives_are_compared_by_their_values(tmp_path: Path) -> None:
    p1 = problem("av", "p1")
    agents = ["averse 0.9", "neutral", "deadline 17", "cvar 0.95"]
    results = write(tmp_path / "r.csv", [planned(p1, "av", "p1", agent) for agent in agents])
    page = report(results)
    (figure,) = section(page, "costs").iter("figure")
    _, *rows = table(figure, "p1")
    assert {row[0]: row[2] for row in rows} == {
        "averse 0.9": "19.4",
        "neutral": "18.35",
        "deadline 17": "0.424",
        "cvar 0.95": "19.4",
    }
    (plot,) = (svg for svg in figure.iter("svg") if svg.get("class") == "plot")
    assert "deadline 17 from 15 to 26" in (plot.get("aria-label") or "")
    assert "No run contradicts another" in page


def test_both_solvers(vehicle: str) -> None:
    duels = section(vehicle, "duels")
    assert [text(caption) for caption in duels.iter("figcaption")] == [
        "time: state auto against plan tdg",
        "expansions: state auto against plan tdg",
    ]
    assert "Solved by both: 5 of 5." in text(duels)
    for plot in (svg for svg in duels.iter("svg") if svg.get("class") == "plot"):
        assert sum(text(title).startswith("p1, ") for title in plot.iter("title")) == 5
    assert table(section(vehicle, "coverage"), "by domain")[1:] == [["av", "5 of 5", "5 of 5"]]
    assert len(table(section(vehicle, "all"), "all problems")) == 11
    assert "No run contradicts another" in text(body(vehicle))


def test_ids_are_unique_and_every_reference_has_its_target(vehicle: str) -> None:
    elements = list(body(vehicle).iter())
    ids = Counter(element.get("id") for element in elements if element.get("id"))
    assert set(ids.values()) == {1}
    references = {value[1:] for e in elements if (value := e.get("href", "")).startswith("#")}
    references |= {match for e in elements for v in e.attrib.values() for match in re.findall(r"url\(#([^)]+)\)", v)}
    assert references <= set(ids)
    assert len(references) > 10
    for plot in (element for element in elements if element.get("class") == "plot"):
        assert all(e.tag in ("text", "title") or not e.text for e in plot.iter())
        assert not any(e.tail for e in plot.iter() if e is not plot)


def test_nothing_is_fetched_and_two_reports_are_the_same(results: Path, vehicle: str) -> None:
    assert report(results) == vehicle
    assert re.findall(r"https?:|@import|src=", vehicle) == []
    assert re.findall(r'href="(?!#)([^"]*)"', vehicle) == ["data:,"]
    assert "default-src 'none'" in vehicle


def test_sections_without_data_are_left_out(tmp_path: Path) -> None:
    certain = [invented(laws=[[(1.0, 4.0)]], risk_cost=4.0, lower_bound=4.0), invented(problem="p2", laws=None)]
    page = report(write(tmp_path / "certain.csv", certain))
    assert sections(page) == ["coverage", "all"]
    links = [a.get("href") for a in body(page).iter("a")]
    assert links == ["#coverage", "#all"]
    assert "contradict" not in text(body(page))
    assert sections(report(write(tmp_path / "one.csv", [invented()]))) == ["costs", "coverage", "all"]
    unsolved = report(write(tmp_path / "none.csv", [invented(status="time-limit", laws=None)]))
    assert sections(unsolved) == ["coverage", "all"]
    assert "<figure" not in unsolved


def test_what_went_wrong_is_counted(tmp_path: Path) -> None:
    records = [
        invented(problem="p1"),
        invented(problem="p1", repeat=2, status="time-limit", laws=None, lower_bound=2.0),  # not always solved
        invented(problem="p2", status="unsolvable", laws=None, lower_bound=None),
        record("errands", "p3", "neutral", status="killed"),
        record("errands", "p4", "neutral", status="error"),
        record("errands", "p5", "neutral", status="input-error"),
        invented(problem="p6", status="exhausted", laws=None, lower_bound=None),
        invented(problem="p7", status="solved", lower_bound=1.0, seconds=0.75),
    ]
    page = report(write(tmp_path / "r.csv", records))
    coverage = section(page, "coverage")
    assert table(coverage, "by domain")[1:] == [["errands", "2 of 7"]]
    (effort,) = table(coverage, "what it took")[1:]
    assert effort[:7] == ["state auto", "7", "0", "1", "2", "2", "2"]
    rows = {row[0]: row for row in table(section(page, "all"), "all problems")[1:]}
    assert rows["p1"][4:] == ["time-limit", "3.4", "3.4", "3.4", "1", "7", "0.250", "20"]
    assert rows["p3"][4:] == ["killed", *[DASH] * 7]
    assert "8: 2 optimal" not in page
    assert "8: 1 optimal, 1 time-limit, 1 unsolvable, 1 killed" in text(body(page))


def test_many_settings_and_domains(tmp_path: Path) -> None:
    names = ("blind", "tdg", "hmax", "lmcut", "potential", "auto", "ff", "add")
    records = [
        invented(f"d{d}", heuristic=name, seconds=0.01 * (d + 1), laws=[[(1.0, 4.0)]], risk_cost=4, lower_bound=4)
        for name in names
        for d in range(8)
        if d or name == "blind"
    ]
    page = report(write(tmp_path / "r.csv", records))
    duels = section(page, "duels")
    assert len(list(duels.iter("figure"))) == 12
    assert "Not shown here: state ff." in text(duels) or "Not shown here: state add." in text(duels)
    assert table(section(page, "coverage"), "by domain")[-1][0] == "all"


def test_unsolved_ones_stand_on_the_rim(tmp_path: Path) -> None:
    records = [
        invented(problem="both"),
        invented(problem="both", solver="plan", heuristic="tdg", seconds=0.5, expanded=0),
        invented(problem="one"),
        invented(problem="one", solver="plan", heuristic="tdg", status="memory-limit", laws=None),
        invented(problem="none", status="time-limit", laws=None),
        invented(problem="none", solver="plan", heuristic="tdg", status="time-limit", laws=None),
    ]
    duels = section(report(write(tmp_path / "r.csv", records)), "duels")
    words = (
        "Solved by both: 1 of 3. state auto needs less 1 times, plan tdg 0 times; the geometric mean is 2 times lower"
    )
    assert words in text(duels)
    assert "Solved by state auto alone: 1. By neither: 1." in text(duels)
    assert "not solved" in text(next(iter(duels.iter("svg"))))


def test_contradictions_are_shown(tmp_path: Path) -> None:
    lower = invented(solver="plan", heuristic="tdg", risk_cost=2.0, lower_bound=2.0)
    none = invented(problem="p2", solver="plan", heuristic="tdg", status="unsolvable", laws=None, lower_bound=None)
    fine = invented(problem="p3", solver="plan", heuristic="tdg", risk_cost=3.4 + 1e-9)
    records = [invented(), lower, invented(problem="p2"), none, invented(problem="p3"), fine]
    page = text(body(report(write(tmp_path / "r.csv", records))))
    assert "errands, p1, neutral: there is a plan of 2, and a proof that none is below 3.4" in page
    assert "errands, p2, neutral: there is a plan, and a proof that there is none" in page
    assert "p3, neutral: there" not in page
    cases = cases_of(read_outcomes(str(tmp_path / "r.csv")))
    assert len(contradictions(cases)) == 2


def test_the_best_plan_is_a_proven_one_of_the_cheapest(tmp_path: Path) -> None:
    records = [
        invented(heuristic="auto", status="solved", risk_cost=3.4),
        invented(heuristic="tdg", status="optimal", risk_cost=3.4 + 1e-9),
        invented(heuristic="lmcut", status="solved", risk_cost=5.0),
    ]
    best = best_of(cases_of(read_outcomes(str(write(tmp_path / "r.csv", records)))))
    assert best is not None
    assert best.settings == "state tdg"


NASTY = ["<script>alert(1)</script>", "a&b", "'\"><svg onload=x>", "$x_1^2$", "{{ 7 * 7 }}", "\udcff", "a\u2028b", "√"]
NAMES = st.text(st.characters(codec="utf-8", exclude_characters="\n\r"), min_size=1, max_size=20)


@settings(max_examples=25)  # each is a whole page
@given(domain=NAMES, name=NAMES)
def test_names_are_text(domain: str, name: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.mktemp("names") / "r.csv"
    root = body(report(write(path, [invented(domain, name, status="time-limit", laws=None)])))
    (row,) = table(root, "all problems")[1:]
    assert row[:2] == [" ".join(printable(name).split()), " ".join(printable(domain).split())]


def test_names_are_text_in_pictures_too(tmp_path: Path) -> None:
    records = [invented(name, name, solver=s, heuristic=h) for name in NASTY for s, h in PAIR]
    root = body(report(write(tmp_path / "r.csv", records)))
    assert list(root.iter("script")) == []
    assert not any("onload" in element.attrib for element in root.iter())
    captions = {(figure.get("id") or "")[:5]: text(figure) for figure in root.iter("figure")}
    assert set(captions) == {"costs", "duel-", "cactu"}
    shown = [(caption.text or "").strip() for caption in root.iter("figcaption")]
    tips = {text(title).partition(", neutral")[0] for title in root.iter("title")}
    for name in NASTY:
        assert printable(name) in shown
        assert printable(name) in tips


def test_a_comparison_that_goes_on_can_be_reported(tmp_path: Path) -> None:
    results = write(tmp_path / "r.csv", [invented()])
    for file, torn in ((results, "errands,p2,neu"), (results.with_suffix(".jsonl"), '{"key": ["err')):
        with file.open("a") as stream:
            stream.write(torn)
    assert "1 in 1 domain" in report(results)


def complaint(capsys: Capture, arguments: list[str]) -> tuple[int, str]:
    code = main(["report", *arguments])
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1, captured.err
    assert captured.err.startswith("error: ")
    return code, captured.err


def edited(results: Path, old: str, new: str) -> None:
    content = results.read_text()
    assert old in content
    results.write_text(content.replace(old, new, 1))


@pytest.mark.parametrize(
    ("file", "old", "new", "words"),
    [
        ("r.csv", "domain,problem", "problem,domain", "is no table of a comparison's results"),
        ("r.csv", "errands,p1,neutral,", "errands,p1,", "line 2 of '{}/r.csv' has 27 columns, expected 28"),
        ("r.csv", ",3.4,3.4,", ",3.4,cheap,", "line 2 of '{}/r.csv': 'value': expected a number, found 'cheap'"),
        ("r.csv", ",3.4,3.4,", ",3.4,inf,", "'value': expected a number, found 'inf'"),
        ("r.csv", "p1", "p9", "has no record of the run in line 2 of '{}/r.csv' (errands p9 neutral state auto 1)"),
        ("r.jsonl", '"key"', '"kye"', "line 1 of '{}/r.jsonl' is no record of a run"),
        ("r.jsonl", '{"key"', '["key"', "line 1 of '{}/r.jsonl' is no record of a run"),
        ("r.jsonl", "[0.8,", "[0.9,", "line 1 of '{}/r.jsonl' is no record of a run"),
        ("r.jsonl", '"outcomes": [', '"outcomes": [7, ', "line 1 of '{}/r.jsonl' is no record of a run"),
    ],
)
def test_broken_files(file: str, old: str, new: str, words: str, tmp_path: Path, capsys: Capture) -> None:
    results = write(tmp_path / "r.csv", [invented()])
    edited(tmp_path / file, old, new)
    code, line = complaint(capsys, [str(results), "--output", str(tmp_path / "r.html")])
    assert code == 30
    assert words.format(tmp_path) in line
    assert not (tmp_path / "r.html").exists()


def test_missing_files(tmp_path: Path, capsys: Capture) -> None:
    output = ["--output", str(tmp_path / "r.html")]
    code, line = complaint(capsys, [str(tmp_path / "no.csv"), *output])
    assert (code, "cannot read" in line, "no.csv" in line) == (30, True, True)
    results = write(tmp_path / "r.csv", [invented()])
    results.with_suffix(".jsonl").unlink()
    code, line = complaint(capsys, [str(results), *output])
    assert (code, "cannot read" in line, "r.jsonl" in line) == (30, True, True)
    empty = write(tmp_path / "empty.csv", [])
    code, line = complaint(capsys, [str(empty), *output])
    assert (code, "there is no run in" in line) == (30, True)
    empty.write_bytes(b"\x00\xff\n")
    assert complaint(capsys, [str(empty), *output])[0] == 30


def test_wrong_outputs(tmp_path: Path, capsys: Capture) -> None:
    results = write(tmp_path / "r.csv", [invented()])
    before = results.read_text()
    for name in ("r.csv", "r.jsonl"):
        code, line = complaint(capsys, [str(results), "--output", str(tmp_path / name)])
        assert (code, "would replace the input" in line) == (2, True)
    code, line = complaint(capsys, [str(results), "--output", str(tmp_path / "no/r.html")])
    assert (code, "no directory" in line) == (2, True)
    assert results.read_text() == before


@pytest.mark.parametrize("package", ["jinja2", "matplotlib"])
def test_a_missing_package(package: str, results: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    code, line = complaint(capsys, [str(results), "--output", str(results.with_suffix(".html"))])
    assert code == 2
    assert f"needs the package '{package}': pip install 'statehtn[report]'" in line


def test_agreement_is_to_half_a_digit() -> None:
    assert agrees(1.2345, "1.23")
    assert agrees(1.235, "1.24")
    assert not agrees(1.2351, "1.23")
    assert agrees("-4.25147e+07", "-4.25147E+7")
    assert not agrees(19.4, "44.08")


def test_the_last_of_two_records_counts(tmp_path: Path) -> None:
    results = write(tmp_path / "r.csv", [invented()])
    lines = results.with_suffix(".jsonl")
    later = json.loads(lines.read_text())
    later["machine"] = "another"
    lines.write_text(lines.read_text() + json.dumps(later) + "\n")
    (outcome,) = read_outcomes(str(results))
    assert outcome.machine == "another"
