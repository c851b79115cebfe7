"""Wire: contact wire or messenger, and the Rayleigh damping that a line's wires share."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import ancf

from ...model import checks
from .galloping import checked_lift

#: Thermal expansion of copper and its alloys, 1/K.
EXPANSION = 17e-6
#: Of a wire of an overhead line, N; less is a slip of units.
LEAST_TENSION = 100.0
#: Beyond these what is meant is in other units: strain under the tension, reach of a bend sqrt(EI/T) in m,
#: drag coefficient of some wires side by side, thermal expansion in 1/K.
LEAST_STRAIN, WIDEST_BEND, MOST_DRAG, MOST_EXPANSION = 2e-6, 10.0, 100.0, 1e-3
#: What makes a wire.
WIRE = "ancf.catenary.Wire(EA=..., EI=..., mass=..., tension=...)"


@dataclass(frozen=True, slots=True, kw_only=True)
class Rayleigh:
    """Damping proportional to mass and to stiffness.

    Parameters
    ----------
    alpha : float, 1/s
        Of the mass.
    beta : float, s
        Of the stiffness, that of the tension included.

    """

    alpha: float = 0.0
    beta: float = 0.0

    def check(self, where: str) -> None:
        """Raise ModelError if a value is no finite number >= 0."""
        checks.non_negative(self.alpha, f"{where}.alpha")
        checks.non_negative(self.beta, f"{where}.beta")


@dataclass(frozen=True, slots=True, kw_only=True)
class Wire:
    """A wire under tension.

    Parameters
    ----------
    EA : float, N
        Axial stiffness.
    EI : float, N m^2
        Bending stiffness.
    mass : float, kg/m
        Mass per length of the wire as it hangs, under its tension.
    tension : float, N
        Component along the track of the force at the anchors; it is the same all along the line at rest.
    damping : float, N s/m^2
        Viscous force per length and velocity, besides Rayleigh's.
    diameter : float, m
        Outer, what wind takes hold of; wind needs it.
    drag : float
        Drag coefficient across the wire.
    lift : (n, 2), rad and -
        Rows of the angle at which the wind meets the wire, from below positive, and its lift coefficient: of
        an iced or worn wire, which may gallop in wind. Default none.
    expansion : float, 1/K
        Thermal, by default that of copper and its alloys, 17e-6.
    rail : bool
        A conductor rail: it carries itself from support to support by its bending stiffness and needs no
        tension.
    count : int
        How many wires side by side it stands for, see `times`: ice hangs on each of them.

    """

    EA: float
    EI: float
    mass: float
    tension: float
    damping: float = 0.0
    diameter: float | None = None
    drag: float = 1.0
    expansion: float = EXPANSION
    rail: bool = False
    lift: Any = None
    count: int = 1

    def __post_init__(self) -> None:
        """Keep rows as they can be compared."""
        if self.lift is not None and not isinstance(self.lift, tuple):
            rows = checks.items(self.lift, "wire.lift", "rows of an angle and a lift coefficient")
            made = tuple(checks.items(row, f"wire.lift[{k}]") for k, row in enumerate(rows))
            object.__setattr__(self, "lift", made)

    @property
    def wave_speed(self) -> float:
        """Speed of transverse waves, m/s: sqrt(T/rhoA)."""
        return math.sqrt(self.tension / self.mass)

    def critical_speed(self, span: float) -> float:
        """Speed at which a load resonates with spans of a length in m, m/s: of waves twice as long.

        A wire's tension lets all waves run alike, and this is the wave speed. A rail bends:
        sqrt((T + EI (pi/L)^2)/rhoA).
        """
        if not self.rail:
            return self.wave_speed
        return math.sqrt((self.tension + self.EI * (math.pi / span) ** 2) / self.mass)

    def pull_for_sag(self, span: float) -> float:
        """Tension of a string that sags as the wire does between clamped ends, N: of a rail T + 48 EI/L^2."""
        return self.tension + (48.0 * self.EI / span**2 if self.rail else 0.0)

    def times(self, count: int) -> Wire:
        """Several such wires side by side that act as one, each under the tension of this one."""
        if checks.integer(count, "wire.times.count", 1, 1000) == 1:
            return self
        added: dict[str, Any] = {
            key: count * getattr(self, key) for key in ("EA", "EI", "mass", "tension", "damping", "drag")
        }
        if self.lift is not None:
            added["lift"] = tuple((angle, count * value) for angle, value in self.lift)
        return replace(self, count=count * self.count, **added)

    def check(self, where: str) -> None:
        """Raise ModelError if a value is out of range, or the wire would stretch by more than 5 %."""
        for key in ("EA", "mass"):
            checks.positive(getattr(self, key), f"{where}.{key}")
        checks.flag(self.rail, f"{where}.rail")
        checks.integer(self.count, f"{where}.count", 1, 1000)
        if self.rail:
            checks.non_negative(self.tension, f"{where}.tension")
            checks.positive(self.EI, f"{where}.EI")
        else:
            checks.positive(self.tension, f"{where}.tension")
        for key in ("EI", "damping"):
            checks.non_negative(getattr(self, key), f"{where}.{key}")
        checks.between(self.drag, f"{where}.drag", 0.0, MOST_DRAG)
        if not 0.0 <= checks.number(self.expansion, f"{where}.expansion") <= MOST_EXPANSION:
            what = f"is {self.expansion:g}, must be between 0 and {MOST_EXPANSION:g}"
            raise ancf.ModelError(f"{where}.expansion", what, "units are 1/K: 17e-6")
        if self.diameter is not None and not 1e-3 <= checks.number(self.diameter, f"{where}.diameter") <= 0.1:
            raise ancf.ModelError(f"{where}.diameter", f"is {self.diameter:g} m", "units are m: 0.012")
        if self.lift is not None:
            checked_lift(self.lift, f"{where}.lift")
            if self.diameter is None:
                what = "is missing, the lift of wind needs it"
                raise ancf.ModelError(f"{where}.diameter", what, "m, or a type")
        self.check_tension(self.tension, f"{where}.tension")
        if not self.rail:
            self._check_stiffness(where)

    def check_tension(self, tension: float, where: str) -> None:
        """Raise ModelError if a tension in N carries no such wire, or would stretch it by more than 5 %."""
        if tension < LEAST_TENSION and not self.rail:
            what = f"is {tension:g} N, which carries no wire"
            raise ancf.ModelError(where, what, "units are N: 12e3 for 12 kN")
        if tension > 0.05 * self.EA:
            what = f"is {tension:g} N, it stretches a wire of EA = {self.EA:g} N by more than 5 %"
            raise ancf.ModelError(where, what, "units are N")

    def _check_stiffness(self, where: str) -> None:
        if self.tension < LEAST_STRAIN * self.EA:
            what = f"is {self.EA:g} N, which the tension of {self.tension:g} N stretches by less than"
            raise ancf.ModelError(f"{where}.EA", f"{what} {LEAST_STRAIN:g}", "units are N: 12e6")
        if (reach := math.sqrt(self.EI / self.tension)) > WIDEST_BEND:
            what = f"is {self.EI:g} N m^2: under {self.tension:g} N a bend reaches {reach:.3g} m"
            raise ancf.ModelError(f"{where}.EI", what, "units are N m^2: 130; rail = true for a rail")

    def section(self, rayleigh: Rayleigh | None = None) -> ancf.Section:
        """Section of the wire as a cable with this damping, or without any damping.

        Rayleigh's damping of a wire under tension T: ``alpha rhoA`` against the velocity, ``beta EA`` and
        ``beta EI`` in the strains, and ``beta T`` against the rate of the slope. A section speaks of the
        unstretched wire, which has more mass per length.
        """
        stretch = 1.0 + self.tension / self.EA
        given: dict[str, Any] = {"EA": self.EA, "EI": self.EI, "rhoA": stretch * self.mass}
        if self.diameter is not None:
            given |= {"diameter": self.diameter, "drag": (self.drag, 0.0)}
        if rayleigh is None:
            return ancf.Section(**given)
        checks.kind(rayleigh, "wire.section.rayleigh", Rayleigh, "Rayleigh(alpha=0.0125, beta=1e-4)")
        given["damping"] = stretch * (self.damping + rayleigh.alpha * self.mass)
        given["axial_damping"] = rayleigh.beta * self.EA
        given["bending_damping"] = rayleigh.beta * self.EI
        given["slope_damping"] = rayleigh.beta * self.tension
        return ancf.Section(**given)
