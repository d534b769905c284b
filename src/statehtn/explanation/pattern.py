"""Atoms and tasks with open arguments: each argument stands for some objects."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product

from statehtn.model.formula import is_variable


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument: how it is written, and the objects that it may stand for."""

    text: str
    objects: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Pattern:
    """A predicate or task with arguments that may be open."""

    name: str
    arguments: tuple[Argument, ...]

    @property
    def key(self) -> tuple[object, ...]:
        """What tells patterns apart: not how open arguments are written, but which of them are one."""
        texts = [argument.text for argument in self.arguments]
        return self.name, tuple(
            (argument.objects, texts.index(argument.text) if len(argument.objects) > 1 else None)
            for argument in self.arguments
        )

    @property
    def is_ground(self) -> bool:
        """Whether each argument stands for one object."""
        return all(len(argument.objects) == 1 for argument in self.arguments)

    def rows(self, most: int) -> Iterator[tuple[str, ...]]:
        """Yield the first so many rows of objects that it stands for."""
        objects = {argument.text: argument.objects for argument in self.arguments}
        for values in islice(product(*objects.values()), most):
            chosen = dict(zip(objects, values, strict=True))
            yield tuple(chosen[argument.text] for argument in self.arguments)

    def __str__(self) -> str:
        words = (arg.objects[0] if len(arg.objects) == 1 else arg.text for arg in self.arguments)
        return f"({' '.join((self.name, *words))})"


def pattern(name: str, terms: Iterable[str], domains: Mapping[str, Sequence[str]]) -> Pattern:
    """Return an atom or task with the objects of its variables."""
    return Pattern(
        name, tuple(Argument(term, tuple(domains[term]) if is_variable(term) else (term,)) for term in terms)
    )


def unified(
    terms: Sequence[str], wanted: Pattern, domains: Mapping[str, Sequence[str]]
) -> dict[str, tuple[str, ...]] | None:
    """Return what is left of the domains of variables when terms are to be the arguments of a pattern.

    None if a term cannot be its argument.
    """
    left = {name: tuple(objects) for name, objects in domains.items()}
    for term, argument in zip(terms, wanted.arguments, strict=True):
        if is_variable(term):
            allowed = set(argument.objects)
            left[term] = tuple(name for name in left[term] if name in allowed)
            if not left[term] and domains[term]:
                return None
        elif term not in argument.objects:
            return None
    return left
