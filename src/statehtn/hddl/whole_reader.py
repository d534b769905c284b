"""Reading with all that can be said about the files: errors and warnings as values, and where everything stands."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike, fspath

from statehtn.collector import without_collector
from statehtn.errors import InputError, StateHtnError
from statehtn.hddl.diagnostics import Diagnostics, Reporter
from statehtn.hddl.domain_reader import DomainReader
from statehtn.hddl.problem_reader import ProblemReader
from statehtn.hddl.source_map import SourceMap
from statehtn.hddl.tokens import Source, read_text
from statehtn.hddl.vocabulary import Vocabulary
from statehtn.limits import Limits
from statehtn.model import Domain, Problem


@dataclass(frozen=True)
class Reading:
    """What two files, or a domain alone, say.

    Args:
        domain: None if it is refused as a whole; without the actions and methods that are refused.
        problem: None if there is none, or it is refused.
        errors: what is refused.
        warnings: what is sloppy.
        places: where things stand; None if not even that is known.
    """

    domain: Domain | None
    problem: Problem | None
    errors: tuple[StateHtnError, ...]
    warnings: tuple[InputError, ...]
    places: SourceMap | None

    @property
    def is_whole(self) -> bool:
        """Whether nothing is refused."""
        return not self.errors


def read_whole_hddl(
    domain_path: str | PathLike[str], problem_path: str | PathLike[str] | None = None, limits: Limits = Limits()
) -> Reading:
    """Read a domain, and a problem if there is one; go on after a mistake where what follows can be understood.

    Args:
        domain_path: the domain's file.
        problem_path: the problem's file. Without one an object that the domain does not declare is a warning.
        limits: time and memory for reading.

    Raises:
        InputError: a file cannot be read at all: it is missing, or no text.
        LimitReached: a limit was reached.
    """
    domain_file = fspath(domain_path)
    texts = [(read_text(domain_file, limits), domain_file)]
    if problem_path is not None:
        problem_file = fspath(problem_path)
        texts.append((read_text(problem_file, limits), problem_file))
    with without_collector():
        return _Run(limits).read(*texts)


class _Run:
    """One run of the reader; what it has found so far."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.diagnostics = Diagnostics(strict=False, goes_on=True)
        self.domain: Domain | None = None
        self.problem: Problem | None = None
        self.places: SourceMap | None = None

    def read(self, domain: tuple[str, str], problem: tuple[str, str] | None = None) -> Reading:
        """Read the declarations of both files first, then the rest, as far as it can be understood."""
        errors = self.diagnostics.errors
        try:
            self._read(domain, problem)
        except StateHtnError as error:
            errors.append(error)
        return Reading(self.domain, self.problem, tuple(errors), tuple(self.diagnostics.found), self.places)

    def _read(self, domain: tuple[str, str], problem: tuple[str, str] | None) -> None:
        vocabulary = Vocabulary()
        vocabulary.assumes_objects = problem is None
        domain_source = Source(*domain, self.limits)
        domain_reader = DomainReader(Reporter(domain_source, self.diagnostics), vocabulary)
        problem_source = problem_reader = None
        if problem is not None:
            try:
                problem_source = Source(*problem, self.limits)
                problem_reader = ProblemReader(Reporter(problem_source, self.diagnostics), vocabulary)
            except StateHtnError as error:  # the domain is read, too, as if there were no problem
                self.diagnostics.errors.append(error)
                vocabulary.assumes_objects = True
        self.places = SourceMap(vocabulary, domain_source, problem_source)
        self.domain = domain_reader.read(problem_reader.objects if problem_reader else {})
        if problem_reader is not None:
            self.problem = problem_reader.read(self.domain)
