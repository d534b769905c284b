"""Make problems of the Satellite domain (`domains/satellite`) of any size."""

from __future__ import annotations

import argparse
import random

from statehtn.errors import UsageError

MODES = ("hd_video", "x_ray", "thermography", "infrared", "ultraviolet", "spectrum")
"""The names of the first modes; others are numbered."""


def satellite_problem(
    observations: int, satellites: int, modes: int, seed: int, *, name: str | None = None, ordered: bool = True
) -> str:
    """Return the HDDL text of a random problem, as the paper describes its own.

    There is one instrument for each mode, and every mode is wanted, never twice in a row. Every satellite has an
    instrument, begins in a direction of its own, and all instruments calibrate at the same ground station.

    Args:
        observations: how many there are, each of another phenomenon.
        satellites: how many there are; with more of them, a problem is easier.
        modes: how many there are, at least 2 and as many as satellites, at most as many as observations.
        seed: another one makes another problem of this size.
        name: of the problem; None for one that says the sizes.
        ordered: whether observations are made one after the other, instead of in any order.

    Raises:
        UsageError: there is no problem of these sizes.
    """
    if not (max(2, satellites) <= modes <= observations and satellites >= 1):
        raise UsageError(
            "expected at least 1 satellite and 2 modes, no more satellites than modes, and no more modes than "
            f"observations; found {satellites} satellites, {modes} modes and {observations} observations"
        )
    draw = random.Random(seed)
    wanted = _modes_in_order(observations, modes, draw)
    carriers = _satellites_of_modes(satellites, modes, draw)
    name = name or f"ra-{observations}obs-{satellites}sat-{modes}mod{'' if ordered else '-unordered'}"
    return _text(name, wanted, carriers, seed, ordered)


def _modes_in_order(observations: int, modes: int, draw: random.Random) -> list[int]:
    """Return the mode of each observation: all of them, numbered by their first use, never one twice in a row."""
    wanted: list[int] = []
    used = 0
    for left in range(observations, 0, -1):
        new = modes - used
        # Only random() yields the same numbers in every version of Python.
        if (used < 2 and new) or draw.random() * left < new:
            wanted.append(used)
            used += 1
        else:
            others = [mode for mode in range(used) if mode != wanted[-1]]
            wanted.append(others[int(draw.random() * len(others))])
    return wanted


def _satellites_of_modes(satellites: int, modes: int, draw: random.Random) -> list[int]:
    """Return the satellite that carries each mode's instrument; each carries at least one."""
    carriers = [*range(satellites), *(int(draw.random() * satellites) for _ in range(modes - satellites))]
    return [carrier for _, carrier in sorted((draw.random(), carrier) for carrier in carriers)]


def _text(name: str, wanted: list[int], carriers: list[int], seed: int, ordered: bool) -> str:
    """Write the problem."""
    modes, satellites = len(carriers), max(carriers) + 1
    mode_names = [MODES[mode] if mode < len(MODES) else f"mode{mode + 1}" for mode in range(modes)]
    places = [carriers[:mode].count(carriers[mode]) + 1 for mode in range(modes)]  # on board of its satellite
    hyphen = "-" if max(satellites - 1, *places) > 9 else ""
    instruments = [f"instrument{carriers[mode]}{hyphen}{places[mode]}" for mode in range(modes)]
    phenomena = [f"phenomenon{number}" for number in range(1, len(wanted) + 1)]
    sizes = f"--observations {len(wanted)} --satellites {satellites} --modes {modes} --seed {seed}"
    order = "in the order given" if ordered else "in any order, interleaved as it pleases"
    lines = [
        f"; Made by: python -m statehtn.experiments.generate satellite {sizes}{'' if ordered else ' --unordered'}",
        f"; The observations are made {order}.",
        f"(define (problem {name})",
        "  (:domain risk-satellite)",
        "",
        "  (:objects",
        f"    {_numbered('satellite', satellites)} - satellite",
        f"    {' '.join(sorted(instruments))} - instrument",
        f"    {' '.join(mode_names)} - mode",
        "    groundstation0 - calibration-target",
        f"    {_numbered('star', satellites)} - direction",
        f"    {' '.join(phenomena)} - phenomenon)",
        "",
        "  (:htn",
        "    :parameters ()",
        f"    :{'ordered-subtasks' if ordered else 'subtasks'} (and",
        "\n".join(
            f"      (observe {phenomenon} {mode_names[mode]})"
            for phenomenon, mode in zip(phenomena, wanted, strict=True)
        )
        + "))",
        "",
        "  (:init",
        *(
            f"    (power-available satellite{number}) (pointing satellite{number} star{number})"
            for number in range(satellites)
        ),
        "\n".join(
            f"    (on-board {instrument} satellite{carrier}) (supports {instrument} {mode}) "
            f"(calibrates-at {instrument} groundstation0)"
            for instrument, carrier, mode in zip(instruments, carriers, mode_names, strict=True)
        )
        + ")",
        "",
        "  (:metric minimize (total-cost)))",
        "",
    ]
    return "\n".join(lines)


def _numbered(word: str, count: int) -> str:
    return " ".join(f"{word}{number}" for number in range(count))


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of this generator to a parser."""
    for option, text in (("observations", "how many observations"), ("satellites", "satellites"), ("modes", "modes")):
        parser.add_argument(f"--{option}", type=int, required=True, metavar="N", help=text)
    parser.add_argument(
        "--seed", type=int, default=1, metavar="N", help="another one makes another problem; default: 1"
    )
    parser.add_argument("--unordered", action="store_true", help="the observations may be made in any order")


def generate(options: argparse.Namespace) -> str:
    """Return the problem that the options ask for.

    Raises:
        UsageError: there is none of these sizes.
    """
    return satellite_problem(
        options.observations, options.satellites, options.modes, options.seed, ordered=not options.unordered
    )
