"""The atlas of a problem: its best plans for every attitude to risk, what each costs, and a page that shows them."""

from statehtn.atlas.survey import Atlas, survey

__all__ = ["Atlas", "survey"]
