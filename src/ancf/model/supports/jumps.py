"""Given motions that jump: of what they move, a jump of the rate is a push that no step resolves.

Forces of inertia grow as such a jump is divided among shorter steps, and their work does not converge. It is
looked for in values of the motion: at a corner the change of the rate stays as it is when the times move
together, elsewhere it goes with their distance, and at a jump of the value it grows.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, TypeGuard

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ..functions.function import TimeFunction
from ..joints.basic import Slide

#: How places in files and descriptions begin.
NUMBERED = ("supports[", "connections[")

Table = Callable[[FloatArray], FloatArray]

#: Times at which a motion is looked at, of the first steps and of the whole, and corners looked at closer.
FIRST, MOST = 400, 4
#: Share of the largest rate that a jump has at least; of a step, how close times come before and after.
SHARE, COARSE, FINE = 0.05, 8.0, 512.0
#: How the change of the rate goes from coarse to fine: at a corner it stays, at a jump it grows.
STAYS, GROWS = 0.5, 4.0


class Jump(NamedTuple):
    """Where and when a motion jumps: the value itself, or its rate."""

    where: str
    of_value: bool
    time: float
    size: float
    unit: str
    body: str = ""  # that is at rest while the motion begins with its rate

    def __str__(self) -> str:
        if self.body:
            text = f"its rate is {self.size:.3g} {self.unit}/s from t = {self.time:.4g} s on"
            grow = "let it grow from zero (ramp= of a Series, ramp(t, 0, 5) in a formula)"
            hint = f'{grow}, or give "{self.body}" that motion by set_motion'
            push = f'"{self.body}" does not move so: an impulse whose size depends on the step'
            return f"{self.where}: {text}, {push}; {hint}"
        if self.of_value:
            text = f"its value jumps by {self.size:.3g} {self.unit} at t = {self.time:.4g} s"
            return f"{self.where}: {text}, which no step can follow; let it grow over several steps"
        text = f"its rate jumps by {self.size:.3g} {self.unit}/s at t = {self.time:.4g} s"
        return f"{self.where}: {text}, an impulse whose size depends on the step; round the corner off"


class Motion(NamedTuple):
    """Values of a given motion at times (n,), shape (n, k), with its place in the model and its unit."""

    where: str
    unit: str
    table: Table
    straight: bool = False


def jumps(model: Any, start: float, end: float, step: float) -> list[Jump]:
    """The largest jump of each given motion of a model between two times, s.

    Motions with given exact derivatives and those that a run is led by are left out.
    """
    if not (math.isfinite(end) and end - start > 2.0 * step):
        return []
    found = []
    for motion in motions(model):
        try:
            found += _of_motion(motion, start, end, step)
        except ModelError:  # the run says at which step
            continue
    return found


def _turned(function: TimeFunction) -> Table:
    """Axes that a rotation vector turns, by angles in rad: it may jump by a full turn, they do not."""
    from scipy.spatial.transform import Rotation

    def table(times: FloatArray) -> FloatArray:
        axes: FloatArray = Rotation.from_rotvec(function.table(times)).as_matrix().reshape(-1, 9)
        return axes / math.sqrt(2.0)

    return table


def motions(model: Any) -> Iterator[Motion]:
    """Given motions of supports, winches and sliding joints that vary, without those that a run is led by."""
    for support in model.supports:
        yield from motion_of(support)
    for joint in model.connections:
        if isinstance(joint, Slide) and _varies(joint.motion):
            yield Motion(place_of(joint, joint.motion), "m", joint.motion.table)


def motion_of(support: Any, exact: bool = False) -> Iterator[Motion]:
    """Given motions of a support; those with exact derivatives as well if they are asked for."""
    known = not exact and getattr(support, "rotation_rate", None) is not None
    for key, unit in (("displacement", "m"), ("length", "m"), ("rotation", "rad")):
        function = None if known and key == "rotation" else getattr(support, key, None)
        if _varies(function):
            straight = any(series.interpolation == "linear" for series in function.series)
            yield Motion(place_of(support, function), unit, function.table, straight)
    if _varies(function := getattr(support, "rotation_vector", None)):
        yield Motion(place_of(support, function), "rad", _turned(function))


def place_of(item: Any, function: TimeFunction) -> str:
    """Where a motion is given: as in the script, or of a file or a description with the name of its item."""
    where = function.where
    return f'{where} of "{item.name}"' if where.startswith(NUMBERED) else where


def _varies(function: Any) -> TypeGuard[TimeFunction]:
    known = isinstance(function, TimeFunction) and not (function.inputs or function.missing)
    return known and not function.constant


def _of_motion(motion: Motion, start: float, end: float, step: float) -> list[Jump]:
    """The largest jump, among the first steps and over all of the time."""
    steps = round((end - start) / step)
    found = _between(motion, start, end, step, int(np.clip(steps, 8, FIRST)))
    if steps > 2 * FIRST:
        found += _between(motion, start, start + FIRST * step, step, FIRST)
    return [max(found, key=lambda jump: (jump.of_value, jump.size))] if found else []


def _between(motion: Motion, start: float, end: float, step: float, count: int) -> list[Jump]:
    """Corners between two times that stay corners from close by."""
    t = np.linspace(start, end, count + 1)
    rates = np.diff(motion.table(t), axis=0) / (t[1] - t[0])
    changes = np.linalg.norm(np.diff(rates, axis=0), axis=1)
    largest = float(np.max(np.linalg.norm(rates, axis=1)))
    near = np.pad(changes, 2, mode="edge")
    sharp = changes - np.maximum(near[:-4], near[4:])  # beyond that of the neighbours
    places = [int(k) for k in np.argsort(sharp)[::-1][:MOST] if sharp[k] > SHARE * largest]
    found = [_closer(motion, float(t[k]), float(t[k + 2]), step) for k in places]
    return [jump for jump in found if jump is not None and (jump.of_value or jump.size > SHARE * largest)]


def _closer(motion: Motion, low: float, high: float, step: float) -> Jump | None:
    """Move together around the sharpest corner; None if there is none."""
    coarse = None
    while True:
        t = np.linspace(low, high, 5)
        values = motion.table(t)
        change = np.diff(np.diff(values, axis=0), axis=0) / (t[1] - t[0])
        sizes: FloatArray = np.linalg.norm(change, axis=1)
        k = int(np.argmax(sizes))
        low, high, now = float(t[k]), float(t[k + 2]), float(sizes[k])
        width = high - low
        if coarse is None and width <= step / COARSE:
            coarse = now
        if coarse is not None and width <= step / FINE:
            break
    if now > GROWS * coarse:
        whole = float(np.linalg.norm(values[k + 2] - values[k]))
        return Jump(motion.where, True, float(t[k + 1]), whole, motion.unit)
    if now > STAYS * coarse:
        return Jump(motion.where, False, float(t[k + 1]), now, motion.unit)
    return None
