"""Similar models have similar equilibria and motions, from micrometres to kilometres.

With lengths times s, masses and stiffnesses as of the same materials (EA and rhoA with s^2, EI with s^4) and
gravity times 1/s, all forces go with s^2 and all shapes with s.

Motions are similar for any units of length, time and mass: every number is that of one model in other units.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

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


class Units:
    """Numbers of a model in units so many times smaller: lengths, times and masses."""

    def __init__(self, length=1.0, time=1.0, mass=1.0):
        self.of = length, time, mass
        self.model = ancf.Model(gravity=(0, 0, self(-9.81, 1, -2)))

    def __call__(self, number, length=0, time=0, mass=0):
        powers = (length, time, mass)
        return np.asarray(number) * np.prod([u**p for u, p in zip(self.of, powers, strict=True)])

    def beam(self, element, start, end, **given):
        if element == "cable":
            section = ancf.Section(
                EA=self(5e3, 1, -2, 1), EI=self(0.4, 3, -2, 1), rhoA=self(1.2, -1, 0, 1), **given
            )
        else:
            sides = self(0.04, 1), self(0.05, 1)
            section = ancf.Section.rectangle(
                *sides, E=self(2.5e6, -1, -2, 1), rho=self(900.0, -3, 0, 1), nu=0.3, **given
            )
        ends = {"start": self(start, 1), "end": self(end, 1)}
        return self.model.add_beam("beam", **ends, elements=4, section=section, element=element)

    def body(self, at, name="body"):
        inertia = self([0.01, 0.012, 0.015], 2, 0, 1)
        return self.model.add_rigid_body(name, at=self(at, 1), mass=self(0.3, 0, 0, 1), inertia=inertia)

    def spring(self, a, b, stiffness=40.0):
        given = {"stiffness": self(stiffness, 0, -2, 1), "damping": self(0.1, 0, -1, 1)}
        self.model.add_spring(a, b, length=self(0.2, 1), **given)


def clamped_to_body(u, element, stretch="fixed"):
    beam, body = u.beam(element, (0, 0, 0), (1.5, 0.2, 0.1)), u.body((1.6, 0.25, 0.0))
    u.model.clamp(beam.start)
    u.model.clamp(beam.end, to=body, stretch=stretch)
    return beam.end, body.at(*u((0.1, 0.05, 0), 1))


def hinged_to_body(u, element):
    beam, body = u.beam(element, (0, 0, 0), (1.5, 0.2, 0.1)), u.body((1.6, 0.3, -0.2))
    u.model.clamp(beam.start)
    u.model.hinge(beam.end, body.at(*u((-0.1, -0.1, 0.3), 1)), axis=(0.3, 1.0, 0.2))
    return beam.end, body.at(*u((0.1, 0, 0), 1))


def pulled(u, join):
    """A body on a joint to the ground, or to another one, and a spring beside it."""
    one, two = u.body((0, 0, 0)), u.body((0.9, 0.1, 0.05), "two")
    u.model.connect(one.at(*u((-0.2, 0.1, 0.3), 1)), u((-0.2, 0.1, 0.3), 1))
    join(u.model, one.at(*u((0.5, 0.1, 0), 1)), two.at(*u((-0.4, 0, -0.05), 1)))
    u.spring(two.at(*u((0.2, 0.1, 0), 1)), u((1.2, 0.4, 0.5), 1))
    return one.centre, two.at(*u((0.3, 0.2, 0.1), 1))


def sliding(u, mass, friction):
    wire, bead = u.beam("cable", (0, 0, 0), (1.5, 0.2, 0.1)), u.body((0.6, 0.08, 0.04))
    u.model.pin(wire.start)
    u.model.pin(wire.end)
    given = {"mass": u(mass, 0, 0, 1), "friction": friction, "friction_velocity": u(0.05, 1, -1)}
    u.model.slide(bead.centre, along=wire, s=0.4 * wire.length, tolerance=u(0.01, 1), **given)
    return wire.at(0.8 * wire.length), bead.centre


AXIS = (0.3, -0.2, 1.0)
JOINED = {
    "hinge": lambda m, a, b: m.hinge(a, b, axis=AXIS),
    "universal": lambda m, a, b: m.universal(a, b, axis_a=AXIS, axis_b=(1.0, 1.5, 0.0)),
    "cylindrical": lambda m, a, b: m.cylindrical(a, b, axis=AXIS),
    "prismatic": lambda m, a, b: m.prismatic(a, b, axis=AXIS),
    "planar": lambda m, a, b: m.planar(a, b, axis=AXIS),
    "spherical": lambda m, a, b: m.connect(a, b),
}
MOVED = {f"two bodies, {name}": (lambda u, join=join: pulled(u, join)) for name, join in JOINED.items()}
MOVED |= {
    f"{name} on a body": (lambda u, e=name: clamped_to_body(u, e)) for name in ("original", "nonlocking")
}
MOVED |= {
    f"{name} on a hinge": (lambda u, e=name: hinged_to_body(u, e)) for name in ("original", "nonlocking")
}
MOVED |= {"cable on a body": lambda u: clamped_to_body(u, "cable", "free")}
MOVED |= {"slide": lambda u: sliding(u, 0.0, 0.0), "rough slide": lambda u: sliding(u, 0.1, 0.3)}
LEFT_OUT = ("two bodies, prismatic", "rough slide")
METHODS = {"index 2": {}, "GGL": {"formulation": "ggl"}, "index 1": {"formulation": "index1"}}


def moved(units, build, method):
    u = Units(*units)
    points = build(u)
    given = {"t_end": float(u(0.12, 0, 1)), "step": float(u(2e-3, 0, 1))}
    ran = ancf.simulate(u.model, integrator=ancf.Trapezoidal(**method), **given)
    places = [ran.position(point) / units[0] for point in points]
    return np.array([*places, *(ran.velocity(point) * units[1] / units[0] for point in points)])


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("build", MOVED)
def test_units_change_no_motion(build, method):
    """Rows of joints in kg took the digits of kg m^2, and gaps in m were no shares of the size of a model."""
    wanted = moved((1.0, 1.0, 1.0), MOVED[build], METHODS[method])
    for units in ((1e-5, 1.0, 1.0), (1e-2, 1e2, 1e-3), (1e4, 1.0, 1.0)):
        found = moved(units, MOVED[build], METHODS[method])
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("build", [name for name in MOVED if name not in LEFT_OUT])
def test_units_change_no_modes(build):
    """Places and directions are measured by their masses where rows of joints are eliminated.

    The body on the prismatic joint has two equilibria, between which round-off decides; modes know no slides
    with friction. Of one on a slide the rotations are neutral: their frequencies are the square root of
    round-off.
    """
    found = []
    for units in ((1.0, 1.0, 1.0), (1e-5, 1.0, 1.0), (1e-2, 1e2, 1e-3), (1e5, 1.0, 1.0)):
        u = Units(*units)
        MOVED[build](u)
        state = ancf.equilibrium(u.model)
        plain = ancf.modes(u.model, about=state, count=4).frequencies
        damped = ancf.damped_modes(u.model, about=state, count=4).eigenvalues
        found.append(np.concatenate([plain, np.abs(damped)]) * units[1])
    for mine in found[1:]:
        np.testing.assert_allclose(mine, found[0], rtol=1e-7, atol=1e-4)


@pytest.mark.parametrize(("time", "windy"), [(1e-4, False), (1e-2, False), (1e-2, True), (10.0, True)])
def test_units_of_time_change_no_force_of_what_is_driven(time, windy):
    """Rates of a given motion at one moment were differences over a millisecond, however fast it was."""

    def run(u):
        wire = u.beam(
            "cable", (0, 0, 0), (1.0, 0.2, 0.1), diameter=0.03, drag=(1.2, 0.1), added_mass=(1.0, 0.2)
        )
        rate = float(u(9.0, 0, -1))
        shaken = f"0.02*(sin({rate!r}*t + 0.1) - sin(0.1))"
        pin = u.model.pin(wire.start, displacement=(shaken, 0, shaken))
        wind = f"{float(u(3.0, 0, -1))!r}*sin({rate!r}*t)"
        if windy:
            u.model.add_fluid("air", density=30.0, velocity=(0, wind, wind))
        ran = ancf.simulate(u.model, t_end=float(u(0.02, 0, 1)), step=float(u(2e-3, 0, 1)))
        found = ran.acceleration(wire.start), ran.reaction(pin), ran.acceleration(wire.end)
        return np.array(found) * u.of[1] ** 2, rate * u.of[1] * (ran.t / u.of[1])

    found, turned = run(Units(1.0, time, 1.0))
    wanted, _ = run(Units())
    exact = -0.02 * 9.0**2 * np.sin(turned + 0.1)
    np.testing.assert_allclose(found[0][:, 0], exact, rtol=0, atol=2e-6)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=2e-6 * np.abs(wanted).max())


@pytest.mark.parametrize("swapped", [False, True])
def test_a_torsion_spring_whose_axis_is_free_knows_no_directions(swapped):
    """One normal of the axis counted, which was chosen by the global axes: turned models came apart."""

    def run(turn, swapped=False):
        model = ancf.Model()
        given = {"mass": 0.3, "inertia": (0.01, 0.012, 0.015), "axes": turn.as_matrix()}
        one, two = (model.add_rigid_body(name, at=turn.apply(at), **given) for name, at in PAIR.items())
        model.connect(one.at(0.3, 0, 0.0), two.at(-0.3, 0.0, 0.0))
        ends, sense = ((two, one), -1.0) if swapped else ((one, two), 1.0)
        axis = turn.apply((0.2, 0.3, 1.0))
        model.add_torsion_spring(*ends, axis=axis, stiffness=3.0, damping=0.02, angle=0.4 * sense)
        model.add_force(one.at(0.1, 0.1, 0.1), turn.apply((1.0, 2.0, 3.0)))
        ran = ancf.simulate(model, t_end=0.2, step=4e-3, integrator=ancf.Trapezoidal(formulation="index2"))
        return turn.inv().apply(ran.position(two.at(0.1, 0.2, 0.0)))

    wanted = run(Rotation.identity())
    for vector in ((0.0, 0.0, 1.9), (0.3, -1.1, 2.0)):
        found = run(Rotation.from_rotvec(vector), swapped)
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9)


PAIR = {"one": (0, 0, 0), "two": (0.6, 0, 0)}
