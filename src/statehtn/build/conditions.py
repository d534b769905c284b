"""Conditions that are given as HDDL text."""

from __future__ import annotations

from statehtn.build.declarations import Declarations, Scope
from statehtn.errors import StateHtnError, UsageError
from statehtn.hddl.diagnostics import Diagnostics, Reporter
from statehtn.hddl.expressions import parse_group
from statehtn.hddl.formula_reader import FormulaReader
from statehtn.hddl.tokens import Source
from statehtn.hddl.vocabulary import Vocabulary, scope_of
from statehtn.limits import Limits
from statehtn.model import Formula, Parameter


def read_condition(text: str, scope: Scope, declared: Declarations) -> Formula:
    """Return the formula of an HDDL text such as `(and (icy ?to) (not (salted ?to)))`.

    Args:
        scope: the variables that it may use.

    Raises:
        UsageError: it is not one formula, or a name in it is wrong.
    """
    vocabulary = Vocabulary()
    vocabulary.declare_types(declared.parents)
    vocabulary.objects.update({**declared.constants, **declared.objects})
    vocabulary.declare("object", vocabulary.objects)
    vocabulary.predicates.update(declared.predicates)
    vocabulary.declare("predicate", vocabulary.predicates)
    variables = scope_of(Parameter(name, types) for name, types in scope.variables.items())
    try:
        source = Source(f"(define {text})", "condition", Limits())
        if len(source.sections) != 1:
            raise UsageError("expected one formula in parentheses")
        reporter = Reporter(source, Diagnostics(strict=True))
        return FormulaReader(vocabulary, reporter).read(parse_group(source, source.sections[0][0]), variables)
    except StateHtnError as error:
        raise UsageError(f"the condition '{text}': {error.message}") from None
