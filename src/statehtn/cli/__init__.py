"""The command line: `statehtn plan` and `statehtn validate`."""

from statehtn.cli.main import main

__all__ = ["main"]
