"""`statehtn attitude`: the alpha of a person from what they say about lotteries."""

from __future__ import annotations

import argparse
import json
import math
from typing import Any

from statehtn.cli.exit_codes import ExitCode
from statehtn.cli.streams import emit
from statehtn.counted import finite
from statehtn.errors import InputError, UsageError
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.risk.elicitation import Certain, Elicited, alpha_of

OVER = " over "


def run_attitude(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        UsageError: the options make no sense.
        InputError: a lottery says nothing about an attitude.
    """
    if len(options.certain) != len(options.lottery):
        numbers = f"{len(options.certain)} and {len(options.lottery)}"
        raise UsageError(f"--certain and --lottery belong together, the first to the first and so on, found {numbers}")
    costs: list[Certain] = list(options.certain)
    laws: list[CostLaw] = [_lottery(text) for text in options.lottery]
    for text in options.prefer:
        cost, law = _preference(text)
        costs.append(cost)
        laws.append(law)
    if not costs:
        raise UsageError(
            "nothing was said: give --certain with --lottery, or --prefer (see 'statehtn attitude --help')"
        )
    said = alpha_of(costs, laws)
    emit(json.dumps(_data(said), allow_nan=False) if options.json else _text(said))
    return ExitCode.SUCCESS


def _lottery(text: str) -> CostLaw:
    """Read probabilities and costs.

    Raises:
        UsageError: they are none.
    """
    outcomes = []
    for word in text.split():
        probability, colon, cost = word.partition(":")
        try:
            outcomes.append((float(probability), float(cost)))
        except ValueError:
            colon = ""
        if not colon:
            raise UsageError(f"a lottery is written as in '0.5:5 0.5:30', probabilities and costs; found '{word}'")
    try:
        return CostDistribution.of(outcomes)
    except InputError as error:
        raise UsageError(f"the lottery '{text}': {error}") from None


def _preference(text: str) -> tuple[Certain, CostLaw]:
    """Read what is preferred to what: a certain cost and a lottery, or the other way round.

    Raises:
        UsageError: it is neither.
    """
    this, over, that = text.partition(OVER)
    certain = [":" not in side for side in (this, that)]
    if not over or sum(certain) != 1:
        raise UsageError(
            f"a preference is a certain cost over a lottery, or the other way round, as in '19.4 over 0.5:5 0.5:30'; "
            f"found '{text}'"
        )
    try:
        cost = float(this if certain[0] else that)
    except ValueError:
        raise UsageError(f"the certain cost in '{text}' is no number") from None
    law = _lottery(that if certain[0] else this)
    if law.least != law.most and not law.least < cost < law.most:
        agree = "nobody" if certain[0] == (cost >= law.most) else "everybody"
        raise UsageError(f"'{text}': {agree} prefers that, whatever they think of risk; it says nothing about alpha")
    return ((cost, math.inf) if certain[0] else (-math.inf, cost)), law


def _text(found: Elicited) -> str:
    lines = [str(found)]
    if len(found.answers) > 1:
        lines += [f"  {number}. {answer}" for number, answer in enumerate(found.answers, 1)]
    if not found.contradictions:
        lines.append(f"as an agent: {_agent(found)}")
    return "\n".join(lines)


def _agent(found: Elicited) -> str:
    """Return the options of an agent, at an end that is known where the interval has no middle."""
    if math.isfinite(found.middle):
        name, *alpha = found.name.split()
        return f"--attitude {name}" + (f" --alpha {alpha[0]}" if alpha else "")
    return "any with such an alpha; say more to narrow it down"


def _data(found: Elicited) -> dict[str, Any]:
    return {
        "alpha_from": finite(found.low),
        "alpha_to": finite(found.high),
        "alpha": None if found.contradictions else finite(found.middle),
        "answers": [
            {
                "certain": [finite(end) for end in answer.certain],
                "lottery": str(answer.lottery),
                "alpha_from": finite(answer.low),
                "alpha_to": finite(answer.high),
            }
            for answer in found.answers
        ],
        "contradictions": [[one + 1, other + 1] for one, other in found.contradictions],
    }
