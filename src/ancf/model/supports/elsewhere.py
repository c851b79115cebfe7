"""Supports that are elsewhere than the shape from which a run starts, and winches of another length.

Said by ``print(model)`` and ``ancf check`` of the initial shape, by runs of what they start from.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ..bodies.beam import Beam
from ..bodies.rigid import PointMass, RigidBody
from .sudden import moved_with
from .support import Clamp, Hold, Support, node_of
from .winch import Winch

#: Share by which the length of a winch may differ from what is drawn, unsaid: cables are pulled by less.
OTHER_LENGTH = 0.01
#: By how much of an element's length, or rad, a support may miss what it holds.
MISSED = 1e-6
INITIAL = "the initial shape"
JOLT = "a run from there begins with a jolt; start from ancf.equilibrium(model), or draw it"


def elsewhere(
    model: Any, inputs: Mapping[str, float] | None = None, time: float = 0.0
) -> list[tuple[str, float]]:
    """What is said of supports and winches that do not fit the initial shape.

    Parameters
    ----------
    model : Model
    inputs : mapping of str to float, optional
        What the model's inputs are; default their first values.
    time : float
        At which a run starts, s.

    Returns
    -------
    list of (str, float)
        Each with the share of an element's length, or rad, by which a support misses; 0 of a winch.
    """
    given = {name: item.value for name, item in model.inputs.items()} if inputs is None else inputs
    misses: list[tuple[str, float]] = []
    lengths: list[tuple[str, float]] = []
    for support in model.supports:
        with suppress(ModelError):  # the run says what is wrong with the motion
            if isinstance(support, Winch):
                lengths += ((text, 0.0) for text in _length(support, given, time))
            else:
                misses += _miss(model, support, time)
    return misses + lengths


def length_said(winch: Winch, now: float, had: float, shape: str = INITIAL) -> Iterator[str]:
    """Of a winch with a length in m where the start of a run has another one."""
    if abs(now - had) > OTHER_LENGTH * had:
        out = f'"{winch.name}" has {now:.4g} m of "{winch.beam.name}" out'
        yield f"{out} and {shape} has {had:.4g} m: {JOLT} so"


def miss_said(
    model: Any, support: Support, now: FloatArray, had: FloatArray, shape: str = INITIAL
) -> Iterator[tuple[str, float]]:
    """Of a support that is not where the start of a run has what it holds.

    ``now`` and ``had``: position (m) and slopes or axes of its node, (vectors, 3); what has no length in
    ``had`` has no direction. The size is a share of the shortest element, or rad.
    """
    far, lengths = np.linalg.norm(now - had, axis=1), np.linalg.norm(had, axis=1)
    lengths[0] = 0.0
    slopes = lengths > 0.0  # an element may have other vectors, which begin with zero
    turned = float(np.max(far[slopes] / lengths[slopes], initial=0.0))
    body = support.point.body
    share = float(far[0]) / (float(np.min(np.diff(body.node_x))) if isinstance(body, Beam) else model.size)
    size = max(share, turned)
    if size > MISSED and moved_with(model, support):
        how = f"{far[0]:.3g} m away" if share >= turned else f"turned by {turned:.3g}"
        yield f'"{support.name}" is {how} from {shape} at the start of the run: {JOLT} there', size


def _length(winch: Winch, inputs: Mapping[str, float], time: float) -> Iterator[str]:
    if not winch.length.missing:
        now = float(winch.length.under(inputs, np.array([time]))[0, 0])
        yield from length_said(winch, now, winch.beam.length * winch.beam.stretch)


def _miss(model: Any, support: Support, time: float) -> Iterator[tuple[str, float]]:
    had = _vectors(support)
    yield from miss_said(model, support, _moved(support, had, time), had)


def _vectors(support: Support) -> FloatArray:
    """Position and slopes or axes of a support's node in the initial shape, (vectors, 3)."""
    body = support.point.body
    if isinstance(body, PointMass):
        return body.position[None]
    if isinstance(body, RigidBody):
        return np.vstack([body.position, body.axes.T])
    node = node_of(support.point)
    vectors = [body.node_position, body.node_tangent]
    vectors += [body.node_y, body.node_z] if body.has_section else []
    return np.array([rows[node] for rows in vectors])


def _moved(support: Support, had: FloatArray, time: float) -> FloatArray:
    """The same where a support holds them at a time in s; ModelError of a motion that has no value there."""
    now = had.copy()
    if support.displacement is not None and not support.displacement.missing:
        parts = ["xyz".index(c) for c in support.position] if isinstance(support, Hold) else [0, 1, 2]
        now[0, parts] += support.displacement(time)[parts]
    vector = _turn(support, time) if isinstance(support, Clamp) else np.zeros(3)
    if np.any(vector):
        from scipy.spatial.transform import Rotation

        now[1:] = Rotation.from_rotvec(vector).apply(now[1:])
    return now


def _turn(clamp: Clamp, time: float) -> FloatArray:
    """Rotation vector (3,) of a clamp, rad."""
    for given, axis in ((clamp.rotation_vector, np.ones(3)), (clamp.rotation, clamp.axis)):
        if given is not None and not given.missing:
            vector: FloatArray = given(time) * axis
            return vector
    return np.zeros(3)
