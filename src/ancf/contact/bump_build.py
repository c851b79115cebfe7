"""From contacts between rigid bodies of the model to the flat arrays of their batches."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import traits
from ..errors import ModelError
from ..model.bodies.rigid import RigidBody
from ..model.surfaces.body_contact import BodyContact
from ..model.surfaces.shape import Shape
from ..model.surfaces.shapes import Capsule, Cylinder, Plane, Sheave, Sphere, Torus
from ..records import Located
from .build import MOST_NUMBERS
from .bump import bump_values
from .lay import DEEPEST, FIRST, LAST, OTHER, SHALLOW
from .meeting import ALONG, PROFILE, SEGMENTS, BumpBatch
from .profiles import NUMBER
from .roll import RollBatch

#: Part of the smaller radius by which bodies may be in each other in the initial shape.
SUNK = 0.5

Ends = tuple[FloatArray, FloatArray, float]


def bumps(items: Sequence[BodyContact], slots: dict[str, IntArray], measured: FloatArray) -> dict[str, Any]:
    """Batches of the normal forces and, where there is any, of the friction, which share their arrays.

    They leave what they find in ``measured``, shape (contacts, 4).  ModelError if bodies lie in each other in
    the initial shape.
    """
    rows = [row for k, item in enumerate(items) for row in _rows(k, item, slots)]
    n = len(rows)
    batch = BumpBatch(
        base=np.array([row["base"] for row in rows], dtype=np.int64),
        dest=np.full((n, 64), -1, dtype=np.int64),
        kind=np.array([row["kind"] for row in rows], dtype=np.int64),
        part=np.array([row["part"] for row in rows], dtype=np.int64),
        ends=np.array([row["ends"] for row in rows]),
        contact=np.array([row["contact"] for row in rows], dtype=np.int64),
        surface=np.array([row["surface"] for row in rows]),
        shape_of=np.array([row["shape"] for row in rows], dtype=np.int64),
        data=np.array([_numbers(item) for item in items]),
        found=measured,
        last=np.full((n, 9), np.inf),
        rough=np.zeros((n, 10)),
    )
    _refuse_sunk(items, batch, slots)
    found: dict[str, Any] = {"bumping": batch}
    if any(item.friction > 0.0 for item in items):
        found["rolling"] = RollBatch(*batch)
    return found


def renumbered(batch: Any, items: Sequence[BodyContact]) -> Any:
    """The batch with the numbers of these contacts in place of the same ones with others.

    What contacts remember is their own.
    """
    own = {key: getattr(batch, key).copy() for key in traits(batch).memory if key != "found"}
    return batch._replace(data=np.array([_numbers(item) for item in items]), **own)


def share(parts: dict[str, Any]) -> None:
    """Let the friction have the arrays of the normal forces again: each has been mapped by itself."""
    if "rolling" in parts:
        parts["rolling"] = RollBatch(*parts["bumping"])


def _refuse_sunk(items: Sequence[BodyContact], batch: BumpBatch, slots: dict[str, IntArray]) -> None:
    """ModelError where bodies lie in each other in the initial shape."""
    q = np.zeros((1, int(np.max(batch.base)) + 3))
    for body in {s.on for item in items for s in (item.surface, item.other)} - {None}:
        assert body is not None
        for slot, x in zip(slots[body.name][0], [body.position, *body.axes.T], strict=True):
            q[0, slot : slot + 3] = x
    out = np.zeros((1, len(items), 4))
    bump_values(Located(batch._replace(found=np.zeros((len(items), 4)))), q, np.zeros_like(q), out)
    for item, depth in zip(items, out[0, :, 1].tolist(), strict=True):
        if depth > SUNK * min(_radius(s.shape) for s in (item.surface, item.other)):
            what = f'"{item.surface.name}" is {depth:.4g} m inside "{item.other.name}"'
            raise ModelError(item.name, what, "let the bodies begin side by side, or just touch")


def _rows(k: int, item: BodyContact, slots: dict[str, IntArray]) -> list[dict[str, Any]]:
    """Rows of a contact."""
    first, second = item.surface, item.other
    one, two = _ends(first.shape), _ends(second.shape)
    if one is None:  # a round body against another surface
        return _rows(k, BodyContact(item.name, second, first, *_law(item)), slots)
    a = slots_of(first.on, slots)
    b = slots_of(second.on, slots)
    if isinstance(first.shape, Sphere) and two is None:
        return [_row(k, a, b, one, None, PROFILE, second.shape)]
    if isinstance(first.shape, Sphere) or (isinstance(second.shape, Sphere) and two is not None):
        return [_row(k, a, b, one, two, SEGMENTS)]
    if isinstance(second.shape, Plane):
        return [_row(k, a, b, (p, p, one[2]), None, PROFILE, second.shape) for p in one[:2]]
    return [_row(k, a, b, one, None, ALONG, second.shape, part) for part in _places(second.shape)]


def _places(shape: Shape) -> list[int]:
    """Places along a capsule that may touch this shape."""
    if isinstance(shape, Torus):
        return [DEEPEST, OTHER + DEEPEST, SHALLOW]
    if isinstance(shape, Cylinder) and shape.length is None:
        return [DEEPEST, FIRST, LAST]
    return [*range(SHALLOW + 1)] if isinstance(shape, Sheave) else [*range(OTHER)]


def _law(item: BodyContact) -> tuple[float, float, float, float | None]:
    return item.stiffness, item.damping, item.friction, item.stick


def _row(
    k: int,
    a: IntArray,
    b: IntArray,
    one: Ends,
    two: Ends | None,
    kind: int,
    shape: Shape | None = None,
    part: int = DEEPEST,
) -> dict[str, Any]:
    numbers = [] if shape is None else [*shape.numbers, *[0.0] * (MOST_NUMBERS - len(shape.numbers))]
    other = (np.zeros(3), np.zeros(3), 0.0) if two is None else two
    return {
        "base": np.concatenate([a, b]),
        "kind": kind,
        "part": part,
        "ends": np.concatenate([one[0], one[1], other[0], other[1], [one[2], other[2]]]),
        "contact": k,
        "surface": np.zeros(6 + MOST_NUMBERS)
        if shape is None
        else np.array([*shape.place.tolist(), *shape.direction.tolist(), *numbers]),
        "shape": 0 if shape is None else NUMBER[shape.word],
    }


def slots_of(body: RigidBody | None, slots: dict[str, IntArray]) -> IntArray:
    """Slots of a rigid body, -1 of the ground."""
    return np.full(4, -1, dtype=np.int64) if body is None else slots[body.name][0]


def _ends(shape: Shape) -> Ends | None:
    """Ends of the segment of a sphere or a capsule, and its radius; None of other shapes."""
    if isinstance(shape, Sphere):
        return shape.place, shape.place, shape.radius
    if isinstance(shape, Capsule):
        half = 0.5 * shape.length * shape.direction
        return shape.place - half, shape.place + half, shape.radius
    return None


def _radius(shape: Shape) -> float:
    ends = _ends(shape)
    return math.inf if ends is None else ends[2]


def _numbers(item: BodyContact) -> list[float]:
    stick = item.stiffness if item.stick is None else item.stick
    drag = item.damping * math.sqrt(stick / item.stiffness)
    least = min(_radius(s.shape) for s in (item.surface, item.other))
    return [least, item.stiffness, item.damping, item.friction, stick, drag]
