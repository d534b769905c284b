"""Find the problems in a tree of benchmark files, and for each the domain that it belongs to."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from statehtn.experiments.run import Instance

SUFFIX = ".hddl"
DOMAIN_NAMES = ("{}-domain", "{}_domain", "domain-{}", "domain")
"""How a problem's domain file may be called, without suffix; the problem's own name is put in. The first one counts."""
DOMAIN_FOLDERS = (".", "domains", "domain")
_DOMAIN = re.compile(rb"\(\s*define\s*\(\s*domain\b", re.IGNORECASE)
_COMMENT = re.compile(rb";[^\n]*")
_HEAD = 1 << 16  # bytes in which a file has said what it defines; long comments come first at times


def find_instances(root: Path) -> list[Instance]:
    """Return all problems below a folder, sorted by name; the layouts of the competition's repositories are known.

    A problem's domain is beside it or in a folder above it, up to the root: `<problem>-domain.hddl`, `domain.hddl`, the
    only domain there, or one of these in a folder `domains`. The instance's `domain` is the path of that folder
    relative to the root, its `problem` the path of the problem from there, without `.hddl`. Where no domain is found,
    `domain.hddl` beside the problem is assumed, so that its run says what is missing.
    """
    instances = []
    for problem in root.rglob(f"*{SUFFIX}"):
        if problem.is_file() and not is_domain(problem):
            folder, domain = next(_domains(problem, root), (problem.parent, problem.with_name(f"domain{SUFFIX}")))
            name = folder.relative_to(root).as_posix()
            instances.append(
                Instance(
                    domain=root.resolve().name if name == "." else name,
                    problem=problem.relative_to(folder).with_suffix("").as_posix(),
                    domain_file=str(domain),
                    problem_file=str(problem),
                )
            )
    return sorted(instances, key=lambda instance: (instance.domain, instance.problem))


def _domains(problem: Path, root: Path) -> Iterator[tuple[Path, Path]]:
    """Yield the folders of a domain that the problem may belong to with the domain's file, nearest first."""
    for folder in problem.parents:
        for place in DOMAIN_FOLDERS:
            for name in DOMAIN_NAMES:
                file = folder / place / (name.format(problem.stem) + SUFFIX)
                if file.is_file():
                    yield folder, file
        shared = [file for file in folder.glob(f"*{SUFFIX}") if file.is_file() and _is_shared_domain(file)]
        if len(shared) == 1:
            yield folder, shared[0]
        if folder == root:
            return


def _is_shared_domain(file: Path) -> bool:
    """Tell whether a file is a domain and not that of a single problem beside it."""
    owner = file.with_name(file.name.replace("-domain", ""))
    return is_domain(file) and (owner == file or not owner.exists())


def is_domain(file: Path) -> bool:
    """Tell domains from problems: by their name, else by what they define; a file that defines nothing is a problem."""
    if file.stem == "domain" or file.stem.endswith("-domain"):
        return True
    try:
        with open(file, "rb") as content:
            return _DOMAIN.search(_COMMENT.sub(b"", content.read(_HEAD))) is not None
    except OSError:
        return False  # its run will say why it cannot be read
