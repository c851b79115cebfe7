"""Units by their symbols, in exponents of SI base units, as FMI wants them.

What is not known has no exponents: a unit that is only a name.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

#: Base units of FMI, in its order.
BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
_N = {"kg": 1, "m": 1, "s": -2}
#: Symbols: size in SI units, and exponents.
SYMBOLS: dict[str, tuple[float, dict[str, int]]] = {
    **{name: (1.0, {name: 1}) for name in BASE},
    "g": (1e-3, {"kg": 1}),
    "t": (1e3, {"kg": 1}),
    "min": (60.0, {"s": 1}),
    "h": (3600.0, {"s": 1}),
    "deg": (math.pi / 180, {"rad": 1}),
    "°": (math.pi / 180, {"rad": 1}),
    "rev": (2 * math.pi, {"rad": 1}),
    "rpm": (math.pi / 30, {"rad": 1, "s": -1}),
    "N": (1.0, _N),
    "Nm": (1.0, {"kg": 1, "m": 2, "s": -2}),
    "Pa": (1.0, {"kg": 1, "m": -1, "s": -2}),
    "bar": (1e5, {"kg": 1, "m": -1, "s": -2}),
    "J": (1.0, {"kg": 1, "m": 2, "s": -2}),
    "W": (1.0, {"kg": 1, "m": 2, "s": -3}),
    "V": (1.0, {"kg": 1, "m": 2, "s": -3, "A": -1}),
    "Hz": (1.0, {"s": -1}),
    "l": (1e-3, {"m": 3}),
    "1": (1.0, {}),
    "-": (1.0, {}),
    "%": (0.01, {}),
}
PREFIXES = {"G": 1e9, "M": 1e6, "k": 1e3, "c": 1e-2, "m": 1e-3, "u": 1e-6, "µ": 1e-6, "μ": 1e-6}
#: Symbols that take a prefix.
SCALED = {"m", "s", "A", "V", "g", "rad", "N", "Nm", "Pa", "J", "W", "Hz", "l"}
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_PART = re.compile(r"([^\W\d_]+|°|%|1|-)(?:(?:\^|\*\*)?(-?\d))?")


@dataclass(frozen=True)
class BaseUnit:
    """A unit as a multiple of a product of SI units.

    Parameters
    ----------
    factor : float
        Its size in SI units.
    exponents : dict of str to int
        Of those of BASE that it has.
    """

    factor: float
    exponents: dict[str, int]


def base_unit(text: str) -> BaseUnit | None:
    """What a unit such as ``"kN m/s^2"`` is; None if it is not known."""
    parts = text.translate(_RAISED).strip().strip("()").split("/")
    factor, exponents = 1.0, dict.fromkeys(BASE, 0)
    for k, part in enumerate(parts):
        words = [word for word in re.split(r"[\s·⋅]+|(?<!\*)\*(?!\*)", part.strip().strip("()")) if word]
        for word in words:
            found = _symbol(word)
            if found is None:
                return None
            size, powers, power = found
            power = -power if k else power
            factor *= size**power
            for name, value in powers.items():
                exponents[name] += power * value
        if not words:
            return None
    return BaseUnit(factor, {name: value for name, value in exponents.items() if value})


def _symbol(word: str) -> tuple[float, dict[str, int], int] | None:
    """Size, exponents and power of a word such as ``mm2``."""
    match = _PART.fullmatch(word)
    if match is None:
        return None
    name, power = match[1], int(match[2] or 1)
    if name in SYMBOLS:
        return (*SYMBOLS[name], power)
    if name[0] in PREFIXES and name[1:] in SCALED:
        size, powers = SYMBOLS[name[1:]]
        return PREFIXES[name[0]] * size, powers, power
    return None
