"""The command line: `statehtn plan`, `statehtn validate` and `statehtn compare`."""

from statehtn.cli.program import main

__all__ = ["main"]
