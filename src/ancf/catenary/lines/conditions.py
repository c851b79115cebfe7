"""Conditions: in which state a line is, away from the one it was designed for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from ...errors import ModelError
from ...model import checks
from .wire import Wire

COLDEST, HOTTEST = -80.0, 200.0  # degrees Celsius
DENSEST = 10.0  # kg/m^3, of air
GUSTS = 1.0, 1e4  # m, lengths of turbulence


@dataclass(frozen=True, slots=True, kw_only=True)
class Conditions:
    """Temperature, wind, ice, wear and tensions; what is not given is as designed.

    Parameters
    ----------
    temperature : float, degrees Celsius
        Default that for which the heights of the line hold, ``Line.temperature``.
    contact_tension, messenger_tension : float, N
        Of weights or springs that pull with another force than in the design; not between fixed ends.
    ice : float, kg/m
        On each of the wires, also on each of several that act as one.
    wind : float, m/s
        Steady, across the track, positive to the left, where y points. The wires need a ``diameter``.
    air_density : float, kg/m^3
    turbulence : float
        Standard deviation of the wind over its speed: in a run gusts blow along the line, after von Karman,
        which grow from 0 in the first second. At rest the wind is steady.
    gust_length : float, m
        Of the turbulence.
    seed : int
        Of the gusts.
    wear : float
        Share of the contact wire's section that is worn off.

    """

    temperature: float | None = None
    contact_tension: float | None = None
    messenger_tension: float | None = None
    ice: float = 0.0
    wind: float = 0.0
    air_density: float = 1.225
    turbulence: float = 0.0
    gust_length: float = 100.0
    seed: int = 1
    wear: float = 0.0

    def check(self, where: str, contact: Wire, messenger: Wire | None, anchors: str) -> None:
        """Raise ModelError if a value is out of range, has no effect, or a tension carries no such wire."""
        if self.temperature is not None:
            checks.between(self.temperature, f"{where}.temperature", COLDEST, HOTTEST)
        for key, wire in (("contact_tension", contact), ("messenger_tension", messenger)):
            self._check_tension(key, f"{where}.{key}", wire, anchors)
        if checks.non_negative(self.ice, f"{where}.ice") > 20.0:
            raise ModelError(f"{where}.ice", f"is {self.ice:g} kg/m", "units are kg/m, not N/m")
        checks.between(self.wind, f"{where}.wind", -80.0, 80.0)
        if checks.positive(self.air_density, f"{where}.air_density") > DENSEST:
            raise ModelError(f"{where}.air_density", f"is {self.air_density:g} kg/m^3", "of air: 1.225")
        if checks.between(self.turbulence, f"{where}.turbulence", 0.0, 1.0) and self.wind == 0.0:
            raise ModelError(f"{where}.turbulence", "has no effect without wind", "leave it out")
        checks.between(self.gust_length, f"{where}.gust_length", *GUSTS)
        checks.integer(self.seed, f"{where}.seed", 0, 2**32)
        if not 0.0 <= checks.number(self.wear, f"{where}.wear") <= 0.6:
            hint = "a share of the section: 0.2 for 20 %"
            raise ModelError(f"{where}.wear", f"must be between 0 and 0.6, is {self.wear:g}", hint)

    def _check_tension(self, key: str, where: str, wire: Wire | None, anchors: str) -> None:
        if (tension := getattr(self, key)) is None:
            return
        checks.positive(tension, where)
        if wire is None:
            raise ModelError(where, "has no effect on a line without messenger", "leave it out")
        wire.check_tension(tension, where)
        if anchors == "fixed":
            what = 'has no effect with anchors = "fixed", between which the tension follows from the state'
            raise ModelError(where, what, 'leave it out, or anchors = "tension" or "spring"')

    def worn(self, wire: Wire) -> Wire:
        """The contact wire with its wear, its ice and the tension of weights, as it hangs at any temperature.

        What temperature and wear do to the tension between fixed ends is known of a form only.
        """
        left, tension = 1.0 - self.wear, self.contact_tension or wire.tension
        EA = left * wire.EA
        mass = (
            (left * wire.mass + wire.count * self.ice) * (1.0 + wire.tension / wire.EA) / (1.0 + tension / EA)
        )
        return replace(wire, EA=EA, EI=left**2 * wire.EI, mass=mass, tension=tension)


def warmer(line: Any) -> float:
    """By how much a line is warmer than where its heights and lengths hold, K."""
    degrees = line.conditions.temperature
    return 0.0 if degrees is None else float(degrees - line.temperature)


def expansion(line: Any) -> float:
    """Of the droppers, 1/K: that of the messenger, which is a rope like them."""
    wire = line.messenger_wire or line.contact_wire
    return float(wire.expansion)
