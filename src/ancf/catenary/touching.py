"""Pantographs at the wire now, as steppers and controllers ask for them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..model import checks
from .collectors import Collector
from .recorded import recording


class Touching(NamedTuple):
    """A pantograph at the wire now.

    Attributes
    ----------
    position : float
        Of its strips along the track, m.
    force : float
        Of the contact, of all strips and wires together, N.
    height, stagger : float
        Of the contact wire there, of two that which presses most, m.
    strip : float
        Height of the strip, m.
    """

    position: float
    force: float
    height: float
    stagger: float
    strip: float


def touching(now: Any, collectors: Sequence[Collector], number: int = 0) -> Touching:
    """A pantograph in a state of now; 0 is the first.

    Raises
    ------
    ModelError
        There is no such pantograph.
    """
    last = len(collectors) - 1
    collector = collectors[checks.integer(number, "pantograph.number", 0, last)]
    found = recording(_Now(now), collector)
    values = (found.position, found.force, found.height, found.stagger, found.strip)
    return Touching(*(float(x[0]) for x in values))


class _Now:
    """A state of now as if it were a history of one row."""

    def __init__(self, state: Any) -> None:
        self._state = state

    def __getattr__(self, name: str) -> Callable[[Any], Any]:
        ask = getattr(self._state, name)
        return lambda item: np.asarray(ask(item))[None]


class Watched:
    """A controller whose run also answers ``run.pantograph(number)``.

    Parameters
    ----------
    controller : callable
    collectors : list of Collector
        The pantographs of the run, the first ahead.

    """

    def __init__(self, controller: Callable[[Any], Any], collectors: Sequence[Collector]) -> None:
        self.controller, self.collectors = controller, collectors

    @property
    def __name__(self) -> str:
        return str(getattr(self.controller, "__name__", type(self.controller).__name__))

    def __call__(self, run: Any) -> None:
        """Ask the controller."""
        self.controller(_OfALine(run, self.collectors))


class _OfALine:
    """The run as a controller sees it, with its pantographs."""

    def __init__(self, run: Any, collectors: Sequence[Collector]) -> None:
        self._run, self._collectors = run, collectors

    def pantograph(self, number: int = 0) -> Touching:
        """A pantograph at the wire now; 0 is the first."""
        return touching(self._run, self._collectors, number)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._run, name)
