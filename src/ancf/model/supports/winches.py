"""The winches of a model, and what does not go together with one on the same cable."""

from __future__ import annotations

from typing import Any

from ...errors import ModelError
from ..joints.basic import Fixation, Slide
from ..joints.rigid_joints import Weld
from ..loads.followers import Pressure
from ..loads.load import DistributedLoad
from ..model import Model
from ..points import Point
from ..surfaces.cable_contact import CableContact
from ..surfaces.contact import Contact
from .winch import Winch


def by_body(model: Model) -> dict[str, Winch]:
    """Winches by the names of their cables, in the order of the bodies."""
    found = {w.point.body.name: w for w in model.supports if isinstance(w, Winch)}
    return {name: found[name] for name in model.bodies if name in found}


def check_winches(model: Model) -> None:
    """Raise ModelError for what does not go together with a winch on the same cable.

    The places between the ends of such a cable belong to no material: what is fastened there would slide.
    """
    winches = by_body(model)
    for found in winches.values():
        if found.beam.section.rotary_inertia is not None:
            raise _refused("Section.rotary_inertia", found, "is not known for", "leave it out")
    for support in model.supports:
        if not isinstance(support, Winch) and (winch := winches.get(support.point.body.name)):
            _check_end(winch, support.name, support.point)
            if getattr(support, "stretch", "") == "fixed" or getattr(support, "slope", ""):
                hint = 'hold directions: clamp(..., stretch="free")'
                raise _refused(support.name, winch, "holds a slope, whose length goes with the mesh", hint)
    loads: list[Any] = [*model.loads]  # there may be kinds of a user's own
    for load in loads:
        if isinstance(load, DistributedLoad):
            if winch := winches.get(load.body.name):
                _check_along(winch, load)
        elif isinstance(load, Pressure):
            if winch := winches.get(load.body.name):
                raise _refused(load.name, winch, "acts along the cable", "give a distributed load")
        elif winch := winches.get(load.point.body.name):
            _check_end(winch, load.name, load.point)
    for item in model.connections:
        _check_connection(winches, item)


def _check_along(winch: Winch, load: DistributedLoad) -> None:
    if load.between != (0.0, load.body.length):
        raise _refused(load.name, winch, "acts on a part of the cable", "leave between out")


def _check_connection(winches: dict[str, Winch], item: Any) -> None:
    """Only ends may be joined, and nothing runs along the cable."""
    carrier = item.carrier if isinstance(item, Slide | Contact) else getattr(item, "body", None)
    for along in (carrier, getattr(item, "other", None)):
        winch = winches.get(getattr(along, "name", ""))
        if winch and isinstance(item, Slide | Contact | CableContact):
            raise _refused(item.name, winch, "runs along the cable", "join it to an end of the cable")
    for end in (getattr(item, key, None) for key in ("a", "b", "point")):
        if isinstance(end, Point) and (winch := winches.get(end.body.name)):
            _check_end(winch, item.name, end)
            if isinstance(item, Fixation) and item.stretch == "fixed":
                what = "holds a slope, whose length goes with the mesh"
                raise _refused(item.name, winch, what, 'stretch="free"')
            if isinstance(item, Weld) and item.shares_slope:
                raise _refused(item.name, winch, "shares its slope with", "clamp both to a rigid body")


def _check_end(winch: Winch, name: str, point: Point) -> None:
    if point.x not in (0.0, winch.beam.length):
        hint = "join two cables there, of which the one at the winch changes its length"
        raise _refused(name, winch, f"is at {point}, between the ends of the cable", hint)


def _refused(name: str, winch: Winch, what: str, hint: str) -> ModelError:
    return ModelError(name, f'{what} "{winch.beam.name}", whose length "{winch.name}" changes', hint)
