"""Bodies on cables that turn freely: of what has no torsion a mode has the frequency zero."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import RigidBody
from ..model.joints.basic import Fixation
from ..model.joints.rigid_joints import Weld
from .state import State

#: A frequency of zero, in parts of the largest; share of a mode's mass by which it is the spin of a body.
ZERO, SPIN = 1e-5, 0.9


def notes(about: State, omega: FloatArray, shapes: FloatArray) -> list[str]:
    """Which bodies that are clamped to cables turn in modes without a frequency, a line for each.

    Parameters
    ----------
    about : State
    omega : ndarray, shape (count,), rad/s
    shapes : ndarray, shape (count, size)
        Normed to a modal mass of 1 kg.
    """
    still = shapes[omega <= ZERO * omega[-1]] if omega[-1] > 0.0 else shapes[:0]
    held = _on_cables(about.model) if len(still) else {}
    return [
        f'"{name}" turns freely about "{cable}", a cable, which has no torsion: a frequency of zero is that; '
        'take element="nonlocking", or a torsion spring'
        for name, cable in held.items()
        if max(_spin(about, name, shape) for shape in still) > SPIN
    ]


def _on_cables(model: Any) -> dict[str, str]:
    """Rigid bodies that are clamped or welded to a cable, with the first of these."""
    found: dict[str, str] = {}
    for item in model.connections:
        ends = (item.point.body, item.to) if isinstance(item, Fixation) else ()
        ends = (item.a.body, item.b.body) if isinstance(item, Weld) else ends
        cables = [body.name for body in ends if isinstance(body, Beam) and not body.has_section]
        bodies = [body.name for body in ends if isinstance(body, RigidBody)]
        if cables and bodies:
            found.setdefault(bodies[0], cables[0])
    return found


def _spin(about: State, name: str, shape: FloatArray) -> float:
    """Share of a mode's modal mass that is a body's turning."""
    places = about.slots[name][0, 1:, None] + np.arange(3)
    axes, moved = about.q[places], shape[places]
    turned = axes @ (0.5 * np.cross(axes, moved).sum(axis=0))
    return float(turned @ about.bodies[name].inertia @ turned)  # type: ignore[union-attr]
