"""Supports that set off at once, or that are elsewhere than the state they hold; said before the run."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.beam import Beam
from ..model.bodies import Body
from ..model.jumps import SHARE
from ..model.sudden import moved_with, sudden
from ..model.supports import Support
from ..model.winch import Winch
from ..system.initial_motion import at_rest
from ..system.nodes import node_of, start_vectors
from ..system.system import System
from .state import State

#: Share of the velocity of a support below which a body is at rest.
STILL = 1e-9

#: Share by which the length of a winch may differ from what is drawn, unsaid: cables are pulled by less.
OTHER_LENGTH = 0.01
#: By how much of an element's length, or rad, a support may miss what it holds; by how much it is a warning.
MISSED, TORN = 1e-6, 1e-3


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
    lengths = list(_other_lengths(system, start, q))
    if system.inputs.still and start is None:
        return lengths
    said = list(_missed(system, start, q))
    for text, size in said:
        if size > TORN:
            warnings.warn(text, UserWarning, stacklevel=level + 1)
    return [*(text for text, _ in said), *lengths]


def _other_lengths(system: System, start: State | None, q: FloatArray) -> Iterator[str]:
    """Winches whose cable is longer or shorter than the shape or state from which a run starts."""
    for winch in system.model.supports:
        if not isinstance(winch, Winch):
            continue
        beam, shape = winch.beam, "the initial shape"
        now, had = float(q[system.lengths[beam.name][0]]), beam.length * beam.stretch
        if start is not None and beam.name in start._lengths:
            had, shape = float(start._q[start._lengths[beam.name][0]]), "the given start"
        if abs(now - had) > OTHER_LENGTH * had:
            jolt = "a jolt in the first step; start from ancf.equilibrium(model), or draw it so"
            yield f'"{winch.name}" has {now:.4g} m of "{beam.name}" out and {shape} has {had:.4g} m: {jolt}'


def _missed(system: System, start: State | None, q: FloatArray) -> Iterator[tuple[str, float]]:
    for support in system.model.supports:
        body = support.point.body
        if isinstance(support, Winch):
            continue
        node = node_of(body, support.point.x)
        slots = system.slots[body.name][node]
        now = q[_triples(slots)].reshape(-1, 3)
        if start is None:
            had = start_vectors(body)[node][: len(now)]
        else:
            had = start._q[_triples(start._slots[body.name][node])].reshape(-1, 3)
        sizes = np.linalg.norm(now - had, axis=1)
        slopes = np.linalg.norm(had, axis=1) > 0.0  # an element may have other vectors, which begin with zero
        slopes[0] = False
        turned = float(np.max(sizes[slopes] / np.linalg.norm(had[slopes], axis=1), initial=0.0))
        size_of_model = 1.0 / float(system.core.weight[slots[0]])
        length = float(np.min(np.diff(body.node_x))) if isinstance(body, Beam) else size_of_model
        size = max(float(sizes[0]) / length, turned)
        if size > MISSED and moved_with(system.model, support):
            far = f"{sizes[0]:.3g} m away" if sizes[0] / length >= turned else f"turned by {turned:.3g}"
            shape = "the initial shape" if start is None else "the given start"
            jolt = "a jolt in the first step; start from ancf.equilibrium(model), or draw it there"
            yield f'"{support.name}" is {far} from {shape} at the start of the run: {jolt}', size


def _triples(slots: IntArray) -> IntArray:
    """Unknowns of vectors at these slots."""
    return (np.ravel(slots)[:, None] + np.arange(3)).ravel()
