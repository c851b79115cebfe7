"""From contacts with surfaces of the model to the flat arrays of their batches."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray, IntArray
from ..compiled import traits
from ..elements.registry import ELEMENTS
from ..elements.shapes import gauss, hermite
from ..errors import ModelError
from ..loads.along import along, ordered
from ..model.surfaces.surface import Surface, SurfaceContact
from .mesh import distances, trees
from .press import PressBatch
from .profiles import NUMBER
from .reel import winched
from .rub import RubBatch
from .touch import BODY, NODES, NUMBERS

#: Gauss points of an element.
POINTS = 5
#: Room for the numbers of a shape.
MOST_NUMBERS = 4
#: Fields of rows that know their winch.
REEL = ("winch", "unwound", "mesh")
#: Part of a beam's radius by which it may be in a surface in the initial shape.
SUNK = 0.5


def batches(
    items: Sequence[SurfaceContact],
    locate: Callable[[Any], Any],
    slots: dict[str, IntArray],
    measured: FloatArray,
) -> dict[str, Any]:
    """Batches of the normal forces and, where there is any, of the friction.

    They leave what they find in ``measured``, shape (contacts, 4).  ModelError if a surface is inside of a
    beam in the initial shape.
    """
    for item in items:
        _refuse_sunk(item)
    surfaces = list(dict.fromkeys(item.surface for item in items))
    fields, owners = along([item.body for item in items], locate, POINTS)
    assert fields["base"].shape[1] == NODES  # the axis of an element depends on no more, and on no less
    which = np.repeat(np.arange(len(items)), [item.body.elements for item in items])
    bodies = np.full((len(owners), BODY), -1, dtype=np.int64)
    for e, k in enumerate(which.tolist()):
        on = items[k].surface.on
        if on is not None:
            bodies[e] = slots[on.name][0]
    base = np.concatenate([fields["base"], bodies], axis=1)
    given = {
        "base": base,
        "dest": np.full((len(base), base.shape[1] ** 2), -1, dtype=np.int64),
        "shape": fields["shape"],
        "reach": _reach(fields, items),
        "weight": fields["weight"],
        **winched([item.body for item in items], locate),
        "contact": which.astype(np.int64),
        "surface": np.array([surfaces.index(items[k].surface) for k in which.tolist()], dtype=np.int64),
        "data": np.array([_numbers(item) for item in items]),
        "surfaces": np.array([_lie(surface) for surface in surfaces]),
        "shape_of": np.array([NUMBER[s.shape.word] for s in surfaces], dtype=np.int64),
        "found": measured,
        "hint": np.zeros(fields["weight"].shape, dtype=np.int64),
        "far": np.full((len(base), 5), -np.inf),
    }
    tree, faces, first = trees([surface.shape for surface in surfaces])
    given |= {"tree": tree, "faces": faces} if len(tree) else {"tree": np.zeros(0), "faces": np.zeros(0)}
    given["surfaces"][:, NUMBERS] = np.where(first >= 0, first, given["surfaces"][:, NUMBERS])
    every = np.concatenate([[len(base), 0], np.arange(len(base))]).astype(np.int64)
    lit, bond = np.ones(len(base), dtype=np.int64), np.zeros(fields["weight"].shape, dtype=np.int64)
    found: dict[str, Any] = {"pressing": PressBatch(**given, near=every, lit=lit, bond=bond)}
    rough = np.array([items[k].friction > 0.0 for k in which.tolist()], dtype=bool)
    if np.any(rough):
        rows = ("base", "dest", "shape", "reach", "weight", "contact", "surface", "hint", "far", *REEL)
        mine = {key: x[rough].copy() if key in rows else x for key, x in given.items()}
        rubbing = [item for item in items if item.friction > 0.0]
        anchor = np.concatenate([_places(item) for item in rubbing])
        moved = len(anchor) if np.any(mine["winch"] >= 0) else 0
        found["rubbing"] = RubBatch(
            **mine,
            anchor=anchor,
            limit=np.zeros(anchor.shape[:2]),
            before=np.zeros(anchor.shape[:2]),
            most=np.zeros(len(anchor)),
            lit=np.zeros(len(anchor) + 1, dtype=np.int64),
            bond=np.zeros(anchor.shape[:2], dtype=np.int64),
            **ordered([item.body for item in rubbing], locate, POINTS),
            drift=np.zeros((moved, POINTS, 3)),
            since=np.zeros(moved),
            acted=np.zeros(anchor.shape[:2]),
        )
    return found


def renumbered(batch: Any, items: Sequence[SurfaceContact], locate: Any = None) -> Any:
    """The batch with the numbers of these contacts in place of the same ones with others.

    ``locate``: finds the probe of a point where lengths of beams differ as well.  What friction remembers is
    its own.
    """
    keys = [key for key in traits(batch).memory if key != "found"] if isinstance(batch, RubBatch) else []
    own = {key: getattr(batch, key).copy() for key in keys}
    if locate is not None:
        own |= _shapes(batch, items, locate)
    return batch._replace(data=np.array([_numbers(item) for item in items]), **own)


def _shapes(batch: Any, items: Sequence[SurfaceContact], locate: Any) -> dict[str, Any]:
    """Fields that depend on lengths of elements."""
    rubs = isinstance(batch, RubBatch)
    items = [item for item in items if item.friction > 0.0] if rubs else items
    bodies = [item.body for item in items]
    fields, _ = along(bodies, locate, POINTS)
    found = {"shape": fields["shape"], "reach": _reach(fields, items), "weight": fields["weight"]}
    found |= winched(bodies, locate)
    if rubs:
        found |= ordered(bodies, locate, POINTS) | {"anchor": np.concatenate([*map(_places, items)])}
    return found


def _numbers(item: SurfaceContact) -> list[float]:
    stick = item.stiffness if item.stick is None else item.stick
    drag = item.damping * math.sqrt(stick / item.stiffness)
    narrow = item.surface.shape.narrowest
    return [item.radius, item.stiffness, item.damping, item.friction, stick, drag, narrow]


def _lie(surface: Surface) -> list[float]:
    shape = surface.shape
    numbers = [*shape.numbers, *[0.0] * (MOST_NUMBERS - len(shape.numbers))]
    row = [*shape.place.tolist(), *shape.direction.tolist(), *numbers]
    assert len(row) == NUMBERS + MOST_NUMBERS
    return row


def _places(item: SurfaceContact) -> FloatArray:
    """Initial places of points of a beam, in the axes of what carries the surface, (elements, points, 3)."""
    beam, (xi, _) = item.body, gauss(POINTS)
    h, r, m = np.diff(beam.node_x)[:, None], beam.node_position, beam.stretch * beam.node_tangent
    S = hermite(np.broadcast_to(xi, (len(h), POINTS)), h * np.ones(POINTS))
    found = np.einsum("epk,ekc->epc", S, np.stack([r[:-1], m[:-1], r[1:], m[1:]], axis=1))
    return item.surface.body_axes(found)


def _refuse_sunk(item: SurfaceContact) -> None:
    """ModelError where the surface is inside of the beam in the initial shape."""
    places, beam = _places(item).reshape(-1, 3), item.body
    depth = item.radius - distances(item.surface.shape, places)
    k = int(np.argmax(depth))
    if depth[k] <= SUNK * item.radius:
        return
    e, at = k // POINTS, gauss(POINTS)[0][k % POINTS]
    x, h = beam.node_x[e], beam.node_x[e + 1] - beam.node_x[e]
    ends = item.surface.body_axes(beam.node_position[e : e + 2])
    there = f"{float(x + at * h):.4g} m"
    what = f'"{item.surface.name}" is {depth[k]:.4g} m inside "{beam.name}" at about x = {there}'
    hint = f"its axis begins at least {item.radius:.4g} m, its radius, away from the surface"
    if np.max(item.radius - distances(item.surface.shape, ends)) <= SUNK * item.radius:
        hint += f"; the nodes do, but element {e} between them is {h:.4g} m long: give shorter ones there"
    raise ModelError(item.name, what, hint)


def _reach(fields: dict[str, NDArray[Any]], items: Sequence[SurfaceContact]) -> FloatArray:
    """Largest factor of each slot, negative of positions: of these one is 1 at an end of an element."""
    largest: FloatArray = np.max(np.abs(fields["shape"]), axis=1)
    first = 0
    for item in items:
        rows, beam = slice(first, first + item.body.elements), item.body
        first, shape = rows.stop, ELEMENTS[beam.element].shape
        ends, (xi, _) = shape(beam.element, [0.0, 1.0], 1.0), gauss(POINTS)
        used = np.any(shape(beam.element, xi, 1.0) != 0.0, axis=0)
        positions = np.max(ends[:, used], axis=0) == 1.0
        largest[rows, : len(positions)] *= np.where(positions, -1.0, 1.0)
    return largest
