"""The command line: `statehtn plan`, `top`, `validate`, `compare`, `report` and `graph`."""

from statehtn.cli.program import main

__all__ = ["main"]
