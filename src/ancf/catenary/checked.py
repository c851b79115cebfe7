"""What a line shows at rest before it is run: arms that hang, droppers that stretch, wide staggers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..errors import ModelError
from .arms import check_hinged, on_arm
from .forms.form import Form
from .forms.reach import STRIP
from .lines.doubts import doubts
from .lines.line import Line
from .lines.route import Route
from .plan import RAISED
from .rest import form

#: Spans of a line up to which its form is found to be looked at; that of 200 takes some seconds.
MOST_FORMED = 200
#: And droppers in a span, on the average, for each of which the wires have nodes.
MOST_DROPPERS = 50
#: Share of its length by which a dropper stretches at rest from which on units are to be looked at.
STRETCH = 0.01
#: Least pull of a hinged arm in loads that it carries: at less it hangs steeper than 1 to this.
LEAST_PULL = 2.0


def at_rest(line: Line | Route) -> list[str]:
    """Find the form of a line, and what is to be said about it.

    Returns
    -------
    list of str
        Warnings: numbers that look like those of other units, staggers at supports beyond strips of the
        usual length, arms that pull little, droppers that stretch much. Of a line of more than 200 spans,
        or 50 droppers a span, that it is not looked at.

    Raises
    ------
    ModelError
        The line has no form, or a hinged arm would hang down.

    """
    said = [*doubts(line), *_wide(line)]
    spans, droppers = len(line.spans), line.dropper_x.size
    if spans > MOST_FORMED or droppers > MOST_DROPPERS * spans:
        text = f"line: its form is not looked at, of {spans} spans and {droppers} droppers"
        return [*said, f"{text}; ancf catenary form finds it"]
    found = form(line)
    starts = np.cumsum([0, *(len(part.supports) for part in line.parts)])
    for part, first in zip(found.shifted, starts.tolist(), strict=False):
        said += [*_arms(part, line, first), *_droppers(part)]
    return said


def _wide(line: Line | Route) -> Iterator[str]:
    """Staggers of the supports at which the wire is low enough to be touched."""
    low = np.array(line.heights) < line.height_at(line.supports) + RAISED
    for k, side in enumerate(line.stagger):
        if low[k] and abs(side) > STRIP:
            text = (
                f"{line.place_of_support('stagger', k)}: is {side:g} m, strips of {2.0 * STRIP:g} m reach to "
            )
            yield text + f"{STRIP:g} m: runs need a longer one"


def _arms(found: Form, line: Line | Route, first: int) -> Iterator[str]:
    for k in range(1, len(found.arm_force) - 1):
        arm = found.arm(k)
        if not arm.hinged or found.settled:  # finding the form of another state tells of its arms
            continue
        where = line.place_of_support("stagger", first + k)
        force = on_arm(found, k, found.arm_force)
        try:
            check_hinged(k, force)
        except ModelError as error:
            raise ModelError(
                where, f"{error.where.removeprefix('line.')}: {error.what}", error.hint
            ) from None
        pull, carries = abs(float(force[1])), abs(float(force[2]))
        if pull < LEAST_PULL * carries:
            text = f"{where}: the arm at support {first + k + 1} pulls with {pull:.0f} N and carries "
            text += (
                f"{carries:.0f} N, less than {LEAST_PULL:g} times as much: it hangs steep, and below what it "
            )
            yield text + "carries it is refused; give more stagger"


def _droppers(found: Form) -> Iterator[str]:
    strain = found.dropper_force / (found.dropper_stiffness * found.dropper_natural)
    if not strain.size or float(strain.max()) <= STRETCH:
        return
    worst, many = int(np.argmax(strain)), int(np.sum(strain > STRETCH))
    grown = 1e3 * float(found.dropper_force[worst] / found.dropper_stiffness[worst])
    text = f"{found.line.dropper_label(worst)}: stretches by {grown:.1f} mm at rest, "
    text += (
        f"{100.0 * strain[worst]:.2g} % of its length, and {many} in all by more than {100.0 * STRETCH:g} %: "
    )
    yield text + "droppers.stiffness is in N/m of each, EA in N"
