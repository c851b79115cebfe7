"""Similar models have similar equilibria, from micrometres to kilometres.

With lengths times s, masses and stiffnesses as of the same materials (EA and rhoA with s^2, EI with s^4) and
gravity times 1/s, all forces go with s^2 and all shapes with s.
"""

import numpy as np
import pytest

import ancf

SIZES = [1e-5, 1e-3, 1e-2, 1e3]


def wire_between(model, s):
    section = ancf.Section(EA=1e4 * s**2, EI=0.05 * s**4, rhoA=0.1 * s**2)
    ends = {"start": (0, 0, 0), "end": (4 * s, 0, 0.5 * s)}
    wire = model.add_beam("wire", **ends, elements=12, length=4.2 * s, section=section)
    model.pin(wire.start)
    model.pin(wire.end)
    return wire


def heavy(model, s, at, name="body"):
    return model.add_rigid_body(name, at=at, mass=0.5 * s**3, inertia=(0.01 * s**5, 0.02 * s**5, 0.03 * s**5))


def sliding_body(model, s):
    body = heavy(model, s, (2 * s, 0, 0.15 * s))
    model.slide(body.at(0, 0, 0.1 * s), along=wire_between(model, s))


def sliding_mass(model, s):
    mass = model.add_point_mass("body", at=(2 * s, 0, 0.25 * s), mass=0.5 * s**3)
    model.slide(mass, along=wire_between(model, s))


def on_springs(model, s):
    body = heavy(model, s, (0, 0, 0))
    for x, y, z in ((0.1, 0, 0), (-0.1, 0.1, 0), (0, -0.1, 0.05)):
        place = (s * (x + 0.3), s * (y + 0.2), s * (z + 1.0))
        model.add_spring(body.at(x * s, y * s, z * s), place, stiffness=100 * s)


def at_the_end_of_a_wire(model, s):
    section = ancf.Section(EA=1e4 * s**2, EI=0.05 * s**4, rhoA=0.1 * s**2)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(s, 0, -s), elements=6, section=section)
    model.pin(wire.start)
    body = heavy(model, s, (1.1 * s, 0, -s))
    model.connect(wire.end, body.at(-0.1 * s, 0, 0))


@pytest.mark.parametrize("build", [sliding_body, sliding_mass, on_springs, at_the_end_of_a_wire])
def test_equilibria_are_similar(build):
    found = {}
    for s in (1.0, *SIZES):
        model = ancf.Model(gravity=(0, 0, -9.81 / s))
        build(model, s)
        found[s] = ancf.equilibrium(model).position("body") / s
    for s in SIZES:
        np.testing.assert_allclose(found[s], found[1.0], rtol=0, atol=1e-9)
