"""The diver and the glider: every attitude has a plan of its own, and every kind of planning decision matters."""

from __future__ import annotations

import pytest

from tests.regression.paper_tables import ADMISSIBLE_HEURISTICS, actions, instances, problem, solve

AGENTS = [("averse", 0.3), ("neutral", None), ("seeking", 0.3)]
