"""`statehtn graph`: write a problem's decomposition graphs, or its relaxed model, as a file."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from statehtn.cli.exit_codes import ExitCode
from statehtn.cli.files import STDOUT, OutputFile, read_problem
from statehtn.cli.shared_options import agent_of
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import emit
from statehtn.core.grounding import PLAIN, ground
from statehtn.counted import counted
from statehtn.decomposition import (
    ground_task_decomposition_graph,
    task_decomposition_graph,
    to_dot,
    to_graphml,
    to_svg,
    with_values,
)
from statehtn.errors import UsageError, one_line
from statehtn.model import Problem
from statehtn.reference import build_rc_model
from statehtn.reference.relaxed_graph import relaxed_model_graph
from statehtn.risk import Neutral, Utility

if TYPE_CHECKING:
    import networkx as nx

FORMATS: Mapping[str, Callable[[nx.MultiDiGraph[str]], str]] = MappingProxyType(
    {"svg": to_svg, "dot": to_dot, "gv": to_dot, "graphml": to_graphml}
)


def run_graph(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: the options or the input are wrong, or something is missing for this kind of file.
        OutputError: the file cannot be written.
    """
    form = options.format or Path(options.output).suffix.lower().removeprefix(".")
    if form not in FORMATS:
        if options.output == STDOUT:
            raise UsageError("--output - needs --format beside it: svg, dot or graphml")
        endings = ", ".join(f".{name}" for name in FORMATS)
        raise UsageError(f"'{options.output}': expected a name that ends in {endings}, or --format beside it")
    agent = agent_of(options)
    if options.kind != "gcv-tdg" and agent != Neutral():
        raise UsageError(f"values for an agent are shown on the gcv-tdg, not on the {options.kind}")
    output = OutputFile(options.output, (options.domain, options.problem, options.costs))
    problem = read_problem(options)
    graph = make_graph(problem, options.kind, agent)
    text = FORMATS[form](graph)
    let_finish()
    output.write(text)
    if not output.is_stdout:
        sizes = f"{counted(len(graph), 'node')}, {counted(graph.number_of_edges(), 'edge')}"
        emit(f"{one_line(options.output)}: {sizes}")
    return ExitCode.SUCCESS


def make_graph(problem: Problem, kind: str, utility: Utility) -> nx.MultiDiGraph[str]:
    """Return the graph of a kind: cv-tdg, gcv-tdg with values for an agent, or relaxed-model (of the initial node)."""
    if kind == "cv-tdg":
        return task_decomposition_graph(problem)
    model = ground(problem, switches=PLAIN).to_model()
    if kind == "gcv-tdg":
        return with_values(ground_task_decomposition_graph(model), utility)
    return relaxed_model_graph(build_rc_model(model.initial_state, [model.initial_task], model), model)
