"""The lifted cost-variable HTN problem, ground problems and plans."""

from statehtn.model.cost.blocks import Arithmetic, CostBlock, Expression, FunctionTerm, Number
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.sum import CostSum
from statehtn.model.formula import TRUE, And, Atom, Equals, Exists, Forall, Formula, Not, OfType, Or
from statehtn.model.ground import GroundAction, GroundCostPart, GroundEffect, GroundMethod, GroundProblem
from statehtn.model.outcome import Outcome, OutcomeBlock
from statehtn.model.plan import Decomposition, Plan, Step
from statehtn.model.problem import Action, Domain, Effect, Fact, Method, Problem, Signature, Subtask, TaskNetwork
from statehtn.model.types import Parameter, TypeHierarchy

__all__ = [
    "TRUE",
    "Action",
    "And",
    "Arithmetic",
    "Atom",
    "CostBlock",
    "CostDistribution",
    "CostLaw",
    "CostSum",
    "Decomposition",
    "Domain",
    "Effect",
    "Equals",
    "Exists",
    "Expression",
    "Fact",
    "Forall",
    "Formula",
    "FunctionTerm",
    "GroundAction",
    "GroundCostPart",
    "GroundEffect",
    "GroundMethod",
    "GroundProblem",
    "Method",
    "Not",
    "Number",
    "OfType",
    "Or",
    "Outcome",
    "OutcomeBlock",
    "Parameter",
    "Plan",
    "Problem",
    "Signature",
    "Step",
    "Subtask",
    "TaskNetwork",
    "TypeHierarchy",
]
