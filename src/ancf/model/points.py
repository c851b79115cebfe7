"""Point: a material point of a body, found by its reference arc length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ancf.model.beam import Beam


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """A point of a body; equal to another with the same body name and arc length.

    Parameters
    ----------
    body : Beam
    x : float
        Reference arc length from the start, m.
    label : str
        ``beam.start``, ``beam.end`` or ``beam.at(0.5)``.

    """

    body: Beam
    x: float
    label: str

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Point):
            return NotImplemented
        return self.body.name == other.body.name and self.x == other.x

    def __hash__(self) -> int:
        return hash((self.body.name, self.x))

    def __str__(self) -> str:
        return self.label

    def __repr__(self) -> str:
        return f"Point({self.label})"
