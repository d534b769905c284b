"""`statehtn report`: write a page about what a comparison has found."""

from __future__ import annotations

import argparse
from pathlib import Path

from statehtn.cli.exit_codes import ExitCode
from statehtn.cli.files import OutputFile
from statehtn.cli.streams import emit
from statehtn.counted import counted
from statehtn.errors import one_line
from statehtn.experiments.report import read_outcomes, report_page


def run_report(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: the results cannot be read, or a package is missing.
        OutputError: the page cannot be written.
    """
    results = Path(options.results)
    output = OutputFile(options.output, (options.results, str(results.with_suffix(".jsonl"))))
    outcomes = read_outcomes(options.results)
    page = report_page(outcomes, results.name)
    output.write(page)
    if not output.is_stdout:
        sizes = f"{counted(len(outcomes), 'run')}, {len(page.encode()) / 1000:.0f} kB"
        emit(f"{one_line(options.output)}: {sizes}")
    return ExitCode.SUCCESS
