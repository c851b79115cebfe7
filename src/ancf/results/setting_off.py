"""Supports that set off at once, or that are elsewhere than the state they hold; said before the run."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.bodies.rigid import Body
from ..model.supports.elsewhere import INITIAL, elsewhere, length_said, miss_said
from ..model.supports.jumps import SHARE
from ..model.supports.sudden import sudden
from ..model.supports.support import Support
from ..model.supports.winch import Winch
from ..system.initial_motion import at_rest
from ..system.nodes import node_of
from ..system.system import System
from .state import State

#: Share of the velocity of a support below which a body is at rest.
STILL = 1e-9

#: By how much of an element's length, or rad, a support may miss what it holds without a warning.
TORN = 1e-3


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


def missed(system: System, start: State | None, q: FloatArray, level: int = 3) -> list[str]:
    """What is said, and warned of, of supports that are elsewhere than what they hold at the start of a run.

    Parameters
    ----------
    system : System
    start : State or None
        From which a run starts; without it from the initial shape.
    q : (size,) array
        Positions at the start, with those of the supports.
    level : int
        Of the caller that a warning names.
    """
    said = elsewhere(system.model, system.inputs.given) if start is None else [*_of_state(system, start, q)]
    for text, size in said:
        if size > TORN:
            warnings.warn(text, UserWarning, stacklevel=level + 1)
    return [text for text, _ in said]


def _of_state(system: System, start: State, q: FloatArray) -> Iterator[tuple[str, float]]:
    """What is said of supports that do not fit a state, with the size of what they miss."""
    shape, winches = "the given start", list[str]()
    for support in system.model.supports:
        body = support.point.body
        if isinstance(support, Winch):
            now, had = q[system.lengths[body.name][0]], support.beam.length * support.beam.stretch
            given = body.name in start._lengths
            had = start._q[start._lengths[body.name][0]] if given else had
            winches += length_said(support, float(now), float(had), shape if given else INITIAL)
            continue
        node = node_of(body, support.point.x)
        places = q[_triples(system.slots[body.name][node])].reshape(-1, 3)
        held = start._q[_triples(start._slots[body.name][node])].reshape(-1, 3)
        yield from miss_said(system.model, support, places, held, shape)
    yield from ((text, 0.0) for text in winches)


def _triples(slots: IntArray) -> IntArray:
    """Unknowns of vectors at these slots."""
    return (np.ravel(slots)[:, None] + np.arange(3)).ravel()
