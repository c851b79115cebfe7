"""Equilibria with a closed form: bending, elastica, bars, catenaries, torsion."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import ancf

from .case import DENSITY, EI, LENGTH, MODULUS, NU, RHO_A, SIDE, Case, cable, solid

if TYPE_CHECKING:
    from ... import State

WEIGHT = 9.81 * RHO_A  # N/m
SPAN, ARC = 10.0, 10.5  # m, of the catenaries
#: Elements that are rolled up to rings: their heights, m, number, Poisson's ratio, and what mesh and higher
#: orders of kappa h leave.
RINGS = (
    ("nonlocking", 0.02, 64, 0.0, 5e-3),
    ("nonlocking", 0.02, 64, 0.3, 5e-3),
    ("original", 0.04, 256, 0.0, 2e-2),
)
SMALL = 2e-4  # N, bends by about 1e-4 of the length: linear to 1e-8


def cases() -> list[Case]:
    """All of them."""
    bent = [_tip_force(), _two_supports(), *_elastica(), *_roll_up(), *_ring()]
    return [*bent, _hanging_bar(), *_catenary(), *_chain(), _shear(), _twist()]


def _tip_force() -> Case:
    model, beam = cable(2)
    model.clamp(beam.start)
    model.add_force(beam.end, (0.0, 0.0, -SMALL))
    value = -float(ancf.equilibrium(model).position(beam.end)[2])
    wanted = SMALL * LENGTH**3 / (3.0 * EI)
    return Case("cantilever, small tip force: deflection", "cable", value, wanted, 1e-6, "m", "F L^3/(3 EI)")


def _two_supports() -> Case:
    """Light enough to stay linear; one end slides."""
    model, beam = cable(8, gravity=1e-3)
    model.pin(beam.start)
    model.hold(beam.end, position="yz")
    value = -float(ancf.equilibrium(model).position(beam.at(0.5 * LENGTH))[2])
    wanted = 5.0 * 1e-3 * RHO_A * LENGTH**4 / (384.0 * EI)
    name = "simply supported beam under its weight: sag"
    return Case(name, "cable", value, wanted, 1e-6, "m", "5 w L^4/(384 EI)")


def _elastica() -> list[Case]:
    """Cantilever under a force of 10 EI/L^2 across it; so stiff along its axis that it hardly stretches."""
    model, beam = cable(64, EA=1e7)
    model.clamp(beam.start)
    model.add_force(beam.end, (0.0, 0.0, -10.0 * EI / LENGTH**2))
    x, _, z = ancf.equilibrium(model, load_steps=8).position(beam.end).tolist()
    down, along = _bent_by_a_force(10.0)
    where = "elastica, elliptic integrals"
    return [
        Case("cantilever, tip force 10 EI/L²: drop", "cable", -z, down * LENGTH, 1e-5, "m", where),
        Case("cantilever, tip force 10 EI/L²: reach", "cable", x, along * LENGTH, 1e-5, "m", where),
    ]


def _bent_by_a_force(load: float) -> tuple[float, float]:
    """Drop and reach of the tip of an inextensible cantilever of length 1 under F L^2/EI.

    With k and sin(phi) = 1/(k sqrt 2): sqrt(load) = K(k) - F(phi, k).
    """
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

    def phi(m: float) -> float:
        return math.asin(1.0 / math.sqrt(2.0 * m))

    root = math.sqrt(load)
    m = float(brentq(lambda m: ellipk(m) - ellipkinc(phi(m), m) - root, 0.5, 1.0 - 1e-12, xtol=1e-15))
    drop = 1.0 - 2.0 / root * float(ellipe(m) - ellipeinc(phi(m), m))
    return drop, math.sqrt(2.0 * (2.0 * m - 1.0)) / root


def _roll_up() -> list[Case]:
    state = rolled_up(64)
    height, bend = float(state.position("beam.end")[2]), float(state.curvature("beam.at(1.1)"))
    name, where = "end moment π EI/L", "half a circle of radius EI/M"
    return [
        Case(f"{name}: height of the tip", "cable", height, 2.0 * LENGTH / math.pi, 1e-5, "m", where),
        Case(f"{name}: curvature", "cable", bend, math.pi / LENGTH, 1e-4, "1/m", where),
    ]


def rolled_up(elements: int, halves: float = 1.0) -> State:
    """A cable under an end moment of pi EI/L, which bends it to so many half circles without stretching."""
    model, beam = cable(elements)
    model.clamp(beam.start)
    model.add_moment(beam.end, (0.0, -halves * math.pi * EI / LENGTH, 0.0))
    return ancf.equilibrium(model, load_steps=8)


def _ring() -> list[Case]:
    """Rolled up by 2 pi EI/L: the cable closes, a beam with a cross-section turns further."""
    state = rolled_up(64, 2.0)
    name = "end moment 2π EI/L"
    across = float(state.position("beam.at(1.0)")[2])
    found = [Case(f"{name}: diameter", "cable", across, LENGTH / math.pi, 1e-5, "m", "closed ring, L/π")]
    for element, height, elements, nu, bar in RINGS:
        section = ancf.Section.rectangle(height, height, E=MODULUS, rho=DENSITY, nu=nu)
        model = ancf.Model()
        given: dict[str, Any] = {"elements": elements, "element": element, "section": section}
        beam = model.add_beam("beam", start=(0.0, 0.0, 0.0), end=(LENGTH, 0.0, 0.0), **given)
        model.clamp(beam.start)
        model.add_moment(beam.end, (0.0, 0.0, 2.0 * math.pi * section.EI_z / LENGTH))
        gap = math.hypot(*ancf.equilibrium(model, load_steps=16).position(beam.end).tolist())
        wanted = (7.0 / 15.0 - 0.5 * nu) * (2.0 * math.pi * height / LENGTH) ** 2 * LENGTH
        text = f"{name}, h = L/{LENGTH / height:.0f}, nu = {nu:g}: gap of the ring"
        found.append(Case(text, element, gap, wanted, bar, "m", "(7/15 - nu/2) (kappa h)^2 L, Green strain"))
    return found


def _hanging_bar() -> Case:
    model, beam = cable(4, 9.81, EA=500.0, end=(0.0, 0.0, -LENGTH))
    model.pin(beam.start)
    long = -float(ancf.equilibrium(model).position(beam.end)[2]) - LENGTH
    wanted = WEIGHT * LENGTH**2 / (2.0 * 500.0)
    return Case("bar under its weight: elongation", "cable", long, wanted, 1e-8, "m", "w L^2/(2 EA)")


def _catenary() -> list[Case]:
    """EI is so small that it shows within a few centimetres of the supports only."""
    stiff = 2e4
    state = _hung(stiff)
    H, V, sag = _elastic(stiff)
    where = "elastic catenary (Irvine)"
    return [
        Case("extensible cable: sag", "cable", _sag(state), sag, 5e-6, "m", where),
        Case("extensible cable: tension at the middle", "cable", _tension(state, 0.5), H, 1e-4, "N", where),
        Case("extensible cable: tension near the support", "cable", _tension(state, 0.05),
             math.hypot(H, V - 0.05 * WEIGHT * ARC), 1e-4, "N", where),
    ]  # fmt: skip


def _chain() -> list[Case]:
    """So stiff that it does not stretch: L = 2 a sinh(l/(2 a))."""
    from scipy.optimize import brentq

    state = _hung(1e9)
    a = float(brentq(lambda a: 2.0 * a * math.sinh(SPAN / (2.0 * a)) - ARC, 1.0, 100.0, xtol=1e-14))
    where = "catenary, L = 2 a sinh(l/(2 a))"
    sag = a * (math.cosh(SPAN / (2.0 * a)) - 1.0)
    return [
        Case("inextensible cable: sag", "cable", _sag(state), sag, 5e-6, "m", where),
        Case("inextensible cable: tension at the middle", "cable", _tension(state, 0.5), WEIGHT * a, 1e-4,
             "N", where),
    ]  # fmt: skip


def _hung(stiff: float) -> State:
    """Equilibrium of a cable of 10.5 m between supports 10 m apart."""
    model, beam = cable(80, 9.81, EA=stiff, EI=1e-6, end=(SPAN, 0.0, 0.0), length=ARC)
    model.pin(beam.start)
    model.pin(beam.end)
    return ancf.equilibrium(model)


def _sag(state: State) -> float:
    return -float(state.position(f"beam.at({0.5 * ARC})")[2])


def _tension(state: State, share: float) -> float:
    return float(state.tension(f"beam.at({share * ARC})"))


def _elastic(stiff: float) -> tuple[float, float, float]:
    """End forces H, V and the sag of the elastic catenary with level supports."""
    from scipy.optimize import brentq

    V = 0.5 * WEIGHT * ARC

    def span(H: float) -> float:
        return H * ARC / stiff + 2.0 * H / WEIGHT * math.asinh(V / H) - SPAN

    H = float(brentq(span, 1e-2, 1e3, xtol=1e-12))
    sag = V**2 / (2.0 * WEIGHT * stiff) + (math.hypot(H, V) - H) / WEIGHT
    return H, V, sag


def _shear() -> Case:
    """The section alone is held: the beam shears at the wall too."""
    model, beam = solid(4)
    model.hold(beam.start, position="xyz", slope_y="xyz", slope_z="xyz")
    model.add_force(beam.end, (0.0, 0.0, -1.0))
    value, s = -float(ancf.equilibrium(model).position(beam.end)[2]), beam.section
    wanted = LENGTH**3 / (3.0 * s.EI_y) + LENGTH / (s.shear_factors[1] * s.G * s.A)
    where = "F L^3/(3 EI) + F L/(k G A)"
    return Case("short cantilever, tip force: deflection", "nonlocking", value, wanted, 1e-5, "m", where)


def _twist() -> Case:
    model, beam = solid(16)
    model.clamp(beam.start)
    model.add_moment(beam.end, (10.0, 0.0, 0.0))
    value = float(ancf.equilibrium(model).twist(beam.end))
    wanted = 10.0 * LENGTH / (MODULUS / (2.0 * (1.0 + NU)) * square_torsion())
    where = "T L/(G J), J of a square by Saint-Venant's series"
    return Case("torsion: angle of the end", "nonlocking", value, wanted, 1e-5, "rad", where)


def square_torsion() -> float:
    """Saint-Venant's torsion constant of the square, m^4."""
    series = sum(math.tanh(0.5 * n * math.pi) / n**5 for n in range(1, 40, 2))
    return SIDE**4 * (1.0 / 3.0 - 64.0 / math.pi**5 * series)
