"""The paper's three kinds of elements, and what its examples give ``add_beam`` for each."""

from __future__ import annotations

from typing import Any

CABLE, ORIGINAL, NONLOCKING = KINDS = ("cable", "original", "nonlocking")

NOTE = (
    'Cable: strain measures "paper", Green axial strain and curvature |r_x x r_xx|/|r_x|^3, 5 axial and 3 '
    "bending Gauss points per element. Original and nonlocking: Green strains of the whole volume, nu = 0, 5 "
    "Gauss points along the axis and 3 x 3 in the section."
)


def options(element: str, strain: str | None) -> dict[str, Any]:
    """Arguments of ``add_beam``: the strains of a cable, default "paper", the Poisson effect of a beam."""
    if element == CABLE:
        return {"element": element, "strain": strain or "paper"}
    return {"element": element, "strain": strain, "poisson": "full"}
