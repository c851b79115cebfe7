"""Initial velocities of the nodes of a beam whose shape changes."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..model.bodies.beam import Beam
from ..model.bodies.initial_velocity import rates_at
from ..model.bodies.rigid import Body, PointMass
from .nodes import layout


def spin_of(body: Body) -> FloatArray:
    """Initial angular velocity, rad/s."""
    return np.zeros(3) if isinstance(body, PointMass) else body.angular_velocity


def at_rest(body: Body) -> bool:
    """Whether it has no initial velocity."""
    shaped = isinstance(body, Beam) and body.along.size > 0
    return not (shaped or np.any(body.velocity) or np.any(spin_of(body)))


def spun(spin: FloatArray, arms: FloatArray) -> FloatArray:
    """Product of a vector and each of the arms, (n, 3); for a few of them numpy takes ten times as long."""
    (w0, w1, w2), (x, y, z) = spin.tolist(), arms.T
    return np.array([w1 * z - w2 * y, w2 * x - w0 * z, w0 * y - w1 * x]).T


def shape_rates(beam: Beam) -> FloatArray:
    """Rates of the vectors of the nodes that ``beam.velocities`` cause, (nodes, vectors + internal, 3).

    Sections turn with the tangent: r_y and r_z with omega = r_x x dr_x/dt / |r_x|^2, which has no part along
    the tangent.
    """
    nodes, shared, internal = layout(beam)
    out = np.zeros((nodes, shared + internal, 3))
    out[:, 0], out[:, 1] = rates_at(beam.along, beam.velocities, beam.node_x)
    if shared == 2:
        return out
    axes = np.stack([beam.node_y, beam.node_z], axis=1)
    out[:, 2:4] = _turned(beam.node_tangent, out[:, 1] / beam.stretch, axes)
    if internal:  # the internal ones let r_y and r_z in mid-element be the axes there
        h = np.diff(beam.node_x)[:, None, None]
        middle = beam.middle_axes
        tangent = np.cross(middle[:, 0], middle[:, 1])
        slope = rates_at(beam.along, beam.velocities, 0.5 * (beam.node_x[1:] + beam.node_x[:-1]))[1]
        between = _turned(tangent, slope / beam.stretch, middle)
        out[:-1, 4:] = (4 * between - 3 * out[:-1, 2:4] - out[1:, 2:4]) / h
    return out


def _turned(tangent: FloatArray, rate: FloatArray, axes: FloatArray) -> FloatArray:
    """Rates of axes (n, 2, 3) of sections that turn with unit tangents (n, 3)."""
    omega = np.cross(tangent, rate)
    return np.cross(omega[:, None], axes)
