"""Laws of costs as tables for notebooks."""

from __future__ import annotations

from statehtn.counted import brief, likely
from statehtn.display.table import Column, Table
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw

MOST_OUTCOMES = 20


def law_html(law: CostLaw) -> str:
    """Return a table of a law: some of its values, and its outcomes where they are few."""
    values = {
        "mean": law.mean,
        "standard deviation": law.standard_deviation,
        "least": law.least,
        "most": law.most,
    }
    rows = [(name, f"{value:.6g}") for name, value in values.items()]
    table = Table((Column(brief(str(law))), Column("", is_number=True)), rows).to_html()
    if isinstance(law, CostDistribution) and 1 < len(law.outcomes) <= MOST_OUTCOMES:
        rows = [(f"{cost:g}", likely(probability, digits=6)) for probability, cost in law.outcomes]
        table += Table((Column("outcome", is_number=True), Column("probability", is_number=True)), rows).to_html()
    return f"<div>{table}</div>"
