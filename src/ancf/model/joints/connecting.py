"""Connecting: the part of a Model that adds joints and springs."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

from ...arrays import FloatArray
from .. import checks
from ..bodies.beam import Beam
from ..bodies.rigid import PointMass, RigidBody
from ..bodies.undeformed import Undeformed
from ..functions.function import check_inputs, refuse_inputs
from ..kinds import kind_of
from ..points import Point
from .basic import Fixation, Revolute, Slide, Spherical
from .connections import FRICTION_VELOCITY, Connection, Spring, make_spring
from .guides import Cylindrical, GuideT, Planar, Prismatic, make_guide
from .make_joints import make_fixation, make_revolute, make_spherical
from .rigid_joints import Guide, Universal, Weld, make_guided, make_universal, make_weld
from .slide_checks import make_slide
from .torsion import TorsionSpring, make_torsion_spring

ConnectionT = TypeVar("ConnectionT", bound=Connection)
PointLike = Point | PointMass | RigidBody | str


class Connecting(Undeformed):
    """Joints and springs of one model."""

    def connect(self, a: PointLike, b: Any, name: str | None = None) -> Spherical:
        """Join two coincident points, or a point and a fixed position, by a spherical joint.

        Parameters
        ----------
        a : Point, PointMass or RigidBody
            Any point of a body; of a rigid body itself its centre of mass.
        b : Point, PointMass, RigidBody or (3,) m
            Any point of another body, or a position in space.
        name : str
            Default "joint of a.end and b.start".

        """
        where, label, first, second = self.named_pair("connect", "joint", a, b, name)
        return self.add_connection(where, make_spherical(where, label, first, second, lambda: self.size))

    def hinge(self, a: PointLike, b: Any, axis: Any, name: str | None = None) -> Revolute:
        """Join two coincident points so that their bodies turn about one axis against each other.

        Parameters
        ----------
        a : Point or RigidBody
            Of a rigid body, or a node of a beam with a cross-section.
        b : Point, RigidBody or (3,) m
            The same of another body, or a position in space: the ground.
        axis : (3,)
            Initial global direction of the axis; any length but zero.
        name : str
            Default "hinge of hub.centre and ground".

        """
        where, label, first, second = self.named_pair("hinge", "hinge", a, b, name)
        return self.add_connection(where, make_revolute(where, label, first, second, axis, lambda: self.size))

    def cylindrical(self, a: PointLike, b: Any, axis: Any, name: str | None = None) -> Cylindrical:
        """Let one body slide along an axis of the other and turn about it.

        Parameters
        ----------
        a : Point or RigidBody
            Of a rigid body, or a node of a beam with a cross-section; the axis goes through it.
        b : Point, RigidBody or (3,) m
            The same of another body, anywhere on the axis, or a position in space: the ground.
        axis : (3,)
            Initial global direction of the axis; any length but zero.
        name : str
            Default "cylindrical joint of hub.centre and ground".

        """
        return self._guide(Cylindrical, "cylindrical", a, b, axis, name)

    def prismatic(self, a: PointLike, b: Any, axis: Any, name: str | None = None) -> Prismatic:
        """Let one body slide along an axis of the other without turning; arguments of ``cylindrical``."""
        return self._guide(Prismatic, "prismatic", a, b, axis, name)

    def planar(self, a: PointLike, b: Any, axis: Any, name: str | None = None) -> Planar:
        """Let one body slide in a plane of the other and turn about its normal.

        The same arguments as of ``cylindrical``; `axis` is the normal of the plane through `a`, in which
        `b` lies.
        """
        return self._guide(Planar, "planar", a, b, axis, name)

    def universal(self, a: PointLike, b: Any, axis_a: Any, axis_b: Any, name: str | None = None) -> Universal:
        """Join two coincident points by a universal (Cardan) joint.

        Parameters
        ----------
        a, b : Point, RigidBody or, of b, (3,) m
            As of ``hinge``.
        axis_a, axis_b : (3,)
            Initial global directions of the arms of the cross, normal to each other: the first is fixed in
            the body of `a`, the second in that of `b`.

        """
        where, label, first, second = self.named_pair("universal", "universal joint", a, b, name)
        made = make_universal(where, label, first, second, (axis_a, axis_b), lambda: self.size)
        return self.add_connection(where, made)

    def weld(self, a: PointLike, b: PointLike, name: str | None = None) -> Weld:
        """Connect two coincident points rigidly: their bodies do not turn against each other.

        Slopes of beams keep their
        directions to each other and are free to stretch. Two cables may be in one line, where they share
        their slope, or at a right angle.

        Parameters
        ----------
        a, b : Point or RigidBody
            Nodes of beams and cables, points of rigid bodies.
        """
        where, label, first, second = self.named_pair("weld", "weld", a, b, name)
        return self.add_connection(where, make_weld(where, label, first, second, lambda: self.size))

    def guide(self, point: PointLike, axis: Any, name: str | None = None) -> Guide:
        """Guide a point: it moves along a line that is fixed in space, and its body does not turn.

        Parameters
        ----------
        point : Point, PointMass or RigidBody
            A node of a beam or cable, whose slopes keep their directions, a point of a rigid body, or a
            point mass, which only stays on the line.
        axis : (3,)
            Direction of the line, which goes through the initial place of the point; any length but zero.

        """
        where, label, clean = self.named_point("guide", "guide", point, name)
        return self.add_connection(where, make_guided(where, label, clean, axis))

    def _guide(
        self, kind: type[GuideT], method: str, a: PointLike, b: Any, axis: Any, name: str | None
    ) -> GuideT:
        where, label, first, second = self.named_pair(method, f"{method} joint", a, b, name)
        made = make_guide(kind, where, label, first, second, axis, lambda: self.size)
        return self.add_connection(where, made)

    def slide(
        self,
        point: PointLike | Any,
        along: Beam | RigidBody | str,
        *,
        line: Any = None,
        offset: Any = (0.0, 0.0),
        s: float | None = None,
        tolerance: float | None = None,
        mass: float = 0.0,
        friction: float = 0.0,
        friction_velocity: float = 1e-3,
        viscous: float = 0.0,
        force: Any = None,
        motion: Any = None,
        release: Any = None,
        unilateral: Any = None,
        at_end: str = "stop",
        name: str | None = None,
    ) -> Slide:
        """Let a point slide along a beam, a cable or a line of a rigid body: the paper's sliding joint.

        Parameters
        ----------
        point : Point, PointMass, RigidBody or (3,) m
            A point of another body, or the position of a fixed ring through which the carrier runs.
        along : Beam or RigidBody
            The carrier.
        line : ((3,), (3,)) m
            Of a rigid carrier: start and end in body axes; s runs from 0 to their distance.
        offset : (2,) m
            Of a beam with a cross-section: the line's place (y, z) in it.
        s : float, m
            Initial arc length, on a beam the reference arc length; default the nearest place, or that of
            `motion` at t = 0.
        tolerance : float, m
            Largest distance of the point from that place in the initial shape, default 1e-6 of the
            model's size. What a computation starts from is checked again: give more when the point comes
            to the line in the equilibrium only.
        mass : float, kg
            Moves along the line with s.
        friction : float
            Coulomb's coefficient.
        friction_velocity : float, m/s
            Speed at which friction has grown to its full size.
        viscous : float, N s/m
            Resistance to sliding.
        force : function of time, N
            Drive along +s.
        motion : function of time, m
            Prescribed arc length, instead of mass, friction, viscous and force.
        release : (3,)
            Direction in which no force acts.
        unilateral : (3,)
            Direction of the only force that the carrier receives, normal to `release`; in the opposite
            one the point lifts off.
        at_end : "stop", "clamp" or "release"
            At an end of the line the computation stops, the point is held there, or it is let go.
        name : str
            Default "slide of a.end along b".

        """
        where = self._where("slide", name, point)
        first, carrier = self._end(point, f"{where}.point"), self._body(along, f"{where}.along")
        label = self._names.of_item(name, f"slide of {shown(first, 'ring')} along {carrier.name}", where)
        item = make_slide(
            where,
            label,
            first,
            carrier,
            self.size,
            line=line,
            offset=offset,
            s=s,
            tolerance=tolerance,
            mass=mass,
            friction=friction,
            friction_velocity=friction_velocity,
            viscous=viscous,
            force=force,
            motion=motion,
            release=release,
            unilateral=unilateral,
            at_end=at_end,
        )
        return self.add_connection(where, item)

    def add_spring(
        self,
        a: PointLike,
        b: Any,
        *,
        stiffness: float = 0.0,
        damping: float = 0.0,
        length: float | None = None,
        slack: bool = False,
        law: Any = None,
        damper: Any = None,
        friction: float = 0.0,
        friction_velocity: float = FRICTION_VELOCITY,
        name: str | None = None,
    ) -> Spring:
        """Add a spring and damper between a point and a point or a fixed position (3,) in m.

        Parameters
        ----------
        a : Point, PointMass or RigidBody
            One end.
        b : Point, PointMass, RigidBody or (3,) m
            The other end, or a position in space.
        stiffness : float, N/m
            Force per elongation.
        damping : float, N s/m
            Force per rate of elongation.
        length : float, m
            Length without force; default the initial distance.
        slack : bool
            It carries tension only.
        law : (n, 2)
            Rows of elongation in m and force in N, tension positive, of a spring beside it: straight between
            the rows and beyond them, so that steep ends are stops.
        damper : (n, 2)
            Rows of rate of elongation in m/s and force in N of a damper beside it, in the same way.
        friction : float, N
            Coulomb's, against elongation and shortening.
        friction_velocity : float, m/s
            Rate at which friction has grown to tanh(1) = 0.76 of its size; it never sticks.
        name : str
            Default "spring from a.end to b.end".

        """
        where = self._where("add_spring", name, a)
        first, second = self._point(a, f"{where}.a"), self._end(b, f"{where}.b")
        label = self._names.of_item(name, f"spring from {first} to {shown(second)}", where)
        item = make_spring(
            where,
            label,
            first,
            second,
            stiffness=stiffness,
            damping=damping,
            length=length,
            slack=slack,
            law=law,
            damper=damper,
            friction=friction,
            friction_velocity=friction_velocity,
        )
        return self.add_connection(where, item)

    def add_torsion_spring(
        self,
        a: PointLike,
        b: Any,
        *,
        axis: Any,
        stiffness: float,
        damping: float = 0.0,
        angle: float = 0.0,
        name: str | None = None,
    ) -> TorsionSpring:
        """Add a torsion spring and damper about an axis between two bodies, or a body and the ground.

        It resists turning alone: a joint holds the ends together, where they are to stay together.

        Parameters
        ----------
        a : Point or RigidBody
            Of a rigid body, or a node of a beam or cable. Of a cable the direction of the tangent counts.
        b : Point, RigidBody or (3,) m
            The same of another body, or a position in space: the ground.
        axis : (3,)
            Initial global direction of the axis. It turns with a rigid body or with the section of a beam.
        stiffness : float, N m/rad
            Moment per angle; beyond a full turn the angle grows on.
        damping : float, N m s/rad
        angle : float, rad
            Angle of a against b from the initial position, about the axis, without moment.

        """
        where = self._where("add_torsion_spring", name, a)
        first, second = self._point(a, f"{where}.a"), self._end(b, f"{where}.b")
        label = self._names.of_item(name, f"torsion spring from {first} to {shown(second)}", where)
        item = make_torsion_spring(
            where, label, first, second, axis=axis, stiffness=stiffness, damping=damping, angle=angle
        )
        return self.add_connection(where, item)

    def _fix(self, point: PointLike, to: Any, stretch: Any, name: str | None) -> Fixation:
        """``Model.clamp`` to a rigid body."""
        where = self._where("clamp", name, point)
        clean, body = self._point(point, f"{where}.point"), self._body(to, f"{where}.to")
        label = self._names.of_item(name, f"clamp of {clean} to {body.name}", where)
        item = make_fixation(where, label, clean, body, stretch)
        return self.add_connection(where, item)

    def named_pair(
        self, method: str, noun: str, a: PointLike, b: Any, name: str | None
    ) -> tuple[str, str, Point, Point | FloatArray]:
        """Where an error is, the name, a point and a point or fixed position (3,) in m, of a new connection.

        Raises
        ------
        ModelError
            One of them is no point, or the name is taken.
        """
        where = self._where(method, name, a)
        first, second = self._point(a, f"{where}.a"), self._end(b, f"{where}.b")
        label = self._names.of_item(name, f"{noun} of {first} and {shown(second)}", where)
        return where, label, first, second

    def named_point(
        self, method: str, noun: str, point: PointLike, name: str | None
    ) -> tuple[str, str, Point]:
        """Where an error is, the name and the point of a new load.

        Raises
        ------
        ModelError
            It is no point, or the name is taken.
        """
        where = self._where(method, name, point)
        clean = self._point(point, f"{where}.point")
        return where, self._names.of_item(name, f"{noun} at {clean}", where), clean

    def add_connection(self, where: str, item: ConnectionT) -> ConnectionT:
        """Add a checked connection; every method that makes one ends here.

        Raises
        ------
        ModelError
            A joint holds what another one holds already.
        """
        kind = kind_of(item)
        refuse_inputs(item, "motion")
        check_inputs(item, self.inputs)
        if kind.constrains:
            self._joined.refuse_repeated(where, item, kind, self.connections)
        self._names.take(item.name, "connection")
        self.connections.append(item)
        return item

    def _end(self, end: Any, where: str) -> Point | FloatArray:
        """A point, or a fixed position."""
        if isinstance(end, Point | PointMass | RigidBody | Beam | str):
            return self._point(end, where)
        return checks.place(end, where)


def shown(end: Point | FloatArray, fixed: str = "ground") -> str:
    """A point's label, or what a fixed position is called."""
    return fixed if isinstance(end, np.ndarray) else str(end)
