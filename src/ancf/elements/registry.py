"""The elements by name: adding one is a file with its batch and a line here."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..model.beam import Beam
from . import cable_build, solid_build


@dataclass(frozen=True)
class ElementKind:
    """What the System needs to know of an element.

    Parameters
    ----------
    vectors : int
        Three-component unknowns per node that neighbours share; the first two are r and r_x.
    internal : int
        Three-component unknowns per element, not shared.
    build : callable
        ``build(beams, slots)`` makes the batch of all such elements.
    """

    vectors: int
    internal: int
    build: Callable[[Sequence[Beam], Sequence[Any]], Any]


ELEMENTS: dict[str, ElementKind] = {
    "cable": ElementKind(vectors=2, internal=0, build=cable_build.build),
    "original": ElementKind(vectors=4, internal=0, build=solid_build.build),
    "nonlocking": ElementKind(vectors=4, internal=2, build=solid_build.build),
}
