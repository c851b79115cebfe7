"""No second joint between the same two places: it holds what is held already."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from itertools import product
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ..bodies.rigid import Body
from ..kind import Kind
from ..kinds import kind_of
from ..points import Point
from .connections import Connection

End = Point | FloatArray
Key = tuple[Hashable, ...]


class Joined:
    """What the joints of a model hold already, found by its places and not by a search through all joints."""

    def __init__(self) -> None:
        self._seen = 0
        self._last: Connection | None = None
        self._by_ends: dict[tuple[str, Key, Key], Connection] = {}

    def refuse_repeated(self, where: str, new: Any, kind: Kind, others: list[Connection]) -> None:
        """Compare a new joint with those among all connections that results answer the same questions of.

        Raises
        ------
        ModelError
            One of them is between the same two places.
        """
        self._follow(others)
        mine = kind.ends_of(new)
        one, two = (list(_asked(end)) for end in mine[:2])
        found = [self._by_ends.get((kind.asked, *pair)) for pair in (*product(one, two), *product(two, one))]
        for other in found:
            if other is not None:
                what = f'"{other.name}" connects {_text(mine[0])} and {_text(mine[1])} already'
                raise ModelError(f"{where}.{kind.last_key}", what)

    def _follow(self, others: list[Connection]) -> None:
        """Take up what came since; anew where something was taken away."""
        if self._seen > len(others) or (self._seen and others[self._seen - 1] is not self._last):
            self._seen, self._by_ends = 0, {}
        for other in others[self._seen :]:
            kind = kind_of(other)
            if kind.constrains:
                one, two = kind.ends_of(other)[:2]
                for pair in product(_held(one), _held(two)):
                    self._by_ends.setdefault((kind.asked, *pair), other)
            self._seen, self._last = self._seen + 1, other


def _held(end: End | Body) -> Iterator[Key]:
    """What an end can be found by: a body stands for all its points."""
    if isinstance(end, np.ndarray):
        yield ("fixed", *end.tolist())
    elif isinstance(end, Point):
        yield "point", end
        yield "on", end.body.name
    else:
        yield "all of", end.name
        yield "on", end.name


def _asked(end: End | Body) -> Iterator[Key]:
    """What is the same place as an end: the same point or the whole body; of a body all that is on it."""
    if isinstance(end, np.ndarray):
        yield ("fixed", *end.tolist())
    elif isinstance(end, Point):
        yield "point", end
        yield "all of", end.body.name
    else:
        yield "on", end.name


def _text(end: End | Body) -> str:
    if isinstance(end, np.ndarray):
        return str(end.tolist())
    return str(end) if isinstance(end, Point) else f'"{end.name}"'
