"""Initial velocities along a beam, beside those of a rigid motion."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks


def initial_velocities(
    where: str, length: float, along: Any, velocities: Any
) -> tuple[FloatArray, FloatArray]:
    """Checked places (m,) in m and velocities (m, 3) in m/s, none for None."""
    if along is None and velocities is None:
        return np.zeros(0), np.zeros((0, 3))
    if along is None or velocities is None:
        missing, other = ("along", "velocities") if along is None else ("velocities", "along")
        raise ModelError(f"{where}.{missing}", f"is missing: {other} is given", "give both or none")
    x = checks.array(along, f"{where}.along", (None,))
    v = checks.array(velocities, f"{where}.velocities", (None, 3))
    if len(x) < 2 or np.any(np.diff(x) <= 0.0):
        raise ModelError(f"{where}.along", "must be at least two arc lengths, increasing")
    if x[0] < -1e-9 * length or x[-1] > (1.0 + 1e-9) * length:
        what = f"goes from {x[0]:g} m to {x[-1]:g} m, the beam from 0 to {length:g} m"
        raise ModelError(f"{where}.along", what)
    if len(v) != len(x):
        raise ModelError(f"{where}.velocities", f"has {len(v)} rows for {len(x)} arc lengths")
    return x, v


def rates_at(along: FloatArray, velocities: FloatArray, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Velocities (n, 3) in m/s at arc lengths (n,) in m, and their derivatives along the beam in 1/s."""
    from scipy.interpolate import make_interp_spline

    spline = make_interp_spline(along, velocities, k=min(3, len(along) - 1))
    return np.asarray(spline(x)), np.asarray(spline(x, 1))
