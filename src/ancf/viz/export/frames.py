"""A result as tables and arrays with names and units: pandas and xarray."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module
from typing import Any

import numpy as np

from ...errors import ModelError, named
from ...model import checks
from ...model.bodies.beam import Beam
from ...model.kind import TORSION
from ...model.points import Point
from ...results.sensors import Sensors
from . import tables
from .csv_files import default_points

EXTRA = "pip install 'ancf[data]'"
#: Word for the energies among what is asked for.
ENERGY = "energy"
#: Kind of the inputs of a model.
INPUT = "input"


def to_pandas(known: Any, items: Sequence[Any] | None) -> Any:
    """A DataFrame of a result or its sensors; see :meth:`ancf.Result.to_pandas`."""
    pandas = library("pandas", "to_pandas")
    found = dict(_columns(known, _asked(known, items, "to_pandas")))
    frame = pandas.DataFrame(found, index=pandas.Index(_times(known), name="t [s]"))
    frame.attrs = {"title": _title(known), "units": {name: _unit(name) for name in found}}
    said = {name: _said(known, name.rpartition(" [")[0] or name) for name in found}
    frame.attrs["descriptions"] = {name: text["long_name"] for name, text in said.items() if text}
    return frame


def to_xarray(known: Any, items: Sequence[Any] | None) -> Any:
    """A Dataset of a result or its sensors; see :meth:`ancf.Result.to_xarray`."""
    xarray = library("xarray", "to_xarray")
    asked = _asked(known, items, "to_xarray")
    variables = dict(_variables(known, asked))
    points = [label for label, kind in asked if kind == "point"]
    springs = [label for label, kind in asked if kind == "spring"]
    coordinates: dict[str, Any] = {"t": ("t", _times(known), {"units": "s", "long_name": "time"})}
    if points:
        coordinates |= {"point": points, "axis": ["x", "y", "z"]}
    if springs:
        coordinates["spring"] = springs
    return xarray.Dataset(variables, coords=coordinates, attrs={"title": _title(known)})


def library(name: str, method: str) -> Any:
    """A library that is imported when it is needed; ModelError that says how to install it."""
    try:
        return import_module(name)
    except ImportError:
        raise ModelError(method, f"needs {name}, which is not installed", EXTRA) from None


def _times(known: Any) -> Any:
    return np.asarray(known.t)


def _title(known: Any) -> str:
    return str(known.model.title)


def _unit(name: str) -> str:
    return name[name.rindex("[") + 1 : -1] if name.endswith("]") else ""


def _asked(known: Any, items: Sequence[Any] | None, method: str) -> list[tuple[str, str]]:
    """Labels of what is asked for, each with its kind."""
    if items is None:
        return _everything(known)
    if isinstance(items, str | Point) or not isinstance(items, Sequence):
        items = [items]
    return [_kind(known, item, f"{method}[{k}]") for k, item in enumerate(items)]


def _everything(known: Any) -> list[tuple[str, str]]:
    """All that sensors recorded; of a result the ends of its bodies, springs, joints and energies."""
    if isinstance(known, Sensors):
        return [*(_kind(known, name, name) for name in known.names), *_inputs(known)]
    found = [(label, "point") for label in default_points(known)]
    found += [(name, "spring") for name in known.springs]
    found += [(name, TORSION) for name in known.torsion_springs]
    found += [(name, "joint") for name in known.joints if name not in known.bodies]
    found += _inputs(known)
    return [*found, (ENERGY, ENERGY)] if _has_energy(known) else found


def _inputs(known: Any) -> list[tuple[str, str]]:
    """Inputs of a run that was led."""
    return [(name, INPUT) for name in known.model.inputs] if known._led() else []


def _has_energy(known: Any) -> bool:
    return not isinstance(known, Sensors) and bool(known.provenance["settings"].get("energy", True))


def _kind(known: Any, item: Any, where: str) -> tuple[str, str]:
    label = item if isinstance(item, str) else str(getattr(item, "name", None) or item)
    if isinstance(item, Point):
        label = str(item) or label
    if label == ENERGY and _has_energy(known):
        return label, ENERGY
    if label in known.torsion_springs:
        return label, TORSION
    for kind, names in (("spring", known.springs), ("joint", known.joints)):
        if label in names and label not in known.model.bodies:
            return label, kind
    if label in known._contacts():
        return label, "contact"
    if label in known.held_supports():
        return label, "support"
    if label in known.model.inputs and label not in known.model.bodies:
        return label, INPUT
    try:
        known.position(item)
    except ModelError as error:
        raise ModelError(where, f"{error.where} {error.what}", error.hint) from None
    except (AttributeError, TypeError):
        raise ModelError(named(where), f"is {checks.shown(item)}, which has no history") from None
    return label, "point"


def _columns(known: Any, asked: list[tuple[str, str]]) -> Iterator[tables.Column]:
    for label, kind in asked:
        if kind == "point":
            yield from tables.motion_columns(known, label, label)
            yield from tables.inside_columns(known, label)
        elif kind == "spring":
            yield f"{label} force [N]", known.spring_force(label)
            yield f"{label} length [m]", known.spring_length(label)
        elif kind == TORSION:
            yield from tables.torsion_columns(known, label)
        elif kind == "joint":
            yield from tables.joint_parts(known, label)
        elif kind == "contact" and isinstance(known, Sensors):
            yield from tables.contact_columns(known, label)
        elif kind == "contact":
            yield f"{label} force [N]", known.contact_force(label)
            yield f"{label} gap [m]", known.contact_gap(label)
        elif kind == INPUT:
            yield tables.input_column(known, label)
        elif kind == "support":
            yield from tables.support_columns(known, label)
        else:
            yield from ((name, values) for name, values in tables.energy_columns(known) if name != "t [s]")


def _variables(known: Any, asked: list[tuple[str, str]]) -> Iterator[tuple[str, Any]]:
    """Arrays over time, points and axes; what a point does not have is not a number there."""
    points = [label for label, kind in asked if kind == "point"]
    if points:
        for question, unit in tables.MOTION.items():
            values = np.stack([getattr(known, question)(label) for label in points], axis=1)
            yield question, (("t", "point", "axis"), values, {"units": unit})
        for question, unit in tables.INSIDE.items():
            values = np.full((len(_times(known)), len(points)), np.nan)
            for k, label in enumerate(points):
                if isinstance(known._probe(label).body, Beam):
                    values[:, k] = getattr(known, question)(label)
            yield question, (("t", "point"), values, {"units": unit})
    springs = [label for label, kind in asked if kind == "spring"]
    for question, unit in (("spring_force", "N"), ("spring_length", "m")) if springs else ():
        values = np.stack([getattr(known, question)(label) for label in springs], axis=1)
        yield question, (("t", "spring"), values, {"units": unit})
    rest = [(label, kind) for label, kind in asked if kind not in ("point", "spring")]
    for name, values in _columns(known, rest):
        plain = name.rpartition(" [")[0] or name
        yield plain, ("t", values, {"units": _unit(name)} | _said(known, plain))


def _said(known: Any, name: str) -> dict[str, str]:
    """Description of an input."""
    item = known.model.inputs.get(name.removeprefix("input "))
    return {} if item is None or not name.startswith("input ") else {"long_name": item.description or name}
