"""What of a section counts in a fluid: its outer diameter, drag and added mass."""

from __future__ import annotations

from typing import Any

from ...errors import ModelError
from .. import checks

#: Keywords of a section that fluids and grounds ask for.
IN_FLUID = ("diameter", "drag", "added_mass")
#: What is usual along the axis of a smooth line, for messages.
_ALONG = {"Section.drag": "0.01", "Section.added_mass": "0.0"}


def in_fluid(diameter: Any, drag: Any, added_mass: Any) -> dict[str, Any]:
    """Checked values, None for what was not given.

    Parameters
    ----------
    diameter : float, m, or None
    drag, added_mass : (2,) or None
        Coefficients normal to the axis and along it.
    """
    return {
        "diameter": None if diameter is None else checks.positive(diameter, "Section.diameter"),
        "drag": _pair(drag, "Section.drag"),
        "added_mass": _pair(added_mass, "Section.added_mass"),
    }


def _pair(given: Any, where: str) -> tuple[float, float] | None:
    if given is None:
        return None
    if isinstance(given, int | float):
        what = f"must be two numbers, normal to the axis and along it, is {checks.shown(given)}"
        raise ModelError(where, what, f"({checks.shown(given)}, {_ALONG[where]})")
    normal, tangential = checks.array(given, where, (2,)).tolist()
    return checks.non_negative(normal, f"{where}[0]"), checks.non_negative(tangential, f"{where}[1]")
