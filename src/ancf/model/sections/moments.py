"""Integrals over the area of a section: which any area may have, and those of a similar rectangle."""

from __future__ import annotations

import math

from ...errors import ModelError


def of_similar_rectangle(key: str, moments: dict[str, float]) -> float:
    """Fourth moment of the rectangle with the same radii of gyration."""
    factor, one, other = {
        "I_yyyy": (1.8, "I_z", "I_z"),
        "I_zzzz": (1.8, "I_y", "I_y"),
        "I_yyzz": (1.0, "I_y", "I_z"),
    }[key]
    return factor * moments[one] * moments[other] / moments["A"]


def check_moments(m: dict[str, float]) -> None:
    """Inequalities of Cauchy and Schwarz, which no area breaks; the strain energy would not be positive."""
    A, I_y, I_z = m["A"], m["I_y"], m["I_z"]
    spread = {"I_yyyy": m["I_yyyy"] - I_z * I_z / A, "I_zzzz": m["I_zzzz"] - I_y * I_y / A}
    for key, text in (("I_yyyy", "I_z^2/A"), ("I_zzzz", "I_y^2/A")):
        if spread[key] < -1e-9 * m[key]:
            what = f"is {m[key]:g} m^6, must be >= {text} = {m[key] - spread[key]:g} m^6 for any area"
            raise ModelError(f"Section.{key}", what)
    middle = I_y * I_z / A
    most = math.sqrt(max(spread["I_yyyy"], 0.0)) * math.sqrt(max(spread["I_zzzz"], 0.0))
    if abs(m["I_yyzz"] - middle) > most + 1e-9 * middle:
        what = f"is {m['I_yyzz']:g} m^6, must be I_y I_z/A = {middle:g} within {most:g} m^6 for any area"
        hint = "the bound is sqrt((I_yyyy - I_z^2/A) (I_zzzz - I_y^2/A))"
        raise ModelError("Section.I_yyzz", what, hint)
