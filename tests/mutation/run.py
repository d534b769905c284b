"""Break what optimality hangs on, one condition at a time, and see whether the tests notice.

`python -m tests.mutation.run [PART OF A NAME ...]` builds a copy of the repository in build/mutation, applies each
mutation there, compiles what it touches, and runs the tests that should notice. It takes about a minute for each, and
fails if a mutation survives.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from tests.mutation.mutations import MUTATIONS, Mutation

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "build" / "mutation"
TREE = FOLDER / "tree"
COPIED = ("relax", "src", "tests", "domains", "pyproject.toml")
SECONDS = 900  # a test that does not come to its end has noticed


def main(parts: Sequence[str]) -> int:
    chosen = [mutation for mutation in MUTATIONS if not parts or any(part in mutation.name for part in parts)]
    copy()
    build()
    check_import()
    tests = sorted({test for mutation in chosen for test in mutation.tests})
    if noticed := failure(tests):
        raise SystemExit(f"the tests fail without a mutation: {noticed}")
    survived = 0
    for mutation in chosen:
        start = time.monotonic()
        with applied(mutation):
            build()
            noticed = failure(mutation.tests)
        survived += noticed is None
        seconds = time.monotonic() - start
        print(f"{mutation.name}: {f'killed by {noticed}' if noticed else 'SURVIVED'} ({seconds:.0f} s)", flush=True)
    print(f"{len(chosen) - survived} of {len(chosen)} mutations were killed")
    return int(survived > 0)


def copy() -> None:
    """Copy what is built and tested; what has not changed since the last time keeps its times, and is not built."""
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.rmtree(TREE / name, ignore_errors=True)
            shutil.copytree(ROOT / name, TREE / name, ignore=shutil.ignore_patterns("__pycache__", "_relax*.so"))
        else:
            shutil.copy2(ROOT / name, TREE / name)


def build() -> None:
    """Compile the module of the copy."""
    import nanobind

    binary = FOLDER / "core"
    if not (binary / "build.ninja").exists():
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DSKBUILD=1", f"-DPython_EXECUTABLE={sys.executable}"]
        options += [f"-Dnanobind_DIR={nanobind.cmake_dir()}"]
        if shutil.which("ccache"):
            options += ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"]
        call("cmake", "-S", TREE / "relax", "-B", binary, "-G", "Ninja", *options)
    call("cmake", "--build", binary)
    for module in binary.glob("_relax*.so"):
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


def failure(tests: Sequence[str]) -> str | None:
    """The first test that fails, of as many examples as in CI; None if none does."""
    for test in tests:
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-q",
            "-x",
            "-p",
            "no:cacheprovider",
            "--hypothesis-profile=mutation",
            test,
        ]
        try:
            ended = subprocess.run(
                command, cwd=TREE, env=environment(), capture_output=True, text=True, timeout=SECONDS, check=False
            )
        except subprocess.TimeoutExpired:
            return f"{test} (no end)"
        if ended.returncode == 1:
            found = re.search(r"^FAILED (\S+)", ended.stdout, re.MULTILINE)
            return found[1] if found else test
        if ended.returncode < 0:
            return f"{test} (signal {-ended.returncode})"
        if ended.returncode != 0:
            raise SystemExit(f"{test} could not be run:\n{ended.stdout[-3000:]}{ended.stderr[-1000:]}")
    return None


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
