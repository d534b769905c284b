"""Laws of scipy: singular ones, those that scipy fails on, long computations under limits, and words about them."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy
import pytest
from scipy import special, stats

from statehtn import CostDistribution, InputError, UnsupportedError, read_costs
from statehtn.cli import main
from statehtn.model.cost.numerics.moment_generating import _integrated
from statehtn.model.cost.numerics.quadrature import log_moment_by_quantiles
from statehtn.model.cost.scipy_law import ScipyCost

DOMAIN = "(define (domain d) (:predicates (there)) (:action go :parameters () :effect (there)))"
PROBLEM = "(define (problem p) (:domain d) (:htn :subtasks (go)) (:init))"


def law(frozen: object) -> ScipyCost:
    found = CostDistribution.from_scipy(frozen)
    assert isinstance(found, ScipyCost)
    return found


def beta(a: float, b: float, slope: float) -> float:
    return math.log(special.hyp1f1(a, a + b, slope)) / slope


SLOPES = (-50.0, -0.3, 1e-4, 0.3, 50.0)
SINGULAR = [
    *((stats.beta(20, 0.2, loc=9), slope, 9 + beta(20, 0.2, slope)) for slope in SLOPES),
    *((stats.beta(0.1, 0.3, scale=4), slope, 4 * beta(0.1, 0.3, 4 * slope)) for slope in SLOPES),
    *((stats.beta(0.5, 0.5, 3, 1e-7), slope, 3 + 1e-7 * beta(0.5, 0.5, 1e-7 * slope)) for slope in (-1.0, 1e7)),
    (stats.gamma(0.002, loc=1), -0.7, 1 + 0.002 * math.log1p(0.7) / 0.7),
    (stats.chi2(1.5, loc=1), -0.3, 1 + 0.75 * math.log1p(0.6) / 0.3),
]


@pytest.mark.parametrize(("frozen", "slope", "expected"), SINGULAR)
def test_infinite_densities_are_integrated(frozen: object, slope: float, expected: float) -> None:
    found, error = _integrated(law(frozen), slope)
    reach = abs(found - law(frozen).least)
    assert found == pytest.approx(expected, abs=error + 1e-10 * reach + 1e-15 * expected)
    assert error <= 1e-9 * reach


@pytest.mark.parametrize("slope", SLOPES)
def test_quantiles_and_densities_give_the_same(slope: float) -> None:
    for frozen in (stats.uniform(), stats.triang(0.3), stats.beta(2, 3)):
        expected, _ = _integrated(law(frozen), slope)
        found, error = log_moment_by_quantiles(law(frozen), slope)
        assert found / slope == pytest.approx(expected, rel=1e-10)
        assert error <= 1e-9 * abs(found)


def entry(folder: Path, text: str) -> str:
    (folder / "d.hddl").write_text(DOMAIN)
    (folder / "p.hddl").write_text(PROBLEM)
    (folder / "costs.toml").write_text(f'[[costs]]\naction = "go"\n{text}\n')
    return str(folder / "costs.toml")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('distribution = "kstwo"\nparameters = { n = 0, loc = 2 }', "scipy.stats fails on 'kstwo' with n = 0, loc = 2"),
        ('distribution = "poisson_binom"\nparameters = { p = 1 }', "scipy.stats fails on 'poisson_binom' with p = 1"),
        ('distribution = "binom"\nparameters = { n = [3, 4], p = 0.5 }', "binom"),
        ('distribution = "gamma"\nparameters = { a = [1, 2] }', "gamma"),
        ("outcomes = [[9e307, 1], [9e307, 2]]", "a probability must be between 0 and 1, found 9e+307"),
        ('samples = "a\\u0000b"', "cannot read"),
    ],
)
def test_what_scipy_raises_names_file_entry_and_law(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        read_costs(entry(tmp_path, text))
    assert f"{tmp_path / 'costs.toml'}: entry 1 of 'costs'" in str(caught.value)
    assert message in str(caught.value)


def test_errors_of_pricing_name_action_and_law(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    costs = entry(tmp_path, 'distribution = "ncf"\nparameters = { dfn = 0.05, dfd = 7, nc = 0.3 }')
    files = [str(tmp_path / "d.hddl"), str(tmp_path / "p.hddl")]
    assert main(["plan", *files, "--costs", costs, "--attitude", "seeking", "--alpha", "0.5"]) == 30
    captured = capsys.readouterr()
    law_and_place = f"ncf(dfn=0.05, dfd=7, nc=0.3) ({costs}: entry 1 of 'costs')"
    assert f"error: the cost of (go): scipy.stats fails on {law_and_place} (OverflowError" in captured.err
    assert captured.err.count("\n") == 1


def test_parameters_may_be_lists(tmp_path: Path) -> None:
    table = read_costs(entry(tmp_path, 'distribution = "poisson_binom"\nparameters = { p = [0.5, 0.25] }'))
    found = table.entries[0].law
    assert isinstance(found, CostDistribution)
    numpy.testing.assert_allclose(found.outcomes, [(0.375, 0), (0.5, 1), (0.125, 2)], rtol=1e-12)


def test_a_long_list_of_outcomes_is_counted() -> None:
    for frozen in (stats.binom(2_000_000, 0.5), stats.randint(0, 2_000_001)):
        with pytest.raises(UnsupportedError, match="has 2000001 outcomes, more than 100000; give a continuous law"):
            CostDistribution.from_scipy(frozen)


def test_no_text_of_scipy_comes_out() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = law(stats.kappa4(2, 7, loc=5, scale=1e-3))
        assert 5 < found.exponential_mean(-1.0) < found.exponential_mean(1.0) < 5.1
