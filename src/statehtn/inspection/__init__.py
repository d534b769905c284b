"""What is wrong or suspicious in a model: findings with their places, by families."""

from statehtn.inspection.finding import CODES, Finding, Level
from statehtn.inspection.inspection import check

__all__ = ["CODES", "Finding", "Level", "check"]
