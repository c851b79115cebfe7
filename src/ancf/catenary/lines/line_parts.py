"""What a line is made of, by class: a part of another kind is named before anything asks it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ...errors import ModelError
from ...model import checks
from .auxiliary import Auxiliary
from .conditions import Conditions
from .fittings import DropperErrors, Droppers, Load, SteadyArm, Tensioner
from .span import Span
from .stitch import StitchWire
from .wire import Rayleigh, Wire

PARTS: dict[str, type] = {
    "contact_wire": Wire,
    "messenger_wire": Wire,
    "droppers": Droppers,
    "damping": Rayleigh,
    "stitch": StitchWire,
    "auxiliary": Auxiliary,
    "tensioner": Tensioner,
    "conditions": Conditions,
    "dropper_errors": DropperErrors,
}
LISTS: dict[str, type] = {"spans": Span, "loads": Load, "steady_arm": SteadyArm}
#: Those that may be None, and those that have no default.
MAY_LACK = ("messenger_wire", "stitch", "auxiliary", "dropper_errors")
NEEDED = ("contact_wire", "spans", "steady_arm")
#: A line of some 600 km; more is a slip that would take all memory.
MOST_SPANS, MOST_DROPPERS = 10_000, 200_000


def check_size(spans: int, droppers: int, where: str) -> None:
    """Raise ModelError if a line has more spans or droppers than can be meant."""
    for count, most, what in ((spans, MOST_SPANS, "spans"), (droppers, MOST_DROPPERS, "droppers")):
        if count > most:
            raise ModelError(where, f"are {count} {what} in all, at most {most} can be")


def check_kinds(line: Any) -> None:
    """Raise ModelError for a part of another kind; makes tuples of spans and loads, which may be any."""
    for key, kind in PARTS.items():
        value = getattr(line, key)
        if value is not None or key not in MAY_LACK:
            _check(f"line.{key}", value, kind, key in NEEDED)
    for key in ("spans", "loads"):
        given = getattr(line, key)
        if isinstance(given, Iterable) and not isinstance(given, str | Mapping):
            object.__setattr__(line, key, checks.items(given, f"line.{key}"))
    for key, kind in LISTS.items():
        values = getattr(line, key)
        if key == "steady_arm" and isinstance(values, SteadyArm):
            continue
        if not isinstance(values, Sequence) or isinstance(values, str):
            what = f"must be a list of {kind.__name__}, is {checks.shown(values)}"
            raise ModelError(f"line.{key}", what)
        for k, value in enumerate(values):
            _check(f"line.{key}[{k}]", value, kind, True)


def _check(where: str, value: Any, kind: type, needed: bool) -> None:
    if not isinstance(value, kind):
        hint = f"catenary.{kind.__name__}(...)" if needed or value is not None else "leave it out"
        raise ModelError(where, f"must be a {kind.__name__}, is {checks.shown(value)}", hint)
