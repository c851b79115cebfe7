"""Beam: a body of elements in a row, with its initial shape at the nodes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..elements import KINDS
from ..points import Point
from ..sections.section import Section
from . import axes
from .initial_velocity import initial_velocities

Shape = Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray]]

POISSON = ("centreline", "full")
NATURAL_SHAPES = ("path", "straight")
MOST_ELEMENTS = 1_000_000
MOST_GAUSS_POINTS = 10
NODE_TOLERANCE = 1e-9  # of the length
BENT = 1e-12  # by which tangents of a shape that is not straight differ


@dataclass(slots=True, eq=False, kw_only=True)
class Beam:
    """A beam or cable, made by ``Model.add_beam``.

    Attributes
    ----------
    name : str
    section : Section
    element, strain, poisson : str
    natural_shape : str
        "path", "straight" or "curve"; of the last `natural_beam` has the nodes.
    gauss : (int, int)
        Gauss points of a cable's axial and bending integrals, or of a beam along its axis and in each
        direction of the section.
    length : float
        Natural length, m.
    stretch : float
        Arc length of the initial shape / `length`.
    node_x : (n+1,) array
        Reference arc lengths of the nodes from 0 to `length`, m.
    node_position : (n+1, 3) array
        Initial positions, m.
    node_tangent : (n+1, 3) array
        Initial unit tangents; the initial slope is ``r_x = stretch * node_tangent``.
    node_y : (n+1, 3) array
        Initial unit vectors of the section's local y axis, normal to `node_tangent`. A cable has them
        too but no use for them.
    velocity, angular_velocity, about : (3,) arrays
        Initial rigid motion, m/s, rad/s, m.
    closed : bool
        Whether the end is the start: a loop, whose last row of the nodes repeats the first.
    along, velocities : (m,) and (m, 3) arrays
        Initial velocities beside the rigid motion, m/s, at arc lengths, m; without any, m is 0.
    lay : callable, optional
        Initial positions, tangents and local y axes (n, 3) at increasing fractions (n,) of the length,
        from 0 to 1; a beam of a results file has none.

    """

    name: str
    section: Section
    element: str
    strain: str
    poisson: str
    natural_shape: str
    gauss: tuple[int, int]
    length: float
    stretch: float
    node_x: FloatArray
    node_position: FloatArray
    node_tangent: FloatArray
    node_y: FloatArray
    velocity: FloatArray
    angular_velocity: FloatArray
    about: FloatArray
    closed: bool = False
    lay: Shape | None = None
    along: FloatArray = field(default_factory=lambda: np.zeros(0))
    velocities: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    natural_beam: Beam | None = None

    def __repr__(self) -> str:
        return f"Beam({self.name!r}, elements={self.elements}, length={self.length:g})"

    @property
    def elements(self) -> int:
        """Number of elements."""
        return self.node_x.size - 1

    @property
    def has_section(self) -> bool:
        """Whether it has cross-sections, which shear and twist; a cable has none."""
        return KINDS[self.element].has_section

    @property
    def node_z(self) -> FloatArray:
        """Initial unit vectors (n+1, 3) of the section's local z axis: node_tangent x node_y."""
        z: FloatArray = axes.cross(self.node_tangent, self.node_y)
        return z

    @property
    def torsional_stiffness(self) -> float:
        """Torque per rate of twist, N m^2.

        0 for a cable; ``G J``, or ``G (I_y + I_z)`` with ``poisson = "full"``, where the section is plane.
        """
        s = self.section
        if not self.has_section or s.G is None or s.J is None or s.I_y is None or s.I_z is None:
            return 0.0
        return s.G * (s.J if self.poisson == "centreline" else s.I_y + s.I_z)

    @property
    def middle_axes(self) -> FloatArray:
        """Initial unit vectors of local y and z in the middle of each element, (n, 2, 3).

        Both are normal to the cubic through the nodes, and y is as near to the axis carried there from
        one node as to that from the other. They fix the slopes inside the nonlocking element.
        """
        return self._middle_axes(0, self.elements)

    @property
    def natural(self) -> Beam | None:
        """The beam as it lies without forces, but for its stretch; None for a straight one."""
        return {"path": self, "straight": None}.get(self.natural_shape, self.natural_beam)

    @property
    def bends(self) -> bool:
        """Whether its tangents differ from node to node in the initial shape."""
        return bool(np.any(np.abs(self.node_tangent - self.node_tangent[0]) >= BENT))

    @property
    def turns_its_bend(self) -> bool:
        """Whether it is a cable that is bent by nature: it does not resist that the bend turns."""
        return self.natural is not None and not self.has_section and self.natural.bends

    @property
    def start(self) -> Point:
        """The point at reference arc length 0."""
        return Point(self, 0.0, f"{self.name}.start")

    @property
    def end(self) -> Point:
        """The point at the full reference length; of a closed beam its start."""
        if self.closed:
            return self.start
        return Point(self, self.length, f"{self.name}.end")

    def at(self, x: float, y: float = 0.0, z: float = 0.0) -> Point:
        """Point at the reference arc length x and at (y, z) in the cross-section, m.

        A closed beam goes round: x + length is the same point.

        Raises
        ------
        ModelError
            x is outside the beam, (y, z) is outside its section, or a cable is given y or z.

        """
        where = f"{self.name}.at"
        clean = checks.answered(x, where)
        slack = NODE_TOLERANCE * self.length
        if self.closed:
            clean %= self.length
        if not -slack <= clean <= self.length + slack:
            raise ModelError(where, f"x = {clean:g} m is outside the beam, 0 <= x <= {self.length:g} m")
        clean = min(max(clean, 0.0), self.length)
        across = checks.number(y, f"{where}.y") + 0.0, checks.number(z, f"{where}.z") + 0.0
        if any(across):
            self._check_place(*across, where)
            text = f"{clean:.12g}, {across[0]:.12g}, {across[1]:.12g}"
            return Point(self, clean, f"{self.name}.at({text})", *across)
        if clean == 0.0:
            return self.start
        return self.end if clean == self.length else Point(self, clean, f"{self.name}.at({clean:.12g})")

    def _check_place(self, y: float, z: float, where: str) -> None:
        if not self.has_section:
            what = f"y = {y:g} m, z = {z:g} m: a cable has no cross-section to place a point in"
            raise ModelError(where, what, 'element = "original" or "nonlocking" has one')
        shape = self.section.shape
        if shape is not None and not shape.contains(y, z):
            raise ModelError(where, f"y = {y:g} m, z = {z:g} m is outside the cross-section, a {shape}")

    def set_motion(
        self,
        velocity: Any = (0, 0, 0),
        angular_velocity: Any = (0, 0, 0),
        about: Any = None,
        along: Any = None,
        velocities: Any = None,
    ) -> None:
        """Initial motion: v = velocity + angular_velocity x (r - about), and velocities along the beam.

        Parameters
        ----------
        velocity : (3,) m/s
            Velocity of the point `about`.
        angular_velocity : (3,) rad/s
            Rate of rotation.
        about : (3,) m, optional
            Default the start of the beam.
        along : (m,) m, optional
            Increasing arc lengths at which `velocities` are given, at least 2.
        velocities : (m, 3) m/s, optional
            Added to the rigid motion: a cubic spline through them, extended to the ends of the beam.
            Sections turn with the tangent and do not twist.

        Raises
        ------
        ModelError
            Not three finite numbers, or velocities that do not fit their places.

        """
        where = f'set_motion("{self.name}")'
        centre = self.node_position[0] if about is None else about
        motion = {"velocity": velocity, "angular_velocity": angular_velocity, "about": centre}
        clean = {key: checks.vector(value, f"{where}.{key}") for key, value in motion.items()}
        self.velocity, self.angular_velocity = clean["velocity"], clean["angular_velocity"]
        self.about = clean["about"].copy()
        self.along, self.velocities = initial_velocities(where, self.length, along, velocities)

    def node_at(self, x: float) -> int | None:
        """Index of the node within 1e-9 of the length of x, or None."""
        i = int(np.argmin(np.abs(self.node_x - x)))
        return i if abs(self.node_x[i] - x) <= NODE_TOLERANCE * self.length else None

    def element_at(self, x: float) -> int:
        """Element at x, of two the second one."""
        after = int(self.node_x.searchsorted(x, side="right"))
        return min(max(after - 1, 0), self.elements - 1)

    def off_centre(self, x: float, y: float, z: float) -> bool:
        """Whether a place is off the centreline."""
        return y != 0.0 or z != 0.0

    def initial_position(self, x: float, y: float = 0.0, z: float = 0.0) -> FloatArray:
        """Initial position (3,) at x, and at (y, z) in the section there, m, as the element interpolates."""
        position: FloatArray = self._hermite(x)[0]
        if y == 0.0 and z == 0.0:
            return position
        position += np.array([y, z]) @ self.initial_axes(x)
        return position

    def initial_places(self, x: FloatArray) -> FloatArray:
        """Initial positions (n, 3) of the centreline at these x, see :meth:`initial_position`."""
        e = np.clip(self.node_x.searchsorted(x, side="right") - 1, 0, self.elements - 1)
        h = np.diff(self.node_x)[e]
        return self._cubic(e, ((x - self.node_x[e]) / h)[:, None], h[:, None])[0]

    def initial_tangent(self, x: float) -> FloatArray:
        """Initial unit tangent (3,) of the cubic through the nodes at x."""
        slope = self._hermite(x)[1]
        unit: FloatArray = slope / np.linalg.norm(slope)
        return unit

    def initial_axes(self, x: float) -> FloatArray:
        """Initial r_y and r_z (2, 3) at x, linear or (nonlocking) quadratic in an element."""
        e, s, _ = self._place(x)
        y, tangent = self.node_y[e : e + 2], self.node_tangent[e : e + 2]
        ends = np.stack([y, axes.cross(tangent, y)], axis=1)
        inside: FloatArray = (1 - s) * ends[0] + s * ends[1]
        if self.element == "nonlocking":
            inside += 4 * s * (1 - s) * (self._middle_axes(e, e + 1)[0] - 0.5 * (ends[0] + ends[1]))
        return inside

    def _middle_axes(self, first: int, last: int) -> FloatArray:
        nodes = slice(first, last + 1)
        tangent, h = self.node_tangent[nodes], np.diff(self.node_x[nodes])
        slope = axes.middle_slopes(self.node_position[nodes], self.stretch * tangent, h)
        middle = slope / np.linalg.norm(slope, axis=1, keepdims=True)
        y = axes.between(self.node_y[nodes], tangent, middle)
        both: FloatArray = np.stack([y, axes.cross(middle, y)], axis=1)
        return both

    def _hermite(self, x: float) -> tuple[FloatArray, FloatArray]:
        return self._cubic(*self._place(x))

    def _cubic(self, e: Any, s: Any, h: Any) -> tuple[FloatArray, FloatArray]:
        """Place and slope at s of elements e of length h."""
        p0, p1 = self.node_position[e], self.node_position[e + 1]
        m0, m1 = (h * self.stretch * self.node_tangent[k] for k in (e, e + 1))
        position = p0 + s * m0 + s**2 * (3 * (p1 - p0) - 2 * m0 - m1) + s**3 * (2 * (p0 - p1) + m0 + m1)
        rate = m0 + 2 * s * (3 * (p1 - p0) - 2 * m0 - m1) + 3 * s**2 * (2 * (p0 - p1) + m0 + m1)
        return position, rate / h

    def _place(self, x: float) -> tuple[int, float, float]:
        """Element at x, place in it from 0 to 1, its reference length."""
        e = self.element_at(x)
        h = float(self.node_x[e + 1] - self.node_x[e])
        return e, float(x - self.node_x[e]) / h, h
