# Everything happens in the virtual environment .venv; stamp files in it remember what is done.
# All paths are relative, so that the name of the working directory may contain spaces.

PYTHON ?= python3
VENV := .venv
RUN := $(VENV)/bin/python
# Modules are compiled when they are first imported: most of what is installed never is.
INSTALL := $(RUN) -m pip --disable-pip-version-check install --no-compile
# Directories are listed, too: their time changes when a file is added or removed.
CORE_SOURCES := $(shell find relax)
# The sessions of noxfile.py run in this environment here, not in ones of their own.
NOX := PATH="$(CURDIR)/$(VENV)/bin:$$PATH" $(RUN) -m nox --no-venv --sessions
HYPOTHESIS_PROFILE := $(if $(CI),ci,dev)
AV := domains/av/domain.hddl domains/av/p1.hddl

SHELL := bash

.DEFAULT_GOAL := help
.PHONY: help demo test lint format docs core-test benchmark clean check-python check-compiler
.DELETE_ON_ERROR:

help:  ## list the targets
	@sed -n 's/^\([a-z-]*\):.*##/\1:/p' Makefile | awk -F ': *' '{ printf "  make %-12s %s\n", $$1, $$2 }'

demo: $(VENV)/.installed  ## plan for a vehicle that avoids, ignores and seeks risk
	@$(RUN) -m statehtn plan $(AV) --attitude averse --alpha 0.9 && echo
	@$(RUN) -m statehtn plan $(AV) --attitude neutral && echo
	@$(RUN) -m statehtn plan $(AV) --attitude seeking --alpha 0.9 && echo
	@$(RUN) examples/demo.py $(AV)

test: $(VENV)/.installed $(VENV)/.test-tools $(VENV)/.storm  ## run the whole test suite (with more random examples where CI is set)
	$(RUN) -m pytest -n auto --dist worksteal --hypothesis-profile=$(HYPOTHESIS_PROFILE) $(PYTEST_OPTIONS)

lint: $(VENV)/.installed $(VENV)/.test-tools $(VENV)/.lint-tools $(VENV)/.nox-tools  ## check style, types, layers and formatting
	$(NOX) lint

format: $(VENV)/.lint-tools $(VENV)/.nox-tools  ## format the Python and C++ sources
	$(NOX) format

docs: $(VENV)/.docs-tools $(VENV)/.nox-tools  ## build the documentation as a site that needs no network: site/index.html
	$(NOX) docs

core-test: $(VENV)/.build-tools $(VENV)/.nox-tools  ## build the core without Python, warnings as errors, and run its tests under sanitizers
	$(NOX) core

benchmark: $(VENV)/.installed  ## time the problems of the paper
	$(RUN) -m tests.benchmarks.paper

clean:  ## remove everything that was built, the virtual environment included
	rm -rf $(VENV) build dist site .mypy_cache .pytest_cache .ruff_cache .hypothesis .import_linter_cache .nox .benchmarks
	find src tests -name __pycache__ -prune -exec rm -rf {} +
	rm -f src/statehtn/_relax*.so

$(VENV)/.created: | check-python
	$(PYTHON) -m venv $(VENV)
	@$(INSTALL) --quiet --upgrade 'pip>=25.1'
	@touch $@

# A dependency group of pyproject.toml.
$(VENV)/.%-tools: pyproject.toml $(VENV)/.created
	$(INSTALL) --quiet --group $*
	@touch $@

# The model checker that some tests ask. It has no wheel for every machine, and without one those tests are skipped.
$(VENV)/.storm: pyproject.toml $(VENV)/.created
	@$(INSTALL) --quiet --only-binary :all: 'stormpy>=2' || \
	  echo "no wheel of stormpy can be had here: what Storm would check is skipped" >&2
	@touch $@

# Of what pip and ninja say, only ninja's steps are shown, as "[12/26] relax_search": in a terminal each in place of the one
# before, else every tenth part of them.
STEPS := awk -F '[][/ ]+' '/^ *\[[0-9]+\/[0-9]+\] / { part = int(10 * $$2 / $$3); name = $$NF ~ /^unity_/ ? $$(NF-2) : $$NF; sub(/\.(o|dir)$$/, "", name); step = "[" $$2 "/" $$3 "] " name; \
  if (terminal) printf "\r\033[K%s", step; else if (part > shown) print step; shown = part; fflush() } \
  END { if (terminal) print "" }'

$(VENV)/.installed: pyproject.toml $(CORE_SOURCES) $(VENV)/.build-tools | check-compiler
	@echo "building the core; the first time this takes a minute or two"
	@set -o pipefail; \
	$(INSTALL) --verbose --no-build-isolation --editable . 2>&1 | tee $(VENV)/build.log | $(STEPS) terminal=$$(test -t 1 && echo 1) || { \
	  tail -n 40 $(VENV)/build.log >&2; \
	  echo "error: the core was not built; all that was said stands in $(VENV)/build.log" >&2; exit 1; }
	@touch $@

# Each check says in one line what is missing and how to get it.
check-python:
	@command -v $(PYTHON) >/dev/null || { \
	  echo "error: $(PYTHON) not found; install Python 3.11 or newer (Debian/Ubuntu: apt install python3 python3-venv python3-dev; Fedora: dnf install python3-devel; macOS: brew install python) or call make with PYTHON=/path/to/python" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	  echo "error: $$($(PYTHON) --version) is too old; install Python 3.11 or newer and call make with PYTHON=python3.11, say" >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { \
	  echo "error: $(PYTHON) has no venv module; install it (Debian/Ubuntu: apt install python3-venv; Fedora: dnf install python3-pip; macOS: brew install python)" >&2; exit 1; }

check-compiler: check-python
	@$(PYTHON) -c 'import os, sys, sysconfig; sys.exit(not os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h")))' || { \
	  echo "error: the header files of $(PYTHON) are missing; install them (Debian/Ubuntu: apt install python3-dev; Fedora: dnf install python3-devel; macOS: brew install python)" >&2; exit 1; }
	@for compiler in "$$CXX" c++ g++ clang++; do \
	  if test -n "$$compiler" && printf '#include <concepts>\n#include <span>\nint main() { return 0; }\n' \
	    | $$compiler -std=c++20 -fsyntax-only -x c++ - 2>/dev/null; then exit 0; fi; \
	done; \
	echo "error: no C++20 compiler found (tried \$$CXX, c++, g++, clang++); install one (Debian/Ubuntu: apt install g++; Fedora: dnf install gcc-c++; macOS: xcode-select --install)" >&2; exit 1
