"""The command line as a process of its own."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path


class Process(subprocess.Popen[str]):
    """A process that does not outlive a failed test."""

    def __exit__(self, kind: type[BaseException] | None, *rest: object) -> None:
        if kind is not None:
            self.kill()
        super().__exit__(kind, *rest)


def start(*arguments: str, **options: object) -> Process:
    """Start `statehtn` with pipes for its output, unless the options of `Popen` say otherwise."""
    command = [sys.executable, "-m", "statehtn", *arguments]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True} | options
    return Process(command, **streams)


def wait_until_signals_are_caught(process: subprocess.Popen[str], seconds: float = 120.0) -> None:
    """Wait until the process has its handlers: on a busy machine its start can take seconds."""
    status = Path(f"/proc/{process.pid}/status")
    deadline = time.monotonic() + seconds
    while status.exists() and time.monotonic() < deadline and process.poll() is None:
        (caught,) = (line.split()[1] for line in status.read_text().splitlines() if line.startswith("SigCgt:"))
        if int(caught, 16) >> (signal.SIGTERM - 1) & 1:
            return
        time.sleep(0.02)
