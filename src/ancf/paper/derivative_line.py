"""Derivatives of a run along an overhead line by the length of a dropper: form, slack droppers, contact."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

import ancf

from .. import catenary

CASE, SPEED = "en50318-2002", 300.0  # km/h
#: Statistics of the contact force whose derivatives are compared.
ASKED = ("deviation", "minimum")
#: Change of the length for central differences, m: so little that droppers slacken in the same order.
CHANGE = 4e-6
#: Newton's method on the whole line: what settles part by part leaves 1e-7 N, which differences see.
METHOD = ancf.GeneralizedAlpha(0.9, newton=ancf.Newton(tolerance=1e-12, modified=False))


class OfLine(NamedTuple):
    """A derivative of a statistic of the contact force, N per m, and that by differences of two runs."""

    asked: str
    dropper: str
    derivative: float
    reference: float


def of_line() -> list[OfLine]:
    """Derivatives by the length of the dropper in the middle of the line of EN 50318:2002."""
    line = catenary.read_line(CASE)
    assert isinstance(line, catenary.Line)
    lengths = np.array(catenary.form(line).dropper_natural)
    a_span = len(lengths) // len(line.spans)
    span, dropper = len(line.spans) // 2, a_span // 2

    def run(by: float, **more: object) -> catenary.Run:
        changed = lengths.copy()
        changed[a_span * span + dropper] += by
        made = catenary.form(replace(line, dropper_lengths=tuple(changed.tolist())))
        given: dict[str, object] = {"speed": SPEED / 3.6, "pantograph": CASE, "integrator": METHOD, **more}
        return catenary.run(made, **given)  # type: ignore[arg-type]

    def numbers(by: float) -> np.ndarray:
        found = catenary.statistics(run(by))
        return np.array([found[key].value for key in ASKED])

    label = f"{span + 1}-{dropper + 1}"
    own = catenary.slopes(run(0.0, sensitivities={"length": [label]}))["length"]
    differences = (numbers(CHANGE) - numbers(-CHANGE)) / (2.0 * CHANGE)
    return [OfLine(key, label, own[key], float(x)) for key, x in zip(ASKED, differences, strict=True)]
