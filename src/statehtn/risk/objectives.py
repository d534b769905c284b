"""The objectives by name: what is written, what is minimised, and the object that it makes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from statehtn.errors import UsageError
from statehtn.expected import did_you_mean, one_of, shown
from statehtn.risk.callable_utility import CallableUtility
from statehtn.risk.cvar import ConditionalValueAtRisk
from statehtn.risk.deadline import Deadline
from statehtn.risk.evar import EntropicValueAtRisk
from statehtn.risk.exponential import Exponential
from statehtn.risk.exponentials import Exponentials
from statehtn.risk.mean_cvar import MeanCvar
from statehtn.risk.mean_deviation import MeanDeviation
from statehtn.risk.mean_variance import MeanVariance
from statehtn.risk.neutral import Neutral
from statehtn.risk.objective import Objective
from statehtn.risk.one_switch import OneSwitch
from statehtn.risk.overrun import Overrun
from statehtn.risk.piecewise import Piecewise
from statehtn.risk.quantile import Quantile
from statehtn.risk.success import Success
from statehtn.risk.success_utility import SuccessUtility
from statehtn.risk.utility import Attitude

ObjectiveLike = Objective | str | Callable[[float], float]
"""What an objective can be given as: itself, its text form, or a utility as a function of the total cost."""


@dataclass(frozen=True, slots=True)
class ObjectiveForm:
    """How an objective is written.

    Args:
        form: its text form, with the names of its parameters in capitals: `cvar LEVEL`. `NAME=` stands before a
            parameter that is written with its name, `..` after what may be repeated.
        meaning: what is minimised, in a line.
        make: makes it from what is written: numbers, and pairs of numbers where the form has a colon.
    """

    form: str
    meaning: str
    make: Callable[..., Objective | Success]

    @property
    def parameters(self) -> list[str]:
        """The words after the name."""
        return self.form.split()[1:]


_FORMS = (
    ObjectiveForm("neutral", "expected cost", Neutral),
    ObjectiveForm("averse A", "certainty equivalent, exponential utility", lambda a: Exponential(Attitude.AVERSE, a)),
    ObjectiveForm("seeking A", "the same of an agent that seeks risk", lambda a: Exponential(Attitude.SEEKING, a)),
    ObjectiveForm("mean-variance L", "expected cost + L times the variance", MeanVariance),
    ObjectiveForm(
        "one-switch alpha=A tradeoff=D wealth=W", "certainty equivalent, careful when little is left", OneSwitch
    ),
    ObjectiveForm(
        "exponentials linear=W0 A1:W1 ..",
        "certainty equivalent, disutility W0 C + W1 e^(A1 C) + ..",
        lambda linear, *pairs: Exponentials(linear, pairs),
    ),
    ObjectiveForm("mean-deviation L", "expected cost + L times the standard deviation", MeanDeviation),
    ObjectiveForm("evar LEVEL", "entropic value at risk", EntropicValueAtRisk),
    ObjectiveForm("deadline D", "probability that the cost exceeds D", Deadline),
    ObjectiveForm("overrun D", "expected cost above D", Overrun),
    ObjectiveForm("piecewise C0:U0 C1:U1 ..", "minus the expected utility, piecewise linear", lambda *p: Piecewise(p)),
    ObjectiveForm("quantile LEVEL", "budget that is kept with that probability", Quantile),
    ObjectiveForm("cvar LEVEL", "mean cost of the worst 1 - LEVEL of all cases", ConditionalValueAtRisk),
    ObjectiveForm("mean-cvar LEVEL W", "(1 - W) expected cost + W cvar", MeanCvar),
    ObjectiveForm(
        "success-utility alpha=A", "-ln of the product of success probabilities and mean e^(-A cost)", SuccessUtility
    ),
)

OBJECTIVES: Mapping[str, ObjectiveForm] = MappingProxyType({form.form.split()[0]: form for form in _FORMS})
"""The objectives that have a text form, by name."""


def objective(wanted: ObjectiveLike | Success) -> Objective:
    """Return the objective that plans are to be chosen by.

    Args:
        wanted: its text form, such as `cvar 0.95` or `one-switch alpha=0.9 tradeoff=20 wealth=40`; a Python function
            `u(total cost)` that does not rise, a utility; or an objective, which is returned as it is.

    Raises:
        UsageError: there is no such objective, or a parameter is missing, superfluous or out of its range.
    """
    if isinstance(wanted, Success) or (isinstance(wanted, str) and name_in(wanted) == str(Success())):
        raise UsageError(
            "plans are not compared by 'success', policies are: 'statehtn policy' finds the one that is most likely "
            "done; 'success-utility' values plans that count on outcomes"
        )
    if isinstance(wanted, str):
        return parsed(wanted, OBJECTIVES)  # type: ignore[return-value]
    if isinstance(wanted, Objective) and not isinstance(wanted, type):
        return wanted
    if callable(wanted) and not isinstance(wanted, type):
        return CallableUtility(wanted)
    raise UsageError(
        f"an objective is its text form, such as 'cvar 0.95', an object of statehtn.risk, or a function of the total "
        f"cost, found {shown(wanted)}"
    )


def name_in(text: str) -> str:
    """Return the first word of the text form of an objective: its name, if there is one like that."""
    return (text.split() or [""])[0]


def parsed(text: str, forms: Mapping[str, ObjectiveForm]) -> Objective | Success:
    """Return an objective from its text form.

    Args:
        text: the text form.
        forms: of the objectives that are known here, by name.

    Raises:
        UsageError: there is no such objective, or a parameter is missing, superfluous or out of its range.
    """
    form = forms[one_of(name_in(text), forms, "objective")]
    given = _in_order(form, text.split()[1:], text)
    try:
        return form.make(*given)
    except UsageError as error:
        raise UsageError(f"objective '{text}': {error.message}") from None


def _in_order(form: ObjectiveForm, words: Sequence[str], text: str) -> list[float | tuple[float, float]]:
    """Return what is written, as numbers and pairs in the order of the form."""
    wanted = [parameter for parameter in form.parameters if parameter != ".."]
    is_open = ".." in form.parameters
    names = [parameter.partition("=")[0] for parameter in wanted if "=" in parameter]
    named: dict[str, float] = {}
    others: list[float | tuple[float, float]] = []
    for word in words:
        key, sign, value = word.partition("=")
        if sign and key not in names:
            raise _wrong(form, text, f"it has no parameter '{key}'{did_you_mean(key, names)}")
        if sign and key in named:
            raise _wrong(form, text, f"{key} is there twice")
        if sign:
            named[key] = _number(form, text, value)
        elif ":" in form.form and ":" in word:
            first, _, second = word.partition(":")
            others.append((_number(form, text, first), _number(form, text, second)))
        elif ":" in form.form:
            raise _wrong(form, text, f"'{word}' is no pair of numbers with a colon between")
        else:
            others.append(_number(form, text, word))
    missing = [name for name in names if name not in named]
    if missing:
        raise _wrong(form, text, f"{' and '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing")
    count = len(wanted) - len(names)
    if not is_open and len(others) != count:
        raise _wrong(
            form, text, f"it takes {count or 'no'} {'number' if count == 1 else 'numbers'}, found {len(others)}"
        )
    return [*(named[name] for name in names), *others]


def _number(form: ObjectiveForm, text: str, word: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise _wrong(form, text, f"'{word}' is no number") from None


def _wrong(form: ObjectiveForm, text: str, what: str) -> UsageError:
    return UsageError(f"objective '{text}': {what}; write {form.form}")
