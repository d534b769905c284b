"""`python -m statehtn.experiments.generate FAMILY ...`: print a problem of a family of any size."""

from __future__ import annotations

import argparse
import sys

from statehtn.errors import UsageError
from statehtn.experiments.generate import av, satellite, trials

FAMILIES = {"av": av, "satellite": satellite, "trials": trials}


def main() -> int:
    """Run the command line and return its exit code."""
    parser = argparse.ArgumentParser(prog="python -m statehtn.experiments.generate", description=__doc__)
    families = parser.add_subparsers(dest="family", required=True, metavar="|".join(FAMILIES))
    for name, family in FAMILIES.items():
        family.add_options(families.add_parser(name, help=(family.__doc__ or "").splitlines()[0]))
    options = parser.parse_args()
    try:
        sys.stdout.write(FAMILIES[options.family].generate(options))
    except UsageError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
