"""The report on a comparison: one page that shows what its runs have found, and how much work it was."""

from statehtn.experiments.report.page import report_page
from statehtn.experiments.report.results import read_outcomes

__all__ = ["read_outcomes", "report_page"]
