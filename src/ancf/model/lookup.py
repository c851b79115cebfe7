"""Lookup: the part of a Model that finds bodies and points by name, and says where an error is."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Self

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from . import checks
from .bodies.beam import Beam
from .bodies.rigid import Body, PointMass, RigidBody, kind
from .functions.inputs import Input, make_input
from .joints.connections import Connection, Spherical, initial_position
from .joints.repeated import Joined
from .kinds import GROUPS, SURROUNDINGS, all_kinds, kind_of
from .names import POINT_LABEL, Names, numbers_of, split_label, unknown
from .points import Point
from .supports.support import Support

#: A question as formulas of studies have it.
QUESTION = re.compile(r"[a-z_]+\((.+)\)")
#: What a point is written like, for messages.
SUCH_AS = "such as beam.start, beam.end or beam.at(0.5), a point mass or a rigid body"


class Lookup:
    """Bodies, connections, inputs and names of one model."""

    supports: list[Support]

    def __init__(self) -> None:
        self.bodies: dict[str, Body] = {}
        self.connections: list[Connection] = []
        self.inputs: dict[str, Input] = {}
        self._names = Names(self._named)
        self._joined = Joined()
        self._place = ""

    @property
    def beams(self) -> dict[str, Beam]:
        """The beams and cables among the bodies, by name."""
        return {name: body for name, body in self.bodies.items() if isinstance(body, Beam)}

    @property
    def masses(self) -> dict[str, PointMass]:
        """The point masses among the bodies, by name."""
        return {name: body for name, body in self.bodies.items() if isinstance(body, PointMass)}

    @property
    def rigid_bodies(self) -> dict[str, RigidBody]:
        """The rigid bodies among the bodies, by name."""
        return {name: body for name, body in self.bodies.items() if isinstance(body, RigidBody)}

    @property
    def size(self) -> float:
        """Largest extent of the initial positions of all bodies along an axis, m; 0 without bodies.

        A rigid body reaches as far as its radius of gyration. Of bodies in one place it is the distance
        to the farthest fixed position they are connected to, or 1 m.
        """
        if not self.bodies:
            return 0.0
        ranges = [_extent(body) for body in self.bodies.values()]
        low, high = np.min([r[0] for r in ranges], axis=0), np.max([r[1] for r in ranges], axis=0)
        return float(np.max(high - low)) or self._reach(low) or 1.0

    def _named(self) -> set[str]:
        """Names of all that is in the model."""
        lists = [getattr(self, key) for key in (*GROUPS, *SURROUNDINGS)]
        return {*self.bodies, *(item.name for items in lists for item in items)}

    def snapshot(self) -> Self:
        """Return the model as it is now: what is added to one later is not in the other."""
        other = object.__new__(type(self))  # many are made; copy asks each for its ways to be copied first
        other.__dict__.update(self.__dict__)
        other.bodies, other._names = dict(self.bodies), self._names.of(other._named)
        other.inputs, other._joined = dict(self.inputs), Joined()
        for key in (*GROUPS, *SURROUNDINGS):
            setattr(other, key, list(getattr(self, key)))
        return other

    def add_input(self, name: str, value: float = 0.0, *, unit: str = "", description: str = "") -> Input:
        """Add a number that is given while a simulation runs, by :func:`ancf.stepper` or a controller.

        It stands wherever a number or a function of time may in loads and drives, also in sums and products:
        ``model.add_force(tip, (2*u, 0, 0))``. It moves no supports: nobody knows its velocity.

        Parameters
        ----------
        name : str
            Unique among inputs; letters, digits and _, and none that formulas have already, such as t.
        value : float
            What it is until something else is given, and in equilibria.
        unit, description : str
            For tables and pictures of results, such as ``"N"`` and ``"pull of the winch"``.

        """
        where = self._where("add_input", name)
        made = make_input(where, name, value, self.inputs, unit, description)
        self.inputs[made.name] = made
        return made

    def body(self, name: str) -> Body:
        """Return the body of a name; an unknown name raises ModelError with the right ones."""
        return self._body(name, "Model.body")

    def point(self, label: str) -> Point:
        """Return the point written as its label.

        Such as ``beam.start``, ``beam.at(0.5)``, ``beam.at(0.5, 0.01, 0)``, the name of a point mass,
        ``hub.centre`` or ``hub.at(0.1, 0, 0.2)``.
        """
        return self._point(label, "Model.point")

    def connection(self, name: Connection | str) -> Connection:
        """Return the joint or spring of a name, or itself; ModelError with the right names otherwise."""
        where = "Model.connection"
        if not isinstance(name, str):
            if not any(name is item for item in self.connections):
                what = f"must be a joint or spring of this model, or its name, is {checks.shown(name)}"
                raise ModelError(where, what)
            return name
        for item in self.connections:
            if item.name == name:
                return item
        raise unknown(where, "joint or spring", name, [item.name for item in self.connections])

    def sensor(self, item: object, where: str = "Model.sensor") -> Point | Connection | Support:
        """Return the point, spring, joint or support that a sensor may record, an object or its name."""
        if isinstance(item, Point | PointMass | RigidBody | Beam):
            return self._point(item, where)
        name = item if isinstance(item, str) else None  # an array is compared with a text item by item
        found = next((c for c in self.connections if item is c or name == c.name), None)
        if isinstance(found, Spherical) and found.shared:
            what = f'"{found.name}" joins two nodes that share their unknowns: it has no force of its own'
            raise ModelError(where, what, "list one of its points")
        if found is not None:
            return found
        held = next((support for support in self.supports if item is support or name == support.name), None)
        if held is not None:
            return held
        if not isinstance(item, str):
            what = "must be a point, spring, joint or support of this model, or its name"
            raise ModelError(where, f"{what}, is {checks.shown(item)}")
        if POINT_LABEL.fullmatch(item.strip()) or item.strip().partition(".")[0] in self.bodies:
            return self._point(item, where)
        names = [*self.bodies, *(c.name for c in self.connections), *(s.name for s in self.supports)]
        error = unknown(where, "point, spring, joint or support", item, names)
        if asked := QUESTION.fullmatch(item.strip()):
            hint = f'list what is asked: "{asked[1]}"; the sensors answer the question'
            raise ModelError(error.where, error.what, hint)
        raise error

    @contextmanager
    def located(self, place: str) -> Iterator[None]:
        """Within this context, errors and time functions speak of `place`, such as ``supports[0]``."""
        before, self._place = self._place, place
        try:
            yield
        finally:
            self._place = before

    def _where(self, method: str, name: object, subject: object = None) -> str:
        if self._place:
            return self._place
        if isinstance(name, str):
            return f'{method}("{name}")'
        if isinstance(subject, Beam | PointMass | RigidBody):
            return f"{method}({subject.name})"
        return f"{method}({subject})" if isinstance(subject, Point | str) else f"{method}()"

    def _body(self, body: object, where: str) -> Body:
        if isinstance(body, Beam | PointMass | RigidBody):
            if self.bodies.get(body.name) is not body:
                raise ModelError(where, f'body "{body.name}" belongs to another model')
            return body
        if not isinstance(body, str):
            hint = f'the body of {body} is "{body.body.name}"' if isinstance(body, Point) else ""
            raise ModelError(where, f"must be a body or its name, is {checks.shown(body)}", hint)
        if body not in self.bodies:
            raise unknown(where, "body", body, self.bodies)
        return self.bodies[body]

    def _point(self, point: object, where: str) -> Point:
        if isinstance(point, Point):
            self._body(point.body, where)
            return point
        if isinstance(point, PointMass | RigidBody):
            return own_point(self._body(point, where), where)
        if isinstance(point, Beam):
            return own_point(point, where)
        if not isinstance(point, str):
            if (item := _item(self, point)) is not None:
                noun, ends = item
                raise ModelError(where, f'must be a point, is the {noun} "{point.name}"', ends)  # type: ignore[attr-defined]
            hint = SUCH_AS
            if where.endswith(".a") and isinstance(point, list | tuple | np.ndarray) and len(point) == 3:
                hint = "a place in space is the other end, b"
            raise ModelError(where, f"must be a point, is {checks.shown(point)}", hint)
        return parse_point(self.bodies, point, where)

    def _reach(self, place: FloatArray) -> float:
        ends = [end for item in self.connections for end in kind_of(item).ends_of(item)]
        far = [float(np.max(np.abs(initial_position(e) - place))) for e in ends if isinstance(e, np.ndarray)]
        return max(far, default=0.0)


def _item(model: Lookup, given: object) -> tuple[str, str] | None:
    """What a support, load or connection is called that was given for a point, and what its points are."""
    found = next((kind for kind in all_kinds() if isinstance(given, kind.item)), None)
    if found is None:
        return None
    points = [str(end) for end in found.ends_of(given) if isinstance(end, Point)]
    return found.noun, f"its point is {points[0]}" if points else ""


def own_point(body: Body, where: str) -> Point:
    """The point that stands for a body: of a point mass its point, of a rigid body its centre."""
    if isinstance(body, PointMass):
        return body.point
    if isinstance(body, RigidBody):
        return body.centre
    if not isinstance(body, Beam):
        raise ModelError(where, f"must be a point, is {checks.shown(body)}", SUCH_AS)
    raise ModelError(where, f'"{body.name}" is no point, it is a {kind(body)}', _points_of(body))


def parse_point(bodies: Mapping[str, Body], label: str, where: str = "point") -> Point:
    """Point written as ``beam.start``, ``beam.at(0.5, 0.01, 0)``, ``tip`` or ``hub.centre``.

    Raises
    ------
    ModelError
        There is no such point.

    """
    if label.strip() in bodies:
        return own_point(bodies[label.strip()], where)
    ends = [
        f"{own.name}.{end}" for own in bodies.values() if isinstance(own, Beam) for end in ("start", "end")
    ]
    name, word, inside = split_label(label, [*ends, *bodies], where)
    if name not in bodies:
        raise unknown(where, "body", name, bodies)
    body = bodies[name]
    if isinstance(body, Beam) and word in ("start", "end"):
        return body.start if word == "start" else body.end
    if isinstance(body, RigidBody) and word == "centre":
        return body.centre
    if isinstance(body, PointMass) or word != "at":
        raise ModelError(where, f'"{label}": "{name}" is a {kind(body)}', _points_of(body))
    place = numbers_of(inside, label, where, rigid=isinstance(body, RigidBody))
    try:
        return body.at(*place)
    except ModelError as error:
        raise ModelError(where, error.what, error.hint) from None


def _points_of(body: Body) -> str:
    """How the points of a body are written."""
    name = body.name
    if isinstance(body, PointMass):
        return f'its point is "{name}"'
    if isinstance(body, RigidBody):
        return f"its points are {name}.centre and {name}.at(x, y, z)"
    return f"its points are {name}.start, {name}.end and {name}.at(x)"


def _extent(body: Body) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest coordinates (3,) of a body, m."""
    if isinstance(body, Beam):
        return np.min(body.node_position, axis=0), np.max(body.node_position, axis=0)
    radius = body.gyration_radius if isinstance(body, RigidBody) else 0.0
    return body.position - radius, body.position + radius
