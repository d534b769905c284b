"""Sessions for checking and building; `make lint` and its like run them in the environment that make has built."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tarfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import nox

nox.needs_version = ">=2024.10"
nox.options.sessions = ["lint", "tests"]
nox.options.reuse_existing_virtualenvs = True

PROJECT = nox.project.load_toml("pyproject.toml")
PYTHONS = ["3.11", "3.12", "3.13", "3.14", "3.15"]
PYTHON_FILES = ["src", "tests", "examples", "docs/site", "noxfile.py"]


def cpp_files() -> list[str]:
    return sorted(str(path) for ending in ("*.hpp", "*.cpp") for path in Path("relax").rglob(ending))


def install(session: nox.Session, *groups: str) -> None:
    """Install dependency groups, unless the session runs in an environment that is already there."""
    if session.virtualenv.venv_backend != "none":
        session.install(*nox.project.dependency_groups(PROJECT, *groups))


@nox.session
def lint(session: nox.Session) -> None:
    """Check style, formatting, types and layers."""
    install(session, "lint")
    session.run("ruff", "check", *PYTHON_FILES)
    session.run("ruff", "format", "--check", *PYTHON_FILES)
    session.run("clang-format", "--dry-run", "-Werror", *cpp_files())
    session.run("mypy")
    session.run("lint-imports", env={"PYTHONPATH": "src"})


@nox.session(name="format")
def format_sources(session: nox.Session) -> None:
    """Format all sources in place."""
    install(session, "lint")
    session.run("ruff", "check", "--fix", *PYTHON_FILES)
    session.run("ruff", "format", *PYTHON_FILES)
    session.run("clang-format", "-i", *cpp_files())


@nox.session
def docs(session: nox.Session) -> None:
    """Build the documentation's site in site/, warnings as errors, and the manual page site/statehtn.1."""
    install(session, "docs")
    session.run("mkdocs", "build", "--strict", *session.posargs, env={"NO_MKDOCS_2_WARNING": "1"})
    source = ("--module", "statehtn.cli.arguments", "--function", "make_parser", "--prog", "statehtn")
    session.run("argparse-manpage", *source, "--project-name", "statehtn", "--output", "site/statehtn.1")


@nox.session
def core(session: nox.Session) -> None:
    """Build the core without Python, with sanitizers and warnings as errors, and run its tests."""
    install(session, "build")
    with session.chdir("relax"):
        session.run("cmake", "--preset", "sanitize", silent=True)
        session.run("cmake", "--build", "--preset", "sanitize", silent=True)
        session.run("ctest", "--preset", "sanitize")


@nox.session(venv_backend="virtualenv")
def sanitize(session: nox.Session) -> None:
    """Build the Python module with the sanitizers of the core, and run tests with it (some minutes).

    It has an environment of its own, so that this module never takes the place of the usual one. Without arguments for
    pytest it runs the paper's tables and the random problems of the differential tests.
    """
    presets = json.loads(Path("relax/CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
    flags = next(preset["cacheVariables"] for preset in presets if preset["name"] == "sanitize")["CMAKE_CXX_FLAGS"]
    install(session, "build")
    session.install("hypothesis>=6.100", "pyperplan>=2.1", "pytest>=8")
    settings = {"build-dir": "build/sanitize-module", "cmake.build-type": "Debug", "install.strip": "false"}
    settings["cmake.define.CMAKE_CXX_FLAGS"] = f"{flags} -O1"  # it runs far longer than it compiles
    session.install("--no-build-isolation", *(f"-C{name}={value}" for name, value in settings.items()), ".")
    compiler = os.environ.get("CXX", "c++")
    # Python itself is not sanitized: the library must be there before it starts. It keeps memory at its exit.
    library = str(session.run(compiler, "-print-file-name=libasan.so", external=True, silent=True)).strip()
    if not Path(library).is_absolute():
        session.error(f"{compiler} has no libasan.so; set CXX to g++, remove build/sanitize-module and try again")
    env = {"LD_PRELOAD": library, "ASAN_OPTIONS": "detect_leaks=0", "UBSAN_OPTIONS": "print_stacktrace=1"}
    chosen = session.posargs or ["tests/regression", "tests/differential"]
    session.run("python", "-m", "pytest", "-p", "no:cacheprovider", *chosen, env=env)


@nox.session
def tidy(session: nox.Session) -> None:
    """Run clang-tidy over the core, on all cores (some minutes); arguments are the files to look at."""
    install(session, "build", "tidy")
    with session.chdir("relax"):
        session.run("cmake", "--preset", "dev", silent=True)
    own = (path for path in Path("relax").glob("*/*.cpp") if path.parent.name not in ("bindings", "tests"))
    program = shutil.which("clang-tidy", path=os.pathsep.join([*session.bin_paths, os.environ["PATH"]]))
    if program is None:
        session.error("clang-tidy cannot be found")

    def check(source: str) -> int:
        return subprocess.run([program, "--quiet", "-p", "build/dev", source], check=False).returncode

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        failed = sum(map(bool, pool.map(check, session.posargs or sorted(map(str, own)))))
    if failed:
        session.error(f"clang-tidy complains of {failed} files")


@nox.session(python=PYTHONS)
def tests(session: nox.Session) -> None:
    """Install the package and run the test suite with one version of Python."""
    session.install(".", *nox.project.dependency_groups(PROJECT, "test"))
    session.run("pytest", *session.posargs)


@nox.session
def precision(session: nox.Session) -> None:
    """Compare 20 000 random problems whose costs are far apart with exact arithmetic (half an hour)."""
    session.install(".", *nox.project.dependency_groups(PROJECT, "test"))
    thorough = ("--hypothesis-profile", "thorough", "-rP")
    session.run("pytest", *thorough, "tests/differential/test_optimal_is_optimal.py", *session.posargs)


@nox.session
def objectives(session: nox.Session) -> None:
    """Compare some ten thousand answers for all objectives with all plans and their exact laws (an hour)."""
    session.install(".", *nox.project.dependency_groups(PROJECT, "test"))
    thorough = ("--hypothesis-profile", "objectives", "-rP")
    session.run("pytest", *thorough, "tests/differential/test_objectives.py", *session.posargs)


@nox.session
def policies(session: nox.Session) -> None:
    """Compare the policies of thousands of random problems with exact arithmetic on their whole graphs (an hour)."""
    session.install(".", *nox.project.dependency_groups(PROJECT, "test"))
    thorough = ("--hypothesis-profile", "objectives", "-rP")
    session.run("pytest", *thorough, "tests/differential/test_policies.py", *session.posargs)


@nox.session
def storm(session: nox.Session) -> None:
    """Compare models and policies of 200 random problems, at every budget, with the model checker Storm (an hour)."""
    session.install(".[check]", *nox.project.dependency_groups(PROJECT, "test"))
    thorough = ("--hypothesis-profile", "objectives", "-rP")
    session.run("pytest", *thorough, "tests/differential/test_storm.py", *session.posargs)


@nox.session(venv_backend="virtualenv")
def mutation(session: nox.Session) -> None:
    """Break the conditions on which optimality hangs, one at a time, and see whether the tests notice (half an hour).

    It has an environment of its own, without the package: the tests run a copy of it. Arguments are parts of names.
    """
    install(session, "build", "test")
    session.install(*PROJECT["project"]["dependencies"])
    session.run("python", "-m", "tests.mutation.run", *session.posargs)


@nox.session(python=["3.11", "3.12"])
def package(session: nox.Session) -> None:
    """Build and check source distribution and wheel, install each in an empty environment, and try it there.

    Python 3.11 has a wheel of its own, that of 3.12 is for all later ones: it is tried with those that are installed.
    The core is compiled twice (some minutes; less with CMAKE_CXX_COMPILER_LAUNCHER=ccache).
    """
    session.install("abi3audit", "auditwheel", "build", "twine")
    folder = Path("build", "package", str(session.python))
    shutil.rmtree(folder, ignore_errors=True)
    session.run("python", "-m", "build", "--sdist", "--outdir", str(folder))
    (source,) = folder.glob("*.tar.gz")
    unpacked = unpack(session, source)
    session.run("python", "-m", "pip", "wheel", "--no-cache-dir", "--no-deps", "--wheel-dir", str(folder), str(source))
    (wheel,) = folder.glob("*.whl")
    session.run("twine", "check", "--strict", str(source), str(wheel))
    if sys.platform == "linux":
        session.run("auditwheel", "show", str(wheel))
    if "abi3" in wheel.name:
        session.run("abi3audit", "--strict", "--report", str(wheel))
    if wheel.stat().st_size > LARGEST_WHEEL:
        session.error(f"{wheel} has {wheel.stat().st_size} bytes")
    for file, python in ((wheel, session.python), *((wheel, new) for new in newer(session)), (source, session.python)):
        try_out(session, file.resolve(), str(python), unpacked)


LARGEST_WHEEL = 5_000_000  # bytes


def newer(session: nox.Session) -> Iterator[str]:
    """Yield the later versions of Python that use this one's wheel and are installed."""
    for version in PYTHONS[PYTHONS.index(str(session.python)) + 1 :] if session.python != "3.11" else []:
        found = shutil.which(f"python{version}")
        # A shim of pyenv may be there without the version that it is for.
        if found and "Python" in str(session.run(found, "-V", external=True, silent=True, success_codes=range(256))):
            yield version


def unpack(session: nox.Session, source: Path) -> Path:
    """Unpack a source distribution; it has to have the repository's files, but for those left out on purpose."""
    temporary = Path(session.create_tmp())
    with tarfile.open(source) as archive:
        archive.extractall(temporary, filter="data")
    unpacked = temporary / source.name.removesuffix(".tar.gz")
    left_out = tuple(name.removeprefix("/") for name in PROJECT["tool"]["scikit-build"]["sdist"]["exclude"])
    listed = str(session.run("git", "ls-files", external=True, silent=True)).splitlines()
    expected = {name for name in listed if not name.startswith(left_out)} | {"PKG-INFO"}
    found = {path.relative_to(unpacked).as_posix() for path in unpacked.rglob("*") if path.is_file()}
    if found != expected:
        session.error(f"the source distribution has other files than the repository: {sorted(found ^ expected)}")
    return unpacked


def try_out(session: nox.Session, file: Path, python: str, unpacked: Path) -> None:
    """Install a distribution in an empty environment, and run demo and some tests there, beside no other sources."""
    environment = Path(session.create_tmp(), f"{python}-{file.suffix}").resolve()
    session.run(f"python{python}", "-m", "venv", "--clear", str(environment), external=True)
    run = str(environment / "bin" / "python")
    with session.chdir(unpacked):
        session.run(run, "-m", "pip", "install", "--quiet", "--no-cache-dir", str(file), external=True)
        av = ("domains/av/domain.hddl", "domains/av/p1.hddl")
        for agent in (("neutral",), ("averse", "--alpha", "0.9"), ("seeking", "--alpha", "0.9")):
            session.run(run, "-m", "statehtn", "plan", *av, "--quiet", "--attitude", *agent, external=True)
        session.run(run, "examples/demo.py", *av, external=True)
        session.run(run, "-m", "pip", "install", "--quiet", "hypothesis>=6.100", "pytest>=8", external=True)
        chosen = (
            "tests/test_minimal.py",
            "tests/regression",
            "tests/unit/test_cli.py",
            "tests/unit/test_planner.py",
        )
        session.run(run, "-m", "pytest", "-q", "-p", "no:cacheprovider", *chosen, external=True)


@nox.session
def verifier(session: nox.Session) -> None:
    """Have the competitions' verifier check, strictly, a plan from each of their domains that is solved in 10 seconds.

    STATEHTN_VERIFIER names the folder of pandaPIparser.tar.gz, STATEHTN_IPC and STATEHTN_IPC2023 those of the problems
    of 2020 and 2023. What is not named is looked for in ../shared.
    """
    folders = {name: Path(os.environ.get(name, default)).resolve() for name, default in COMPETITION.items()}
    archive = folders.pop("STATEHTN_VERIFIER") / "pandaPIparser.tar.gz"
    if missing := [str(path) for path in (archive, *folders.values()) if not path.exists()]:
        session.skip(f"there is no {', no '.join(missing)}")
    if missing := [tool for tool in ("g++", "make", "flex", "bison", "gengetopt") if shutil.which(tool) is None]:
        session.skip(f"{', '.join(missing)} cannot be found (Debian/Ubuntu: apt install {' '.join(missing)})")
    if session.virtualenv.venv_backend != "none":
        session.install(".", "hypothesis>=6.100", "pytest>=8", "pytest-xdist>=3.6")
    program = Path("build", "verifier", "pandaPIparser").resolve()
    program.parent.mkdir(parents=True, exist_ok=True)
    session.run("tar", "-xzf", str(archive), "-C", str(program.parent), external=True)
    session.run("make", "-s", "-C", str(program), external=True, silent=True)
    env = {name: str(path) for name, path in folders.items()}
    env["STATEHTN_VERIFIER_PROGRAM"] = str(program / "pandaPIparser")
    session.run("python", "-m", "pytest", "-n", "auto", "tests/verifier", *session.posargs, env=env, external=True)


COMPETITION = {
    "STATEHTN_VERIFIER": "../shared/verifier",
    "STATEHTN_IPC": "../shared/ipc",
    "STATEHTN_IPC2023": "../shared/ipc2023",
}
