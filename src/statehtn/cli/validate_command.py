"""`statehtn validate`: say whether a plan is valid, action by action."""

from __future__ import annotations

import argparse

from statehtn.cli.exit_codes import ExitCode
from statehtn.cli.files import read_problem
from statehtn.cli.streams import emit
from statehtn.errors import InputError
from statehtn.hddl.plan_format import read_plan
from statehtn.validate import validate


def run_validate(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: a file cannot be read.
    """
    from statehtn.cli.tables import readable_validation

    problem = read_problem(options)
    plan = read_plan(_read_text(options.plan), problem, options.plan)
    validation = validate(problem, plan)
    emit(readable_validation(validation, plan.steps), raw=True)
    return ExitCode.SUCCESS if validation.valid else ExitCode.INVALID_PLAN


def _read_text(name: str) -> str:
    try:
        with open(name, encoding="utf-8") as file:
            return file.read()
    except OSError as error:
        raise InputError(f"cannot read '{name}': {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"'{name}' is no text file: byte {error.start} cannot be decoded") from None
