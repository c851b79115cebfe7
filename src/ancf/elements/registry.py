"""The elements by name: adding one is a file with its batch and a line here."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..model.beam import Beam
from . import cable_build


@dataclass(frozen=True)
class ElementKind:
    """What the System needs to know of an element.

    Parameters
    ----------
    vectors : int
        Three-component unknowns per node; the first two are r and r_x.
    build : callable
        ``build(beams, slots)`` makes the batch of all such elements.
    """

    vectors: int
    build: Callable[[Sequence[Beam], Sequence[Any]], Any]


ELEMENTS: dict[str, ElementKind] = {
    "cable": ElementKind(vectors=2, build=cable_build.build),
}
