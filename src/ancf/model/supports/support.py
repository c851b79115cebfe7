"""Supports: what holds nodes of beams, point masses and rigid bodies, at rest or in prescribed motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..bodies.beam import Beam
from ..bodies.rigid import Body, PointMass, RigidBody, kind
from ..functions.function import TimeFunction
from ..joints.basic import STRETCH
from ..points import Point
from .winch import Winch

AXES = "xyz"


@dataclass(frozen=True, slots=True, eq=False)
class Pin:
    """Holds the position of a node, a point mass or a rigid body's centre of mass.

    `displacement` (3,) in m is relative to the initial position.
    """

    name: str
    point: Point
    displacement: TimeFunction | None

    @property
    def held(self) -> frozenset[str]:
        """Components held: ``position x`` and so on."""
        return components(AXES, "")


@dataclass(frozen=True, slots=True, eq=False)
class Clamp:
    """Holds position and slope of a node, on a beam all three slopes, or a rigid body altogether.

    Attributes
    ----------
    stretch : str
        "free": the directions of r_x, r_y, r_z are held, their lengths are free; "fixed": all of them
        is held. A rigid body has no slopes, "free" says nothing there.
    rotation, rotation_rate, rotation_acceleration : TimeFunction or None
        Angle of the slopes or the body about `axis` from the initial ones, rad, and its exact derivatives.
    axis : (3,) array
        Unit vector.
    displacement : TimeFunction or None
        (3,), m, relative to the initial position.
    rotation_vector : TimeFunction or None
        (3,), rad, in place of `rotation`: axis times angle from the initial slopes or axes of the body.

    """

    name: str
    point: Point
    stretch: str
    rotation: TimeFunction | None
    rotation_rate: TimeFunction | None
    rotation_acceleration: TimeFunction | None
    axis: FloatArray
    displacement: TimeFunction | None
    rotation_vector: TimeFunction | None = None

    @property
    def held(self) -> frozenset[str]:
        """Components held; with a free stretch the slopes still belong to the clamp as a whole."""
        body = self.point.body
        if not isinstance(body, Beam):
            return components(AXES, "") | {"rotation"}
        if not body.has_section:
            return components(AXES, AXES)
        return components(AXES, AXES, AXES, AXES, twist=True)


@dataclass(frozen=True, slots=True, eq=False)
class Hold:
    """Holds single components of position and slopes of a node at their initial values.

    Those of the position may move. Also of the position of a point mass or a rigid body's centre of mass.

    Attributes
    ----------
    position, slope, slope_y, slope_z : str
        Letters of "xyz", in that order, of r, r_x, r_y and r_z; global directions. Of point masses and
        rigid bodies the position only.
    twist : bool
        Holds the component of r_y along the initial local z axis: the section does not turn about the
        tangent and is free to bend.
    displacement : TimeFunction or None
        (3,), m, of the components in `position`, relative to their initial values.

    """

    name: str
    point: Point
    position: str
    slope: str
    slope_y: str = ""
    slope_z: str = ""
    twist: bool = False
    displacement: TimeFunction | None = None

    @property
    def held(self) -> frozenset[str]:
        """Components held: ``position x``, ``slope z``, ``slope_y z``, ``twist`` and so on."""
        return components(self.position, self.slope, self.slope_y, self.slope_z, twist=self.twist)


Support = Pin | Clamp | Hold | Winch


def components(
    position: str, slope: str, slope_y: str = "", slope_z: str = "", *, twist: bool = False
) -> frozenset[str]:
    """Names of the components given by strings from "xyz"."""
    given = {"position": position, "slope": slope, "slope_y": slope_y, "slope_z": slope_z}
    names = {f"{key} {i}" for key, letters in given.items() for i in letters}
    return frozenset(names | ({"twist"} if twist else set()))


def optional(value: Any, size: int, where: str, unit: str) -> TimeFunction | None:
    """A TimeFunction, or None for None."""
    return None if value is None else TimeFunction(value, size, where, unit)


def make_clamp(
    where: str,
    name: str,
    point: Point,
    *,
    stretch: Any,
    rotation: Any,
    axis: Any,
    rotation_rate: Any,
    rotation_acceleration: Any,
    displacement: Any,
    rotation_vector: Any = None,
) -> Clamp:
    """Check everything that ``Model.clamp`` was given without `to`."""
    if isinstance(point.body, PointMass):
        what = f'"{point.body.name}" is a point mass and has no orientation'
        raise ModelError(f"{where}.point", what, "hold it with model.pin(...)")
    if isinstance(point.body, RigidBody) and stretch == "fixed":
        what = f'"{point.body.name}" is a rigid body and does not stretch'
        raise ModelError(f"{where}.stretch", what, "leave stretch out")
    if rotation is not None and rotation_vector is not None:
        what = "is given beside rotation: a clamp turns in one way"
        raise ModelError(f"{where}.rotation_vector", what, "keep one of them")
    _check_derivatives(where, rotation, rotation_rate, rotation_acceleration)
    return Clamp(
        name,
        point,
        checks.choice(stretch, f"{where}.stretch", STRETCH),
        optional(rotation, 1, f"{where}.rotation", "rad"),
        optional(rotation_rate, 1, f"{where}.rotation_rate", "rad/s"),
        optional(rotation_acceleration, 1, f"{where}.rotation_acceleration", "rad/s^2"),
        checks.direction(axis, f"{where}.axis"),
        optional(displacement, 3, f"{where}.displacement", "m"),
        optional(rotation_vector, 3, f"{where}.rotation_vector", "rad"),
    )


def _check_derivatives(where: str, rotation: Any, rate: Any, acceleration: Any) -> None:
    if (rate is None) != (acceleration is None):
        missing = "rotation_rate" if rate is None else "rotation_acceleration"
        raise ModelError(f"{where}.{missing}", "is missing: give both exact derivatives or none")
    if rotation is None and rate is not None:
        raise ModelError(f"{where}.rotation", "is missing: rotation_rate is its derivative")


def make_hold(where: str, name: str, point: Point, *, twist: Any, displacement: Any, **letters: Any) -> Hold:
    """Check everything that ``Model.hold`` was given."""
    clean = {key: _letters(value, f"{where}.{key}") for key, value in letters.items()}
    motion = optional(displacement, 3, f"{where}.displacement", "m")
    hold = Hold(name, point, **clean, twist=checks.flag(twist, f"{where}.twist"), displacement=motion)
    if not hold.held:
        what = "nothing is held: give position, slope, slope_y, slope_z or twist"
        raise ModelError(f"{where}.position", what, 'such as position="xz"')
    if motion is not None and not hold.position:
        what = "moves nothing: no component of the position is held"
        raise ModelError(f"{where}.displacement", what, 'give position too, such as position="xy"')
    _check_slopes(where, hold, point.body)
    if hold.twist and hold.slope_y:
        what = "holds a component of r_y already: give slope_y or twist, not both"
        raise ModelError(f"{where}.twist", what)
    return hold


def _check_slopes(where: str, hold: Hold, body: Body) -> None:
    """A cable has one slope, a point mass or rigid body none."""
    missing = {"slope_y": "r_y", "slope_z": "r_z", "twist": "r_y"}
    hint = 'element = "original" or "nonlocking" has one'
    if not isinstance(body, Beam):
        missing = {"slope": "slope", "slope_y": "slope", "slope_z": "slope", "twist": "slope"}
        hint = "clamp holds a rigid body altogether" if isinstance(body, RigidBody) else ""
    elif body.has_section:
        return
    for key, slope in missing.items():
        if getattr(hold, key):
            what = f'"{body.name}" is a {kind(body)} and has no {slope}'
            raise ModelError(f"{where}.{key}", what, hint)


def _letters(value: Any, where: str) -> str:
    given = checks.text(value, where)
    if not set(given) <= set(AXES) or len(set(given)) < len(given):
        raise ModelError(where, f'is "{given}", must be letters of "xyz", each at most once')
    return "".join(sorted(given))


def check_overlap(where: str, new: Support, others: list[Support]) -> None:
    """No component of a node may be held twice; a second clamp adds to the first one."""
    for other in others:
        _refuse_second_winch(where, new, other)
        if isinstance(other, Clamp) and isinstance(new, Clamp):
            _refuse_repeated(where, new, other)
            continue
        same_node = other.point.body is new.point.body and node_of(other.point) == node_of(new.point)
        twice = _held_twice(other.held, new.held)
        if same_node and twice:
            what = f'"{new.name}" and "{other.name}" both hold {", ".join(twice)} of {new.point}'
            raise ModelError(f"{where}.point", what, "keep one of them")


def _refuse_repeated(where: str, new: Clamp, other: Clamp) -> None:
    """A second clamp of a node that holds nothing more is the first one again, or moves it otherwise."""
    if other.point.body is not new.point.body or node_of(other.point) != node_of(new.point):
        return
    for name, motion, given in zip(("rotation", "displacement"), _motions(new), _motions(other), strict=True):
        if motion is not None and given is not None:
            what = f'"{other.name}" has a {name} of {new.point} already'
            raise ModelError(
                f"{where}.{name}", what, "give one of the two, with both motions in one function"
            )
    holds_more = new.stretch == "fixed" and other.stretch == "free"
    if not holds_more and all(motion is None for motion in _motions(new)):
        what = f'"{other.name}" clamps {new.point} already'
        raise ModelError(f"{where}.point", what, "keep one of them; a second one gives a motion or a stretch")


def _motions(clamp: Clamp) -> tuple[TimeFunction | None, TimeFunction | None]:
    """How a clamp turns, and how it moves."""
    return clamp.rotation or clamp.rotation_vector, clamp.displacement


def _refuse_second_winch(where: str, new: Support, other: Support) -> None:
    if isinstance(new, Winch) and isinstance(other, Winch) and new.beam is other.beam:
        what = f'"{other.name}" changes the length of "{new.beam.name}" already'
        raise ModelError(f"{where}.point", what, "keep one of them")


def _held_twice(one: frozenset[str], two: frozenset[str]) -> list[str]:
    """Components in both; twist is a direction of r_y that may not be one of x, y, z."""
    twice = sorted(one & two)
    mixed = any("twist" in a and any(i.startswith("slope_y") for i in b) for a, b in ((one, two), (two, one)))
    return twice or (["r_y (twist and slope_y)"] if mixed else [])


def node_of(point: Point) -> int | None:
    """Index of the node at a point, or None between nodes."""
    node: int | None = point.body.node_at(point.x)
    return node


def require_node(point: Point, where: str) -> int:
    """Index of the node at a point; 0 for a point mass or a rigid body's centre of mass.

    Raises
    ------
    ModelError
        The point is off the centreline or the centre of mass, or inside an element; the nearest nodes
        are named.

    """
    body = point.body
    if point.eccentric:
        if not isinstance(body, Beam):
            what = f"{point} is off the centre of mass, a support holds a rigid body there"
            place = [round(float(x), 9) for x in point.initial_position]
            hint = f"model.clamp({body.name}) holds all of it, model.connect({point}, {place}) lets it turn"
            raise ModelError(where, what, hint)
        what = f"{point} is off the centreline, what holds or joins a node must be on the centreline"
        raise ModelError(where, what, f"give {body.at(point.x)}")
    node = node_of(point)
    if node is not None or not isinstance(body, Beam):
        return node or 0
    after = int(body.node_x.searchsorted(point.x))
    near = f"{body.node_x[after - 1]:.9g} m and {body.node_x[after]:.9g} m"
    what = f"{point} is not at a node, the nearest nodes are at {near}"
    raise ModelError(where, what, f'put a node there: add_beam("{body.name}", nodes=[...])')
