"""No second joint between the same two places: it holds what is held already."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from .bodies import Body
from .connections import Connection
from .kind import Kind
from .kinds import CONNECTIONS
from .points import Point

End = Point | FloatArray


def check_repeated(where: str, new: Any, kind: Kind, others: list[Connection]) -> None:
    """Compare a new joint with all that results answer the same questions of."""
    joints = {other.item: other for other in CONNECTIONS if other.asked == kind.asked}
    mine = kind.ends_of(new)
    for other in others:
        if type(other) not in joints:
            continue
        theirs = joints[type(other)].ends_of(other)
        if _same(mine, theirs) or _same(mine, theirs[::-1]):
            what = f'"{other.name}" connects {_text(mine[0])} and {_text(mine[1])} already'
            raise ModelError(f"{where}.{kind.last_key}", what)


def _same(mine: list[Any], theirs: list[Any]) -> bool:
    return _same_end(mine[0], theirs[0]) and _same_end(mine[1], theirs[1])


def _same_end(one: End | Body, two: End | Body) -> bool:
    """Whether two ends are the same place; a body stands for all its points."""
    if isinstance(one, np.ndarray):
        return isinstance(two, np.ndarray) and bool(np.array_equal(one, two))
    if isinstance(two, np.ndarray):
        return False
    if isinstance(one, Point) and isinstance(two, Point):
        return one == two
    bodies = [end.body if isinstance(end, Point) else end for end in (one, two)]
    return bodies[0] is bodies[1]


def _text(end: End | Body) -> str:
    if isinstance(end, np.ndarray):
        return str(end.tolist())
    return str(end) if isinstance(end, Point) else f'"{end.name}"'
