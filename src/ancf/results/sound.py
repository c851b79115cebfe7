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

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.bodies.beam import NODE_TOLERANCE, Beam
from ..model.joints.basic import Slide
from ..model.model import Model
from ..model.points import Point
from ..system.nodes import layout
from ..system.sensors import Listing
from .hdf5 import DAMAGED, damaged


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
    for key in ("sensors", "called once a step", "sensitivities"):
        for k, name in enumerate(_list(settings.get(key, []), f"header.settings.{key}")):
            checks.text(name, f"header.settings.{key}[{k}]")
    for key in ("title", "created"):
        checks.text(header.get(key, ""), f"header.{key}")
    for key, version in _table(header.get("versions", {}), "header.versions").items():
        checks.text(version, f"header.versions.{key}")
    _table(header.get("model"), "header.model")


def check_unknowns(
    model: Model, slots: dict[str, NDArray[Any]], joints: dict[str, NDArray[Any]], width: int
) -> None:
    """Unknowns of bodies and joints in states of this width; of a sliding joint three multipliers and s."""
    for name, body in model.bodies.items():
        nodes, shared, internal = layout(body)
        _unknowns(slots[name], f"bodies/{name}/slots", (nodes, shared + internal), width - 2)
    slides = {item.name for item in model.connections if isinstance(item, Slide)}
    for name, unknowns in joints.items():
        _unknowns(unknowns, f'joints "{name}"', (4,) if name in slides else (None,), width)
    if missing := slides - joints.keys():
        raise ModelError("joints", f'has no "{min(missing)}"')


def check_listing(listing: Listing, width: int, widths: dict[str, int]) -> None:
    """What sensors recorded, against the widths of the data sets that hold it."""
    for point in listing.points:
        _check_point(point, "sensors")
    for name in listing.connections:
        checks.text(name, "sensors.connections")
    _unknowns(listing.index, "sensors/index", (None,), width)
    if np.any(np.diff(listing.index) <= 0):
        raise ModelError("sensors/index", "does not ascend")
    wanted = {"q": len(listing.index), "v": len(listing.index), "measured": listing.width}
    if widths != wanted:
        raise ModelError("sensors", f"has data of widths {widths}, wanted {wanted}")
    for known, count in ((listing.columns, 4), (listing.springs, 2)):
        for name, places in known.items():
            _unknowns(places, f'sensors "{name}"', (count,), len(listing.entries))
    for key in ("moved", "pushed"):
        _unknowns(getattr(listing, key), f"sensors/{key}", (None,), width)
    if np.any(np.diff(listing.moved) <= 0):
        raise ModelError("sensors/moved", "does not ascend")
    for name, places in listing.held.items():
        if places.size:
            _unknowns(places[:, 0], f'sensors "{name}"', (None,), len(listing.pushed))
            _unknowns(places[:, 1], f'sensors "{name}"', (None,), 3)


def check_times(t: FloatArray, where: str) -> None:
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
