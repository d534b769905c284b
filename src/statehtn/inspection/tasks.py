"""Tasks that no decomposition ends: without a method, or by methods that all lead back to the task; and unused ones."""

from __future__ import annotations

from collections.abc import Iterator

from statehtn.counted import counted
from statehtn.inspection.finding import Finding, Level
from statehtn.inspection.subject import Subject


def check_tasks(subject: Subject) -> Iterator[Finding]:
    """Yield tasks without methods, recursion without an end, and what stands in no network."""
    yield from _without_methods(subject)
    yield from _endless(subject)
    if subject.problem is not None:
        yield from _unused(subject)


def _without_methods(subject: Subject) -> Iterator[Finding]:
    for task, methods in subject.methods_of.items():
        if methods:
            continue
        users = [f"method '{method.name}'" for method in subject.methods_with[task]]
        message = f"task '{task}' has no method"
        if task in subject.initial_tasks:
            message += ", and stands in the initial network"
        elif users:
            more = f" and {counted(len(users) - 1, 'other')}" if len(users) > 1 else ""
            message += f", so that {users[0]}{more} can never be used to the end"
        is_used = bool(users) or task in subject.initial_tasks
        level = Level.WARNING if is_used else Level.NOTE
        advice = "write a method for it, or leave it out where it stands" if is_used else "write one, or leave it out"
        place = subject.places.declared("task", task)
        yield Finding(level, place, message, advice, "no-method", ("task", task))


def _endless(subject: Subject) -> Iterator[Finding]:
    """Yield the tasks whose methods all lead to a task of this kind, the first of each circle."""
    endless = _without_end(subject, {task for task, methods in subject.methods_of.items() if not methods})
    told: set[str] = set()
    for task in subject.methods_of:
        if task not in endless or task in told:
            continue
        circle = _circle(subject, task, endless)
        if circle is None:
            continue
        told.update(circle)
        methods = subject.methods_of[task]
        what = f"each of the {len(methods)} methods" if len(methods) > 1 else f"its only method '{methods[0].name}'"
        itself = all(task in {subtask.task for subtask in method.network.subtasks} for method in methods)
        way = f" ({' to '.join((*circle, task))})" if len(circle) > 1 else ""
        back = "back to it" if itself else f"back to it{way}, or to another task without an end"
        message = f"task '{task}' can never be decomposed to the end, as {what} leads {back}"
        place = subject.places.declared("method", methods[0].name)
        advice = f"write a method of '{task}' that ends the recursion"
        yield Finding(Level.WARNING, place, message, advice, "endless-recursion", ("task", task))


def _without_end(subject: Subject, ending: set[str]) -> set[str]:
    """Return the compound tasks without a finite decomposition, where some tasks are taken to have one."""
    ends = {*subject.domain.actions, *ending}
    missing = {
        name: {subtask.task for subtask in method.network.subtasks} - ends
        for name, method in subject.domain.methods.items()
    }
    pending = [method for method in subject.domain.methods.values() if not missing[method.name]]
    while pending:
        task = pending.pop().task
        if task in ends:
            continue
        ends.add(task)
        for method in subject.methods_with[task]:
            missing[method.name].discard(task)
            if not missing[method.name]:
                pending.append(method)
    return set(subject.methods_of) - ends


def _circle(subject: Subject, task: str, among: set[str]) -> list[str] | None:
    """Return a shortest way from a task back to itself through some tasks, without its end; None if there is none."""
    came_from: dict[str, str] = {}
    pending = [task]
    for current in pending:
        for method in subject.methods_of[current]:
            for subtask in method.network.subtasks:
                if subtask.task == task:
                    way = [current]
                    while way[-1] != task:
                        way.append(came_from[way[-1]])
                    return way[::-1]
                if subtask.task in among and subtask.task not in came_from:
                    came_from[subtask.task] = current
                    pending.append(subtask.task)
    return None


def _unused(subject: Subject) -> Iterator[Finding]:
    """Yield what stands in no network; without methods it is told elsewhere."""
    for name in (*subject.domain.tasks, *subject.domain.actions):
        if subject.methods_with[name] or name in subject.initial_tasks or subject.methods_of.get(name) == []:
            continue
        what = "task" if name in subject.domain.tasks else "action"
        message = f"{what} '{name}' stands in no method and not in the initial network: no plan makes use of it"
        place = subject.places.declared("task", name)
        advice = "add it to a method where it is needed, or leave it out"
        yield Finding(Level.NOTE, place, message, advice, "unused-task", (what, name))
