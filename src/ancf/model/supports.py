"""Supports: what holds nodes of the bodies, at rest or in prescribed motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ancf.errors import ModelError
from ancf.model import checks
from ancf.model.checks import FloatArray
from ancf.model.functions import TimeFunction
from ancf.model.points import Point

STRETCH = ("free", "fixed")
AXES = "xyz"


@dataclass(frozen=True, slots=True, eq=False)
class Pin:
    """Holds the position of a node; `displacement` (3,) in m is relative to the initial position."""

    name: str
    point: Point
    displacement: TimeFunction | None

    @property
    def held(self) -> frozenset[str]:
        """Components held: ``position x`` and so on."""
        return components(AXES, "")


@dataclass(frozen=True, slots=True, eq=False)
class Clamp:
    """Holds position and slope of a node.

    Attributes
    ----------
    stretch : str
        "free": the direction of r_x is held, its length is free; "fixed": all of r_x is held.
    rotation, rate, acceleration : TimeFunction or None
        Angle of the tangent about `axis` through the initial one, rad, and its exact derivatives.
    axis : (3,) array
        Unit vector.
    displacement : TimeFunction or None
        (3,), m, relative to the initial position.

    """

    name: str
    point: Point
    stretch: str
    rotation: TimeFunction | None
    rate: TimeFunction | None
    acceleration: TimeFunction | None
    axis: FloatArray
    displacement: TimeFunction | None

    @property
    def held(self) -> frozenset[str]:
        """Components held; with a free stretch the slope still belongs to the clamp as a whole."""
        return components(AXES, AXES)


@dataclass(frozen=True, slots=True, eq=False)
class Hold:
    """Holds single components of position and slope of a node at their initial values ("xyz")."""

    name: str
    point: Point
    position: str
    slope: str

    @property
    def held(self) -> frozenset[str]:
        """Components held: ``position x``, ``slope z`` and so on."""
        return components(self.position, self.slope)


Support = Pin | Clamp | Hold


def components(position: str, slope: str) -> frozenset[str]:
    """Names of the components given by two strings from "xyz"."""
    return frozenset({f"position {i}" for i in position} | {f"slope {i}" for i in slope})


def optional(value: Any, size: int, where: str) -> TimeFunction | None:
    """A TimeFunction, or None for None."""
    return None if value is None else TimeFunction(value, size, where)


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
) -> Clamp:
    """Check everything that ``Model.clamp`` was given."""
    _check_derivatives(where, rotation, rotation_rate, rotation_acceleration)
    return Clamp(
        name,
        point,
        checks.choice(stretch, f"{where}.stretch", STRETCH),
        optional(rotation, 1, f"{where}.rotation"),
        optional(rotation_rate, 1, f"{where}.rotation_rate"),
        optional(rotation_acceleration, 1, f"{where}.rotation_acceleration"),
        checks.direction(axis, f"{where}.axis"),
        optional(displacement, 3, f"{where}.displacement"),
    )


def _check_derivatives(where: str, rotation: Any, rate: Any, acceleration: Any) -> None:
    if (rate is None) != (acceleration is None):
        missing = "rotation_rate" if rate is None else "rotation_acceleration"
        raise ModelError(f"{where}.{missing}", "is missing: give both exact derivatives or none")
    if rotation is None and rate is not None:
        raise ModelError(f"{where}.rotation", "is missing: rotation_rate is its derivative")


def make_hold(where: str, name: str, point: Point, position: Any, slope: Any) -> Hold:
    """Check everything that ``Model.hold`` was given."""
    clean = [_letters(position, f"{where}.position"), _letters(slope, f"{where}.slope")]
    if not any(clean):
        raise ModelError(f"{where}.position", "nothing is held: give position and/or slope", 'such as "xz"')
    return Hold(name, point, clean[0], clean[1])


def _letters(value: Any, where: str) -> str:
    given = checks.text(value, where)
    if not set(given) <= set(AXES) or len(set(given)) < len(given):
        raise ModelError(where, f'is "{given}", must be letters of "xyz", each at most once')
    return "".join(sorted(given))


def check_overlap(where: str, new: Support, others: list[Support]) -> None:
    """No component of a node may be held twice; a second clamp refines the first one."""
    for other in others:
        if isinstance(other, Clamp) and isinstance(new, Clamp):
            continue
        same_node = other.point.body is new.point.body and node_of(other.point) == node_of(new.point)
        twice = sorted(other.held & new.held)
        if same_node and twice:
            what = f'"{new.name}" and "{other.name}" both hold {", ".join(twice)} of {new.point}'
            raise ModelError(f"{where}.point", what, "keep one of them")


def node_of(point: Point) -> int | None:
    """Index of the node at a point, or None between nodes."""
    node: int | None = point.body.node_at(point.x)
    return node


def require_node(point: Point, where: str) -> int:
    """Index of the node at a point.

    Raises
    ------
    ModelError
        The point lies inside an element; the nearest nodes are named.

    """
    node = node_of(point)
    if node is not None:
        return node
    node_x = point.body.node_x
    after = int(node_x.searchsorted(point.x))
    near = f"{node_x[after - 1]:.9g} m and {node_x[after]:.9g} m"
    what = f"{point} is not at a node, the nearest nodes are at {near}"
    raise ModelError(where, what, f'put a node there: add_beam("{point.body.name}", nodes=[...])')
