"""What is possible of a line and hardly meant: numbers that look like those of other units."""

from __future__ import annotations

import math
from collections.abc import Iterator

from .line import Line
from .route import Route

#: Of a steady arm, kg: they have some kilograms, which are thousands of grams.
HEAVIEST_ARM = 100.0
#: Share of the critical damping of a span's lowest vibration: lines have about 0.01, EN 50318 has less.
DAMPED = 0.2
#: What Rayleigh's numbers are in, and those of a line.
UNITS = {"alpha": ("1/s", "0.0125"), "beta": ("s", "1e-4")}


def doubts(line: Line | Route) -> Iterator[str]:
    """What is to be said of the numbers of a line, section after section."""
    for number, part in enumerate(line.parts):
        for text in (*_arms(part), *_damping(part)):
            yield text if part is line else f"sections[{number}].{text.removeprefix('line.')}"


def _arms(part: Line) -> Iterator[str]:
    each = isinstance(part.steady_arm, tuple)
    for k in range(len(part.supports) if each else 1):
        mass = part.arm(k).mass
        if mass >= HEAVIEST_ARM:
            where = f"line.steady_arm[{k}].mass" if each else "line.steady_arm.mass"
            if each and k < len(part.rows):
                where = f"{part.rows[k]}arm_mass"
            yield f"{where}: is {mass:g} kg, arms have some kilograms: it is in kg"


def _damping(part: Line) -> Iterator[str]:
    longest = max(span.length for span in part.spans)
    w = math.pi / longest * part.contact_wire.critical_speed(longest)
    for key, share in (("alpha", part.damping.alpha / (2.0 * w)), ("beta", 0.5 * part.damping.beta * w)):
        if share > DAMPED:
            unit, usual = UNITS[key]
            text = f"line.damping.{key}: is {getattr(part.damping, key):g} {unit}, which damps the lowest "
            text += f"vibration of a span by {100.0 * share:.2g} % of critical, where lines have about 1 %: "
            yield text + f"it is in {unit}, such as {usual}"
