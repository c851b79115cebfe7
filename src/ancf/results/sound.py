"""Whether the parts of a results file fit together: looked at when it is opened, before anything is asked.

The states themselves are not read; ``ancf check`` does.  All functions raise ModelError with the place in the
file; :func:`inside` puts the file's name before it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ModelError
from ..model import checks
from ..model.beam import MOST_GAUSS_POINTS, NATURAL_SHAPES, NODE_TOLERANCE, POISSON, Beam
from ..model.bodies import Body, PointMass, RigidBody
from ..model.connections import Spring
from ..model.elements import KINDS
from ..model.kinds import by_word
from ..model.points import Point
from ..system.nodes import layout
from ..system.sensors import Listing
from .hdf5 import DAMAGED, damaged

#: Largest arc length of an initial shape in natural lengths.
MOST_STRETCH = 1e9
#: How far directions of unit length may be off.
UNIT = 1e-6


@contextmanager
def inside(path: Path) -> Iterator[None]:
    """Errors within this context are about the file."""
    try:
        yield
    except ModelError as error:
        if error.where == str(path):
            raise
        raise ModelError(str(path), f"is damaged: {error.where} {error.what}") from None
    except DAMAGED as error:
        raise damaged(path, error) from None


def check_header(header: Any) -> None:
    """What made the result, as far as it is read again: settings, texts, and what pictures mark."""
    _table(header, "header")
    settings = _table(header.get("settings"), "header.settings")
    for key in ("t_start", "t_end", "step", "output_step"):
        if settings.get(key) is not None:
            checks.number(settings[key], f"header.settings.{key}")
    checks.flag(settings.get("energy", True), "header.settings.energy")
    checks.text(settings.get("integrator", ""), "header.settings.integrator")
    for k, name in enumerate(_list(settings.get("sensors", []), "header.settings.sensors")):
        checks.text(name, f"header.settings.sensors[{k}]")
    for key in ("title", "created"):
        checks.text(header.get(key, ""), f"header.{key}")
    for key, version in _table(header.get("versions", {}), "header.versions").items():
        checks.text(version, f"header.versions.{key}")
    model = _table(header.get("model", {}), "header.model")
    checks.text(model.get("title", ""), "header.model.title")
    for group in ("supports", "connections"):
        for k, item in enumerate(_list(model.get(group, []), f"header.model.{group}")):
            _check_item(item, f"header.model.{group}[{k}]", by_word(group))


def _check_item(item: Any, where: str, kinds: dict[str, Any]) -> None:
    """A support or connection: kind, name, and where it is marked."""
    _table(item, where)
    kind = kinds[checks.choice(item.get("type"), f"{where}.type", tuple(kinds))]
    checks.text(item.get("name"), f"{where}.name")
    for key in kind.ends:
        if not isinstance(item.get(key), str):
            checks.place(item.get(key), f"{where}.{key}")
    if kind.word == "contact":
        checks.direction(item.get("strip"), f"{where}.strip")


def check_bodies(bodies: dict[str, Body], slots: dict[str, NDArray[Any]], width: int) -> None:
    """Numbers of the bodies, and their unknowns in states of this width."""
    for name, body in bodies.items():
        where = f"bodies/{name}"
        for key in ("velocity", "angular_velocity", "about"):
            if hasattr(body, key):
                checks.vector(getattr(body, key), f"{where}.{key}")
        if isinstance(body, Beam):
            _check_beam(body, where)
        else:
            _check_mass(body, where)
        nodes, shared, internal = layout(body)
        _unknowns(slots[name], f"{where}/slots", (nodes, shared + internal), width - 2)


def _check_beam(beam: Beam, where: str) -> None:
    kind = KINDS[checks.choice(beam.element, f"{where}.element", tuple(KINDS))]
    checks.choice(beam.strain, f"{where}.strain", kind.strains)
    checks.choice(beam.natural_shape, f"{where}.natural_shape", NATURAL_SHAPES)
    checks.choice(beam.poisson, f"{where}.poisson", POISSON)
    for count in beam.gauss:
        checks.integer(count, f"{where}.gauss", 1, MOST_GAUSS_POINTS)
    length = checks.positive(beam.length, f"{where}.length")
    checks.between(beam.stretch, f"{where}.stretch", 1.0 / MOST_STRETCH, MOST_STRETCH)
    x = checks.array(beam.node_x, f"{where}/node_x", (None,))
    slack = NODE_TOLERANCE * length
    if len(x) < 2 or abs(x[0]) > slack or abs(x[-1] - length) > slack or np.any(np.diff(x) <= 0.0):
        raise ModelError(f"{where}/node_x", f"does not run from 0 to the length of {length:g} m")
    for key in ("node_position", "node_tangent", "node_y"):
        values = checks.array(getattr(beam, key), f"{where}/{key}", (len(x), 3))
        if key == "node_tangent" or (key == "node_y" and kind.has_section):
            _units(values, f"{where}/{key}")


def _check_mass(body: PointMass | RigidBody, where: str) -> None:
    checks.positive(body.mass, f"{where}.mass")
    checks.place(body.position, f"{where}.position")
    if isinstance(body, RigidBody):
        inertia = checks.array(body.inertia, f"{where}.inertia", (3, 3))
        if not np.all(np.linalg.eigvalsh(inertia) > -1e-9 * np.abs(inertia).max()):
            raise ModelError(f"{where}.inertia", "has a negative moment")
        axes = checks.array(body.axes, f"{where}.axes", (3, 3))
        _units(axes.T, f"{where}.axes")


def _units(vectors: NDArray[np.float64], where: str) -> None:
    if np.any(np.abs(np.linalg.norm(vectors, axis=1) - 1.0) > UNIT):
        raise ModelError(where, "holds directions that are no unit vectors")


def check_joints(joints: dict[str, NDArray[Any]], arcs: dict[str, int], width: int) -> None:
    """Unknowns of joints and rigid bodies; of a sliding joint three multipliers and s."""
    for name, unknowns in joints.items():
        _unknowns(unknowns, f'joints "{name}"', (4,) if name in arcs else (None,), width)


def check_springs(springs: dict[str, Spring]) -> None:
    """Numbers of springs and where they begin and end."""
    for name, spring in springs.items():
        where = f'springs "{name}"'
        for key in ("stiffness", "damping", "length"):
            checks.non_negative(getattr(spring, key), f"{where}.{key}")
        for end in (spring.a, spring.b):
            if isinstance(end, Point):
                _check_point(end, where)
            else:
                checks.place(end, where)


def check_listing(listing: Listing, width: int, widths: dict[str, int]) -> None:
    """What sensors recorded, against the widths of the data sets that hold it."""
    for point in listing.points:
        _check_point(point, "sensors")
    for name in listing.connections:
        checks.text(name, "sensors.connections")
    _unknowns(listing.index, "sensors/index", (None,), width)
    if np.any(np.diff(listing.index) <= 0):
        raise ModelError("sensors/index", "does not ascend")
    wanted = {"q": len(listing.index), "v": len(listing.index), "measured": len(listing.entries)}
    if widths != wanted:
        raise ModelError("sensors", f"has data of widths {widths}, wanted {wanted}")
    for name, places in listing.columns.items():
        _unknowns(places, f'sensors "{name}"', (4,), len(listing.entries))


def check_times(t: NDArray[np.float64], where: str) -> None:
    """Times that ascend."""
    checks.array(t, where, (None,))
    if np.any(np.diff(t) <= 0.0):
        raise ModelError(where, "does not ascend")


def _check_point(point: Point, where: str) -> None:
    checks.text(point.label, f"{where}: a point")
    x = float(checks.place([point.x, point.y, point.z], f"{where}: {point.label}")[0])
    length = point.body.length if isinstance(point.body, Beam) else None
    if length is not None and not -NODE_TOLERANCE * length <= x <= length * (1.0 + NODE_TOLERANCE):
        raise ModelError(f"{where}: {point.label}", f"lies at {x:g} m of a beam of {length:g} m")


def _unknowns(values: NDArray[Any], where: str, shape: tuple[int | None, ...], width: int) -> None:
    """Whole numbers of this shape from 0 to `width` - 1."""
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "iu":
        raise ModelError(where, "must hold whole numbers")
    checks.array(values, where, shape)
    if values.size and not 0 <= values.min() <= values.max() < width:
        raise ModelError(where, "lies outside the states")


def _table(value: Any, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise ModelError(where, f"must be a table, is {checks.shown(value)}")
    return value


def _list(value: Any, where: str) -> list[Any]:
    if not isinstance(value, list):
        raise ModelError(where, f"must be a list, is {checks.shown(value)}")
    return value
