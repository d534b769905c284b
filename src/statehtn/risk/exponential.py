"""The exponential utilities, risk-averse and risk-seeking, without overflow and with little lost to rounding.

Costs `C` are positive, in the domain's unit, and minimised. With the paper's negative costs `c = -C` and `a` = -1
(averse) or +1 (seeking), its equation 1 `a e^(a alpha c) / alpha` becomes `-e^(alpha C) / alpha` and
`e^(-alpha C) / alpha`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Context, Decimal

from statehtn.errors import UsageError
from statehtn.expected import number, whole_number
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import text_of
from statehtn.risk.objective import ValueUnit
from statehtn.risk.utility import DIGITS, Attitude, FunctionType, PlanUtility

DOUBLE_DIGITS = 15
_MANY_DIGITS = Context(prec=60)


@dataclass(frozen=True, slots=True)
class Exponential:
    """The exponential utility of an averse or a seeking agent; the larger alpha, the more it cares about risk.

    The value is the certainty-equivalent cost (`risk_cost`).

    Args:
        attitude: averse or seeking.
        alpha: the curving coefficient, positive, per unit of cost.

    Raises:
        UsageError: the attitude is neutral, or alpha is not a positive finite number.
    """

    attitude: Attitude
    alpha: float

    unit = ValueUnit.COST
    monotone = True

    def __post_init__(self) -> None:
        if self.attitude not in (Attitude.AVERSE, Attitude.SEEKING):
            raise UsageError(f"an exponential utility is averse or seeking, found '{self.attitude}'")
        if not (math.isfinite(number(self.alpha, "alpha")) and self.alpha > 0):
            raise UsageError(f"alpha must be a positive finite number, found {self.alpha:g}")

    @property
    def function_type(self) -> FunctionType:
        """The family of the function."""
        return FunctionType.EXPONENTIAL

    @property
    def allows_segmentation(self) -> bool:
        """True by the paper's Theorem 1."""
        return True

    @property
    def plan_utility(self) -> PlanUtility:
        """A product over the actions."""
        return PlanUtility.PRODUCT

    @property
    def concave(self) -> bool:
        """True for an averse agent."""
        return self.attitude == Attitude.AVERSE

    @property
    def slope(self) -> float:
        """Alpha of an averse agent, minus alpha of a seeking one: that of the exponential mean which is its price."""
        return self.alpha if self.attitude == Attitude.AVERSE else -self.alpha

    def risk_cost(self, law: CostLaw) -> float:
        """Return the certainty-equivalent cost.

        It is `ln E[e^(alpha C)] / alpha` for an averse agent and `-ln E[e^(-alpha C)] / alpha` for a seeking one: at
        least, or at most, the expected cost, to which it tends as alpha tends to 0. The paper's price of an action
        (equation 10) is this one's negative, in another unit.

        Raises:
            InputError: it is infinite, or cannot be computed; never for a list of outcomes.
        """
        return expect_law(law).exponential_mean(self.slope)

    def value(self, law: CostLaw) -> float:
        """Return the certainty-equivalent cost; see `risk_cost`."""
        return self.risk_cost(law)

    def utility(self, cost: float) -> float:
        """Return the utility of a certain cost: averse `-e^(alpha C) / alpha`, seeking `e^(-alpha C) / alpha`."""
        cost = number(cost, "a cost")
        if self.attitude == Attitude.SEEKING:
            return math.exp(-self.alpha * cost) / self.alpha
        try:
            return -math.exp(self.alpha * cost) / self.alpha
        except OverflowError:
            return -math.inf

    def log10_expected_utility(self, risk_cost: float) -> float | None:
        """Return `log10 EU` for a seeking and `-log10 |EU|` for an averse agent, as the paper prints it.

        The size of EU is `e^(alpha K) / alpha` or `e^(-alpha K) / alpha`, where `K` is the plan's risk cost. None where
        the logarithm itself is too large for a float.
        """
        log10_slope = self.alpha * number(risk_cost, "a risk cost") / math.log(10)
        log10_alpha = math.log10(self.alpha)
        log10 = log10_alpha - log10_slope if self.attitude == Attitude.AVERSE else -log10_alpha - log10_slope
        return log10 if math.isfinite(log10) else None

    def expected_utility_text(self, risk_cost: float, digits: int = DIGITS) -> str:
        """Return the expected utility of a plan of that risk cost, such as `-42514703.23` or `2.607706e-49`.

        Fewer than `digits` digits are printed where a rounding error in `risk_cost` already shows in them: EU is
        exponential in it.
        """
        digits = whole_number(digits, "the number of digits")
        risk_cost = number(risk_cost, "a risk cost")
        if not math.isfinite(risk_cost):
            raise UsageError(f"a risk cost must be finite, found {risk_cost:g}")
        exponent = Decimal(self.alpha) * Decimal(risk_cost)
        carried = DOUBLE_DIGITS - max(0, exponent.adjusted() + 1) if exponent else DOUBLE_DIGITS
        averse = self.attitude == Attitude.AVERSE
        log10_size = _MANY_DIGITS.subtract(
            _MANY_DIGITS.divide(exponent if averse else -exponent, _MANY_DIGITS.ln(Decimal(10))),
            _MANY_DIGITS.log10(Decimal(self.alpha)),
        )
        return ("-" if averse else "") + _power_of_ten(log10_size, max(1, min(digits, carried)))

    def __str__(self) -> str:
        return f"{self.attitude} {text_of(self.alpha)}"


def _power_of_ten(log10: Decimal, digits: int) -> str:
    """Print `10^log10` with so many significant digits, as `format(..., 'g')` does where a float can hold it."""
    exponent = math.floor(log10)
    if abs(exponent) >= 10**18:  # more than any reader of decimal numbers takes
        return f"10^{log10:.9e}"
    mantissa = _MANY_DIGITS.power(Decimal(10), _MANY_DIGITS.subtract(log10, Decimal(exponent)))
    if -300 < exponent < 300:
        return format(float(f"{mantissa}e{exponent}"), f".{digits}g")
    text = format(mantissa, f".{digits - 1}f")
    if text.startswith("10"):  # rounded up
        text, exponent = format(mantissa / 10, f".{digits - 1}f"), exponent + 1
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return f"{text}e{exponent:+03d}"
