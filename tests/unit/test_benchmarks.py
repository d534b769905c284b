"""What the benchmarks make of measurements: tables, means, choices and fits. Nothing is timed."""

from __future__ import annotations

import csv
import re
from argparse import Namespace
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, fields, replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn.compatible import PRICE_SWITCHES
from statehtn.core.heuristics import ADMISSIBLE
from statehtn.experiments.run import Grid, Instance
from statehtn.experiments.suites import runs_of
from tests.benchmarks import limits
from tests.benchmarks.ablation import ablation_table, by_configuration, other_costs
from tests.benchmarks.growth import MEASURES, exponent_table, families, fit, points
from tests.benchmarks.limits_case import Case as LimitedCase
from tests.benchmarks.limits_case import Recorder
from tests.benchmarks.limits_case import measure as measure_limits
from tests.benchmarks.records import Row, read_runs
from tests.benchmarks.search import baseline_of, compared
from tests.benchmarks.search_summary import Compared, domain_table, effort_table, ratios_of_bytes, summary
from tests.benchmarks.suite import ablation_suite, search_suite
from tests.benchmarks.tables import measure_all, read_rows, table

ROOT = Path(__file__).parents[2]
AV = ROOT / "domains" / "av"
RUN = Row("total-order/A", "p1", "state", "auto", "optimal", 3.0, expanded=10, evaluated=20, search_seconds=0.01)
EASY = Compared(**vars(RUN), baseline_cost=3.0, baseline_seconds=1.0, baseline_expanded=40)
HARD = replace(EASY, problem="p2", search_seconds=0.5, baseline_seconds=0.25)
OPEN = Compared("total-order/B", "p1", "state", "auto", "time-limit", search_seconds=5.0)
LINE = {"order": "total", "domain": "A", "problem": "p1", "status": "solved", "cost": "3", "search_time": "2"}
LINE |= {"search_time_low_h_ties": "1", "expanded": "40", "generated": "", "engine_mem_mb": "", "engine_limit": "5"}


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split("|")]


def test_the_better_time_of_the_baseline_counts_and_an_unsolved_line_has_none() -> None:
    assert baseline_of(LINE)["baseline_seconds"] == 1.0
    # A search that was ended early, by memory say, has a time below its limit all the same.
    assert "baseline_seconds" not in baseline_of(LINE | {"status": "timeout", "cost": "", "search_time": "2.5"})


def test_summary_compares_what_both_solve_and_names_the_rest() -> None:
    lines = list(summary([EASY, HARD, OPEN], markdown=False))
    assert lines[0] == "proven optimal: 2 of 3; by the baseline 2"
    assert lines[1] == "100.0 times as fast where the baseline needs 0.5 s (1 problems, geometric mean)"
    assert lines[2] == "7.1 times as fast where the baseline needs 0.1 s (2 problems, geometric mean)"
    assert "Slower by more than 0.1 s: 1" in lines
    assert "  total-order/A p2: 0.50 s, baseline 0.25 s" in lines
    assert "  total-order/B p1: time-limit, baseline neither" in lines


def test_summary_names_another_optimal_cost() -> None:
    lines = list(summary([replace(EASY, risk_cost=4.0)], markdown=True))
    assert "- total-order/A p1: 4.0, baseline 3.0" in lines


def test_domain_table_has_a_line_for_each_domain_and_one_for_all() -> None:
    lines = list(domain_table([EASY, HARD, OPEN]))
    assert [cells(line)[0] for line in lines[2:]] == ["total-order/A", "total-order/B", "**all**"]
    assert cells(lines[2])[1:] == ["2/2", "2", "100.0", "7.1", "p1", "0.010", "1.000", "100.0"]
    assert cells(lines[3])[1:] == ["0/1", "0", "", "", "", "", "", ""]


def test_effort_table_tells_bytes_beyond_the_smallest_process_and_the_time_of_an_evaluation() -> None:
    many = replace(EASY, generated=200_000, peak_memory_mb=70.0)
    small = replace(EASY, problem="p0", evaluated=1, peak_memory_mb=50.0)
    (line,) = list(effort_table([many, small]))[2:]
    assert cells(line)[1:] == ["p1", "10", "200000", "20", "100", "500000"]


def test_bytes_per_node_are_compared_where_both_have_many_nodes() -> None:
    many = replace(EASY, generated=200_000, peak_memory_mb=70.0, baseline_generated=100_000, baseline_memory_mb=52.0)
    few = replace(many, peak_memory_mb=50.0, baseline_generated=10, baseline_memory_mb=12.0)
    assert ratios_of_bytes([many, few]) == [pytest.approx(100 / 400)]


def test_runs_are_put_beside_the_baseline_by_their_names() -> None:
    assert compared([RUN, replace(RUN, problem="p9")], [LINE, LINE | {"problem": "p3"}]) == [EASY]
    assert [row.solved for row in compared([replace(RUN, search_seconds=5.1)], [LINE])] == [False]


def test_a_table_is_aligned_and_has_as_many_cells_in_every_line() -> None:
    assert list(table(("a", "bb"), [("long", "1")])) == ["| a    | bb |", "|------|---:|", "| long |  1 |"]


ROWS = st.builds(Row, *[st.text("ab ", min_size=1)] * 5, st.none() | st.floats(0, 1e9), st.none() | st.integers(0, 99))


@given(st.lists(ROWS, max_size=5))
def test_rows_come_back_from_csv(tmp_path_factory: pytest.TempPathFactory, rows: list[Row]) -> None:
    path = tmp_path_factory.mktemp("rows") / "rows.csv"
    write(path, rows)
    assert read_rows(Row, path) == rows


def write(path: Path, rows: Sequence[Row]) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(Row)])
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)


def test_of_a_repeated_run_that_of_median_time_counts(tmp_path: Path) -> None:
    write(tmp_path / "rows.csv", [replace(RUN, search_seconds=seconds) for seconds in (3.0, 1.0, 2.0)])
    assert read_runs(tmp_path / "rows.csv") == [replace(RUN, search_seconds=2.0)]


def test_what_is_measured_already_is_not_measured_again(tmp_path: Path) -> None:
    options = Namespace(output=tmp_path / "rows.csv", resume=True, jobs=2)
    other = replace(RUN, problem="p2")
    assert measure_all(Row, {RUN.name: lambda: RUN}, options, str) == [RUN]
    assert measure_all(Row, {RUN.name: pytest.fail, other.name: lambda: other}, options, str) == [RUN, other]
    assert read_rows(Row, options.output) == [RUN, other]


INSTANCES = {RUN.name: Instance("total-order/A", "p1", str(AV / "domain.hddl"), str(AV / "p1.hddl"))}


def test_the_suite_of_a_baseline_has_its_limits(tmp_path: Path) -> None:
    (tmp_path / "search.toml").write_text("\n".join(search_suite(INSTANCES, [LINE])))
    (run,) = runs_of(str(tmp_path / "search.toml"), Grid())
    assert (f"{run.instance.domain} {run.instance.problem}", run.time_limit) == (RUN.name, 65.0)
    assert f"{run.settings.solver} {run.settings.heuristic}" == RUN.configuration


def test_the_suite_of_an_ablation_lacks_one_thing_at_a_time(tmp_path: Path) -> None:
    (tmp_path / "ablation.toml").write_text("\n".join(ablation_suite(INSTANCES, [replace(RUN, parse_seconds=0.49)])))
    first, *others = [run.settings for run in runs_of(str(tmp_path / "ablation.toml"), Grid())]
    assert (first.heuristic, first.without) == ("auto", ())
    assert {one.without for one in others if one.heuristic == "auto"} == {(name,) for name in PRICE_SWITCHES}
    assert {one.heuristic for one in others if not one.without} == set(ADMISSIBLE)
    assert all(len(one.without) + (one.heuristic != "auto") == 1 for one in others)
    assert {run.time_limit for run in runs_of(str(tmp_path / "ablation.toml"), Grid())} == {11.0}


def test_problems_that_are_too_short_or_unsolved_are_not_in_an_ablation() -> None:
    left_out = replace(RUN, search_seconds=0.001), replace(RUN, status="time-limit"), replace(RUN, heuristic="tdg")
    assert len(list(ablation_suite(INSTANCES, left_out))) == 1


def test_ablation_table_counts_an_unsolved_problem_as_twenty_times_as_long() -> None:
    complete = [replace(RUN, search_seconds=1.0), replace(RUN, problem="p2", search_seconds=1.0)]
    lacking = [replace(row, solver="state without x", search_seconds=5.0, expanded=40) for row in complete]
    lacking[1] = replace(lacking[1], status="time-limit")
    unsolved = replace(RUN, problem="p3", status="memory-limit")
    lines = list(ablation_table(by_configuration([*lacking, *complete, unsolved, replace(lacking[0], problem="p3")])))
    assert cells(lines[2]) == ["state auto", "2/2", "1.00", "1.00", "0", "0"]
    assert cells(lines[3]) == ["state without x auto", "1/2", "10.00", "4.00", "2", "0"]
    assert len(lines) == 4


def test_another_optimal_cost_of_a_variant_is_named() -> None:
    found = by_configuration([RUN, replace(RUN, solver="state without x", risk_cost=2.0)])
    assert other_costs(found) == ["state without x auto: total-order/A p1: 2.0, not 3.0"]


@given(st.floats(-2, 5), st.floats(1e-3, 1e3), st.sets(st.integers(10, 10**5), min_size=3, max_size=8))
def test_fit_finds_the_exponent_of_a_power(exponent: float, factor: float, sizes: set[int]) -> None:
    found = fit([(size, factor * size**exponent) for size in sorted(sizes)])
    assert found is not None
    assert found.exponent == pytest.approx(exponent, abs=1e-3)


def test_growth_leaves_out_what_is_unsolved_or_too_short() -> None:
    row = Row("F", "p", "state", "auto", "optimal", search_seconds=0.1, actions=60, methods=40)
    rows = [row, replace(row, search_seconds=1e-5), replace(row, status="time-limit")]
    assert points(rows, MEASURES[0]) == [(100, 0.1)]
    assert fit(points(rows, MEASURES[0])) is None
    assert cells(list(exponent_table({"F": rows}))[2]) == ["F", "seconds of search", "too few problems", "1", ""]


def test_the_suite_of_growth_finds_its_problems() -> None:
    runs = runs_of(str(ROOT / "tests/benchmarks/growth.toml"), Grid(repeat=1))
    sizes = Counter(run.instance.domain for run in runs)
    assert sizes == {"Satellite": len(range(3, 11)), "Vehicle": len(list(AV.glob("p*.hddl")))}


@pytest.mark.parametrize("page", sorted((ROOT / "docs/benchmarks").glob("*.md")), ids=lambda page: page.name)
def test_the_commands_of_the_pages_have_their_options(page: Path) -> None:
    for module, arguments in re.findall(r"python -m tests\.benchmarks\.(\w+)([^`\n|>]*)", page.read_text("utf-8")):
        files = [ROOT / f"tests/benchmarks/{name}.py" for name in (module, "tables")]
        known = "".join(file.read_text("utf-8") for file in files)
        options = re.findall(r"--[a-z-]+", re.sub(r'"[^"]*"', "", arguments))
        assert [option for option in options if f'add_argument("{option}"' not in known] == []


def test_memory_grows_from_that_of_the_smallest_process() -> None:
    rows = [
        replace(RUN, domain=name, peak_memory_mb=memory) for name, memory in (("A", 50.0), ("B", 70.0), ("B", None))
    ]
    assert {name: [row.peak_memory_mb for row in own] for name, own in families(rows).items()} == {
        "A": [0.0],
        "B": [20.0, None],
    }


def test_a_growth_figure_is_drawn(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    from tests.benchmarks.growth_plot import draw

    row = Row("F", "p", "state", "auto", "optimal", methods=40)
    rows = [replace(row, actions=60 * k, search_seconds=0.1 * k, peak_memory_mb=50.0 + k) for k in (1, 2, 3)]
    files = [tmp_path / "growth.svg", tmp_path / "growth.png"]
    draw(families([*rows, replace(row, domain="unsolved", status="time-limit")]), files)
    assert "ground actions and methods" in files[0].read_text(encoding="utf-8")
    assert files[1].read_bytes().startswith(b"\x89PNG")


def test_recorder_keeps_the_longest_stretch_and_its_ends() -> None:
    times = iter((1.0, 1.5, 4.0, 4.25))
    recorder = Recorder(lambda: next(times))
    for place in ("begin", "middle", "late", "end"):
        recorder.note(place)
    assert recorder.longest == 2.5
    assert recorder.between == ("middle", "late")


def test_limits_summary_counts_what_is_over_the_marks() -> None:
    held = limits.Row("A", "p1", "", 20, 1.0, 0.1, "x", "y", 0.05, 100.0, 200.0)
    late = replace(held, problem="p2", longest_stretch=0.75, overrun=0.5, peak_memory_mb=230.0)
    slow_to_stop = replace(held, signal="TERM", overrun=2.0)
    crashed = limits.Row("A", "p3", exit_code=-11, message="gone")
    lines = list(limits.summary([held, late, slow_to_stop, crashed], markdown=False))
    assert lines[0] == "runs: 4; with a plan or a proof: 0"
    assert lines[1] == "longest stretch between two looks, s: at most 0.750; over 0.3: 1 of 3"
    assert lines[2] == "time after the limit, s: at most 0.500; over 0.3: 1 of 2"
    assert lines[3] == "time after a signal, s: at most 2.000; over 0.3: 1 of 1"
    assert lines[4] == "peak of memory, in parts of the limit: at most 1.150; over 1.1: 1 of 3"
    assert lines[-2:] == ["Ended otherwise: 1", "  A p3: -11 gone"]


def test_a_limited_run_is_measured_in_a_process_of_its_own() -> None:
    command = ("plan", str(AV / "domain.hddl"), str(AV / "p1.hddl"), "--quiet")
    found = measure_limits(LimitedCase(command, 60.0, 4000.0))
    assert found["exit_code"] == 0, found["message"]
    assert 0 < found["longest_stretch"] < found["cpu_seconds"]
    assert found["overrun"] is None
    assert found["peak_memory_mb"] > 1
