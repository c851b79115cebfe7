"""Physical fields at material points, from state vectors: the same face for one state or a history."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..elements.measures import axial_strain, axial_strain_rate, curvature, normal_curvature
from ..elements.shapes import gauss, hermite
from ..errors import ModelError
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body, PointMass, RigidBody, kind
from ..model.lookup import own_point, parse_point
from ..model.names import unknown
from ..model.other_words import OF_RESULT, hint_of
from ..model.points import Point
from . import sections
from .probe import R_X, R_XX, R_Y, R_Z, BeamProbe, Probe, locate


class Fields:
    """Values at points; shapes are (3,) and () for a state, (n_t, 3) and (n_t,) for a history.

    A point is ``beam.start``, ``beam.end``, ``beam.at(x)``, on the two beams with a cross-section
    ``beam.at(x, y, z)`` as well, or that text.
    """

    @property
    def bodies(self) -> dict[str, Body]:
        """Bodies by name."""
        return self._bodies

    @property
    def slots(self) -> dict[str, IntArray]:
        """First unknowns of the nodes' vectors, shape (nodes, vectors), by body."""
        return self._slots

    @property
    def lengths(self) -> Mapping[str, tuple[int, float]]:
        """Unknown of the length and place of the far end, by cable with a winch."""
        return self._lengths

    @property
    def q(self) -> FloatArray:
        """State vectors, shape (..., size)."""
        return self._q

    @property
    def v(self) -> FloatArray:
        """Rates of the state vectors, shape (..., size)."""
        return self._v

    @property
    def rates(self) -> FloatArray:
        """Those with which forces act, shape (..., size): none in an equilibrium, whose supports may move."""
        return self.v

    _bodies: dict[str, Body]
    _slots: dict[str, IntArray]
    #: Of cables with a winch, see :func:`ancf.system.probe.lengths_of`.
    _lengths: Mapping[str, tuple[int, float]] = MappingProxyType({})
    _q: FloatArray
    _v: FloatArray

    if not TYPE_CHECKING:  # a misspelled question is an error

        def __getattr__(self, name: str) -> Any:
            said = f"{type(self).__name__} has no attribute {name!r}"
            hint = "" if name.startswith("_") else hint_of(name, OF_RESULT)
            raise AttributeError(f"{said}: {hint}" if hint else said, name=name, obj=self)

    def position(self, point: Point | PointMass | RigidBody | str) -> FloatArray:
        """Position r, m."""
        return self._probe(point).field(self.q)

    def velocity(self, point: Point | PointMass | RigidBody | str) -> FloatArray:
        """Velocity, m/s."""
        return self._probe(point).field(self.v)

    def natural_length(self, beam: Beam | str) -> FloatArray:
        """Natural length of a beam, m: what a winch has paid out of a cable, or what it was made with.

        Raises
        ------
        ModelError
            There is no such beam.
        """
        name = getattr(beam, "name", beam)
        body = self.bodies.get(name) if isinstance(name, str) else None
        if not isinstance(body, Beam):
            there = [name for name, body in self.bodies.items() if isinstance(body, Beam)]
            raise unknown("natural_length", "beam", name, there)
        place, _ = self._length_of(body.name)
        length: FloatArray = self.q[..., place] if place >= 0 else np.full(self.q.shape[:-1], body.length)[()]
        return length

    def slope(self, point: Point | str) -> FloatArray:
        """Slope r_x at the point, dimensionless; its length is the stretch."""
        return self._beam(point).slope(self.q)

    def strain(self, point: Point | str) -> FloatArray:
        """Axial strain in the body's measure, dimensionless; E_xx of Green and Lagrange for the two beams.

        The cubic element's strain oscillates within an element; what is returned is its projection on
        straight lines over the element, which is far more accurate (superconvergent).
        """
        probe = self._beam(point)
        if probe.solid:
            y, z = probe.y, probe.z
            return _projected(probe, lambda p: sections.strain_tensor(p, self.q, y, z)[..., 0, 0])
        strain = probe.beam.strain
        return _projected(probe, lambda p: axial_strain(p.field(self.q, R_X), strain) - natural_strains(p)[0])

    def tension(self, point: Point | str) -> FloatArray:
        """Axial force along the tangent, N, positive in tension, axial damping included.

        It is the force that is work-conjugate to the stretch, the length of r_x: EA eps for material
        strains, EA eps times the stretch for the paper's Green strain, and for the two beams the
        resultant of the section's stresses, projected as :meth:`strain` is.
        """
        probe = self._beam(point)
        if probe.solid:
            return _projected(
                probe, lambda p: _along(p, self.q, sections.resultants(p, self.q, self.rates)[0])
            )
        section, strain = probe.beam.section, probe.beam.strain
        r_x = probe.field(self.q, R_X)
        force = section.EA * self.strain(point)
        if section.axial_damping:
            rate = axial_strain_rate(r_x, probe.rate(self.q, self.rates, R_X), strain)
            force = force + section.axial_damping * rate
        return force if strain == "material" else force * np.linalg.norm(r_x, axis=-1)

    def curvature(self, point: Point | str) -> FloatArray:
        """Curvature kappa >= 0 in the body's measure, 1/m; that of the deformed centreline for the beams."""
        probe = self._beam(point)
        strain = "paper" if probe.solid else probe.beam.strain
        return curvature(probe.field(self.q, R_X), probe.field(self.q, R_XX), strain)

    def bending_moment(self, point: Point | str) -> FloatArray:
        """Bending moment, N m, damping included: EI (kappa - kappa0), or the size of the section's."""
        probe = self._beam(point)
        if probe.solid:
            moment: FloatArray = np.linalg.norm(self.section_moment(point)[..., 1:], axis=-1)
            return moment
        section, strain = probe.beam.section, probe.beam.strain
        moment = section.EI * (self.curvature(point) - natural_strains(probe)[1])
        if section.bending_damping:
            moment = moment + section.bending_damping * _curvature_rate(probe, self.q, self.rates, strain)
        return moment

    def section_moment(self, point: Point | str) -> FloatArray:
        """Moment of the section's stresses in the section's axes (torque, M_y, M_z), N m, shape (..., 3).

        Raises
        ------
        ModelError
            The body is a cable; so for all that follow.
        """
        probe = self._section(point)
        moment = sections.resultants(probe, self.q, self.rates)[1]
        axes = sections.rotation(sections.section(probe, self.q))
        components: FloatArray = np.einsum("...ij,...i->...j", axes, moment)
        return components

    def torque(self, point: Point | str) -> FloatArray:
        """Torque about the section's normal, N m."""
        torque: FloatArray = self.section_moment(point)[..., 0]
        return torque

    def twist(self, point: Point | str) -> FloatArray:
        """Angle by which the sections turn about their normals from the start to the point, rad.

        It is the integral of the rate of twist less that of the natural shape, and grows beyond a turn.
        """
        probe = self._section(point)
        labels = probe.beam.node_x[: probe.element]
        before = [self._section(Point(probe.beam, float(x), "")) for x in labels]
        return sections.twist(probe, before, self.q)

    def section_rotation(self, point: Point | RigidBody | str) -> FloatArray:
        """Axes of the section as columns, shape (..., 3, 3): its normal, y and z; or directors."""
        probe = self._probe(point)
        if isinstance(probe.body, RigidBody):
            directors: FloatArray = np.stack([probe.field(self.q, row) for row in (R_X, R_Y, R_Z)], axis=-1)
            return directors
        return sections.rotation(sections.section(self._section(point), self.q))

    def strain_tensor(self, point: Point | str) -> FloatArray:
        """Green-Lagrange strains at the point in the section's axes x, y, z, shape (..., 3, 3)."""
        probe = self._section(point)
        return sections.strain_tensor(probe, self.q, probe.y, probe.z)

    def stress_tensor(self, point: Point | str) -> FloatArray:
        """Second Piola-Kirchhoff stresses in the section's axes, N/m^2, shape (..., 3, 3); no damping."""
        probe = self._section(point)
        return sections.stress_tensor(probe, self.q, probe.y, probe.z)

    def _probe(self, point: Point | PointMass | RigidBody | str) -> Probe:
        if isinstance(point, str):
            place = self._parsed(point)
        else:
            place = point if isinstance(point, Point) else own_point(point, "point")
        body = self.bodies.get(place.body.name)
        if body is None:
            names = ", ".join(self.bodies)
            raise ModelError(str(place), f'there is no body "{place.body.name}" here, there are: {names}')
        there, element = self._there(place, body)
        return locate(there, self.slots[body.name], self._length_of(body.name), element)

    def _there(self, place: Point, body: Body) -> tuple[Point, int | None]:
        """A point on the body of that name here, and the element in which it is looked at."""
        return replace(place, body=body), None

    def _parsed(self, label: str) -> Point:
        """The point of a label; of a support's name the error says what it holds."""
        try:
            return parse_point(self.bodies, label)
        except ModelError as error:
            supports = getattr(getattr(self, "model", None), "supports", ())
            held = next((item.point for item in supports if item.name == label), None)
            hint = f"the support of that name holds {held}: ask that" if held is not None else error.hint
            raise ModelError(error.where, error.what, hint) from None

    def _length_of(self, name: str) -> tuple[int, float]:
        return self._lengths.get(name, (-1, 0.0))

    def _beam(self, point: Point | RigidBody | str) -> BeamProbe:
        probe = self._probe(point)
        if not isinstance(probe, BeamProbe):
            raise ModelError(str(point), f"a {kind(probe.body)} has no strains, forces or slopes")
        return probe

    def _section(self, point: Point | RigidBody | str) -> BeamProbe:
        probe = self._beam(point)
        if not probe.solid:
            hint = 'add_beam(..., element="original") or "nonlocking" has one'
            raise ModelError(str(point), "a cable has no cross-section", hint)
        return probe


def _projected(probe: BeamProbe, value: Callable[[BeamProbe], FloatArray]) -> FloatArray:
    """Value at a point of the straight line that fits a quantity best over its element."""
    xi, weight = gauss(5)
    total: FloatArray = np.zeros(())
    for x, w in zip(xi.tolist(), weight.tolist(), strict=True):
        total = total + w * (1.0 + 12.0 * (x - 0.5) * (probe.xi - 0.5)) * value(probe.moved(x))
    return total


def _along(probe: BeamProbe, q: FloatArray, force: FloatArray) -> FloatArray:
    """Component of a force along the tangent of the centreline."""
    r_x = probe.field(q, R_X)
    along: FloatArray = np.einsum("...k,...k->...", force, r_x) / np.linalg.norm(r_x, axis=-1)
    return along


def natural_strains(probe: BeamProbe) -> tuple[float, float]:
    """Axial strain and curvature of the natural shape of a cable at a point."""
    beam, e = probe.beam.natural, probe.element
    if beam is None:
        return 0.0, 0.0
    h = probe.element_length
    values = np.stack(
        [
            beam.node_position[e],
            beam.stretch * beam.node_tangent[e],
            beam.node_position[e + 1],
            beam.stretch * beam.node_tangent[e + 1],
        ]
    )
    r_x, r_xx = hermite(probe.xi, h, 1) @ values, hermite(probe.xi, h, 2) @ values
    return float(axial_strain(r_x / beam.stretch, beam.strain)), float(curvature(r_x, r_xx, beam.strain))


def _curvature_rate(probe: BeamProbe, q: FloatArray, v: FloatArray, strain: str) -> FloatArray:
    """d kappa/dt: the part along n of the rate of the curvature vector n, by a small difference."""
    r_x, r_xx = probe.field(q, R_X), probe.field(q, R_XX)
    v_x, v_xx = probe.rate(q, v, R_X), probe.rate(q, v, R_XX)
    size = np.abs(v_x).max() * probe.S[1].max() + np.abs(v_xx).max() + 1e-30
    d = 1e-6 * (np.abs(r_xx).max() + 1.0) / size
    ahead = normal_curvature(r_x + d * v_x, r_xx + d * v_xx, strain)
    behind = normal_curvature(r_x - d * v_x, r_xx - d * v_xx, strain)
    rate: FloatArray = (np.linalg.norm(ahead, axis=-1) - np.linalg.norm(behind, axis=-1)) / (2 * d)
    return rate
