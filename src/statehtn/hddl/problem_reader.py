"""The problem: objects, initial network, initial state and goal."""

from __future__ import annotations

from contextlib import suppress

from statehtn.errors import StateHtnError
from statehtn.hddl.cost_reader import TOTAL_COST
from statehtn.hddl.diagnostics import Diagnostics, Reporter, unknown
from statehtn.hddl.expressions import Group, Word, describe, parse_group
from statehtn.hddl.formula_reader import FormulaReader
from statehtn.hddl.initial_state_reader import InitialStateReader
from statehtn.hddl.network_reader import NETWORK_KEYWORDS, read_network
from statehtn.hddl.sections import Fields, read_header, section_name
from statehtn.hddl.tokens import Source, shortened
from statehtn.hddl.typed_lists import read_objects, read_parameters
from statehtn.hddl.vocabulary import Vocabulary, scope_of
from statehtn.limits import Limits
from statehtn.model import TRUE, Domain, Formula, Parameter, Problem, TaskNetwork

SECTIONS = (":domain", ":requirements", ":objects", ":htn", ":init", ":goal", ":metric")
TASK_INSERTION = "inserting tasks that the hierarchy does not ask for (TIHTN) is not supported; expected ':htn'"
UNSUPPORTED = {
    ":constraints": "trajectory constraints are not supported",
    ":utility": "utilities of facts are not supported",
    ":bound": "bounds on the cost are not supported",
    ":include": "including other files is not supported",
    ":tihtn": TASK_INSERTION,
    ":htnti": TASK_INSERTION,
    ":htn-ti": TASK_INSERTION,
}
UNIQUE = (":domain", ":htn", ":goal", ":metric")


def read_problem(
    source: Source, domain: Domain, vocabulary: Vocabulary, diagnostics: Diagnostics, limits: Limits
) -> Problem:
    """Return the problem of a file.

    Args:
        vocabulary: the domain's declarations; the problem's objects are added to them. Objects that the problem
            declares with several types add types to the domain.

    Raises:
        InputError: with the place of the mistake.
        UnsupportedError: it asks for something that is not supported, a metric other than the total cost, say.
    """
    return _ProblemReader(source, domain, vocabulary, Reporter(source, diagnostics), limits).read()


def problem_objects(source: Source, vocabulary: Vocabulary) -> Vocabulary:
    """Return the objects of a problem with their types, before the problem is read.

    Mistakes in them end the list; they are told when the problem is read.
    """
    scratch = Vocabulary()
    scratch.declare_types(vocabulary.types.parents)
    reporter = Reporter(source, Diagnostics(strict=False))
    with suppress(StateHtnError):
        for start, end in source.sections:
            if source.tokens[start + 1].lower() == ":objects":
                read_objects(start, end, scratch, {}, reporter)
    return scratch


class _ProblemReader:
    def __init__(
        self, source: Source, domain: Domain, vocabulary: Vocabulary, reporter: Reporter, limits: Limits
    ) -> None:
        self.source = source
        self.domain = domain
        self.vocabulary = vocabulary
        self.reporter = reporter
        self.limits = limits
        self.sections: dict[str, list[tuple[int, int]]] = {name: [] for name in SECTIONS}

    def read(self) -> Problem:
        name = read_header(self.source, "problem", self.reporter)
        self._sort_sections()
        self._check_domain()
        objects: dict[str, str] = {}
        for start, end in self.sections[":objects"]:
            read_objects(start, end, self.vocabulary, objects, self.reporter)
        parameters, network = self._network()
        goal = self._goal()
        self._check_metric()
        state = InitialStateReader(self.vocabulary, self.reporter, self.limits)
        for start, end in self.sections[":init"]:
            state.read(start, end)
        return Problem(name, self.domain, objects, parameters, network, frozenset(state.facts), state.values, goal)

    def _sort_sections(self) -> None:
        for start, end in self.source.sections[1:]:
            word = name = section_name(self.source, start)
            if name not in self.sections:
                if name in UNSUPPORTED:
                    raise self.reporter.unsupported(UNSUPPORTED[name], Word(name, start))
                raise self.source.error(unknown("section", name, SECTIONS), start)
            if self.sections[name]:
                if name in UNIQUE:
                    raise self.source.error(f"a second section '{shortened(word)}'", start)
                self.reporter.warn(f"a second section '{name}'; it is added to the first", Word(name, start))
            self.sections[name].append((start, end))

    def _only(self, name: str) -> Group | None:
        return parse_group(self.source, self.sections[name][0][0]) if self.sections[name] else None

    def _check_domain(self) -> None:
        section = self._only(":domain")
        if section is None:
            return
        named = section.items[1] if len(section.items) == 2 else section
        if isinstance(named, Group):
            raise self.reporter.error("expected '(:domain <name>)'", section)
        if named.lower != self.domain.name.lower():
            self.reporter.warn(
                f"the problem is for domain '{shortened(named.text)}', the domain is '{shortened(self.domain.name)}'",
                named,
            )

    def _network(self) -> tuple[tuple[Parameter, ...], TaskNetwork]:
        section = self._only(":htn")
        if section is None:
            raise self.source.error(
                "the problem has no initial task network; expected a section '(:htn :subtasks ...)'", 0
            )
        fields = Fields(section, section.items[1:], (":parameters", *NETWORK_KEYWORDS), self.reporter)
        parameters = read_parameters(fields.items(":parameters"), self.vocabulary, self.reporter)
        return parameters, read_network(fields, scope_of(parameters), self.vocabulary, self.reporter)

    def _goal(self) -> Formula:
        section = self._only(":goal")
        if section is None or len(section.items) == 1:
            return TRUE
        if len(section.items) > 2:
            raise self.reporter.error(
                f"expected one formula in ':goal', found {describe(section.items[2])}", section.items[2]
            )
        return FormulaReader(self.vocabulary, self.reporter).read(section.items[1], {})

    def _check_metric(self) -> None:
        section = self._only(":metric")
        if section is None:
            return
        direction, measure = section.items[1:] if len(section.items) == 3 else (section, section)
        if isinstance(direction, Group) or direction.lower not in ("minimize", "minimise", "maximize", "maximise"):
            raise self.reporter.error("expected '(:metric minimize (total-cost))'", section)
        name = measure.lower if isinstance(measure, Word) else measure.head if len(measure.items) == 1 else ""
        if not direction.lower.startswith("minim") or name != TOTAL_COST:
            raise self.reporter.unsupported("the only metric is '(:metric minimize (total-cost))'", section)
