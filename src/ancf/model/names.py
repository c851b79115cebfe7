"""Names of bodies and items: unique over a model, found with a suggestion when misspelt."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from ..errors import ModelError
from . import checks

BODY_NAME = re.compile(r"\w([\w -]*\w)?")
#: What is asked of a point, and is tried as a part of its name.
OF_POINT = ("x", "y", "z", "position", "velocity", "speed", "tension", "strain", "curvature", "twist")
POINT_LABEL = re.compile(r"(?P<body>.*)\.(?:(?P<word>start|end|centre)|at\((?P<inside>[^()]*)\))")
BEAM_PLACES = ("arc length", "place along local y", "place along local z")


class Names:
    """The names taken in one model."""

    __slots__ = ("_present", "_taken")

    def __init__(self, present: Callable[[], set[str]]) -> None:
        self._taken: dict[str, str] = {}
        self._present = present  # of all that is in the model: what was removed from its lists is free

    def of(self, present: Callable[[], set[str]]) -> Names:
        """The same of a copy of the model."""
        other = Names(present)
        other._taken = dict(self._taken)
        return other

    def of_body(self, given: object, where: str) -> str:
        """Check a body's name: letters, digits, _, - and spaces, not taken."""
        name = checks.text(given, f"{where}.name")
        if not BODY_NAME.fullmatch(name):
            rule = "must be letters, digits, _, - and spaces inside"
            raise ModelError(f"{where}.name", f"is {checks.shown(name)}, {rule}")
        return self._free(name, where)

    def of_item(self, given: object, automatic: str, where: str) -> str:
        """Return the name given for an item, or its automatic one with #2, #3 when repeated."""
        if given is not None:
            name = checks.text(given, f"{where}.name")
            if not name or name != name.strip() or not name.isprintable():
                raise ModelError(f"{where}.name", f"is {checks.shown(name)}, must be printable text")
            return self._free(name, where)
        name, count = automatic, 1
        while name in self._taken:
            count += 1
            name = f"{automatic} #{count}"
        return name

    def take(self, name: str, kind: str) -> None:
        """Register a name."""
        self._taken[name] = kind

    def _free(self, name: str, where: str) -> str:
        if name in self._taken and name in self._present():
            raise ModelError(f"{where}.name", f'"{name}" is the name of a {self._taken[name]} already')
        return name


def unknown(where: str, kind: str, name: object, known: Iterable[str]) -> ModelError:
    """Error for a name that is not there; lists the right ones."""
    names = list(known)
    have = f"known: {checks.listed(names)}" if names else "the model has none yet"
    return ModelError(where, f"unknown {kind} {checks.shown(name)}, {have}", checks.nearest(name, names))


def split_label(label: str, bodies: Iterable[str], where: str) -> tuple[str, str, str]:
    """Split "beam.end" into ("beam", "end", "") and "beam.at(0.5, 0)" into ("beam", "at", "0.5, 0")."""
    found = POINT_LABEL.fullmatch(label.strip())
    if found is None:
        example = "beam.start, beam.end, beam.at(0.5) or beam.at(0.5, 0.01, 0)"
        what = f'"{label}" is no point, a point is written like {example}'
        raise ModelError(where, what, _asked_of(label) or checks.nearest(label, bodies))
    return found["body"], found["word"] or "at", found["inside"] or ""


def _asked_of(label: str) -> str:
    """Of a point with a question behind it, ``rope.end.tension``, how it is written; "" of others."""
    point, _, word = label.strip().rpartition(".")
    asked = f"position({point})[{'xyz'.index(word)}]" if word in ("x", "y", "z") else f"{word}({point})"
    if not POINT_LABEL.fullmatch(point) or word not in OF_POINT:
        return ""
    return f'the point is "{point}", of which {asked} may be asked'


def numbers_of(inside: str, label: str, where: str, *, rigid: bool) -> tuple[float, ...]:
    """Numbers between the brackets of "beam.at(0.5, 0.01, 0)", or of a rigid body's "hub.at(1, 0, 0)"."""
    parts = inside.split(",")
    if len(parts) > 3 or (rigid and len(parts) < 3):
        wanted = "x, y, z" if rigid else "x or x, y, z"
        count = f"{len(parts)} number{'s' if len(parts) > 1 else ''}"
        raise ModelError(where, f'"{label}" has {count}, wanted {wanted} in m')
    kinds = ("place along x", "place along y", "place along z") if rigid else BEAM_PLACES
    return tuple(_number(*pair, label, where) for pair in zip(parts, kinds, strict=False))


def _number(text: str, kind: str, label: str, where: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ModelError(where, f'"{label}": "{text.strip()}" is no {kind} in m') from None
