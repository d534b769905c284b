"""Sessions for checking and building; `make lint` and its like run them in the environment that make has built."""

from __future__ import annotations

import json
import os
from pathlib import Path

import nox

nox.needs_version = ">=2024.10"
nox.options.sessions = ["lint", "tests"]
nox.options.reuse_existing_virtualenvs = True

PROJECT = nox.project.load_toml("pyproject.toml")
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
    """Build the documentation's site in site/, warnings as errors."""
    install(session, "docs")
    session.run("mkdocs", "build", "--strict", *session.posargs, env={"NO_MKDOCS_2_WARNING": "1"})


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
    settings["cmake.define.CMAKE_CXX_FLAGS"] = flags
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
    """Run clang-tidy over the core (some minutes)."""
    install(session, "build", "lint")
    with session.chdir("relax"):
        session.run("cmake", "--preset", "dev", silent=True)
    sources = sorted(str(path) for path in Path("relax/src").glob("*.cpp"))
    session.run("clang-tidy", "--quiet", "-p", "build/dev", *sources)


@nox.session(python=["3.11", "3.12", "3.13", "3.14"])
def tests(session: nox.Session) -> None:
    """Install the package and run the test suite with one version of Python."""
    session.install(".", *nox.project.dependency_groups(PROJECT, "test"))
    session.run("pytest", *session.posargs)
