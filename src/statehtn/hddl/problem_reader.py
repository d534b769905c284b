"""The problem: objects, initial network, initial state and goal."""

from __future__ import annotations

from statehtn.hddl.chance_reader import hidden_predicates_in
from statehtn.hddl.cost_reader import TOTAL_COST
from statehtn.hddl.diagnostics import Reporter
from statehtn.hddl.expressions import Group, Word, describe, parse_group
from statehtn.hddl.formula_reader import FormulaReader
from statehtn.hddl.initial_state_reader import InitialStateReader
from statehtn.hddl.network_reader import NETWORK_KEYWORDS, read_network
from statehtn.hddl.sections import Fields, read_header, sorted_sections
from statehtn.hddl.tokens import shortened
from statehtn.hddl.typed_lists import read_objects, read_parameters
from statehtn.hddl.vocabulary import Vocabulary, scope_of
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


class ProblemReader:
    """Reads the file of a problem: its objects, and what is hidden, when it is made, the rest when the domain is known.

    Args:
        reporter: of the file.
        vocabulary: the domain's declarations; gets the objects, and types for those that are declared with several.

    Raises:
        InputError: with the place of the mistake.
        UnsupportedError: it asks for something that is not supported.
    """

    def __init__(self, reporter: Reporter, vocabulary: Vocabulary) -> None:
        self.reporter = reporter
        self.vocabulary = vocabulary
        self.name = read_header("problem", reporter)
        self.sections = sorted_sections(reporter, SECTIONS, UNSUPPORTED, SECTIONS, UNIQUE)
        self.objects: dict[str, str] = {}
        for start, end in self.sections[":objects"]:
            read_objects(start, end, vocabulary, self.objects, reporter)
        for start, end in self.sections[":init"]:
            vocabulary.hidden.update(hidden_predicates_in(start, end, vocabulary, reporter))

    def read(self, domain: Domain) -> Problem:
        """Return the problem.

        Raises:
            InputError: with the place of the mistake.
            UnsupportedError: it asks for something that is not supported, a metric other than the total cost, say.
        """
        self._check_domain(domain)
        parameters, network = self._network()
        goal = self._goal()
        self._check_metric()
        state = InitialStateReader(self.vocabulary, self.reporter)
        for start, end in self.sections[":init"]:
            state.read(start, end)
        facts, values, chances = frozenset(state.facts), state.values, state.chances
        return Problem(self.name, domain, self.objects, parameters, network, facts, values, goal, chances)

    def _only(self, name: str) -> Group | None:
        return parse_group(self.reporter.source, self.sections[name][0][0]) if self.sections[name] else None

    def _check_domain(self, domain: Domain) -> None:
        section = self._only(":domain")
        if section is None:
            return
        named = section.items[1] if len(section.items) == 2 else section
        if isinstance(named, Group):
            raise self.reporter.error("expected '(:domain <name>)'", section)
        if named.lower != domain.name.lower():
            self.reporter.warn(
                f"the problem is for domain '{shortened(named.text)}', the domain is '{shortened(domain.name)}'",
                named,
            )

    def _network(self) -> tuple[tuple[Parameter, ...], TaskNetwork]:
        section = self._only(":htn")
        if section is None:
            raise self.reporter.source.error(
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
