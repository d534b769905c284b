"""Sessions for checking and building; `make lint` and its like run them in the environment that make has built."""

from __future__ import annotations

from pathlib import Path

import nox

nox.needs_version = ">=2024.10"
nox.options.sessions = ["lint", "tests"]
nox.options.reuse_existing_virtualenvs = True

PROJECT = nox.project.load_toml("pyproject.toml")
PYTHON_FILES = ["src", "tests", "examples", "noxfile.py"]


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
def core(session: nox.Session) -> None:
    """Build the core without Python with warnings as errors, and run its tests under sanitizers."""
    install(session, "build")
    with session.chdir("relax"):
        for preset in ("dev", "sanitize"):
            session.run("cmake", "--preset", preset, silent=True)
            session.run("cmake", "--build", "--preset", preset, silent=True)
        session.run("ctest", "--preset", "sanitize")


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
    session.install(".[test]")
    session.run("pytest", *session.posargs)
