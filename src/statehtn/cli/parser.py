"""A parser of command lines that raises its errors, prints like everything else, and suggests what was meant."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, NoReturn

from statehtn.cli.streams import emit
from statehtn.errors import UsageError
from statehtn.expected import did_you_mean

if TYPE_CHECKING:
    from _typeshed import SupportsWrite

_CHOICE = re.compile(r"invalid choice: '?(?P<found>.*?)'? \(choose from (?P<known>.*)\)$", re.DOTALL)


class Parser(argparse.ArgumentParser):
    """An argument parser that raises its errors instead of printing them."""

    def error(self, message: str) -> NoReturn:
        """Raise a `UsageError` for a mistake on the command line."""
        if match := _CHOICE.search(message):
            known = re.findall(r"[\w-]+", match["known"])
            message = f"{message[: match.start()]}there is no '{match['found']}'{did_you_mean(match['found'], known)}; "
            message += f"choose from {', '.join(known)}"
        message = message.replace("invalid float value:", "expected a number, found")
        raise UsageError(f"{message} (see '{self.prog} --help')")

    def print_help(self, file: SupportsWrite[str] | None = None) -> None:
        """Print the help as everything else is printed: with an error where that cannot be done."""
        del file
        emit(self.format_help().rstrip("\n"))

    def check_options(self, arguments: Sequence[str]) -> None:
        """Look for options that are misspelt, before anything else is said of the command line.

        What begins with two dashes is an option and never the value of one.

        Raises:
            UsageError: there is no such option; names the most similar one.
        """
        known = [name for action in self._actions for name in action.option_strings]
        for argument in arguments:
            if argument == "--":
                return
            name = argument.split("=", 1)[0]
            if name.startswith("--") and name not in known:
                self.error(f"unknown option {name}{did_you_mean(name, known)}")
