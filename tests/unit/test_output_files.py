"""Files of results: every better plan at once, whole or not at all, and none that does not belong to the run."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

import statehtn
from statehtn import Status
from statehtn.cli import files, main
from statehtn.cli.streams import OutputError
from statehtn.limits import Limits
from statehtn.pipeline import solutions
from statehtn.session import Session
from statehtn.settings import Settings
from tests.processes import start
from tests.test_minimal import DOMAIN, PROBLEM
from tests.unit.test_planner import ENDLESS_DOMAIN, ENDLESS_PROBLEM, UNSOLVABLE

Capture = pytest.CaptureFixture[str]

A_PLAN_AND_NO_PROOF = ENDLESS_DOMAIN.replace(
    "(:task wander",
    "(:task arrive :parameters ()) (:method by-taxi :parameters () :task (arrive) :ordered-subtasks (and (ride)))"
    " (:method on-foot :parameters () :task (arrive) :ordered-subtasks (and (wander) (be-everywhere)))"
    " (:action ride :parameters () :effect (increase (total-cost) 100000)) (:task wander",
    1,
)
ARRIVE = ENDLESS_PROBLEM.replace("(wander) (be-everywhere)", "(arrive)")


@pytest.fixture
def inputs(tmp_path: Path) -> list[str]:
    return written(tmp_path, DOMAIN, PROBLEM)


def written(folder: Path, domain: str, problem: str) -> list[str]:
    (folder / "in").mkdir(exist_ok=True)
    names = [folder / "in" / "domain.hddl", folder / "in" / "problem.hddl"]
    for name, text in zip(names, (domain, problem), strict=True):
        name.write_text(text)
    return [str(name) for name in names]


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGHUP, signal.SIGTERM])
def test_a_better_plan_is_in_the_file_before_the_run_ends(tmp_path: Path, number: signal.Signals) -> None:
    inputs = written(tmp_path, A_PLAN_AND_NO_PROOF, ARRIVE)
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "plan").write_text("of an earlier run")
    with start("plan", *inputs, "--search", "anytime", "--output", str(folder / "plan"), "--quiet") as process:
        deadline = time.monotonic() + 120
        while not (folder / "plan").read_text().startswith("==>") and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(number)
        output, errors = process.communicate(timeout=120)
    assert (folder / "plan").read_text() == "==>\n0 ride\nroot 1\n1 arrive -> by-taxi 0\n<==\n"
    assert [path.name for path in folder.iterdir()] == ["plan"]
    expected = (-signal.SIGKILL, "") if number is signal.SIGKILL else (0, "(ride)\n")
    assert (process.returncode, output) == expected, errors


@pytest.mark.parametrize(
    ("problem", "options", "code"),
    [
        (UNSOLVABLE, [], 10),
        (PROBLEM, ["--time-limit", "0.000001"], 20),
        (PROBLEM, ["--memory-limit", "1"], 21),
        (UNSOLVABLE, ["--search", "anytime"], 10),
    ],
)
def test_without_a_plan_no_file_stays(tmp_path: Path, problem: str, options: list[str], code: int) -> None:
    target = tmp_path / "plan"
    link = tmp_path / "link"
    link.symlink_to("plan")
    for name in (target, link):
        target.write_text("of an earlier run")
        assert main(["plan", *written(tmp_path, DOMAIN, problem), *options, "--output", str(name)]) == code
        assert not target.exists()
    assert link.is_symlink()


@pytest.mark.parametrize(
    ("domain", "options", "code"),
    [
        (DOMAIN, ["--alpha", "-1"], 2),
        (DOMAIN, ["--costs", "missing.toml"], 30),
        (DOMAIN.replace("(home) (away)", "(home)"), [], 30),
        (DOMAIN.replace("(and (away)", "(and (forall (?x) (assign (total-cost) 3)) (away)"), [], 31),
    ],
)
def test_after_a_mistake_every_file_stays(tmp_path: Path, domain: str, options: list[str], code: int) -> None:
    target = tmp_path / "plan"
    target.write_text("of an earlier run")
    assert main(["plan", *written(tmp_path, domain, PROBLEM), *options, "--output", str(target)]) == code
    assert target.read_text() == "of an earlier run"


@pytest.mark.parametrize("command", [["plan", "--quiet"], ["graph", "--format", "dot"]])
@pytest.mark.parametrize("problem", [PROBLEM, UNSOLVABLE])
def test_inputs_are_not_replaced(tmp_path: Path, command: list[str], problem: str, capsys: Capture) -> None:
    inputs = written(tmp_path, DOMAIN, problem)
    costs = tmp_path / "costs.toml"
    costs.write_text("[actions.take-train]\nvalue = 1\n")
    (tmp_path / "link").symlink_to(costs)
    (tmp_path / "twin").hardlink_to(costs)
    before = {name: Path(name).read_text() for name in (*inputs, str(costs))}
    for output in (*inputs, str(costs), str(tmp_path / "in" / ".." / "link"), str(tmp_path / "twin")):
        assert main([*command, *inputs, "--costs", str(costs), "--output", output]) == 2
        assert f"'{output}' would replace the input '" in capsys.readouterr().err
    assert {name: Path(name).read_text() for name in before} == before


def test_an_input_on_standard_input_is_not_replaced(inputs: list[str]) -> None:
    with open(inputs[0]) as domain, start("plan", "-", inputs[1], "--output", inputs[0], stdin=domain) as process:
        assert "would replace the input" in process.communicate(timeout=120)[1]
    assert (process.returncode, Path(inputs[0]).read_text()) == (2, DOMAIN)


@pytest.mark.parametrize("command", [["plan", "--quiet"], ["graph", "--format", "dot"]])
def test_samples_that_costs_are_read_from_are_not_replaced(
    tmp_path: Path, inputs: list[str], command: list[str], capsys: Capture
) -> None:
    (tmp_path / "samples.txt").write_text("1 2 3")
    costs = tmp_path / "costs.toml"
    costs.write_text('[[costs]]\naction = "take-train"\nsamples = "samples.txt"\n')
    output = str(tmp_path / "samples.txt")
    assert main([*command, *inputs, "--costs", str(costs), "--output", output]) == 2
    assert f"'{output}' would replace the input '{output}'" in capsys.readouterr().err
    assert (tmp_path / "samples.txt").read_text() == "1 2 3"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_that_nobody_reads_ends_at_the_limit(tmp_path: Path, inputs: list[str], capsys: Capture) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert main(["plan", *inputs, "--quiet", "--output", str(tmp_path / "pipe"), "--time-limit", "1"]) == 74
    captured = capsys.readouterr()
    assert "nobody reads it" in captured.err
    assert captured.out  # the plan was found


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_reader_that_stops_does_not_hold_up_a_run(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    try:
        with pytest.raises(OutputError, match="nobody reads it"):
            files.OutputFile(str(tmp_path / "pipe")).write("x" * 10**7, Limits.starting_now(0.2))
    finally:
        os.close(reader)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_pipes_and_devices_are_not_removed(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    unsolvable = written(tmp_path, DOMAIN, UNSOLVABLE)
    assert main(["plan", *unsolvable, "--quiet", "--output", str(tmp_path / "pipe")]) == 10
    assert (tmp_path / "pipe").is_fifo()
    assert main(["plan", *unsolvable, "--quiet", "--output", os.devnull]) == 10
    assert Path(os.devnull).is_char_device()


def test_a_named_pipe_takes_one_plan(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    arguments = ["plan", *written(tmp_path, DOMAIN, PROBLEM), "--search", "anytime", "--quiet"]
    with start(*arguments, "--output", str(tmp_path / "pipe")) as process:
        text = (tmp_path / "pipe").read_text()
        process.communicate(timeout=120)
    assert (process.returncode, text.count("==>"), text.count("<==")) == (0, 1, 1)


@pytest.mark.parametrize("name", ["-", "/dev/stdout", "/dev/fd/1"])
@pytest.mark.parametrize("to_a_file", [False, True])
def test_the_plan_goes_to_standard_output(inputs: list[str], tmp_path: Path, name: str, to_a_file: bool) -> None:
    if not to_a_file:
        process = start("plan", *inputs, "--output", name)
        output, errors = process.communicate(timeout=120)
    else:  # which must neither be replaced nor emptied
        (tmp_path / "all").write_text("before\n")
        with open(tmp_path / "all", "a") as file:
            process = start("plan", *inputs, "--output", name, stdout=file)
            _, errors = process.communicate(timeout=120)
        head, output = (tmp_path / "all").read_text().split("\n", 1)
        assert head == "before"
    assert process.returncode == 0
    assert output == "==>\n0 take-car\nroot 1\n1 errand -> by-car 0\n<==\n"
    assert "optimal: no plan of this problem has a higher expected utility" in errors


def test_only_the_plan_goes_there_if_told_to_be_quiet(inputs: list[str], capsys: Capture) -> None:
    assert main(["plan", *inputs, "--quiet", "--output", "-"]) == 0
    captured = capsys.readouterr()
    assert (captured.out[:4], captured.out[-4:], captured.err) == ("==>\n", "<==\n", "")
    assert main(["plan", *inputs, "--json", "--output", "-"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "leave out one" in captured.err


def test_standard_input_is_a_file(inputs: list[str]) -> None:
    for position in (0, 1):
        with open(inputs[position]) as file:
            names = [*inputs[:position], "-", *inputs[position + 1 :]]
            process = start("plan", *names, "--quiet", stdin=file)
            assert process.communicate(timeout=120) == ("(take-car)\n", "")
    process = start("validate", *inputs, "-", stdin=subprocess.PIPE)
    output, _ = process.communicate("==>\n0 take-car\nroot 1\n1 errand -> by-car 0\n<==\n", timeout=120)
    assert (process.returncode, "valid" in output) == (0, True)


def test_standard_input_is_one_file_only(capsys: Capture) -> None:
    assert main(["plan", "-", "-"]) == 2
    assert "standard input can be one file only" in capsys.readouterr().err


@pytest.mark.parametrize("command", [["plan"], ["top", "2"]])
def test_a_name_that_is_too_long(inputs: list[str], command: list[str], capsys: Capture) -> None:
    assert main([*command, *inputs, "--output", "x" * 300]) == 74
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: cannot write 'xxx")
    assert captured.err.count("\n") == 1


def test_the_longest_name_that_there_is(inputs: list[str], tmp_path: Path) -> None:
    target = tmp_path / ("x" * 255)
    for _ in range(2):
        assert main(["plan", *inputs, "--quiet", "--output", str(target)]) == 0
    assert target.read_text().startswith("==>")


def test_without_nameless_files_plans_are_replaced_whole(
    inputs: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unknown(*_: object) -> None:
        raise OSError(95, "not supported")

    monkeypatch.setattr(files, "_replace_by_nameless_file", unknown)
    target = tmp_path / "out" / "plan"
    target.parent.mkdir()
    for _ in range(2):
        assert main(["plan", *inputs, "--quiet", "--output", str(target)]) == 0
        assert target.read_text().startswith("==>")
        assert [path.name for path in target.parent.iterdir()] == ["plan"]


def test_an_interruption_loses_no_plan_that_was_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def interrupted(output: files.OutputFile, text: str, limits: Limits) -> None:
        writing(output, text, limits)
        monkeypatch.setattr(files.OutputFile, "write", writing)
        raise KeyboardInterrupt

    writing = files.OutputFile.write
    monkeypatch.setattr(files.OutputFile, "write", interrupted)
    target = tmp_path / "plan"
    arguments = ["plan", *written(tmp_path, A_PLAN_AND_NO_PROOF, ARRIVE), "--search", "anytime", "--quiet"]
    assert main([*arguments, "--output", str(target)]) == 0
    assert target.read_text().startswith("==>\n0 ride\n")
    assert capsys.readouterr().out == "(ride)\n"


def test_graphs_and_pages_go_to_pipes(inputs: list[str], capsys: Capture) -> None:
    assert main(["graph", *inputs, "--output", "-", "--format", "graphml"]) == 0
    assert capsys.readouterr().out.rstrip().endswith("</graphml>")
    assert main(["graph", *inputs, "--output", "-"]) == 2
    assert "--format" in capsys.readouterr().err


def test_plans_of_top_are_files_of_a_folder(inputs: list[str], capsys: Capture) -> None:
    assert main(["top", "2", *inputs, "--output", "-"]) == 2
    assert "folder" in capsys.readouterr().err


def test_better_plans_come_with_their_problem(tmp_path: Path) -> None:
    files = written(tmp_path, A_PLAN_AND_NO_PROOF, ARRIVE)
    session = Session(lambda limits: statehtn.read_hddl(*files, limits=limits))
    first, *others = solutions(session, Settings.of(search="anytime"), Limits.starting_now(1.0), every_plan=True)
    assert session.problem is not None
    assert [str(step.step) for step in first.steps] == ["(ride)"]
    assert others[-1].stopped is Status.TIME_LIMIT
    assert others[-1].plan is first.plan  # it is validated once
