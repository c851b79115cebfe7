"""Supports that move at once, of what is at rest at the start: there the velocity jumps.

Of a motion that begins smoothly the rate at the start is nothing: seen over shorter and shorter times it
shrinks with them.  What begins with its rate pushes what does not have that rate already.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ..bodies.beam import Beam
from ..bodies.rigid import Body
from ..joints.basic import Fixation, Revolute, Slide, Spherical
from ..joints.guides import Cylindrical, Planar, Prismatic
from ..joints.rigid_joints import Universal, Weld
from ..joints.touching import bodies_of
from .jumps import COARSE, FINE, FIRST, GROWS, SHARE, STAYS, Jump, Motion, motion_of
from .support import Hold, Support
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
    # a winch pays out evenly from the start, see docs/theory/winch.md
    moved = {s: [*motion_of(s, exact=True)] for s in model.supports if not isinstance(s, Winch)}
    beside = _joined(model) if any(moved.values()) else {}
    for support, motions in moved.items():
        pushed = [body for body in _beside(support, beside) if rests(support, body)] if motions else []
        for motion in motions if pushed else []:
            try:
                found += _at_start(motion, support, pushed[0].name, start, end, step)
            except ModelError:  # the run says at which step
                continue
    return found


def moved_with(model: Any, support: Support) -> list[Body]:
    """What a support moves: its beam, and what is joined to the mass or rigid body that it moves."""
    return list(_beside(support, _joined(model)))


def _joined(model: Any) -> dict[str, list[Body]]:
    """By the name of a body what moves with it: beams that are joined to it, and what no support holds."""
    held = {support.point.body.name for support in model.supports}
    found: dict[str, list[Body]] = {}
    for joint in model.connections:
        bodies = [model.bodies[name] for name in bodies_of(joint)] if isinstance(joint, RIGID) else []
        for body in bodies:
            others = (other for other in bodies if other is not body)
            found.setdefault(body.name, []).extend(
                other for other in others if isinstance(other, Beam) or other.name not in held
            )
    return found


def _beside(support: Support, joined: dict[str, list[Body]]) -> Iterator[Body]:
    """The beam that a support moves, or what is joined to the mass or rigid body that it moves."""
    body = support.point.body
    if isinstance(body, Beam):
        yield body
    yield from joined.get(body.name, [])


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
