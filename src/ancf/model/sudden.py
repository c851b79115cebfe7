"""Supports that move at once, of what is at rest at the start: there the velocity jumps.

Of a motion that begins smoothly the rate at the start is nothing: seen over shorter and shorter times it
shrinks with them.  What begins with its rate pushes what does not have that rate already.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from .beam import Beam
from .bodies import Body
from .guides import Cylindrical, Planar, Prismatic
from .joints import Fixation, Revolute, Slide, Spherical
from .jumps import COARSE, FINE, FIRST, GROWS, SHARE, STAYS, Jump, Motion, motion_of
from .rigid_joints import Universal, Weld
from .supports import Hold, Support
from .touching import bodies_of
from .winch import Winch

#: Joints that give a body the velocity of another one; springs and contacts give way.
RIGID = (Fixation, Revolute, Spherical, Slide, Cylindrical, Planar, Prismatic, Universal, Weld)


def sudden(
    model: Any, start: float, end: float, step: float, rests: Callable[[Support, Body], bool]
) -> list[Jump]:
    """Supports that begin at a time with a velocity that a body beside them does not have.

    Parameters
    ----------
    model : Model
    start, end, step : float
        Of the run, s.
    rests : callable
        ``rests(support, body)``: whether the body does not move at the start as the support does.
    """
    found: list[Jump] = []
    for support in model.supports:
        moved = [] if isinstance(support, Winch) else [*motion_of(support, exact=True)]
        # a winch pays out evenly from the start, see docs/theory/winch.md
        pushed = [body for body in _beside(model, support) if rests(support, body)] if moved else []
        for motion in moved if pushed else []:
            try:
                found += _at_start(motion, support, pushed[0].name, start, end, step)
            except ModelError:  # the run says at which step
                continue
    return found


def _beside(model: Any, support: Support) -> Iterator[Body]:
    """The beam that a support moves, or what is joined to the mass or rigid body that it moves."""
    body = support.point.body
    if isinstance(body, Beam):
        yield body
    held = {other.point.body.name for other in model.supports}
    for joint in model.connections:
        names = bodies_of(joint) if isinstance(joint, RIGID) else []
        if body.name in names:
            others = (model.bodies[name] for name in names if name != body.name)
            yield from (other for other in others if isinstance(other, Beam) or other.name not in held)


def _at_start(
    motion: Motion, support: Support, body: str, start: float, end: float, step: float
) -> Iterator[Jump]:
    """The jump of a motion at the start, if it is one."""
    columns = ["xyz".index(c) for c in support.position] if isinstance(support, Hold) else slice(None)

    def rate(time: float) -> FloatArray:
        values: FloatArray = np.diff(motion.table(np.array([start, start + time]))[:, columns], axis=0)[0]
        return values / time

    coarse, fine = (float(np.linalg.norm(rate(step / share))) for share in (COARSE, FINE))
    if coarse > 0.0 and fine > GROWS * coarse:
        yield Jump(motion.where, True, start, fine * step / FINE, motion.unit)
        return
    times = np.linspace(start, end, FIRST + 1)
    values = motion.table(times)[:, columns]
    largest = float(np.max(np.linalg.norm(np.diff(values, axis=0), axis=1))) / (times[1] - times[0])
    if fine > STAYS * coarse and fine > SHARE * largest:
        yield Jump(motion.where, False, start, fine, motion.unit, body)
