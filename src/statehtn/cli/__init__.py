"""The command line: `statehtn plan`, `statehtn top`, `statehtn validate`, `statehtn compare` and `statehtn graph`."""

from statehtn.cli.program import main

__all__ = ["main"]
