"""One run of the command line in a process of its own, and how well its limits held: what `limits` measures.

From inside, the process's own time (CPU) between two looks at the limits: calls of `statehtn.limits.Limits.check` in
Python; in the core, where the looks are cheaper than a record of them, the moments at which it lets Python handle
signals, which it does at a look, every 50 ms. The figure is thus up to 60 ms too high there, and it is also how long
Ctrl-C waits. From outside, the CPU time that a run takes after its time limit, or after a signal, and its peak of
memory.
"""

from __future__ import annotations

import functools
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

from statehtn.effort import peak_memory_mb

GRACE = 30.0  # seconds after the limit or the signal when a process is ended from outside
SAMPLE_SECONDS = 0.01
SIGNALS = {"": None, "INT": signal.SIGINT, "TERM": signal.SIGTERM}


@dataclass(frozen=True)
class Case:
    """A command with a limit of `seconds`, or one that gets a signal after them; `memory_mb` is a limit in any case."""

    arguments: tuple[str, ...]
    seconds: float
    memory_mb: float
    signal: str = ""

    def command(self) -> list[str]:
        seconds = self.seconds + (10 * GRACE if self.signal else 0)
        return [*self.arguments, "--time-limit", f"{seconds:g}", "--memory-limit", f"{self.memory_mb:g}"]


class Recorder:
    """Keeps the longest stretch of the process's own time between two looks, and what stood at its two ends."""

    def __init__(self, clock: Callable[[], float] = time.process_time) -> None:
        self.clock = clock
        self.longest = 0.0
        self.between = ("", "")
        self._last: tuple[float, str] | None = None

    def note(self, place: str) -> None:
        """Record a look at the limits."""
        now = self.clock()
        if self._last is not None and now - self._last[0] > self.longest:
            self.longest = now - self._last[0]
            self.between = (self._last[1], place)
        self._last = (now, place)


def run_child(case: Case, report: int) -> int:
    """Run the command in this process; write when its limits began, and in the end what was recorded, to a file."""
    import statehtn._relax as relax
    from statehtn.cli.program import main
    from statehtn.limits import Limits

    recorder = Recorder()
    core = ""
    check, starting_now = Limits.check, Limits.starting_now

    def write(record: dict[str, object]) -> None:
        os.write(report, (json.dumps(record) + "\n").encode())

    def noted_check(self: Limits) -> None:
        caller = sys._getframe(1)
        recorder.note(f"{caller.f_globals['__name__']}.{caller.f_code.co_name}")
        check(self)

    def noted_start(*arguments: Any, **named: Any) -> Limits:
        write({"began": time.monotonic()})
        recorder.note("the beginning")
        return starting_now(*arguments, **named)

    def in_core(function: Callable[..., Any], name: str) -> Callable[..., Any]:
        @functools.wraps(function)
        def call(*arguments: Any, **named: Any) -> Any:
            nonlocal core
            core = name
            try:
                return function(*arguments, **named)
            finally:
                core = ""

        return call

    def handle(_number: int, _frame: object) -> None:
        if core:
            recorder.note(core)

    Limits.check = noted_check  # type: ignore[method-assign]
    Limits.starting_now = staticmethod(noted_start)  # type: ignore[method-assign]
    for name, function in vars(relax).items():
        if type(function).__name__ == "nb_func":
            setattr(relax, name, in_core(function, f"the core's {name}"))
    signal.signal(signal.SIGPROF, handle)
    signal.setitimer(signal.ITIMER_PROF, SAMPLE_SECONDS, SAMPLE_SECONDS)
    code = main(case.command())
    signal.setitimer(signal.ITIMER_PROF, 0)
    recorder.note("the end")
    write({"longest_stretch": recorder.longest, "after": recorder.between[0], "before": recorder.between[1]})
    write({"peak_memory_mb": peak_memory_mb()})
    return code


def measure(case: Case) -> dict[str, Any]:
    """Run the case in a process of its own, and return fields of a `Row`."""
    reading, writing = os.pipe()
    command = [sys.executable, "-m", "tests.benchmarks.limits_case", json.dumps(asdict(case)), str(writing)]
    process = subprocess.Popen(
        command,
        pass_fds=[writing],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    os.close(writing)
    os.set_blocking(reading, False)
    text = ""
    began: float | None = None
    cpu_at_end: float | None = None  # of the limit, or when the signal was sent
    message = ""
    while True:
        ended, status, usage = os.wait4(process.pid, os.WNOHANG)
        if ended:
            break
        now, cpu = time.monotonic(), cpu_seconds(process.pid)
        if began is None:
            text += read_all(reading)
            began = json.loads(text.splitlines()[0])["began"] if "\n" in text else None
        elif cpu_at_end is None and now >= began + case.seconds:
            cpu_at_end = cpu
            if number := SIGNALS[case.signal]:
                process.send_signal(number)
        elif now >= began + case.seconds + GRACE:
            process.kill()
            message = f"still running after {GRACE:g} s"
        time.sleep(SAMPLE_SECONDS)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.stderr is not None
    with process.stderr as stream:
        message = message or stream.read().strip()[-200:]
    text += read_all(reading)
    os.close(reading)
    found: dict[str, Any] = {}
    for line in text.splitlines():
        found |= json.loads(line)
    found.pop("began", None)
    found.setdefault("peak_memory_mb", usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024) / 1e6)
    seconds = usage.ru_utime + usage.ru_stime
    overrun = None if cpu_at_end is None else max(0.0, seconds - cpu_at_end)
    return found | {
        "exit_code": process.returncode,
        "cpu_seconds": seconds,
        "overrun": overrun,
        "message": " ".join(message.split()),
    }


def cpu_seconds(pid: int) -> float:
    """Return the CPU time that a process has taken so far; 0 where the system does not tell."""
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as file:
            fields = file.read().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    except OSError:
        return 0.0


def read_all(descriptor: int) -> str:
    """Read what is there."""
    try:
        return os.read(descriptor, 1 << 16).decode()
    except BlockingIOError:
        return ""


if __name__ == "__main__":
    given = json.loads(sys.argv[1])
    sys.exit(run_child(Case(**(given | {"arguments": tuple(given["arguments"])})), int(sys.argv[2])))
