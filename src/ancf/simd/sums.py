"""Sums of vectors in eight lanes."""

from __future__ import annotations

from typing import Any

from ..compiled import formula
from .memory import load


@formula
def lanes_plus(x: Any, w: Any, d: Any, k: Any, i: Any) -> Any:
    """Three values x plus w times those at ``d[k, i]``, ``d[k, i + 1]`` and ``d[k, i + 2]``."""
    return x[0] + w * load(d, k, i), x[1] + w * load(d, k, i + 1), x[2] + w * load(d, k, i + 2)
