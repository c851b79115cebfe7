"""Formulas that were meant by names as tables of results and other programs have them."""

from __future__ import annotations

import re

_POINT = r"(?P<point>[^\s()]+\.(?:start|end|centre|at\([^()]*\)))"
_WORDS = "position|velocity|tension|curvature|reaction|spring_force"
#: ``rope.end position z`` of tables, ``tie force`` of a spring; ``position(rope.end).z``; ``rope.end.z``.
_WAYS = [
    re.compile(rf"(?P<point>\S.*?) (?P<what>{_WORDS})(?: (?P<part>[xyz]))?"),
    re.compile(r"(?P<point>\S.*?) (?P<force>force)"),
    re.compile(r"(?P<what>\w+)\((?P<point>.*)\)\.(?P<part>[xyz])"),
    re.compile(rf"{_POINT}\.(?P<what>{_WORDS})"),
    re.compile(rf"{_POINT}\.(?P<part>[xyz])"),
    re.compile(_POINT),
]


def meant_by(text: str) -> str:
    """What to write in place of a text that is no formula, "" if nobody knows."""
    flat = " ".join(text.split())
    found = next((match for way in _WAYS if (match := way.fullmatch(flat))), None)
    if found is None:
        return ""
    parts = found.groupdict()
    point, what = parts["point"], parts.get("what") or ("spring_force" if parts.get("force") else "position")
    item = point if re.fullmatch(r"[\w.]+|[\w.]+\([^()]*\)", point) else f'"{point}"'
    if parts.get("part"):
        return f"write {what}({item})[{'xyz'.index(parts['part'])}]"
    alone = what == "position"
    return f"write {what}({item})" + ("[0], [1] or [2], which are along x, y and z" if alone else "")
