"""Beam: a body of elements in a row, with its initial shape at the nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ancf.errors import ModelError
from ancf.model import checks
from ancf.model.checks import FloatArray
from ancf.model.points import Point
from ancf.model.section import Section

ELEMENTS = ("cable",)
STRAINS = ("material", "paper")
POISSON = ("centreline", "full")
NATURAL_SHAPES = ("path", "straight")
MOST_ELEMENTS = 1_000_000
MOST_GAUSS_POINTS = 10
NODE_TOLERANCE = 1e-9  # of the length


@dataclass(slots=True, eq=False, kw_only=True)
class Beam:
    """A beam or cable, made by ``Model.add_beam``.

    Attributes
    ----------
    name : str
    section : Section
    element, strain, poisson, natural_shape : str
    gauss : (int, int)
        Gauss points of the axial and the bending integrals.
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
    velocity, angular_velocity, about : (3,) arrays
        Initial rigid motion, m/s, rad/s, m.

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
    velocity: FloatArray
    angular_velocity: FloatArray
    about: FloatArray

    def __repr__(self) -> str:
        return f"Beam({self.name!r}, elements={self.elements}, length={self.length:g})"

    @property
    def elements(self) -> int:
        """Number of elements."""
        return self.node_x.size - 1

    @property
    def start(self) -> Point:
        """The point at reference arc length 0."""
        return Point(self, 0.0, f"{self.name}.start")

    @property
    def end(self) -> Point:
        """The point at the full reference length."""
        return Point(self, self.length, f"{self.name}.end")

    def at(self, x: float) -> Point:
        """Point at the reference arc length x in m.

        Raises
        ------
        ModelError
            x is outside the beam.

        """
        where = f"{self.name}.at"
        clean = checks.number(x, where)
        slack = NODE_TOLERANCE * self.length
        if not -slack <= clean <= self.length + slack:
            raise ModelError(where, f"x = {clean:g} m is outside the beam, 0 <= x <= {self.length:g} m")
        if clean <= 0.0:
            return self.start
        if clean >= self.length:
            return self.end
        return Point(self, clean, f"{self.name}.at({clean:.12g})")

    def set_motion(
        self, velocity: Any = (0, 0, 0), angular_velocity: Any = (0, 0, 0), about: Any = None
    ) -> None:
        """Initial rigid motion: v = velocity + angular_velocity x (r - about).

        Parameters
        ----------
        velocity : (3,) m/s
            Velocity of the point `about`.
        angular_velocity : (3,) rad/s
            Rate of rotation.
        about : (3,) m, optional
            Default the start of the beam.

        Raises
        ------
        ModelError
            Not three finite numbers.

        """
        where = f'set_motion("{self.name}")'
        centre = self.node_position[0] if about is None else about
        motion = {"velocity": velocity, "angular_velocity": angular_velocity, "about": centre}
        clean = {key: checks.vector(value, f"{where}.{key}") for key, value in motion.items()}
        self.velocity, self.angular_velocity = clean["velocity"], clean["angular_velocity"]
        self.about = clean["about"].copy()

    def node_at(self, x: float) -> int | None:
        """Index of the node within 1e-9 of the length of x, or None."""
        i = int(np.argmin(np.abs(self.node_x - x)))
        return i if abs(self.node_x[i] - x) <= NODE_TOLERANCE * self.length else None

    def initial_position(self, x: float) -> FloatArray:
        """Initial position (3,) of the cubic through the nodes at x, m."""
        return self._hermite(x)[0]

    def initial_tangent(self, x: float) -> FloatArray:
        """Initial unit tangent (3,) of the cubic through the nodes at x."""
        slope = self._hermite(x)[1]
        unit: FloatArray = slope / np.linalg.norm(slope)
        return unit

    def _hermite(self, x: float) -> tuple[FloatArray, FloatArray]:
        e = int(np.clip(np.searchsorted(self.node_x, x, side="right") - 1, 0, self.elements - 1))
        h = self.node_x[e + 1] - self.node_x[e]
        s = (x - self.node_x[e]) / h
        (p0, p1), (m0, m1) = self.node_position[e : e + 2], h * self.stretch * self.node_tangent[e : e + 2]
        position = p0 + s * m0 + s**2 * (3 * (p1 - p0) - 2 * m0 - m1) + s**3 * (2 * (p0 - p1) + m0 + m1)
        rate = m0 + 2 * s * (3 * (p1 - p0) - 2 * m0 - m1) + 3 * s**2 * (2 * (p0 - p1) + m0 + m1)
        return position, rate / h
