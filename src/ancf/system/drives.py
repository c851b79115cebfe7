"""Lengths that a winch changes step by step: it follows a speed or a length with a limited acceleration.

The length and its rate are those of the state, so that a run goes on from any state; within a step the speed
changes evenly.  With a step h, the largest change a h of the speed V in a step, and the way e = wanted - L
that is left when the drum is stopped in this step, a length is followed with the largest speed v that is
allowed and from which the drum can still be stopped there,

    v^2/(2 a) + h v/2 = |e|.

This brakes with a to the last step, in which the rest, less than a h^2/2, is taken.
"""

from __future__ import annotations

import math

import numpy as np

from ..arrays import FloatArray
from ..model.supports.winch import Winch


def driven_steps(
    winch: Winch, length: float, rate: float, times: FloatArray, step: float, given: dict[str, float]
) -> FloatArray:
    """Length, rate and second rate at the ends of steps.

    Parameters
    ----------
    winch : Winch
        That is driven.
    length, rate : float
        At the start, m and m/s.
    times : ndarray, shape (n,)
        Ends of the steps, s.
    step : float
        s.
    given : dict of str to float
        The model's inputs.

    Returns
    -------
    ndarray, shape (n, 3)

    Raises
    ------
    ModelError
        Next to nothing would be left of the cable, or a function fails.
    """
    out = _followed(winch, length, rate, times, step, given)
    winch.check_left(out[:, 0], times)
    return out


def acceleration_from(
    winch: Winch, length: float, rate: float, time: float, step: float, given: dict[str, float]
) -> float:
    """Second rate in a step from a time on, m/s^2: that of the drum where something begins at the time."""
    return float(_followed(winch, length, rate, np.array([time + step]), step, given)[0, 2])


def _followed(
    winch: Winch, length: float, rate: float, times: FloatArray, step: float, given: dict[str, float]
) -> FloatArray:
    """What :func:`driven_steps` gives, however little is left of the cable."""
    assert winch.speed is not None
    assert winch.acceleration is not None
    most = winch.acceleration * step
    speeds = winch.speed.under(given, times)[:, 0].tolist()
    goals = winch.length.under(given, times)[:, 0].tolist() if winch.goes_to_length else None
    out = np.empty((len(times), 3))
    for k, wanted in enumerate(speeds):
        before = rate
        if goals is None:
            rate = min(max(wanted, rate - most), rate + most)
            length += 0.5 * step * (before + rate)
        else:
            length, rate = _towards(goals[k], length, rate, wanted, most, step)
        out[k] = length, rate, (rate - before) / step
    return out


def _towards(
    goal: float, length: float, rate: float, fastest: float, most: float, step: float
) -> tuple[float, float]:
    """Length and rate a step nearer to a length."""
    left = goal - length - 0.5 * step * rate
    if abs(rate) <= most and abs(left) <= 0.5 * most * step:
        return goal, 0.0
    half = 0.5 * most
    speed = min(math.sqrt(half * half + 2.0 * most * abs(left) / step) - half, fastest)
    rest = min(max(math.copysign(speed, left), rate - most), rate + most)
    return length + 0.5 * step * (rate + rest), rest
