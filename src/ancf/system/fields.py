"""Physical fields at material points, from state vectors: the same face for one state or a history."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..elements.measures import axial_strain, axial_strain_rate, curvature, normal_curvature
from ..elements.shapes import gauss, hermite
from ..errors import ModelError
from ..model.beam import Beam
from ..model.lookup import parse_point
from ..model.points import Point
from .probe import Probe, locate

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Fields:
    """Values at points; shapes are (3,) and () for a state, (n_t, 3) and (n_t,) for a history.

    A point is ``beam.start``, ``beam.end``, ``beam.at(x)`` or that text.
    """

    @property
    def bodies(self) -> dict[str, Beam]:
        """Bodies by name."""
        return self._bodies

    @property
    def slots(self) -> dict[str, IntArray]:
        """First unknowns of the nodes' vectors, shape (nodes, vectors), by body."""
        return self._slots

    @property
    def q(self) -> FloatArray:
        """State vectors, shape (..., size)."""
        return self._q

    @property
    def v(self) -> FloatArray:
        """Rates of the state vectors, shape (..., size)."""
        return self._v

    _bodies: dict[str, Beam]
    _slots: dict[str, IntArray]
    _q: FloatArray
    _v: FloatArray

    def position(self, point: Point | str) -> FloatArray:
        """Position r, m."""
        return self._probe(point).field(self.q)

    def velocity(self, point: Point | str) -> FloatArray:
        """Velocity, m/s."""
        return self._probe(point).field(self.v)

    def slope(self, point: Point | str) -> FloatArray:
        """Slope r_x, dimensionless; its length is the stretch."""
        return self._probe(point).field(self.q, 1)

    def strain(self, point: Point | str) -> FloatArray:
        """Axial strain in the body's measure, dimensionless.

        The cubic element's strain oscillates within an element; what is returned is its projection on
        straight lines over the element, which is far more accurate (superconvergent).
        """
        probe = self._probe(point)
        xi, weight = gauss(5)
        h = probe.element_length
        at = (probe.x - probe.beam.node_x[probe.element]) / h
        total = np.zeros(self.q.shape[:-1])
        for x, w in zip(xi.tolist(), weight.tolist(), strict=True):
            there = probe.moved(x)
            eps = axial_strain(there.field(self.q, 1), probe.beam.strain) - natural_strains(there)[0]
            total += w * (1.0 + 12.0 * (x - 0.5) * (at - 0.5)) * eps
        return total

    def tension(self, point: Point | str) -> FloatArray:
        """Axial force along the tangent, N, positive in tension, axial damping included.

        It is the force that is work-conjugate to the stretch, the length of r_x: EA eps for material
        strains, EA eps times the stretch for the paper's Green strain.
        """
        probe = self._probe(point)
        section, strain = probe.beam.section, probe.beam.strain
        r_x = probe.field(self.q, 1)
        force = section.EA * self.strain(point)
        if section.axial_damping:
            force = force + section.axial_damping * axial_strain_rate(r_x, probe.field(self.v, 1), strain)
        return force if strain == "material" else force * np.linalg.norm(r_x, axis=-1)

    def curvature(self, point: Point | str) -> FloatArray:
        """Curvature kappa >= 0 in the body's measure, 1/m."""
        probe = self._probe(point)
        return curvature(probe.field(self.q, 1), probe.field(self.q, 2), probe.beam.strain)

    def bending_moment(self, point: Point | str) -> FloatArray:
        """Bending moment EI (kappa - kappa0) + bending damping, N m."""
        probe = self._probe(point)
        section, strain = probe.beam.section, probe.beam.strain
        kappa = self.curvature(point)
        moment = section.EI * (kappa - natural_strains(probe)[1])
        if section.bending_damping:
            moment = moment + section.bending_damping * _curvature_rate(probe, self.q, self.v, strain)
        return moment

    def _probe(self, point: Point | str) -> Probe:
        if isinstance(point, str):
            point = parse_point(self.bodies, point)
        beam = self.bodies.get(point.body.name)
        if beam is None:
            names = ", ".join(self.bodies)
            raise ModelError(str(point), f'there is no body "{point.body.name}" here, there are: {names}')
        return locate(beam, point.x, self.slots[beam.name])


def natural_strains(probe: Probe) -> tuple[float, float]:
    """Axial strain and curvature of the natural shape at a point."""
    beam, e = probe.beam, probe.element
    if beam.natural_shape == "straight":
        return 0.0, 0.0
    h = probe.element_length
    xi = (probe.x - beam.node_x[e]) / h
    values = np.stack(
        [
            beam.node_position[e],
            beam.stretch * beam.node_tangent[e],
            beam.node_position[e + 1],
            beam.stretch * beam.node_tangent[e + 1],
        ]
    )
    r_x, r_xx = hermite(xi, h, 1) @ values, hermite(xi, h, 2) @ values
    return float(axial_strain(r_x / beam.stretch, beam.strain)), float(curvature(r_x, r_xx, beam.strain))


def _curvature_rate(probe: Probe, q: FloatArray, v: FloatArray, strain: str) -> FloatArray:
    """d kappa/dt: the part along n of the rate of the curvature vector n, by a small difference."""
    r_x, r_xx = probe.field(q, 1), probe.field(q, 2)
    v_x, v_xx = probe.field(v, 1), probe.field(v, 2)
    size = np.abs(v_x).max() * probe.S[1].max() + np.abs(v_xx).max() + 1e-30
    d = 1e-6 * (np.abs(r_xx).max() + 1.0) / size
    ahead = normal_curvature(r_x + d * v_x, r_xx + d * v_xx, strain)
    behind = normal_curvature(r_x - d * v_x, r_xx - d * v_xx, strain)
    rate: FloatArray = (np.linalg.norm(ahead, axis=-1) - np.linalg.norm(behind, axis=-1)) / (2 * d)
    return rate
