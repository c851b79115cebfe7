"""What contacts between bodies do in states."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..records import Located
from .bump import bump_places, bump_values
from .roll import roll_values
from .rubbed import RUBBED


def bump_pressures(batch: Any, q: FloatArray, v: FloatArray) -> FloatArray:
    """Force and depth of each contact in states (n, size), NaN behind them, (n, contacts, 4)."""
    mine = batch._replace(found=batch.found.copy())  # a question must not move what a run measures
    out = np.full((len(q), len(batch.found), 4), np.nan)
    bump_values(Located(mine), q, v, out)
    return out


def roll_frictions(batch: Any, q: FloatArray, v: FloatArray) -> FloatArray:
    """Friction and the share of it that slips of each contact where a run begins, (contacts, 2)."""
    mine = batch._replace(found=batch.found.copy())
    roll_values(Located(mine), np.ascontiguousarray(q), np.ascontiguousarray(v))
    return np.array(mine.found[:, RUBBED:])


def bump_ends(batch: Any, j: int, q: FloatArray) -> FloatArray:
    """Where contact j is nearest in states (n, size): on both bodies, (n, 2, 3) m."""
    out = np.full((len(q), 2, 3), np.nan)
    bump_places(Located(batch), j, np.ascontiguousarray(q), out)
    return out
