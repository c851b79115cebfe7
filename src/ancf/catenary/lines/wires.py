"""The wires of the catalogue: contact wires and ropes by the names under which they are ordered."""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ...errors import ModelError
from ...model.checks import nearest, shown
from .wire import EXPANSION, Wire

FILE = Path(__file__).parents[1] / "data" / "wires.toml"
#: What does not describe a section in the file.
COMMON = ("source", "modulus", "materials")


@dataclass(frozen=True, slots=True)
class WireType:
    """A wire as it is bought.

    Attributes
    ----------
    EA : float, N
    EI : float, N m^2
        Of a round bar with its area, A^2/(4 pi); a rope whose strands slide has less.
    mass : float, kg/m
    diameter : float, m
    expansion : float, 1/K
    source, tag : str
        Where the numbers come from, and how sure they are.

    """

    EA: float
    EI: float
    mass: float
    diameter: float
    expansion: float
    source: str
    tag: str


@cache
def wires() -> dict[str, WireType]:
    """Wires of the catalogue by name, such as "CuAg AC-100" and "BzII 70"."""
    found = {}
    for group in tomllib.loads(FILE.read_text(encoding="utf-8")).values():
        for material in group["materials"]:
            for section, data in group.items():
                if section not in COMMON:
                    found[f"{material} {section}"] = _made(group, data)
    return found


def _made(group: dict[str, Any], data: dict[str, Any]) -> WireType:
    area, modulus = 1e-6 * data["area"], group["modulus"]
    return WireType(
        EA=modulus * area,
        EI=modulus * area**2 / (4.0 * math.pi),
        mass=data["mass"],
        diameter=1e-3 * data["diameter"],
        expansion=EXPANSION,
        source=group["source"],
        tag=data["tag"],
    )


def wire_data(name: object, where: str = "wire.type") -> dict[str, float]:
    """EA, EI, mass, diameter and expansion of a wire of the catalogue; ModelError for an unknown name."""
    known = wires()
    if not isinstance(name, str) or name not in known:
        near = nearest(name, list(known)) if isinstance(name, str) else ""
        what = f"there is no wire {shown(name)} in the catalogue"
        raise ModelError(where, what, near or "ancf catenary list shows all, or give EA, EI and mass")
    data = known[name]
    return {key: getattr(data, key) for key in ("EA", "EI", "mass", "diameter", "expansion")}


def wire(name: str, tension: float, **changes: float) -> Wire:
    """A wire of the catalogue under a tension in N, with other values than its own where they are given.

    Raises
    ------
    ModelError
        The catalogue has no such wire; near names are given.

    """
    given: dict[str, Any] = wire_data(name) | {"tension": tension} | changes
    return Wire(**given)
