"""Run the command line: `python -m statehtn`."""

from __future__ import annotations

import sys

from statehtn.cli import main

if __name__ == "__main__":
    sys.exit(main())
