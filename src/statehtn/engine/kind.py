"""What problems may have, in the terms of unified-planning (UP)."""

from __future__ import annotations

from unified_planning.model import ProblemKind

SUPPORTED_KIND = ProblemKind(
    {
        "HIERARCHICAL",
        "METHOD_PRECONDITIONS",
        "TASK_NETWORK_CONSTRAINTS",
        "INITIAL_TASK_NETWORK_VARIABLES",
        "TASK_ORDER_TOTAL",
        "TASK_ORDER_PARTIAL",
        "FLAT_TYPING",
        "HIERARCHICAL_TYPING",
        "OBJECT_FLUENTS",
        "BOUNDED_TYPES",  # of fluents that costs alone read: other numbers have kinds of their own
        "NEGATIVE_CONDITIONS",
        "DISJUNCTIVE_CONDITIONS",
        "EQUALITIES",
        "EXISTENTIAL_CONDITIONS",
        "UNIVERSAL_CONDITIONS",
        "CONDITIONAL_EFFECTS",
        "FORALL_EFFECTS",
        "STATIC_FLUENTS_IN_BOOLEAN_ASSIGNMENTS",
        "FLUENTS_IN_BOOLEAN_ASSIGNMENTS",
        "STATIC_FLUENTS_IN_OBJECT_ASSIGNMENTS",
        "FLUENTS_IN_OBJECT_ASSIGNMENTS",
        "ACTIONS_COST",
        "STATIC_FLUENTS_IN_ACTIONS_COST",
        "INT_NUMBERS_IN_ACTIONS_COST",
        "REAL_NUMBERS_IN_ACTIONS_COST",
        "PLAN_LENGTH",
        "UNDEFINED_INITIAL_NUMERIC",  # as long as no action that can be reached costs it
    },
    version=3,
)
