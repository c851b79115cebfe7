"""A model with one body or item for another one: all that refers to it refers to the new one."""

from __future__ import annotations

from copy import copy, deepcopy
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from .bodies.beam import Beam
from .joints.basic import Slide
from .kinds import GROUPS, SURROUNDINGS
from .loads.load import DistributedLoad
from .points import Point
from .surfaces.surface import SurfaceContact, touches_with_its_own

#: What refers to nothing.
_PLAIN = (float, int, str, np.ndarray, type(None))


def exchanged(model: Any, old: Any, new: Any, factor: float = 1.0) -> Any:
    """A copy of a model with one body or item for another; places on a body of another length move along."""
    memo: dict[int, Any] = {id(old): new}
    for item in _all_of(model):
        if item is not old and not is_dataclass(item):
            memo[id(item)] = item
        for value in _values(item):
            if isinstance(value, Point):
                if value.body is old:
                    memo[id(value)] = _carried(value, new, factor)
            elif not isinstance(value, tuple) and not is_dataclass(value):
                memo[id(value)] = value
    made = deepcopy(model, memo)
    _follow(made, old, new, factor)
    return made


def renewed(model: Any, old: Any, new: Any, factor: float = 1.0) -> Any:
    """The same, of which all that does not refer to the old one is shared with the model."""
    made, memo = model.snapshot(), {id(old): new}
    for item in _all_of(model) if old in model.bodies.values() else ():
        for value in _values(item):
            if isinstance(value, Point) and value.body is old:
                memo[id(value)] = _carried(value, new, factor)
    made.bodies = {name: _renewed(body, memo) for name, body in model.bodies.items()}
    for key in (*GROUPS, *SURROUNDINGS):
        items = getattr(model, key)
        if items:
            setattr(made, key, [_renewed(item, memo) for item in items])
    _follow(made, old, new, factor)
    return made


def _renewed(item: Any, memo: dict[int, Any]) -> Any:
    """What stands for an item: itself, if nothing in it has changed."""
    if id(item) in memo:
        return memo[id(item)]
    made = item
    if isinstance(item, tuple):
        parts = [_renewed(part, memo) for part in item]
        if any(a is not b for a, b in zip(parts, item, strict=True)):
            made = type(item)(*parts) if hasattr(item, "_fields") else tuple(parts)
    elif _names_of(item):
        found = {name: (value, _renewed(value, memo)) for name, value in _named(item)}
        changed = {name: new for name, (value, new) in found.items() if new is not value}
        if changed:
            made = copy(item)
            for name, value in changed.items():
                object.__setattr__(made, name, value)
    memo[id(item)] = made
    return made


def _all_of(model: Any) -> list[Any]:
    items = [item for key in (*GROUPS, *SURROUNDINGS) for item in getattr(model, key)]
    return [*model.bodies.values(), *items]


def _named(item: Any) -> list[tuple[str, Any]]:
    """Fields in which there may be others, and their values."""
    found = [(name, getattr(item, name)) for name in _names_of(item)]
    return [
        (name, x) for name, x in found if not isinstance(x, _PLAIN) and (_names_of(x) or isinstance(x, tuple))
    ]


def _names_of(item: Any) -> tuple[str, ...]:
    kind: Any = type(item)
    return _names(kind)


@cache
def _names(kind: Any) -> tuple[str, ...]:
    """Of the fields of a kind of items."""
    return tuple(field.name for field in fields(kind)) if is_dataclass(kind) else ()


def _values(item: Any) -> list[Any]:
    return [getattr(item, name) for name in _names_of(item)]


def _carried(point: Point, body: Any, factor: float) -> Point:
    if not isinstance(body, Beam) or factor == 1.0:
        return replace(point, body=body)
    if point.label.endswith(".end"):
        return body.end
    x = point.x * factor
    label = point.label if point.label.endswith(".start") else body.at(x, point.y, point.z).label
    return replace(point, body=body, x=x, label=label)


def _follow(made: Any, old: Any, new: Any, factor: float) -> None:
    """Let what is given by arc lengths or by the diameter of a beam go with them."""
    if isinstance(old, Beam) and (factor != 1.0 or old.section.diameter != new.section.diameter):
        for key in GROUPS:
            setattr(made, key, [_following(item, old, new, factor) for item in getattr(made, key)])


def _following(item: Any, old: Beam, beam: Beam, factor: float) -> Any:
    if isinstance(item, DistributedLoad) and item.body is beam and factor != 1.0:
        x0, x1 = item.between
        return replace(item, between=(x0 * factor, min(x1 * factor, beam.length)))
    if isinstance(item, Slide) and item.carrier is beam and factor != 1.0:
        return replace(item, s=item.s * factor)
    if isinstance(item, SurfaceContact) and item.body is beam and touches_with_its_own(item, old):
        return replace(item, radius=0.5 * (beam.section.diameter or 0.0))
    return item
