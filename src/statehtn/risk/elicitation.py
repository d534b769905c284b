"""A person's attitude to risk from what they say about lotteries: certainty equivalents, turned into alpha.

The certainty equivalent of a cost rises with the slope (alpha of an averse agent, -alpha of a seeking one) from the
least cost to the largest, strictly where the cost is uncertain. So an answer "a certain cost of 19.4 would be as bad as
this lottery" fits exactly one slope. Source: the method of certainty equivalents, as in Wakker, *Prospect Theory: For
Risk and Ambiguity*, 2010, section 3, for constant absolute risk aversion.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from statehtn.errors import InputError, UsageError
from statehtn.expected import number
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.exponential import Exponential
from statehtn.risk.neutral import Neutral
from statehtn.risk.utility import Attitude, Utility

Certain = float | tuple[float, float]
"""A certain cost that is as bad as a lottery: a number, or two between which it lies."""
PRECISION = 1e-12  # of alpha times the range of the cost
NEUTRAL = 1e-9
"""Alpha times the range of the cost, below which a person is neutral."""
CLOSE = 1e-6
HALVINGS = 200


@dataclass(frozen=True, slots=True)
class Answer:
    """What a person has said about one lottery, and the alphas that fit: signed, negative for seeking agents.

    Args:
        certain: the least and the largest certain cost that may be as bad to the person as the lottery.
        lottery: the law of the uncertain cost.
        low: the least alpha that fits.
        high: the largest.
    """

    certain: tuple[float, float]
    lottery: CostLaw
    low: float
    high: float

    def __str__(self) -> str:
        least, most = self.certain
        if math.isinf(most):
            between = f"rather {least:g} than"
        elif math.isinf(least):
            between = f"not rather {most:g} than"
        else:
            between = f"{least:g} for" if least == most else f"{least:g} to {most:g} for"
        return f"{between} {self.lottery}: alpha {_interval_text(self.low, self.high)}"


@dataclass(frozen=True, slots=True, repr=False)
class Elicited:
    """The exponential agents that fit what a person has said.

    Alphas are signed here: negative for seeking agents, 0 for the neutral one, positive for averse ones.

    Args:
        answers: each with the alphas that fit it.
        low: the least alpha that fits all answers; where none does, the least that fits any of them.
        high: the largest.
        contradictions: pairs of answers that no alpha fits both of, by their numbers from 0.
    """

    answers: tuple[Answer, ...]
    low: float
    high: float
    contradictions: tuple[tuple[int, int], ...]

    def __repr__(self) -> str:
        return f"<{self}>"

    def __str__(self) -> str:
        text = f"alpha {_interval_text(self.low, self.high)}"
        if self.contradictions:
            pairs = ", ".join(f"{one + 1} and {other + 1}" for one, other in self.contradictions)
            return f"no alpha fits all answers (contradictory are {pairs}); they lie in {text}"
        return text if self.low != self.high else f"{self.name} (alpha {self.low:.6g})"

    @property
    def middle(self) -> float:
        """The alpha in the middle of the interval, signed."""
        return (self.low + self.high) / 2

    @property
    def utility(self) -> Utility:
        """The agent in the middle of the interval."""
        if self.middle == 0:
            return Neutral()
        return Exponential(Attitude.AVERSE if self.middle > 0 else Attitude.SEEKING, abs(self.middle))

    @property
    def attitude(self) -> Attitude:
        """The attitude of the agent in the middle of the interval."""
        return self.utility.attitude

    @property
    def alpha(self) -> float | None:
        """The coefficient of the agent in the middle of the interval, positive; None for neutral."""
        return self.utility.alpha

    @property
    def name(self) -> str:
        """The agent in the middle of the interval as it is written as an objective, such as `averse 0.9`."""
        return str(self.attitude) if self.alpha is None else f"{self.attitude} {self.alpha:.6g}"


def alpha_of(certain: Certain | Sequence[Certain], lottery: CostLaw | Sequence[CostLaw]) -> Elicited:
    """Return the exponential agents to whom certain costs are as bad as uncertain ones.

    Args:
        certain: the certain cost, positive, in the unit of the lottery; two numbers, as a tuple, where the person would
            rather pay the first and rather take the lottery than pay the second; one of them is infinite where only
            the other one was said. A list of them for several answers.
        lottery: the law of the uncertain cost; a list of as many for several answers.

    Raises:
        UsageError: the numbers of answers differ, or there are none.
        InputError: a lottery is certain, a certain cost is not between its least and its largest cost, or no agent can
            be found.
    """
    costs = list(certain) if isinstance(certain, list) else [certain]
    laws: list[object] = list(lottery) if isinstance(lottery, list | tuple) else [lottery]
    if len(costs) != len(laws) or not costs:
        raise UsageError(f"as many certain costs as lotteries are expected, found {len(costs)} and {len(laws)}")
    answers = tuple(_answer(cost, law) for cost, law in zip(costs, laws, strict=True))
    contradictions = tuple(
        (one, other)
        for other in range(len(answers))
        for one in range(other)
        if max(answers[one].low, answers[other].low) > min(answers[one].high, answers[other].high)
    )
    lows, highs = [answer.low for answer in answers], [answer.high for answer in answers]
    fits = (min(lows), max(highs)) if contradictions else (max(lows), min(highs))
    return Elicited(answers, *fits, contradictions)


def _answer(certain: object, lottery: object) -> Answer:
    law = expect_law(lottery)
    ends = certain if isinstance(certain, tuple) else (certain, certain)
    if len(ends) != 2:
        raise UsageError(f"a certain cost is a number, or two between which it lies, found {len(ends)} numbers")
    least, most = (number(end, "a certain cost") for end in ends)
    if not least <= most:
        raise UsageError(f"of two certain costs the smaller one comes first, found {least:g} and {most:g}")
    if law.least == law.most:
        raise InputError(f"the lottery costs {law.least:g} in any case; it says nothing about an attitude to risk")
    low = -math.inf if least == -math.inf else slope_of(least, law)
    return Answer((least, most), law, low, math.inf if most == math.inf else slope_of(most, law))


def slope_of(certain: float, law: CostLaw) -> float:
    """Return the slope at which a law has a certainty equivalent: alpha if averse, -alpha if seeking, 0 if neutral.

    Raises:
        InputError: the certain cost is not strictly between the least and the largest cost of the law, or too near to
            one of them.
    """
    if not law.least < certain < law.most:
        raise InputError(
            f"a certain cost of {certain:g} is as bad to nobody as a lottery of {law}; give one above {law.least:g} "
            f"and below {law.most:g}"
        )
    unit = law.standard_deviation if math.isfinite(law.standard_deviation) else law.mean
    if abs(certain - law.mean) <= NEUTRAL * unit:
        return 0.0
    sign = 1.0 if certain > law.mean else -1.0

    def is_beyond(size: float) -> bool:
        try:
            return sign * (law.exponential_mean(sign * size) - certain) >= 0
        except InputError:  # infinite, or too large to tell
            return True

    low, high = 0.0, 1 / unit
    while not is_beyond(high):
        low, high = high, 2 * high
        if not math.isfinite(high * unit):
            raise InputError(f"a certain cost of {certain:g} is too near to the end of {law} to tell an alpha")
    for _ in range(HALVINGS):
        middle = low + (high - low) / 2
        if not low < middle < high or high - low <= PRECISION * high:
            break
        low, high = (low, middle) if is_beyond(middle) else (middle, high)
    if low == 0 or abs(law.exponential_mean(sign * low) - certain) > CLOSE * unit:
        raise InputError(
            f"no exponential agent finds a certain cost of {certain:g} as bad as {law}: to averse ones with an alpha "
            f"above {low:g} it is infinitely bad"
        )
    return sign * high


def _interval_text(low: float, high: float) -> str:
    if math.isinf(high) and math.isfinite(low):
        return f"at least {low:.6g}"
    if math.isinf(low) and math.isfinite(high):
        return f"at most {high:.6g}"
    return f"{low:.6g}" if low == high else f"{low:.6g} to {high:.6g}"
