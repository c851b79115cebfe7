"""Taylor remainders by a number of every registered kind: what has no case here fails."""

import numpy as np
import pytest

import ancf
from ancf.model.elements import KINDS as ELEMENTS
from ancf.model.kinds import GROUPS, SURROUNDINGS
from ancf.model.vary import names_of, value_of, varied
from ancf.system.system import System
from helpers import EXACT
from slopes import remainder_slopes

METHOD = ancf.GeneralizedAlpha(rho_inf=0.8, newton=EXACT)
#: Relative size of the largest change.
STEP = 1e-2
STEEL = ancf.Section.circle(diameter=0.05, E=2e8, rho=2e3, nu=0.3)
ROPE = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, diameter=0.02, drag=(1.0, 0.1), added_mass=(1.0, 0.0))


def space(gravity=-9.81):
    return ancf.Model(gravity=(0.0, 0.0, gravity))


def cable(element="cable", pinned=True, moves=True, **more):
    """A hanging cable or beam that moves."""
    model = space()
    section = ROPE if element == "cable" else STEEL
    given = {"elements": 2, "section": section, "element": element} | more
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), **given)
    if pinned:
        model.pin(beam.start)
    if moves:
        beam.set_motion(velocity=(0.0, 0.3, -0.2))
    return model, beam


def with_beam(add, element="cable", **more):
    """A cable or beam with what ``add(model, beam)`` adds."""

    def build():
        model, beam = cable(element, **more)
        add(model, beam)
        return model

    return build


def hub(join):
    """A rigid body with an eccentric mass on a spring, which ``join(model, hub)`` holds."""

    def build():
        model = space()
        body = model.add_rigid_body("hub", at=(1, 0, 0), mass=0.8, inertia=(0.02, 0.03, 0.04))
        load = model.add_point_mass("load", at=(1.5, 0.3, 0.0), mass=0.3)
        model.add_spring(body.at(0.1, 0.2, 0.0), load, stiffness=300.0, length=0.2, name="link")
        model.add_moment(body, (0.3, 0.4, 0.5))
        join(model, body)
        return model

    return build


def two_beams():
    model = space()
    given = {"elements": 1, "section": STEEL, "element": "nonlocking"}
    one = model.add_beam("one", start=(0, 0, 0), end=(1, 0, 0), **given)
    two = model.add_beam("two", start=(1, 0, 0), end=(1, 1, 0), **given)
    model.clamp(one.start)
    model.weld(one.end, two.start)
    return model


def fixed_to_hub(model, body):
    beam = model.add_beam("beam", start=(1, 0, 0), end=(1, 0, -0.5), elements=1, section=ROPE)
    model.clamp(beam.start, to=body)


def guided(model, beam):
    model.guide(beam.end, axis=(1, 0, 0))


def bead(model, beam):
    mass = model.add_point_mass("bead", at=(0.4, 0, 0), mass=0.3)
    model.add_force(mass, (30.0, 0.0, 0.0), name="push")
    model.slide(mass, along=beam, name="it", viscous=0.5)


def winched():
    model = space()
    section = ancf.Section(EA=500.0, EI=0.05, rhoA=0.2)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(0.6, 0, -0.8), elements=3, section=section)
    model.pin(rope.start)
    model.winch(rope.start, length="1 - 0.1*sin(3*t)**2", name="it")
    return model


def crossed():
    model = space()
    for name, z, turned in (("low", 0.0, False), ("high", 0.019, True)):
        start = (0.4, -0.5, z) if turned else (0, 0, z)
        end = (0.4, 0.5, z) if turned else (1, 0, z)
        beam = model.add_beam(name, start=start, end=end, elements=2, section=ROPE)
        model.pin(beam.start)
        model.pin(beam.end)
    low, high = model.bodies.values()
    model.add_contact(low, high, stiffness=200.0, name="it")
    return model


def pressed(model, beam):
    surface = model.add_surface("ball", ancf.Sphere(radius=0.2, at=(0.5, 0, -0.209)))
    model.add_contact(beam, surface, stiffness=2000.0, name="it")


def balls():
    model = space()
    for name, z in (("low", 0.0), ("high", 0.198)):
        body = model.add_rigid_body(name, at=(0, 0, z), mass=0.5, inertia=(0.01, 0.01, 0.01))
        model.add_surface(f"{name} ball", ancf.Sphere(radius=0.1), on=body)
    model.add_contact("low ball", "high ball", stiffness=2000.0, name="it")
    return model


def stripped(model, beam):
    head = model.add_point_mass("head", at=(0.5, 0, -0.001), mass=0.4)
    model.add_spring(head, (0.5, 0, -1), stiffness=200.0, length=1.1, name="lift")
    model.pin(beam.end)
    model.add_contact(head, along=beam, stiffness=3000.0, name="it")


def turned(model, beam):
    model.clamp(beam.start, rotation="0.3*sin(5*t)", axis=(0, 1, 0), name="it")


def moved(model, beam):
    model.pin(beam.start, displacement=(0, "t**2", "0.1*sin(9*t)"), name="it")


def held(model, beam):
    model.hold(beam.start, position="xyz", displacement=(0, "t**2", "0.1*sin(9*t)"), name="it")


TORQUE = {"axis": (0, 1, 0), "stiffness": 4.0, "damping": 0.1, "angle": 0.5, "name": "it"}
#: Of each kind a model and numbers that act through it.
CASES = {
    "pin": (with_beam(moved, pinned=False), ["it.displacement", "beam.EI"]),
    "clamp": (with_beam(turned, pinned=False), ["it.rotation", "beam.EI"]),
    "hold": (with_beam(held, pinned=False), ["it.displacement"]),
    "winch": (winched, ["rope.EA", "rope.rhoA"]),
    "force": (with_beam(lambda m, b: m.add_force(b.end, (0, "3*t", "1 - vz"), name="it")), ["beam.rhoA"]),
    "moment": (with_beam(lambda m, b: m.add_moment(b.end, (0, 0.3, 0.2), name="it")), ["it.moment[1]"]),
    "distributed": (
        with_beam(lambda m, b: m.add_distributed_load(b, (0, 3, 0), between=(0.2, 0.7), name="it")),
        ["it.load[1]", "it.between[0]", "it.between[1]"],
    ),
    "follower_force": (
        with_beam(lambda m, b: m.add_follower_force(b.end, (1.0, 0.0, 2.0), name="it"), "nonlocking"),
        ["it.force[2]", "beam.rho"],
    ),
    "pressure": (
        with_beam(lambda m, b: m.add_pressure(b, 20.0, axis=(0, 1, 0), name="it")),
        ["it.pressure"],
    ),
    "spherical": (hub(lambda m, h: m.connect(h.at(-0.2, 0, 0), (0.8, 0, 0))), ["hub.mass", "hub.inertia"]),
    "hinge": (hub(lambda m, h: m.hinge(h.at(-0.2, 0, 0), (0.8, 0, 0), (0, 1, 0))), ["hub.mass"]),
    "cylindrical": (hub(lambda m, h: m.cylindrical(h, (1, 0, 0), (1, 1, 0))), ["hub.mass", "hub.inertia"]),
    "prismatic": (hub(lambda m, h: m.prismatic(h, (1, 0, 0), (1, 1, 0))), ["hub.mass"]),
    "planar": (hub(lambda m, h: m.planar(h, (1, 0, 0), (1, 1, 0))), ["hub.mass", "hub.inertia"]),
    "universal": (
        hub(lambda m, h: m.universal(h, (1, 0, 0), axis_a=(1, 0, 0), axis_b=(0, 1, 0))),
        ["hub.inertia"],
    ),
    "weld": (two_beams, ["one.E", "two.rho"]),
    "guide": (with_beam(guided, moves=False), ["beam.EI", "beam.rhoA"]),
    "fixation": (hub(fixed_to_hub), ["hub.mass", "beam.EI"]),
    "slide": (with_beam(bead, moves=False), ["bead.mass", "it.viscous"]),
    "spring": (
        with_beam(
            lambda m, b: m.add_spring(
                b.end, (1, 0.2, 0.5), stiffness=30.0, damping=0.4, length=0.4, name="it"
            )
        ),
        ["it.stiffness", "it.damping", "it.length", "it.b[2]"],
    ),
    "torsion_spring": (
        hub(lambda m, h: (m.hinge(h, (1, 0, 0), (0, 1, 0)), m.add_torsion_spring(h, (1, 0, 0), **TORQUE))),
        ["it.stiffness", "it.damping", "it.angle"],
    ),
    "contact": (with_beam(stripped), ["it.stiffness", "lift.length"]),
    "surface_contact": (with_beam(pressed), ["it.stiffness"]),
    "cable_contact": (crossed, ["it.stiffness"]),
    "body_contact": (balls, ["it.stiffness", "high.mass"]),
    "fluids": (
        with_beam(lambda m, b: m.add_fluid("it", density=1000.0, velocity=(0.5, 0.3, 0))),
        ["it.density", "beam.drag[0]", "beam.added_mass[0]"],
    ),
    "grounds": (
        with_beam(lambda m, b: m.add_ground("it", 0.002, stiffness=3000.0, damping=5.0)),
        ["it.stiffness", "it.damping"],
    ),
    "surfaces": (with_beam(pressed), ["beam.EI"]),
    "cable": (lambda: cable()[0], ["beam.EI", "beam.EA", "beam.rhoA", "beam.length", "beam.velocity[1]"]),
    "original": (lambda: cable("original")[0], ["beam.E", "beam.nu", "beam.diameter"]),
    "nonlocking": (lambda: cable("nonlocking")[0], ["beam.E", "beam.rho", "beam.nu"]),
}


def test_every_kind_has_a_case():
    words = {kind.word for kinds in GROUPS.values() for kind in kinds}
    assert set(CASES) == words | set(SURROUNDINGS) | set(ELEMENTS)


@pytest.mark.parametrize("word", CASES)
def test_numbers_of_every_kind_have_names(word):
    """What a model names as its numbers has values."""
    model = CASES[word][0]()
    assert all(np.isfinite(value_of(model, name)) for name in names_of(model))


def test_a_load_stays_on_its_body():
    model = CASES["distributed"][0]()
    with pytest.raises(ancf.ModelError, match=r"it.between\[1\]: is 0.2 to 1.1 m, must be"):
        varied(model, "it.between[1]", 1.1)


@pytest.mark.filterwarnings("ignore:.*the support wins")
@pytest.mark.parametrize("word", CASES)
def test_remainder(word):
    """|f(p + h) - f(p) - h f'| falls with the square of h over three decades, if there is any."""
    build, names = CASES[word]
    model = build()

    def states(other, **more):
        return ancf.simulate(other, t_end=0.01, step=2e-3, integrator=METHOD, **more)

    result = states(model, sensitivities=names)
    system = System(model)
    places = np.setdiff1d(np.arange(system.size), system.multipliers)  # those have the round-off of forces
    for name in names:
        own = result.sensitivity(name)
        slope = own.dq[:, places]
        moves = np.max(np.abs(slope)) * STEP * (abs(own.value) or 1.0)
        assert moves > 1e-8 * np.max(np.abs(result.q[:][:, places])), f"{name} does nothing"
        found = remainder_slopes(lambda m: states(m).q[:][:, places], model, name, slope, STEP, noise=3e-13)
        assert np.all(np.abs(found - 2.0) < 0.05), (name, found)
