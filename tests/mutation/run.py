"""Break what optimality hangs on, one condition at a time, and see whether the tests notice.

`python -m tests.mutation.run [PART OF A NAME ...]` builds a copy of the repository in build/mutation, applies each
mutation there, compiles what it touches, and runs the tests that should notice, until one fails. In the end the tests
that have noticed something have to pass without any mutation. It takes about a minute for each mutation, some minutes
for one that survives, and fails if too many do.
"""

from __future__ import annotations

import filecmp
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.mutation.mutations import MUTATIONS, Mutation

ROOT = Path(__file__).parents[2]
TREE = ROOT / "build" / "mutation"
BINARY = TREE / "build" / "core"
COPIED = ("relax", "src", "tests", "domains", "pyproject.toml")
SECONDS = 900  # a test that does not come to its end has noticed
KILLED = 0.95  # of the mutations


def main(parts: Sequence[str]) -> int:
    chosen = [mutation for mutation in MUTATIONS if not parts or any(part in mutation.name for part in parts)]
    copy()
    build()
    check_import()
    noticed = set()
    killed = 0
    for mutation in chosen:
        start = time.monotonic()
        with applied(mutation):
            build()
            failed = failure(mutation.tests)
        if failed:
            killed += 1
            noticed.add(failed.test)
        seconds = time.monotonic() - start
        print(f"{mutation.name}: {f'killed by {failed}' if failed else 'SURVIVED'} ({seconds:.0f} s)", flush=True)
    build()
    if failed := failure(sorted(noticed)):
        raise SystemExit(f"without a mutation there is a failure, too: {failed}")
    print(f"{killed} of {len(chosen)} mutations were killed")
    return int(killed < KILLED * len(chosen))


def copy() -> None:
    """Copy what is built and tested. Only what has changed is written: the rest keeps its times, and is not built."""
    listed = subprocess.check_output(("git", "ls-files", "-z", *COPIED), cwd=ROOT, text=True).split("\0")
    wanted = {Path(name) for name in listed if name and (ROOT / name).exists()}
    for path in (file for name in COPIED for file in (TREE / name).rglob("*")):
        if path.is_file() and path.relative_to(TREE) not in wanted:
            path.unlink()
    for name in wanted:
        source, target = ROOT / name, TREE / name
        if not target.exists() or not filecmp.cmp(source, target, shallow=False):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)


def build() -> None:
    """Compile the module of the copy."""
    import nanobind

    if not (BINARY / "build.ninja").exists():
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DSKBUILD=1", f"-DPython_EXECUTABLE={sys.executable}"]
        options += [f"-Dnanobind_DIR={nanobind.cmake_dir()}"]
        if shutil.which("ccache"):
            options += ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"]
        call("cmake", "-S", TREE / "relax", "-B", BINARY, "-G", "Ninja", *options)
    call("cmake", "--build", BINARY)
    for module in BINARY.glob("_relax*.so"):
        shutil.copy2(module, TREE / "src" / "statehtn" / module.name)


def check_import() -> None:
    """The copy is what is tested, whatever else is installed."""
    where = "import statehtn; print(statehtn.__file__)"
    found = subprocess.check_output([sys.executable, "-c", where], cwd=TREE, env=environment(), text=True)
    if not found.startswith(str(TREE)):
        raise SystemExit(f"instead of the copy, the tests would run {found.strip()}: use an environment without it")


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(TREE / "src")}


def call(*command: str | Path) -> None:
    ended = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if ended.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: {ended.returncode}\n{ended.stdout[-3000:]}")


@contextmanager
def applied(mutation: Mutation) -> Iterator[None]:
    path = TREE / mutation.file
    text = path.read_text(encoding="utf-8")
    if text.count(mutation.old) != 1:
        raise SystemExit(f"{mutation.name}: what it replaces stands {text.count(mutation.old)} times in {path}")
    path.write_text(text.replace(mutation.old, mutation.new), encoding="utf-8")
    try:
        yield
    finally:
        path.write_text(text, encoding="utf-8")


@dataclass(frozen=True)
class Failure:
    """A test that did not pass, as pytest takes it, and how if it did not fail."""

    test: str
    otherwise: str = ""

    def __str__(self) -> str:
        return f"{self.test} ({self.otherwise})" if self.otherwise else self.test


def failure(tests: Sequence[str]) -> Failure | None:
    """The first test that does not pass, of 100 examples; None if all do."""
    options = ("-q", "-x", "-p", "no:cacheprovider", "--hypothesis-profile=mutation")
    for test in tests:
        command = (sys.executable, "-m", "pytest", *options, test)
        try:
            ended = subprocess.run(
                command, cwd=TREE, env=environment(), capture_output=True, text=True, timeout=SECONDS, check=False
            )
        except subprocess.TimeoutExpired:
            return Failure(test, "no end")
        if ended.returncode == 1:
            found = re.search(r"^FAILED (.+?)(?: - |$)", ended.stdout, re.MULTILINE)
            return Failure(found[1] if found else test)
        if ended.returncode < 0:
            return Failure(test, f"signal {-ended.returncode}")
        if ended.returncode != 0:
            raise SystemExit(f"{test} could not be run:\n{ended.stdout[-3000:]}{ended.stderr[-1000:]}")
    return None


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
