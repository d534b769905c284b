"""By what the core was compiled."""

from __future__ import annotations

import statehtn._relax as _relax

COMPILER = _relax.compiler()
"""The compiler and its version."""
