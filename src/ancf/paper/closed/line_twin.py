"""Twin contact wires, two side by side, beside strings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ... import catenary
from ..check import Check

G, APART = 9.81, 0.04  # m/s^2, m
WIRE = catenary.Wire(EA=7.5e6, EI=1.0, mass=0.675, tension=10e3)


def checks() -> list[Check]:
    """Sag and elasticity of two wires alone; how droppers draw them together, and what each carries."""
    return [*_alone(), *_hung()]


def _alone() -> list[Check]:
    length, force = 45.0, 80.0
    line = catenary.Line(
        spans=(catenary.Span(length=length, droppers=()),) * 2,
        contact_wire=WIRE,
        contact_spacing=APART,
        steady_arm=catenary.SteadyArm(vertical=1e8),
        anchors="tension",
    )
    mesh = catenary.Mesh(contact_support=0.05, contact=1.0)
    found = catenary.form(line, mesh)
    sags = [-float(np.interp(0.5 * length, *shape.position[:, [0, 2]].T)) for shape in found.contacts]
    sag, give = WIRE.mass * G * length**2 / 8.0 / WIRE.tension, force * length / 8.0 / WIRE.tension
    made = catenary.elasticity(line, (force,), points=2, span=0, mesh=mesh).lift[0, 1]
    names = ("left", "right")
    told = [
        Check(f"Overhead line, twin wires: sag of the {name} one", one, sag, 0.01 * sag, "m", "w l^2/(8 T)")
        for name, one in zip(names, sags, strict=True)
    ]
    name = "Overhead line, twin wires: lift of both by a force on both"
    return [*told, Check(name, float(made), give, 0.015 * give, "m", "F l/(4 (2 T))")]


def _hung() -> list[Check]:
    """Droppers pull each wire to the middle by force over length times its distance from there."""
    length, x = 48.0, np.arange(2.0, 48.0, 4.0)
    line = catenary.Line(
        spans=(catenary.Span(length=length, droppers=tuple(x)),) * 3,
        contact_wire=WIRE,
        contact_spacing=APART,
        messenger_wire=catenary.Wire(EA=11.6e6, EI=131.7, mass=1.07, tension=16e3),
        droppers=catenary.Droppers(stiffness=5e4),
        steady_arm=catenary.SteadyArm(vertical=150.0),
        system_height=1.2,
        anchors="tension",
    )
    mesh = catenary.Mesh(contact=1.0, messenger=2.0, contact_support=0.1, dropper=0.1)
    found, middle = catenary.form(line, mesh), slice(24, 48, 2)
    lean = np.diag((found.dropper_force / found.dropper_length)[middle])
    give = np.minimum.outer(x, x) * (length - np.maximum.outer(x, x)) / length / WIRE.tension
    wanted = np.linalg.solve(np.eye(x.size) + give @ lean, np.full(x.size, 0.5 * APART))
    places = [shape.position[shape.nodes.dropper, 1][middle] for shape in found.contacts]
    apart, exact = float(np.min(places[0] - places[1])), 2.0 * float(wanted.min())
    name = "Overhead line, twin wires: smallest distance between both"
    origin = "strings that droppers pull to the middle by their lean"
    one = replace(line, contact_spacing=None, contact_wire=WIRE.times(2))
    one = replace(one, droppers=catenary.Droppers(stiffness=1e5))
    whole, share = catenary.form(one, mesh).dropper_force[18], found.dropper_force[36:38]
    halves = [
        Check(
            f"Overhead line, twin wires: force of a dropper of the {name} one",
            float(force),
            0.5 * float(whole),
            2e-3 * float(whole),
            "N",
            "half of that of one wire for both",
        )
        for name, force in zip(("left", "right"), share, strict=True)
    ]
    return [Check(name, apart, exact, 0.01 * exact, "m", origin), *halves]
