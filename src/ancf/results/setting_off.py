"""Supports that set off at once from a state that does not move as they do; said before the run."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.bodies import Body
from ..model.jumps import SHARE
from ..model.sudden import sudden
from ..model.supports import Support
from ..system.initial_motion import at_rest
from ..system.nodes import node_of
from ..system.system import System
from .state import State

#: Share of the velocity of a support below which a body is at rest.
STILL = 1e-9


def setting_off(
    system: System, start: State | None, v: FloatArray, t_start: float, t_end: float, step: float
) -> list[str]:
    """What is said of supports that begin with a velocity which a body beside them does not have.

    Parameters
    ----------
    system : System
    start : State or None
        From which a run starts; without it from the bodies' initial motions, which a support that they do
        not fit is said of when they are set.
    v : (size,) array
        Velocities at the start, with those of the supports.
    t_start, t_end, step : float
        Of the run, s.
    """
    rests = _initially if start is None else _in_state(system, start, v)
    return [str(jump) for jump in sudden(system.model, t_start, t_end, step, rests)]


def _initially(support: Support, body: Body) -> bool:
    return at_rest(body)


def _in_state(system: System, start: State, v: FloatArray) -> Callable[[Support, Body], bool]:
    """Of a state: an equilibrium moves where supports do and nowhere else."""

    def rests(support: Support, body: Body) -> bool:
        mine = _triples(system.slots[body.name])
        free = mine[np.isin(mine, system.free)]
        own = support.point.body
        node = node_of(own, support.point.x)
        wanted = v[_triples(system.slots[own.name][node])]
        if np.max(np.abs(v[free]), initial=0.0) <= STILL * np.max(np.abs(wanted), initial=0.0):
            return True
        had = start._v[_triples(start._slots[own.name][node])]
        return float(np.max(np.abs(wanted - had))) > SHARE * float(np.max(np.abs(wanted)))

    return rests


def _triples(slots: IntArray) -> IntArray:
    """Unknowns of vectors at these slots."""
    return (np.ravel(slots)[:, None] + np.arange(3)).ravel()
