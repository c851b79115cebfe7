"""The force of sliding joints in its parts, from state vectors."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..connections.sliding_build import carrier_line
from ..errors import called
from ..model.joints.basic import Slide
from .joint_fields import JointFields


class SlideFields(JointFields):
    """Values of sliding joints; shapes are () and (3,) for a state, (n_t,) and (n_t, 3) for a history."""

    def normal_force(self, joint: Any) -> FloatArray:
        """Part of the force of a sliding joint, N, that the carrier receives normal to its line.

        Raises
        ------
        ModelError
            There is no such sliding joint.
        """
        return self._sliding(joint)[0]

    def sliding_friction(self, joint: Any) -> FloatArray:
        """Friction of a sliding joint along its carrier, N, that the carrier receives; positive as s grows.

        With the size l of the tangent r_x at s and N of the normal force it is c l s' + mu N tanh(l s'/v0).

        Raises
        ------
        ModelError
            There is no such sliding joint.
        """
        return self._sliding(joint)[1]

    def _sliding(self, joint: Any) -> tuple[FloatArray, FloatArray]:
        me: Any = self
        arc = self._arc(joint)
        name = called(joint)
        item = next(c for c in me.model.connections if isinstance(c, Slide) and c.name == name)
        x, line, poly = carrier_line(item, me.slots)
        q, v = np.atleast_2d(me.q[...]), np.atleast_2d(me.rates[...])
        s, force = q[:, arc], q[:, self._joints[name][:3]]
        e = np.clip(np.searchsorted(x[:, 0], s, side="right") - 1, 0, len(x) - 1)
        t = _tangent(q, line[e], poly[e], (s - x[e, 0]) / x[e, 1]) / x[e, 1:2]
        size = np.linalg.norm(t, axis=1)
        t = t / size[:, None]
        normal = force - np.einsum("nc,nc->n", force, t)[:, None] * t
        rate = size * v[:, arc]
        limit = item.friction * np.linalg.norm(normal, axis=1)
        rubbed = item.viscous * rate + limit * np.tanh(rate / item.friction_velocity)
        return (normal, rubbed) if me.q.ndim > 1 else (normal[0], rubbed[0])


def _tangent(q: FloatArray, slots: Any, poly: FloatArray, xi: FloatArray) -> FloatArray:
    """Derivative of points of lines by xi, shape (n, 3)."""
    rows, total = np.arange(len(q)), np.zeros((len(q), 3))
    for k in range(slots.shape[1]):
        w = poly[:, k, 1] + xi * (2.0 * poly[:, k, 2] + xi * 3.0 * poly[:, k, 3])
        for c in range(3):
            total[:, c] += np.where(slots[:, k] >= 0, w * q[rows, slots[:, k] + c], 0.0)
    return total
