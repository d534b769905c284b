"""The command line: `statehtn plan` and `statehtn validate`."""

from statehtn.cli.program import main

__all__ = ["main"]
