"""`statehtn completion`: a script by which a shell completes commands, options, their values and files."""

from __future__ import annotations

import argparse

from statehtn.cli.exit_codes import ExitCode
from statehtn.cli.parser import Parser
from statehtn.cli.streams import emit
from statehtn.errors import UsageError

FILES = ("domain", "problem", "plan", "costs", "results", "output")
"""Arguments that are files."""
EPILOG = """to have it in every shell:
  bash   statehtn completion bash > ~/.local/share/bash-completion/completions/statehtn
  zsh    statehtn completion zsh > DIR/_statehtn, where DIR is in $fpath
  tcsh   statehtn completion tcsh > ~/.statehtn.completion, and in ~/.tcshrc: source ~/.statehtn.completion

It needs pip install 'statehtn[completion]' to be made, and nothing to be used.
"""


def add_completion(commands: argparse._SubParsersAction[Parser]) -> None:
    """Add `statehtn completion`."""
    parser = commands.add_parser(
        "completion",
        help="print a script that lets a shell complete command lines",
        description="Print a script that lets a shell complete commands, options, their values and files.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("shell", choices=("bash", "zsh", "tcsh"))


def run_completion(options: argparse.Namespace, parser: Parser) -> ExitCode:
    """Print the script for the command lines of a parser, and return the exit code.

    Raises:
        UsageError: a package is missing.
    """
    try:
        import shtab
    except ImportError:
        raise UsageError("this needs the package 'shtab': pip install 'statehtn[completion]'") from None
    (commands,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    commands.metavar = None  # shtab takes it for one command
    for command in commands.choices.values():
        for action in command._actions:
            if action.dest in FILES:
                action.complete = shtab.FILE
    emit(shtab.complete(parser, options.shell), raw=True)
    return ExitCode.SUCCESS
