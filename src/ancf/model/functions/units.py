"""Units of measured columns in those of the package, and of heads that name them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ...columns import split_unit
from ...errors import ModelError
from .. import checks

#: Units of a column by the unit of the package that they stand for: m, s, N, kg, rad and what they make.
KINDS: dict[str, dict[str, float]] = {
    "": {"": 1.0, "-": 1.0, "1": 1.0, "%": 0.01},
    "m": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "µm": 1e-6, "km": 1e3, "in": 0.0254, "ft": 0.3048},
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "min": 60.0, "h": 3600.0},
    "m/s": {"m/s": 1.0, "mm/s": 1e-3, "km/h": 1 / 3.6, "kn": 1852 / 3600},
    "m/s^2": {"m/s^2": 1.0, "m/s²": 1.0, "g": 9.80665},
    "N": {"N": 1.0, "kN": 1e3, "MN": 1e6, "lbf": 4.4482216152605},
    "N/m": {"N/m": 1.0, "kN/m": 1e3},
    "N m": {"N m": 1.0, "Nm": 1.0, "kN m": 1e3, "kNm": 1e3},
    "rad": {"rad": 1.0, "deg": np.pi / 180, "°": np.pi / 180},
    "rad/s": {"rad/s": 1.0, "deg/s": np.pi / 180, "rpm": np.pi / 30},
    "rad/s^2": {"rad/s^2": 1.0, "rad/s²": 1.0, "deg/s^2": np.pi / 180},
    "kg": {"kg": 1.0}, "kg/s": {"kg/s": 1.0}, "Pa": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6},
    "Hz": {"Hz": 1.0, "kHz": 1e3}, "1/m": {"1/m": 1.0},
}  # fmt: skip
UNITS = {unit: scale for kind in KINDS.values() for unit, scale in kind.items()}
#: A head whose brackets hold a unit, and no component of a formula.
SPACED = re.compile(r"\s[\[(][^\[(]*[\])]$")

#: Units by their words.
WORDS = {
    "degree": "deg",
    "radian": "rad",
    "metre": "m",
    "meter": "m",
    "second": "s",
    "newton": "N",
    "feet": "ft",
}


def factor(unit: Any, where: str, of: str | None = None) -> float:
    """What a unit is in those of the package; ModelError if it is unknown, or of another kind than ``of``."""
    if isinstance(unit, str) and unit.strip() in UNITS:
        if of is not None and unit.strip() not in KINDS[of]:
            raise ModelError(where, f"is {checks.shown(unit)}, wanted one of {checks.listed([*KINDS[of]])}")
        return UNITS[unit.strip()]
    word = WORDS.get(unit.strip().lower().removesuffix("s")) if isinstance(unit, str) else None
    near = f'did you mean "{word}"?' if word else checks.nearest(unit, UNITS)
    raise ModelError(where, f"is {checks.shown(unit)}, known are {checks.listed(list(UNITS)[1:], 60)}", near)


def kind_of(unit: str) -> str:
    """Unit of the package that a known one stands for."""
    return next(kind for kind, known in KINDS.items() if unit.strip() in known)


def check_kind(unit: str | None, of: str | None, where: str) -> None:
    """Raise ModelError if a unit of the package is known to be that of something else than what is wanted."""
    if unit is not None and of is not None and unit != of:
        hint = "give another column, or the unit that its numbers have"
        hint += "; integrate = true makes a way of speeds" if unit == f"{of}/s" else ""
        raise ModelError(where, f"is {_in(unit)}, must be {_in(of)}", hint)


def _in(unit: str) -> str:
    return f"in {unit}" if unit else "a plain number"


def in_plain_units(
    found: Mapping[str, Any], where: str, of: Callable[[str], str | None] = lambda name: None
) -> dict[str, Any]:
    """Columns by their names without units, numbers in those of the package.

    A unit is what stands behind a space in brackets, ``"t [ms]"``: what follows a name at once is a part of
    it, ``"position(rope.end)[2]"``.  ``of(name)`` is the unit of the package that belongs to a column, if it
    is known.

    Raises
    ------
    ModelError
        A unit is unknown or that of something else, a column with a unit holds no numbers, or two columns
        have one name.
    """
    made: dict[str, Any] = {}
    for head, column in found.items():
        name, unit = split_unit(head) if SPACED.search(head) else (head, "")
        if unit:
            scale = factor(unit, f'{where}: the unit of column "{head}"', of(name))
            column = [_scaled(entry, scale, f'{where}: column "{head}"') for entry in column]
        if name in made:
            raise ModelError(where, f'has two columns "{name}"')
        made[name] = column
    return made


def _scaled(entry: Any, scale: float, where: str) -> Any:
    """A number in units of the package; an empty entry stays."""
    if isinstance(entry, str) and not entry.strip():
        return entry
    try:
        return scale * float(entry)
    except ValueError:
        raise ModelError(where, f"must hold numbers, holds {checks.shown(entry)}") from None
