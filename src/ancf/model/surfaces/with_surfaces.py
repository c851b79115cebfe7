"""WithSurfaces: the part of a Model that adds surfaces, and contacts with them and with strips."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...errors import ModelError
from .. import checks
from ..bodies.beam import Beam
from ..bodies.rigid import RigidBody, kind
from ..joints.connecting import Connecting, PointLike
from ..names import unknown
from .body_contact import BodyContact, make_body_contact
from .cable_contact import CableContact, make_cable_contact
from .contact import make_contact
from .shape import Shape
from .surface import Surface, SurfaceContact, make_surface_contact, shape_of

#: Strip and normal of a contact with a strip that gives none.
STRIP, NORMAL = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


class WithSurfaces(Connecting):
    """Surfaces of one model."""

    def __init__(self) -> None:
        super().__init__()
        self.surfaces: list[Surface] = []

    def add_surface(self, name: str, shape: Shape | str, on: Any = None, **numbers: Any) -> Surface:
        """Add a surface, at rest or on a rigid body, for beams and cables that :meth:`add_contact` names.

        Parameters
        ----------
        name : str
            Unique over the model.
        shape : Plane, Cylinder, Sphere, Capsule, Torus or Sheave
            Such as ``ancf.Cylinder(radius=0.2, axis=(0, 1, 0))``, or its word with its numbers.
        on : RigidBody or name, optional
            What carries it; its place and axis are in body axes then, from the centre of mass. Default the
            ground.
        **numbers
            Of a shape given by its word: ``add_surface("drum", "cylinder", radius=0.2)``.

        """
        where = self._where("add_surface", name if isinstance(name, str) else None)
        label = self._names.of_item(checks.text(name, f"{where}.name"), "surface", where)
        body = None if on is None else self._body(on, f"{where}.on")
        if body is not None and not isinstance(body, RigidBody):
            what = f'"{body.name}" is a {kind(body)}, must be a rigid body'
            raise ModelError(f"{where}.on", what, "leave it out for the ground")
        item = Surface(label, shape_of(shape, numbers, where), body)
        self._names.take(item.name, "surface")
        self.surfaces.append(item)
        return item

    def surface(self, name: Surface | str, where: str = "Model.surface") -> Surface:
        """Return the surface of a name, or itself; ModelError with the right names otherwise."""
        found = next((s for s in self.surfaces if s is name or s.name == name), None)
        if found is None:
            if isinstance(name, Surface):
                raise ModelError(where, f'surface "{name.name}" belongs to another model')
            raise unknown(where, "surface", name, [s.name for s in self.surfaces])
        return found

    def add_contact(
        self,
        point: PointLike | Beam,
        along: Beam | Surface | str,
        *,
        stiffness: float,
        damping: float = 0.0,
        friction: float | None = None,
        stick: float | None = None,
        radius: float | None = None,
        strip: Any = None,
        normal: Any = None,
        s: float | None = None,
        profile: Any = None,
        name: str | None = None,
    ) -> Any:
        """Let a beam or cable touch a surface, another cable or itself, or rest on a strip through a point.

        With a surface, ``add_contact(rope, drum, ...)``, it is :meth:`add_surface_contact`: stiffness and
        damping are per length, in Pa and Pa s. With two cables, or the same one twice, it is
        :meth:`add_cable_contact`, in the same units. With two surfaces it is :meth:`add_body_contact`; there
        and with a strip, as of a pantograph, they are in N/m and N s/m.
        The force of a strip is a penalty on the overlap, it pushes only, and there is no friction: the wire
        is free to sweep along the strip and the strip to run along the wire. Beyond the wire's ends nothing
        touches.

        Parameters
        ----------
        point : Beam, or Point, PointMass or RigidBody
            What touches a surface or a cable, or the strip's point.
        along : Surface, or Beam
            The surface, the cable or the wire.
        stiffness : float, Pa or N/m
            Force per depth and length, or per overlap.
        damping : float, Pa s or N s/m
            Force per rate of depth and length, or of overlap.
        friction, stick, radius
            With a surface or a cable, see :meth:`add_surface_contact`.
        strip : (3,)
            Direction of the strip, default y.
        normal : (3,)
            Direction of the force that the wire receives, perpendicular to `strip`, default z. The wire runs
            along strip x normal.
        s : float, m
            Reference arc length near which the wire crosses the strip at the start, default the nearest.
        profile : (n, 2) m
            Rows of reference arc length and of how far the wire's surface stands out towards the strip
            there, straight between the rows and beyond them: waves and wear.
        name : str
            Default "contact of head and wire".

        Returns
        -------
        SurfaceContact, CableContact or Contact

        """
        where = self._where("add_contact", name, point)
        of_surface = {"friction": friction, "stick": stick, "radius": radius}
        of_strip = {"strip": strip, "normal": normal, "s": s, "profile": profile}
        if self._is_surface(along):
            _refuse(where, of_strip, "a contact with a surface")
            if self._is_surface(point):
                _refuse(where, {"radius": radius}, "a contact of bodies")
                return self.add_body_contact(
                    point,
                    along,
                    stiffness=stiffness,
                    damping=damping,
                    friction=0.0 if friction is None else friction,
                    stick=stick,
                    name=name,
                )
            return self.add_surface_contact(
                point,
                along,
                stiffness=stiffness,
                damping=damping,
                friction=0.0 if friction is None else friction,
                stick=stick,
                radius=radius,
                name=name,
            )
        if self._is_beam(point) and self._is_beam(along):
            _refuse(where, of_strip, "a contact of cables")
            return self.add_cable_contact(
                point,
                along,
                stiffness=stiffness,
                damping=damping,
                friction=0.0 if friction is None else friction,
                stick=stick,
                radius=radius,
                name=name,
            )
        _refuse(where, of_surface, "a contact with a strip")
        clean, wire = self._point(point, f"{where}.point"), self._body(along, f"{where}.along")
        label = self._names.of_item(name, f"contact of {clean} and {wire.name}", where)
        item = make_contact(
            where,
            label,
            clean,
            wire,
            stiffness=stiffness,
            damping=damping,
            strip=STRIP if strip is None else strip,
            normal=NORMAL if normal is None else normal,
            s=s,
            profile=profile,
        )
        return self.add_connection(where, item)

    def add_surface_contact(
        self,
        body: Any,
        surface: Any,
        *,
        stiffness: float,
        damping: float = 0.0,
        friction: float = 0.0,
        stick: float | None = None,
        radius: float | None = None,
        name: str | None = None,
    ) -> SurfaceContact:
        """Let a beam or cable touch a surface with its radius, all along it, with friction that sticks.

        Parameters
        ----------
        body : Beam or name
        surface : Surface or name
        stiffness : float, Pa
            Normal force per length and depth.
        damping : float, Pa s
            Normal force per length and rate of depth; it never pulls.
        friction : float
            Coulomb's coefficient.
        stick : float, Pa
            Force per length and way against sliding, before it slips; default `stiffness`.
        radius : float, m
            Of the beam, default half the diameter of its section.
        name : str
            Default "contact of rope and drum".

        """
        where = self._where("add_surface_contact", name)
        clean, found = self._body(body, f"{where}.body"), self.surface(surface, f"{where}.surface")
        label = self._names.of_item(name, f"contact of {clean.name} and {found.name}", where)
        for other in self.connections:
            if isinstance(other, SurfaceContact) and other.body is clean and other.surface is found:
                what = f'"{other.name}" is between "{clean.name}" and "{found.name}" already'
                raise ModelError(f"{where}.surface", what)
        item = make_surface_contact(
            where,
            label,
            clean,
            found,
            stiffness=stiffness,
            damping=damping,
            friction=friction,
            stick=stick,
            radius=radius,
        )
        return self.add_connection(where, item)

    def add_cable_contact(
        self,
        body: Any,
        other: Any,
        *,
        stiffness: float,
        damping: float = 0.0,
        friction: float = 0.0,
        stick: float | None = None,
        radius: float | None = None,
        name: str | None = None,
    ) -> CableContact:
        """Let two cables or beams touch, or one touch itself, all along, with friction that sticks.

        A cable touches itself where it is more than two diameters of its length away.

        Parameters
        ----------
        body, other : Beam or name
            The same one: it touches itself.
        stiffness : float, Pa
            Normal force per length and depth where they lie side by side.
        damping : float, Pa s
            Normal force per length and rate of depth; it never pulls.
        friction : float
            Coulomb's coefficient.
        stick : float, Pa
            Force per length and way against sliding, before it slips; default `stiffness`.
        radius : float, m
            Of both, default half the diameters of their sections.
        name : str
            Default "contact of rope and line", or "contact of rope and itself".

        """
        where = self._where("add_cable_contact", name)
        first, second = self._body(body, f"{where}.body"), self._body(other, f"{where}.other")
        what = "itself" if second is first else second.name
        label = self._names.of_item(name, f"contact of {first.name} and {what}", where)
        known = (c for c in self.connections if isinstance(c, CableContact))
        _refuse_a_second(where, first, second, ((c.name, {c.body, c.other}) for c in known))
        item = make_cable_contact(
            where,
            label,
            first,
            second,
            stiffness=stiffness,
            damping=damping,
            friction=friction,
            stick=stick,
            radius=radius,
        )
        return self.add_connection(where, item)

    def add_body_contact(
        self,
        surface: Any,
        other: Any,
        *,
        stiffness: float,
        damping: float = 0.0,
        friction: float = 0.0,
        stick: float | None = None,
        name: str | None = None,
    ) -> BodyContact:
        """Let two rigid bodies, or one and the ground, touch with surfaces that they carry.

        Spheres and capsules touch every shape but a mesh.

        Parameters
        ----------
        surface, other : Surface or name
            On two different bodies, or one of them on the ground.
        stiffness : float, N/m
            Normal force per depth.
        damping : float, N s/m
            Normal force per rate of depth; it never pulls.
        friction : float
            Coulomb's coefficient.
        stick : float, N/m
            Force per way against sliding, before it slips; default `stiffness`.
        name : str
            Default "contact of ball and floor".

        """
        where = self._where("add_body_contact", name)
        first, second = self.surface(surface, f"{where}.surface"), self.surface(other, f"{where}.other")
        label = self._names.of_item(name, f"contact of {first.name} and {second.name}", where)
        known = (c for c in self.connections if isinstance(c, BodyContact))
        _refuse_a_second(where, first, second, ((c.name, {c.surface, c.other}) for c in known))
        item = make_body_contact(
            where,
            label,
            first,
            second,
            stiffness=stiffness,
            damping=damping,
            friction=friction,
            stick=stick,
        )
        return self.add_connection(where, item)

    def _is_surface(self, given: Any) -> bool:
        return isinstance(given, Surface) or any(given == item.name for item in self.surfaces)

    def _is_beam(self, given: Any) -> bool:
        return isinstance(given, Beam) or (isinstance(given, str) and given in self.beams)


def _refuse(where: str, given: dict[str, Any], kind_of_it: str) -> None:
    for key, value in given.items():
        if value is not None:
            raise ModelError(f"{where}.{key}", f"has no effect on {kind_of_it}", "leave it out")


def _refuse_a_second(where: str, first: Any, second: Any, known: Iterable[tuple[str, set[Any]]]) -> None:
    """One contact between two is enough: another one would double its force."""
    for name, pair in known:
        if pair == {first, second}:
            what = f'"{name}" is between "{first.name}" and "{second.name}" already'
            raise ModelError(f"{where}.other", what)
