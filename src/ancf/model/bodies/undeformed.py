"""Undeformed: the part of a Model that adds point masses and rigid bodies."""

from __future__ import annotations

from typing import Any, TypeVar

from ..lookup import Lookup
from .rigid import Body, PointMass, RigidBody, make_point_mass, make_rigid_body

BodyT = TypeVar("BodyT", bound=Body)


class Undeformed(Lookup):
    """Bodies without elements of one model."""

    def add_point_mass(
        self,
        name: str,
        *,
        at: Any,
        mass: float,
        volume: float = 0.0,
        drag_area: float = 0.0,
        added_mass: float = 0.0,
    ) -> PointMass:
        """Add a mass at a point, without rotation.

        Parameters
        ----------
        name : str
            Unique over the model.
        at : (3,) m
            Initial position.
        mass : float, kg
        volume : float, m^3
            That it displaces in a fluid.
        drag_area : float, m^2
            Drag coefficient times area.
        added_mass : float
            Coefficient: added mass in units of the displaced mass.

        """
        where = self._where("add_point_mass", name if isinstance(name, str) else None)
        clean = self._names.of_body(name, where)
        return self._add_body(make_point_mass(where, clean, at, mass, volume, drag_area, added_mass))

    def add_rigid_body(
        self,
        name: str,
        *,
        at: Any,
        mass: float,
        inertia: Any = None,
        axes: Any = None,
        volume: float = 0.0,
        drag_area: float = 0.0,
        added_mass: float = 0.0,
    ) -> RigidBody:
        """Add a rigid body.

        Parameters
        ----------
        name : str
            Unique over the model.
        at : (3,) m
            Initial position of its centre of mass.
        mass : float, kg
        inertia : (3,) or (3, 3) kg m^2
            Principal moments, or matrix, about the centre of mass in body axes; must be given.
        axes : (3, 3)
            Rotation matrix whose columns are the initial directions of the body axes; default global.
        volume, drag_area, added_mass : float
            In a fluid, as of a point mass; the forces act at the centre of mass and do not turn it.

        """
        where = self._where("add_rigid_body", name if isinstance(name, str) else None)
        clean = self._names.of_body(name, where)
        in_fluid = volume, drag_area, added_mass
        return self._add_body(make_rigid_body(where, clean, at, mass, inertia, axes, *in_fluid))

    def _add_body(self, body: BodyT) -> BodyT:
        self._names.take(body.name, "body")
        self.bodies[body.name] = body
        return body
