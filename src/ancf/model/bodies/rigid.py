"""Bodies without elements: the point mass and the rigid body."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..points import Point
from .beam import Beam

ROUNDING = 1e-9  # relative, of what a user computed: symmetry and triangle inequality of an inertia
ROUND_OFF = 1e-14  # of a rotation matrix that is left as it is
NOT_A_ROTATION = 1e-6  # largest deviation of axes from a rotation that is taken for rounding


@dataclass(slots=True, eq=False, kw_only=True)
class PointMass:
    """A mass at a point, without rotation; made by ``Model.add_point_mass``.

    Attributes
    ----------
    name : str
    mass : float
        kg.
    position : (3,) array
        Initial position, m.
    velocity : (3,) array
        Initial velocity, m/s.
    volume, drag_area, added_mass : float
        In a fluid: displaced volume, m^3, drag coefficient times area, m^2, coefficient of added mass.

    """

    name: str
    mass: float
    position: FloatArray
    velocity: FloatArray
    volume: float = 0.0
    drag_area: float = 0.0
    added_mass: float = 0.0

    def __repr__(self) -> str:
        return f"PointMass({self.name!r}, mass={self.mass:g})"

    @property
    def point(self) -> Point:
        """Its point."""
        return Point(self, 0.0, self.name)

    def initial_position(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> FloatArray:
        """Initial position (3,), m; it has no extent, x, y, z are 0."""
        return self.position.copy()

    def node_at(self, x: float) -> int | None:
        """Return 0: it is one node."""
        return 0 if x == 0.0 else None

    def off_centre(self, x: float, y: float, z: float) -> bool:
        """Return False: it has no extent."""
        return False

    def set_motion(self, velocity: Any = (0, 0, 0)) -> None:
        """Initial velocity (3,), m/s; ModelError if it is not three finite numbers."""
        self.velocity = checks.vector(velocity, f'set_motion("{self.name}").velocity')


@dataclass(slots=True, eq=False, kw_only=True)
class RigidBody:
    """A rigid body, made by ``Model.add_rigid_body``.

    Attributes
    ----------
    name : str
    mass : float
        kg.
    inertia : (3, 3) array
        About the centre of mass, in body axes, kg m^2.
    position : (3,) array
        Initial position of the centre of mass, m.
    axes : (3, 3) array
        Its columns are the initial directions of the body axes d_1, d_2, d_3: orthonormal, right-handed.
    velocity, angular_velocity, about : (3,) arrays
        Initial motion, m/s, rad/s, m; global directions.
    volume, drag_area, added_mass : float
        In a fluid, as of a point mass.

    """

    name: str
    mass: float
    inertia: FloatArray
    position: FloatArray
    axes: FloatArray
    velocity: FloatArray
    angular_velocity: FloatArray
    about: FloatArray
    volume: float = 0.0
    drag_area: float = 0.0
    added_mass: float = 0.0

    def __repr__(self) -> str:
        return f"RigidBody({self.name!r}, mass={self.mass:g})"

    @property
    def centre(self) -> Point:
        """The centre of mass."""
        return Point(self, 0.0, f"{self.name}.centre")

    def at(self, x: float, y: float, z: float) -> Point:
        """Point at the place (x, y, z) in body axes from the centre of mass, m; anywhere in space."""
        where = f"{self.name}.at"
        given = zip("xyz", (x, y, z), strict=True)
        clean = [checks.number(value, f"{where}.{key}") + 0.0 for key, value in given]
        checks.place(clean, where)
        if not any(clean):
            return self.centre
        label = f"{where}({', '.join(f'{value:.12g}' for value in clean)})"
        return Point(self, clean[0], label, clean[1], clean[2])

    def initial_position(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> FloatArray:
        """Initial position (3,) of the place (x, y, z) in body axes, m."""
        position: FloatArray = self.position + self.axes @ np.array([x, y, z])
        return position

    def node_at(self, x: float) -> int | None:
        """Return 0 at its centre of mass, which is its one node, else None."""
        return 0 if x == 0.0 else None

    def off_centre(self, x: float, y: float, z: float) -> bool:
        """Whether a place is not the centre of mass."""
        return x != 0.0 or y != 0.0 or z != 0.0

    @property
    def gyration_radius(self) -> float:
        """Root of the mean squared distance of its mass from the centre, m."""
        return math.sqrt(0.5 * float(np.trace(self.inertia))) / math.sqrt(self.mass)

    def set_motion(
        self, velocity: Any = (0, 0, 0), angular_velocity: Any = (0, 0, 0), about: Any = None
    ) -> None:
        """Initial motion: v = velocity + angular_velocity x (r - about).

        Parameters
        ----------
        velocity : (3,) m/s
            Velocity of the body at `about`.
        angular_velocity : (3,) rad/s
            Rate of rotation, global directions.
        about : (3,) m, optional
            Default the centre of mass.

        Raises
        ------
        ModelError
            Not three finite numbers.

        """
        where = f'set_motion("{self.name}")'
        motion = (
            checks.vector(velocity, f"{where}.velocity"),
            checks.vector(angular_velocity, f"{where}.angular_velocity"),
            self.position.copy() if about is None else checks.vector(about, f"{where}.about"),
        )
        self.velocity, self.angular_velocity, self.about = motion


Body = Beam | PointMass | RigidBody


def kind(body: Body) -> str:
    """What a body is, for messages: ``cable``, ``beam``, ``point mass`` or ``rigid body``."""
    if isinstance(body, Beam):
        return "beam" if body.has_section else "cable"
    return "point mass" if isinstance(body, PointMass) else "rigid body"


#: What bodies without elements have in a fluid.
IN_FLUID = ("volume", "drag_area", "added_mass")


def _in_fluid(where: str, *given: Any) -> dict[str, float]:
    pairs = zip(IN_FLUID, given, strict=True)
    return {key: checks.non_negative(value, f"{where}.{key}") for key, value in pairs}


def make_point_mass(
    where: str, name: str, at: Any, mass: Any, volume: Any = 0.0, drag_area: Any = 0.0, added_mass: Any = 0.0
) -> PointMass:
    """Check what ``Model.add_point_mass`` was given."""
    position = checks.place(at, f"{where}.at")
    return PointMass(
        name=name,
        mass=checks.positive(mass, f"{where}.mass"),
        position=position,
        velocity=np.zeros(3),
        **_in_fluid(where, volume, drag_area, added_mass),
    )


def make_rigid_body(
    where: str,
    name: str,
    at: Any,
    mass: Any,
    inertia: Any,
    axes: Any,
    volume: Any = 0.0,
    drag_area: Any = 0.0,
    added_mass: Any = 0.0,
) -> RigidBody:
    """Check what ``Model.add_rigid_body`` was given."""
    position = checks.place(at, f"{where}.at")
    return RigidBody(
        name=name,
        mass=checks.positive(mass, f"{where}.mass"),
        inertia=as_inertia(inertia, f"{where}.inertia"),
        position=position,
        axes=np.eye(3) if axes is None else _axes(axes, f"{where}.axes"),
        velocity=np.zeros(3),
        angular_velocity=np.zeros(3),
        about=position.copy(),
        **_in_fluid(where, volume, drag_area, added_mass),
    )


def as_inertia(given: Any, where: str) -> FloatArray:
    """Matrix (3, 3) from three principal moments or a matrix, that some spread of mass has."""
    if given is None:
        what = "a rigid body needs its inertia: three principal moments or a 3x3 matrix, kg m^2"
        raise ModelError(where, what, "a body without rotation is a point mass: model.add_point_mass(...)")
    if isinstance(given, int | float) and not isinstance(given, bool):
        what = f"must be three principal moments or a 3x3 matrix, is {checks.shown(given)}"
        raise ModelError(where, what, f"alike about all axes it is ({given:g}, {given:g}, {given:g})")
    rows = given if isinstance(given, list | tuple) else np.atleast_1d(np.asarray(given, dtype=object))
    if not any(isinstance(row, list | tuple | np.ndarray) for row in rows):
        matrix = np.diag(checks.vector(given, where))
    else:
        matrix = checks.array(given, where, (3, 3))
        _check_symmetric(matrix, where)
        matrix = 0.5 * matrix + 0.5 * matrix.T
    _check_moments(matrix, where)
    return matrix


def _check_symmetric(matrix: FloatArray, where: str) -> None:
    difference = np.abs(matrix - matrix.T)
    i, j = np.unravel_index(int(np.argmax(difference)), (3, 3))
    if difference[i, j] > ROUNDING * np.max(np.abs(matrix)):
        pair = f"[{i}][{j}] = {matrix[i, j]:g}, [{j}][{i}] = {matrix[j, i]:g}"
        raise ModelError(where, f"must be symmetric: {pair}")


def _check_moments(matrix: FloatArray, where: str) -> None:
    """Principal moments are integrals of y^2 + z^2 and so on: none negative, none above the other two."""
    size = float(np.max(np.abs(matrix)))
    if size > checks.LARGEST:
        raise ModelError(where, f"is up to {size:g} kg m^2, must be within {checks.LARGEST:g}")
    if size == 0.0:
        raise ModelError(where, "is zero", "a body without rotation is a point mass: model.add_point_mass")
    moments = np.linalg.eigvalsh(matrix / size) * size
    low, middle, high = moments.tolist()
    text = f"principal moments {low:g}, {middle:g}, {high:g} kg m^2"
    if low < -ROUNDING * high or high <= 0.0:
        raise ModelError(where, f"{text}: {low:g} is negative")
    if high > (low + middle) * (1 + ROUNDING):
        what = f"{text}: {high:g} is above the sum of the others, {low + middle:g}; no mass is spread so"
        raise ModelError(where, what)


def _axes(given: Any, where: str) -> FloatArray:
    matrix = checks.array(given, where, (3, 3))
    clipped = np.clip(matrix, -2.0, 2.0)
    left, stretch, right = np.linalg.svd(clipped)
    if np.max(np.abs(stretch - 1.0)) > NOT_A_ROTATION or np.max(np.abs(matrix)) > 2.0:
        what = "must be a rotation matrix, its columns orthonormal: the body axes in global directions"
        raise ModelError(where, f"{what}; is {matrix.tolist()}")
    if np.linalg.det(matrix) < 0.0:
        raise ModelError(where, "is left-handed: its third column must be the first x the second")
    if np.max(np.abs(clipped.T @ clipped - np.eye(3))) <= ROUND_OFF:
        return matrix
    nearest: FloatArray = left @ right
    return nearest
