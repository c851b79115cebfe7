"""Damping, whirl, forces that follow, initial velocities and chosen meshes with a closed form."""

from __future__ import annotations

import math

import numpy as np

import ancf

from .case import LENGTH, Case


def cases() -> list[Case]:
    """Those of cables, and of what turns."""
    return [*_damped(), _flap(), _pressed(), _plucked(), _chosen()]


def turning() -> list[Case]:
    """A shaft that whirls and a body pushed in its own direction: they take the longest to compile."""
    return [*_whirl(), _pushed()]


def _damped() -> list[Case]:
    mass, stiffness, damping = 2.0, 50.0, 3.0
    model = ancf.Model()
    body = model.add_point_mass("body", at=(1, 0, 0), mass=mass)
    model.hold(body, position="yz")
    model.add_spring(body, (0, 0, 0), stiffness=stiffness, damping=damping)
    modes = ancf.damped_modes(model, count=1)
    decay, swing = 0.5 * damping / mass, stiffness / mass
    return [
        Case("complex mode, oscillator: decay", "none", -float(modes.eigenvalues[0].real), decay, 1e-9, "1/s",
             "d/(2 m)"),
        Case("complex mode, oscillator: frequency", "none", float(modes.eigenvalues[0].imag),
             math.sqrt(swing - decay**2), 1e-9, "rad/s", "sqrt(k/m - (d/(2 m))^2)"),
    ]  # fmt: skip


def _flap() -> Case:
    """EI = rhoA = L = 1, turning at 6 rad/s."""
    rate = 6.0
    model = ancf.Model()
    section = ancf.Section(EA=1e7, EI=1.0, rhoA=1.0)
    blade = model.add_beam("blade", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section)
    model.clamp(blade.start, rotation=f"{rate}*t", axis=(0, 0, 1))
    blade.set_motion(angular_velocity=(0, 0, rate))
    lag, flap = ancf.damped_modes(model, count=2).eigenvalues.imag.tolist()
    assert lag < flap
    return Case("turning blade: frequency of flapping", "cable", flap, 7.3604, 5e-5, "rad/s",
                "Wright et al. (1982), power series")  # fmt: skip


def _pressed() -> Case:
    """A quarter of a ring that a pressure from inside widens: the force in it."""
    radius, pressure = 1.5, 2e3
    model = ancf.Model()
    section = ancf.Section(EA=1e5, EI=500.0, rhoA=1.0)

    def arc(u: float) -> tuple[float, float, float]:
        return radius * math.cos(0.5 * math.pi * u), radius * math.sin(0.5 * math.pi * u), 0.0

    ring = model.add_beam("ring", path=arc, elements=12, section=section, natural_shape="path")
    model.hold(ring.start, position="y", slope="x")
    model.hold(ring.end, position="x", slope="y")
    for x in ring.node_x:
        model.hold(ring.at(float(x)), position="z", slope="z")
    model.add_pressure(ring, pressure, (0, 0, 1))
    value = float(ancf.equilibrium(model).tension(ring.at(0.5 * ring.length)))
    wanted = pressure * radius / (1.0 - pressure * radius / section.EA)
    return Case("pressure that follows, ring: tension", "cable", value, wanted, 1e-5, "N",
                "p r, r = R/(1 - p R/EA)")  # fmt: skip


def _plucked() -> Case:
    """A string that starts straight with the speeds of its second mode: how far a quarter of it goes."""
    strain, speed, n = 1e-3, 1e-3, 2
    section = ancf.Section(EA=1e5, EI=1e-6, rhoA=0.2)
    model = ancf.Model()
    wire = model.add_beam("wire", start=(0, 0, 0), end=(LENGTH, 0, 0), length=LENGTH / (1 + strain),
                          elements=24, section=section)  # fmt: skip
    model.pin(wire.start)
    model.pin(wire.end)
    x = np.linspace(0.0, wire.length, 25)
    wire.set_motion(along=x, velocities=np.outer(speed * np.sin(n * math.pi * x / wire.length), (0, 0, 1)))
    rate = n * math.pi / LENGTH * math.sqrt(section.EA * strain * (1 + strain) / section.rhoA)
    result = ancf.simulate(model, t_end=0.5 * math.pi / rate, step=0.5 * math.pi / rate / 200)
    value = float(result.position(wire.at(wire.length / (2 * n)))[-1, 2])
    return Case("initial velocities, string: largest deflection", "cable", value, speed / rate, 1e-5, "m",
                "v/w, w = n pi/L sqrt(T/rhoA)")  # fmt: skip


def _chosen() -> Case:
    """The number of elements by their error, which may be 1e-4 of the length."""
    from scipy.optimize import brentq

    natural, span = 10.0, 6.0
    section = ancf.Section(EA=1e8, EI=1e-5, rhoA=0.7)
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    line = model.add_beam("line", start=(0, 0, 0), end=(span, 0, 0), length=natural, elements="auto",
                          section=section)  # fmt: skip
    model.pin(line.start)
    model.pin(line.end)
    value = -float(ancf.equilibrium(model).position(line.at(0.5 * natural))[2])
    a = brentq(lambda a: 2.0 * a * math.sinh(span / (2.0 * a)) - natural, 0.5, 50.0)
    wanted = a * (math.cosh(span / (2.0 * a)) - 1.0)
    name = f'elements="auto" ({line.elements}), slack cable: sag'
    return Case(name, "cable", value, wanted, 1e-4 * natural / wanted, "m", "catenary, L = 2 a sinh(l/(2 a))")


def _whirl() -> list[Case]:
    """A shaft on two bearings at 500 rad/s, forwards and backwards, for an observer at rest.

    Shear, which Rayleigh leaves out, lowers each of both frequencies by some parts in a thousand.
    """
    modulus, density, rate, k = 2e11, 7850.0, 500.0, 0.5 * math.pi
    model = ancf.Model()
    section = ancf.Section.circle(diameter=0.1, E=modulus, rho=density, nu=0.3)
    shaft = model.add_beam("shaft", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=section,
                           element="nonlocking")  # fmt: skip
    model.pin(shaft.start)
    model.hold(shaft.end, position="yz")
    shaft.set_motion(angular_velocity=(rate, 0, 0))
    modes = ancf.damped_modes(model, count=16)
    area, inertia = 0.25 * math.pi * 0.1**2, math.pi * 0.1**4 / 64.0
    equation = [area + inertia * k**2, -2 * rate * inertia * k**2, -modulus * inertia * k**4 / density]
    back, ahead = sorted(np.roots(equation).real.tolist())
    circles = np.abs(modes.whirl) > 0.9
    found = (rate + modes.whirl.round() * modes.eigenvalues.imag)[circles]
    slow, fast = (float(found[np.argmin(np.abs(found - w))]) for w in (back, ahead))
    where = "Rayleigh's shaft, (A + I k^2) w^2 - 2 W I k^2 w = E I k^4/rho"
    rows = (
        ("backwards", -slow, -back, 4e-3),
        ("forwards", fast, ahead, 4e-3),
        ("split by gyroscopic moments", fast + slow, ahead + back, 2e-2),
    )
    return [
        Case(f"whirl of a shaft: {name}", "nonlocking", value, wanted, share, "rad/s", where)
        for name, value, wanted, share in rows
    ]


def _pushed() -> Case:
    """A body that spins and is pushed along one of its own axes goes round."""
    mass, spin, force, t = 2.0, 3.0, 1.0, 1.0
    model = ancf.Model()
    hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=mass, inertia=(0.1, 0.1, 0.1))
    hub.set_motion(angular_velocity=(0, 0, spin))
    model.add_follower_force(hub.centre, (force, 0.0, 0.0))
    speed = float(np.linalg.norm(ancf.simulate(model, t_end=t, step=1e-3).velocity(hub.centre)[-1]))
    wanted = 2.0 * force / (mass * spin) * math.sin(0.5 * spin * t)
    return Case("follower force on a body that spins: speed", "none", speed, wanted, 1e-5, "m/s",
                "2 F/(m w) sin(w t/2)")  # fmt: skip
