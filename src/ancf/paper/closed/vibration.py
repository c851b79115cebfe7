"""Frequencies with a closed form: bending, strings, bars, torsion, springs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

import ancf

from .case import EA, EI, LENGTH, MODULUS, NU, RHO_A, SIDE, Case, cable, solid
from .statics import square_torsion

#: Roots of cos(b) cosh(b) = -1, clamped and free.
CANTILEVER = (1.8751040687119611, 4.694091132974175, 7.854757438237613)
#: With s = sqrt(P^2/4 + w^2), a^2 = s + P/2, b^2 = s - P/2 the frequencies w of a column under a follower
#: force P obey P^2 + 2 w^2 + P w sin a sinh b + 2 w^2 cos a cosh b = 0; two of them meet at
BECK = 20.05095362


def cases() -> list[Case]:
    """All of them."""
    of_cables = [*_cantilever(), *_simply_supported(), *_string(), _compressed(), _bar()]
    return [*of_cables, *_timoshenko(), _torsion(), *_spring(), _beck()]


def _cantilever() -> list[Case]:
    found, wanted = clamped(16)
    return _numbered("cantilever", "cable", found, wanted, 1e-4, "Euler-Bernoulli beam, cos b cosh b = -1")


def clamped(elements: int) -> tuple[list[float], list[float]]:
    """First three bending frequencies of a clamped cable, and those of a beam, rad/s."""
    model, beam = cable(elements)
    model.clamp(beam.start)
    found = ancf.modes(model, count=6).frequencies[::2]  # each twice, in y and in z
    return found.tolist(), [(b / LENGTH) ** 2 * math.sqrt(EI / RHO_A) for b in CANTILEVER]


def _simply_supported() -> list[Case]:
    wanted = [(n * math.pi / LENGTH) ** 2 * math.sqrt(EI / RHO_A) for n in (1, 2, 3)]
    where = "Euler-Bernoulli beam, (n pi/L)^2 sqrt(EI/rhoA)"
    return _numbered("simply supported beam", "cable", _pinned(LENGTH, EI), wanted, 1e-4, where)


def _string() -> list[Case]:
    """Stretched by 1 %: the waves run in the natural length, m."""
    natural = LENGTH / 1.01
    speed = math.sqrt(EA * 0.01 / 1.01 / RHO_A)
    wanted = [n * math.pi / natural * speed for n in (1, 2, 3)]
    where = "string, n pi/L sqrt(T/(rhoA s)) with the stretch s"
    return _numbered("taut string", "cable", _pinned(natural, 1e-4), wanted, 1e-5, where)


def _compressed() -> Case:
    """Pinned ends that press with half of Euler's load pi^2 EI/L^2."""
    press = 0.5 * math.pi**2 * EI / LENGTH**2
    stretch = 1.0 - press / EA
    k = math.pi * stretch / LENGTH
    wanted = k * math.sqrt((-press / stretch + EI * k**2 / stretch**2) / RHO_A)
    value = float(_pinned(LENGTH / stretch, EI)[0])
    name, where = "beam under half of Euler's load: frequency 1", "k sqrt((T/s + EI k^2/s^2)/rhoA), T < 0"
    return Case(name, "cable", value, wanted, 1e-4, "rad/s", where)


def _pinned(natural: float, stiff: float) -> list[float]:
    """First three frequencies between two pins, each once."""
    model, beam = cable(16, EI=stiff, length=natural)
    model.pin(beam.start)
    model.pin(beam.end)
    found: list[float] = ancf.modes(model, count=6).frequencies[::2].tolist()
    return found


def _bar() -> Case:
    model, beam = cable(16)
    model.clamp(beam.start)
    for x in beam.node_x[1:]:
        model.hold(beam.at(x), position="yz", slope="yz")
    value = float(ancf.modes(model, count=1).frequencies[0])
    wanted = 0.5 * math.pi / LENGTH * math.sqrt(EA / RHO_A)
    return Case("bar, axial: frequency 1", "cable", value, wanted, 2e-6, "rad/s", "pi/(2 L) sqrt(EA/rhoA)")


def _timoshenko() -> list[Case]:
    found, wanted = thick(16)
    where = "Timoshenko beam with rotary inertia"
    return _numbered("thick simply supported beam", "nonlocking", found, wanted, 1e-4, where)


def thick(elements: int, element: str = "nonlocking") -> tuple[list[float], list[float]]:
    """First two bending frequencies of a thick beam between two pins, and those of Timoshenko's beam, rad/s.

    Both planes have the same ones, and there are axial ones between them; the beam cannot spin.
    """
    model, beam = solid(elements, element=element)
    model.pin(beam.start)
    model.hold(beam.start, twist=True)
    model.hold(beam.end, position="yz")
    found = ancf.modes(model, count=12).frequencies
    wanted = [_shear_frequency(n * math.pi / LENGTH, beam.section.shear_factors[0]) for n in (1, 2)]
    return [float(found[np.argmin(np.abs(found - w))]) for w in wanted], wanted


def _shear_frequency(k: float, factor: float) -> float:
    """EI k^4 - rhoA (1 + i^2 k^2 (1 + g)) w^2 + rhoA^2 i^4 g/EI w^4 = 0, g = E/(k_s G), i^2 = I/A."""
    i2, g = SIDE**2 / 12.0, 2.0 * (1.0 + NU) / factor
    bend, mass = MODULUS * SIDE**4 / 12.0, 1000.0 * SIDE**2
    a, b, c = mass**2 * i2**2 * g / bend, mass * (1.0 + i2 * k**2 * (1.0 + g)), bend * k**4
    return math.sqrt(2.0 * c / (b + math.sqrt(b**2 - 4.0 * a * c)))  # the smaller root, without cancellation


def _torsion() -> Case:
    """Held along its axis: it can twist only."""
    model, beam = solid(16)
    for x in beam.node_x:
        model.hold(beam.at(x), position="xyz", slope="yz")
    model.hold(beam.start, slope_y="z", slope_z="y")
    value = float(ancf.modes(model, count=1).frequencies[0])
    polar = 1000.0 * SIDE**4 / 6.0
    wanted = 0.5 * math.pi / LENGTH * math.sqrt(MODULUS / (2.0 * (1.0 + NU)) * square_torsion() / polar)
    where = "pi/(2 L) sqrt(G J/(rho I_p)), J by Saint-Venant's series"
    return Case("torsion: frequency 1", "nonlocking", value, wanted, 1e-5, "rad/s", where)


def _spring() -> list[Case]:
    """A mass of 2 kg under a spring of 50 N/m."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    mass = model.add_point_mass("mass", at=(0.0, 0.0, -1.0), mass=2.0)
    model.add_spring(mass, (0.0, 0.0, 0.0), stiffness=50.0, length=1.0)
    state = ancf.equilibrium(model)
    down = -1.0 - float(state.position(mass)[2])
    found = ancf.modes(model, about=state, count=3).frequencies
    length, fall = 1.0 + 2.0 * 9.81 / 50.0, 2.0 * 9.81 / 50.0
    up, sway = math.sqrt(50.0 / 2.0), math.sqrt(9.81 / length)
    return [
        Case("mass on a spring: extension", "none", down, fall, 1e-9, "m", "m g/k"),
        Case("mass on a spring: sway", "none", float(found[0]), sway, 1e-9, "rad/s", "sqrt(g/l)"),
        Case("mass on a spring: up and down", "none", float(found[2]), up, 1e-9, "rad/s", "sqrt(k/m)"),
    ]


def _numbered(
    name: str, element: str, found: Sequence[float], wanted: Sequence[float], tolerance: float, where: str
) -> list[Case]:
    return [
        Case(f"{name}: frequency {n}", element, float(value), other, tolerance, "rad/s", where)
        for n, (value, other) in enumerate(zip(found, wanted, strict=True), start=1)
    ]


def _beck() -> Case:
    """A column that a force along its tangent presses: from some load on it flutters."""
    low, high = 18.0, 22.0  # EI/L^2
    while high - low > 1e-5:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if flutters(middle) else (middle, high)
    where = "Beck 1952: a double root of his characteristic equation"
    return Case("column, follower force: flutter", "cable", low, BECK, 1e-3, "EI/L^2", where)


def flutters(load: float) -> bool:
    """Whether a column of 12 elements does in its plane, under a load in EI/L^2."""
    model, beam = cable(12)
    model.clamp(beam.start)
    for x in beam.node_x[1:]:
        model.hold(beam.at(x), position="z", slope="z")
    model.add_follower_force(beam.end, (-load * EI / LENGTH**2, 0.0, 0.0))
    modes = ancf.damped_modes(model, about=ancf.equilibrium(model), count=2)
    return bool(modes.eigenvalues.real.max() > 1e-3 * math.sqrt(EI / RHO_A) / LENGTH**2)
