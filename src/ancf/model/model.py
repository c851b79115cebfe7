"""Model: everything the user describes, checked when it is added; no numerics."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

from ancf.model import checks, describe
from ancf.model.beam import Beam
from ancf.model.checks import FloatArray
from ancf.model.connections import Connection, Spherical, Spring, check_repeated, make_spherical, make_spring
from ancf.model.functions import TimeFunction
from ancf.model.layout import make_beam
from ancf.model.loads import DistributedLoad, Force, Load, Moment, make_distributed, make_moment
from ancf.model.lookup import Lookup
from ancf.model.points import Point
from ancf.model.section import Section
from ancf.model.supports import (
    Clamp,
    Hold,
    Pin,
    Support,
    check_overlap,
    make_clamp,
    make_hold,
    optional,
    require_node,
)

SupportT = TypeVar("SupportT", bound=Support)
LoadT = TypeVar("LoadT", bound=Load)
ConnectionT = TypeVar("ConnectionT", bound=Connection)


class Model(Lookup):
    """Bodies, supports, loads and connections in a field of gravity.

    Points are given as ``beam.start``, ``beam.end``, ``beam.at(x)`` or as that text. Values that may
    depend on time are constants, functions of t in s, or formulas such as ``"10*sin(2*pi*t)"``.
    Every ``add_`` and support method takes a unique ``name`` and returns the new item; each raises
    ModelError, with the place, when something given is wrong.

    Parameters
    ----------
    gravity : (3,) m/s^2
    title : str

    Attributes
    ----------
    bodies : dict of str to Beam
    supports, loads, connections : list

    """

    def __init__(self, gravity: Any = (0.0, 0.0, 0.0), title: str = "") -> None:
        super().__init__()
        self.gravity: FloatArray = checks.vector(gravity, "Model.gravity")
        self.title = checks.text(title, "Model.title")
        self.supports: list[Support] = []
        self.loads: list[Load] = []
        self.connections: list[Connection] = []

    def __repr__(self) -> str:
        counts = ("bodies", "supports", "loads", "connections")
        inside = ", ".join(f"{len(getattr(self, key))} {key}" for key in counts)
        return f"Model({self.title!r}, {inside})" if self.title else f"Model({inside})"

    def add_beam(
        self,
        name: str,
        *,
        section: Section,
        start: Any = None,
        end: Any = None,
        path: Any = None,
        elements: int | None = None,
        nodes: Any = None,
        element: str = "cable",
        strain: str = "material",
        poisson: str = "centreline",
        length: float | None = None,
        natural_shape: str = "path",
        gauss: tuple[int, int] = (5, 3),
    ) -> Beam:
        """Add a beam or cable.

        Parameters
        ----------
        name : str
            Unique over the model.
        section : Section
            Stiffnesses, mass and damping per length.
        start, end : (3,) m
            Ends of a straight beam.
        path : (m, 3) m or callable
            Instead of start and end: at least 3 points of a spline, or a function of u from 0 to 1.
        elements : int
            Number of elements of equal length.
        nodes : (n+1,) m
            Instead of elements: increasing reference arc lengths from 0 to the length.
        element : "cable"
            Kind of element.
        strain : "material" or "paper"
            Strain measures of the cable.
        poisson : "centreline" or "full"
            For the thick beams; a cable ignores it.
        length : float, m
            Natural length; default the arc length of the initial shape.
        natural_shape : "path" or "straight"
            Whether the initial shape is free of bending, or a straight beam was bent into it.
        gauss : (int, int)
            Gauss points of the axial and the bending integrals.

        """
        where = self._where("add_beam", name if isinstance(name, str) else None)
        beam = make_beam(
            where,
            self._names.of_body(name, where),
            start=start,
            end=end,
            path=path,
            elements=elements,
            nodes=nodes,
            section=section,
            element=element,
            strain=strain,
            poisson=poisson,
            length=length,
            natural_shape=natural_shape,
            gauss=gauss,
        )
        self._names.take(beam.name, "body")
        self.bodies[beam.name] = beam
        return beam

    def pin(self, point: Point | str, displacement: Any = None, name: str | None = None) -> Pin:
        """Hold the position of a node, or move it by displacement(t) (3,) in m from its initial place."""
        where, clean = self._at_node("pin", point, name)
        item = Pin(
            self._names.of_item(name, f"pin at {clean}", where),
            clean,
            optional(displacement, 3, f"{where}.displacement"),
        )
        return self._add_support(where, item)

    def clamp(
        self,
        point: Point | str,
        stretch: str = "free",
        rotation: Any = None,
        axis: Any = (0, 0, 1),
        rotation_rate: Any = None,
        rotation_acceleration: Any = None,
        displacement: Any = None,
        name: str | None = None,
    ) -> Clamp:
        """Hold position and slope of a node, or move them.

        Parameters
        ----------
        point : Point
            At a node.
        stretch : "free" or "fixed"
            Hold the direction of r_x only, or all of it (the wall strain is then zero).
        rotation : function of time, rad
            Angle of the tangent about `axis`, from the initial one.
        axis : (3,)
            Axis of the rotation; any length but zero.
        rotation_rate, rotation_acceleration : functions of time, rad/s, rad/s^2
            Exact derivatives, both or none.
        displacement : function of time, (3,) m
            From the initial position.
        name : str
            Default "clamp at beam.start".

        """
        where, clean = self._at_node("clamp", point, name)
        item = make_clamp(
            where,
            self._names.of_item(name, f"clamp at {clean}", where),
            clean,
            stretch=stretch,
            rotation=rotation,
            axis=axis,
            rotation_rate=rotation_rate,
            rotation_acceleration=rotation_acceleration,
            displacement=displacement,
        )
        return self._add_support(where, item)

    def hold(self, point: Point | str, position: str = "", slope: str = "", name: str | None = None) -> Hold:
        """Keep single components of position and slope r_x of a node, letters of "xyz"."""
        where, clean = self._at_node("hold", point, name)
        label = self._names.of_item(name, f"hold at {clean}", where)
        return self._add_support(where, make_hold(where, label, clean, position, slope))

    def add_force(self, point: Point | str, force: Any, name: str | None = None) -> Force:
        """Add a force (3,) in N at a point, in fixed directions."""
        where = self._where("add_force", name, point)
        clean = self._point(point, f"{where}.point")
        label = self._names.of_item(name, f"force at {clean}", where)
        return self._add_load(Force(label, clean, TimeFunction(force, 3, f"{where}.force")))

    def add_moment(self, point: Point | str, moment: Any, name: str | None = None) -> Moment:
        """Add a moment (3,) in N m at a point, in fixed directions; it acts on the slope r_x."""
        where = self._where("add_moment", name, point)
        clean = self._point(point, f"{where}.point")
        label = self._names.of_item(name, f"moment at {clean}", where)
        return self._add_load(make_moment(where, label, clean, moment))

    def add_distributed_load(
        self, body: Beam | str, load: Any, between: Any = None, name: str | None = None
    ) -> DistributedLoad:
        """Add a load (3,) in N per m of reference length on a body, or on its part between=(x0, x1) in m."""
        where = self._where("add_distributed_load", name, body)
        clean = self._body(body, f"{where}.body")
        label = self._names.of_item(name, f"load on {clean.name}", where)
        return self._add_load(make_distributed(where, label, clean, load, between))

    def connect(self, a: Point | str, b: Point | str, name: str | None = None) -> Spherical:
        """Join two coincident nodes by a spherical joint."""
        where = self._where("connect", name, a)
        ends = self._point(a, f"{where}.a"), self._point(b, f"{where}.b")
        label = self._names.of_item(name, f"joint of {ends[0]} and {ends[1]}", where)
        item = make_spherical(where, label, *ends, self.size)
        check_repeated(where, item, self.connections)
        return self._add_connection(item)

    def add_spring(
        self,
        a: Point | str,
        b: Any,
        *,
        stiffness: float,
        damping: float = 0.0,
        length: float | None = None,
        slack: bool = False,
        name: str | None = None,
    ) -> Spring:
        """Add a spring and damper between a point and a point or a fixed position (3,) in m.

        Parameters
        ----------
        a : Point
            One end.
        b : Point or (3,) m
            The other end, or a position in space.
        stiffness : float, N/m
            Force per elongation.
        damping : float, N s/m
            Force per rate of elongation.
        length : float, m
            Length without force; default the initial distance.
        slack : bool
            It carries tension only.
        name : str
            Default "spring from a.end to b.end".

        """
        where = self._where("add_spring", name, a)
        first = self._point(a, f"{where}.a")
        fixed = not isinstance(b, Point | str)
        second = checks.vector(b, f"{where}.b") if fixed else self._point(b, f"{where}.b")
        other = "ground" if isinstance(second, np.ndarray) else str(second)
        label = self._names.of_item(name, f"spring from {first} to {other}", where)
        item = make_spring(
            where, label, first, second, stiffness=stiffness, damping=damping, length=length, slack=slack
        )
        return self._add_connection(item)

    @property
    def size(self) -> float:
        """Largest extent of all initial node positions along an axis, m; 0 without bodies."""
        if not self.bodies:
            return 0.0
        low = np.min([np.min(beam.node_position, axis=0) for beam in self.bodies.values()], axis=0)
        high = np.max([np.max(beam.node_position, axis=0) for beam in self.bodies.values()], axis=0)
        return float(np.max(high - low))

    def to_dict(self) -> dict[str, Any]:
        """Plain description, ready for JSON; Python functions as ``<function name>``."""
        kinds = {
            Pin: "pin",
            Clamp: "clamp",
            Hold: "hold",
            Force: "force",
            Moment: "moment",
            DistributedLoad: "distributed",
            Spherical: "spherical",
            Spring: "spring",
        }
        plain: dict[str, Any] = {"title": self.title, "gravity": self.gravity.tolist()}
        plain["bodies"] = [describe.beam(beam) for beam in self.bodies.values()]
        for key in ("supports", "loads", "connections"):
            plain[key] = [describe.other(item, kinds[type(item)]) for item in getattr(self, key)]
        return plain

    def _at_node(self, method: str, point: object, name: object) -> tuple[str, Point]:
        where = self._where(method, name, point)
        clean = self._point(point, f"{where}.point")
        require_node(clean, f"{where}.point")
        return where, clean

    def _add_support(self, where: str, item: SupportT) -> SupportT:
        check_overlap(where, item, self.supports)
        self._names.take(item.name, "support")
        self.supports.append(item)
        return item

    def _add_load(self, item: LoadT) -> LoadT:
        self._names.take(item.name, "load")
        self.loads.append(item)
        return item

    def _add_connection(self, item: ConnectionT) -> ConnectionT:
        self._names.take(item.name, "connection")
        self.connections.append(item)
        return item
