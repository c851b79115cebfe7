"""What inputs of a linear model push and move: forces, displaced supports, turned clamps, slides, winches."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import ModelError
from ...system.core import apply_load, residual
from .damped_modal import Damped, physical

#: Change of a difference that is none, and how often a quarter of its step is taken.
SETTLED, QUARTERS = 1e-11, 14


@dataclass(frozen=True)
class Moved:
    """A motion s of held unknowns, which inputs give.

    Parameters
    ----------
    order : int
        1: inputs give its rate, 2: its second rate.
    gain : ndarray, shape (inputs,)
        Of the inputs in that.
    unknowns, along : ndarray, shape (k,)
        What moves, and by how much per unit of s.
    more : ndarray, shape (3, n)
        Forces per s'', s' and s that mass, damping and stiffness do not have at these unknowns.
    places, seen : ndarray, shape (l,)
        Where a state vector shows s, and by how much per unit.
    """

    order: int
    gain: FloatArray
    unknowns: IntArray
    along: FloatArray
    more: FloatArray
    places: IntArray
    seen: FloatArray


def along_of(moved: list[Moved], n: int) -> FloatArray:
    """Changes of all unknowns per unit of each motion, (n, moved)."""
    found = np.zeros((n, len(moved)))
    for j, one in enumerate(moved):
        found[one.unknowns, j] = one.along
    return found


def more_of(moved: list[Moved], n: int) -> FloatArray:
    """Their ``more``, (3, n, moved)."""
    found = np.zeros((3, n, len(moved)))
    for j, one in enumerate(moved):
        found[:, :, j] = one.more
    return found


def reading_of(moved: list[Moved]) -> tuple[IntArray, FloatArray]:
    """Places (k,) of a state vector, and the motions that follow from changes there, (moved, k).

    Of turns about several axes that a cable feels as one the smallest ones together.
    """
    places = np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *(one.places for one in moved)]))
    seen = np.zeros((len(places), len(moved)))
    for j, one in enumerate(moved):
        seen[np.searchsorted(places, one.places), j] = one.seen
    return places, np.asarray(np.linalg.pinv(seen, rcond=1e-12), dtype=np.float64)


def moved_alone(
    made: Damped, unknown: int, order: int, gain: FloatArray, more: FloatArray | None = None
) -> Moved:
    """One held unknown that inputs move: a component of a position, the place of a slide, a length."""
    at, one = np.array([unknown]), np.ones(1)
    none = np.zeros((3, made.system.n))
    return Moved(order, gain, at, one, none if more is None else more, at, one)


def turned(made: Damped, slots: IntArray, axis: FloatArray, order: int, gain: FloatArray) -> Moved:
    """Vectors of a node that a clamp holds, turned about a global axis (3,).

    A vector whose length is free has local axes, of which the first one is its own: it turns with them. The
    force along it is then that along the turned axis, which has a part of what the clamp holds it with.
    """
    supports = made.system.core.supports
    local = {int(slot): k for k, slot in enumerate(supports.rot_slot)}
    held = out_of_balance(made, made.q, made.v, made.a)
    more = np.zeros((3, made.system.n))
    unknowns, along, places, seen = [], [], [], []
    for slot in slots.tolist():
        three = slot + np.arange(3)
        k = local.get(slot)
        R = np.eye(3) if k is None else supports.rot_R[k, 0]
        change = np.cross(R.T @ axis, made.q[three])
        unknowns.append(three)
        along.append(change)
        places.append(three if k is None else int(supports.rot_shadow[k]) + np.arange(3))
        seen.append(R @ change)
        if k is not None:
            more[2, slot] = held[three] @ np.cross(R.T @ axis, np.eye(3)[0])
    at, by, shown, how = (np.concatenate(part) for part in (unknowns, along, places, seen))
    return Moved(order, gain, at, by, more, shown, how)


def forces_of(made: Damped, name: str) -> FloatArray:
    """Forces of an input on all unknowns along their own axes, per unit of it, (n,)."""
    inputs, first = made.system.inputs, made.system.inputs.given[name]

    def pushed(by: float) -> FloatArray:
        inputs.give(name, first + by)
        try:
            return -out_of_balance(made, made.q, made.v, made.a, loads_alone=True)
        finally:
            inputs.give(name, first)

    found: FloatArray = slope(pushed, max(abs(first), 1.0))
    return found


def columns_of(made: Damped, unknown: int) -> FloatArray:
    """Columns of mass, damping and stiffness of a length that a winch changes, (3, n)."""
    size = float(made.q[unknown])

    def column(k: int) -> FloatArray:
        def changed(by: float) -> FloatArray:
            a, v, q = (x.copy() for x in (made.a, made.v, made.q))
            (a, v, q)[k][unknown] += by
            return out_of_balance(made, q, v, a)

        return slope(changed, 1e-2 * size)

    return np.array([column(k) for k in range(3)])


def out_of_balance(
    made: Damped, q: FloatArray, v: FloatArray, a: FloatArray, loads_alone: bool = False
) -> FloatArray:
    """Forces out of balance along the axes of the unknowns, (n,); of loads alone where these alone change."""
    system, core = made.system, made.system.core
    before = core.loads.value.copy()
    core.loads.value[:] = system.inputs.moment(made.time, (q, v)).value[0]
    f, r = np.zeros(system.size), np.zeros(system.size)
    apply_load(core.loads, core.loads.value, f)
    residual(core.external if loads_alone else core.batches, core.ws, q, v, a, f, r)
    core.loads.value[:] = before
    found: FloatArray = made.axes.T @ physical(system, r)
    return found


def slope(value: Callable[[float], FloatArray], step: float) -> FloatArray:
    """Derivative of value(x) at 0 by differences of order four, with a step at which it has settled.

    Raises
    ------
    ModelError
        What the value itself raises, however small the step.
    """
    best, least, before = np.zeros(()), np.inf, None
    for attempt in range(QUARTERS):
        try:
            near, far = ((value(x) - value(-x)) / (2.0 * x) for x in (step, 2.0 * step))
        except ModelError:
            if attempt == QUARTERS - 1:
                raise
            step *= 0.25
            continue
        found = (4.0 * near - far) / 3.0
        change = np.inf if before is None else float(np.max(np.abs(found - before), initial=0.0))
        if before is None or change < least:
            best, least = found, change
        if change <= SETTLED * np.max(np.abs(found), initial=0.0):
            break
        before, step = found, 0.25 * step
    return best
