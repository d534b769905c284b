"""Make problems of the Trials domain (`domains/trials`), whose best chance of success is a formula."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from statehtn.errors import UsageError
from statehtn.expected import shown

DIGITS = 16
"""Of a chance that has no finite decimal."""


@dataclass(frozen=True, slots=True)
class Way:
    """One way to try a step.

    Args:
        chance: with which it works, from 0 to 1.
        final: whether there is no other try after it.
    """

    chance: Fraction
    final: bool = False

    def __str__(self) -> str:
        return f"{self.chance}{'!' if self.final else ''}"


def trials_problem(steps: int, tries: int, ways: Sequence[Way], *, name: str | None = None) -> str:
    """Return the HDDL text of a problem: steps to achieve one after the other, each by so many tries of these ways.

    Args:
        steps: how many there are, at least 1.
        tries: how many each of them has, at least 1.
        ways: which ways a try can take.
        name: of the problem; None for one that says the sizes.

    Raises:
        UsageError: there is no problem of these sizes.
    """
    if steps < 1 or tries < 1 or not ways:
        raise UsageError(
            f"expected at least 1 step, 1 try and 1 way; found {steps} steps, {tries} tries and {len(ways)} ways"
        )
    for way in ways:
        if not 0 <= way.chance <= 1:
            raise UsageError(f"expected chances from 0 to 1, found {way.chance}")
    command = f"--steps {steps} --tries {tries} --ways {' '.join(map(str, ways))}"
    lines = [
        f"; Made by: python -m statehtn.experiments.generate trials {command}",
        f"(define (problem {name or f'trials-{steps}-{tries}-{len(ways)}'})",
        "  (:domain trials)",
        "",
        "  (:objects",
        f"    {_numbered('step', 1, steps)} - step",
        f"    {_numbered('way', 1, len(ways))} - way",
        f"    {_numbered('n', 0, tries)} - count)",
        "",
        "  (:htn",
        "    :parameters ()",
        "    :ordered-subtasks (and",
        "\n".join(f"      (achieve step{number})" for number in range(1, steps + 1)) + "))",
        "",
        "  (:init",
        *(f"    (one-less n{number} n{number + 1})" for number in range(tries)),
        *(f"    (tries-left step{number} n{tries})" for number in range(1, steps + 1)),
        *(f"    (= (chance way{number}) {_decimal(way.chance)})" for number, way in enumerate(ways, 1)),
        *(f"    (final way{number})" for number, way in enumerate(ways, 1) if way.final),
        "  )",
        "",
        "  (:metric minimize (total-cost)))",
        "",
    ]
    return "\n".join(lines)


def _numbered(word: str, first: int, last: int) -> str:
    return " ".join(f"{word}{number}" for number in range(first, last + 1))


def _decimal(chance: Fraction) -> str:
    """Write a chance as HDDL has numbers: exactly, or to DIGITS digits."""
    scaled = round(chance * 10**DIGITS)
    whole, rest = divmod(scaled, 10**DIGITS)
    return f"{whole}.{rest:0{DIGITS}d}".rstrip("0").rstrip(".")


def way_of(text: str) -> Way:
    """Read a way from the command line: a chance such as 0.5 or 2/3, with `!` behind it where it is final.

    Raises:
        argparse.ArgumentTypeError: it is none.
    """
    try:
        return Way(Fraction(text.removesuffix("!")), text.endswith("!"))
    except (ValueError, ZeroDivisionError):
        raise argparse.ArgumentTypeError(f"expected a chance such as 0.5, 2/3 or 0.85!, found {shown(text)}") from None


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of this generator to a parser."""
    parser.add_argument("--steps", type=int, required=True, metavar="N", help="how many steps")
    parser.add_argument("--tries", type=int, default=1, metavar="N", help="how many tries each has; default: 1")
    text = "the chance of each way to try, such as 0.5 or 2/3; with ! behind it where no other try follows"
    parser.add_argument("--ways", type=way_of, nargs="+", required=True, metavar="P", help=text)


def generate(options: argparse.Namespace) -> str:
    """Return the problem that the options ask for.

    Raises:
        UsageError: there is none of these sizes.
    """
    return trials_problem(options.steps, options.tries, options.ways)
