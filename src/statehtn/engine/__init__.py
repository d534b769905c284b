"""The engine of unified-planning (UP): a planner and a validator for hierarchical problems.

`statehtn.register()` lets UP find it by the name `statehtn`; so does a file `up.ini` with the lines

[engine statehtn]
module_name: statehtn.engine
class_name: StateHtnEngine

UP asks the engine's `supported_kind` whether a problem is one for it, and refuses others by itself.
"""

from __future__ import annotations

from statehtn.errors import UsageError

try:
    import unified_planning  # noqa: F401
except ImportError:
    raise UsageError("the engine needs the package 'unified-planning': pip install 'statehtn[up]'") from None

from statehtn.engine.engine import StateHtnEngine
from statehtn.engine.kind import SUPPORTED_KIND
from statehtn.engine.parameters import ADMISSIBLE

__all__ = ["ADMISSIBLE", "SUPPORTED_KIND", "StateHtnEngine"]
