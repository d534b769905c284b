"""Problems without files: built from Python objects, checked at every call.

`ProblemBuilder` makes the same immutable `Problem` that the reader makes; docs/library.md shows how.
"""

from statehtn.build.builder import ProblemBuilder
from statehtn.build.declared import NumericFunction, Predicate, Task, Type
from statehtn.build.external import ExternalFunction
from statehtn.build.networks import Occurrence
from statehtn.build.outcomes import Outcome, OutcomePart
from statehtn.build.parts import Chance, CostPart, EffectPart, Quantified, When, chance, forall, when
from statehtn.build.terms import Object, Term, equal, exists
from statehtn.build.with_cost import with_cost

__all__ = [
    "Chance",
    "CostPart",
    "EffectPart",
    "ExternalFunction",
    "NumericFunction",
    "Object",
    "Occurrence",
    "Outcome",
    "OutcomePart",
    "Predicate",
    "ProblemBuilder",
    "Quantified",
    "Task",
    "Term",
    "Type",
    "When",
    "chance",
    "equal",
    "exists",
    "forall",
    "when",
    "with_cost",
]
