"""Forward sensitivities of cables and bodies that touch: closed forms, against differences of runs.

Parameters of these change so little that nothing touches in another step.
"""

from dataclasses import replace

import numpy as np
import pytest
from backwards import apart, differences, forward
from jointed import methods

import ancf
from ancf.model.vary import value_of
from ancf.system.system import System
from helpers import some
from slopes import extrapolated, remainder_slopes

TIGHT = ancf.Newton(tolerance=1e-14, modified=False)
METHODS = [ancf.Trapezoidal(newton=TIGHT), ancf.GeneralizedAlpha(rho_inf=0.7, newton=TIGHT)]
D = 0.02
OF_CABLES = ["low.EI", "gravity[2]", "low.length", "low.diameter", "touch.stiffness", "touch.damping"]
FALL = "integral(norm(velocity(top.end))**2) + last(position(low.at(0.4))[2])"


def settings(method=METHODS[0], steps=50, step=1e-3):
    return {"t_end": steps * step, "step": step, "integrator": method}


def fallen(angle=1.5, stiffness=2e4, damping=30.0, elements=(3, 4), gap=3e-4, of_cable=0.0, count=1):
    """Cables that fall on one between two pins, each in its own place and turned."""
    model = ancf.Model(gravity=(0.0, 0.3, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, diameter=D, damping=of_cable)
    low = model.add_beam("low", start=(0, 0, 0), end=(1, 0.02, 0), elements=elements[0], section=section)
    model.pin(low.start)
    model.pin(low.end)
    for k in range(count):
        turn = angle - 0.6 * k
        at, way = np.array([0.45 + 0.3 * k, 0.02, D + gap]), 0.4 * np.array([np.cos(turn), np.sin(turn), 0.0])
        given = {"start": at - way, "end": at + way, "elements": elements[1], "section": section}
        top = model.add_beam("top" if k == 0 else f"top{k}", **given)
        top.set_motion(velocity=(0.0, 0.0, -1.0 - 0.1 * k))
        name = "touch" if k == 0 else f"touch{k}"
        model.add_contact(low, top, stiffness=stiffness * (1 + k), damping=damping, name=name)
    return model


def names_of(damping):
    return OF_CABLES if damping > 0.0 else OF_CABLES[:-1]


def agrees(model, text, names, given, change=1e-6, off=1e-7):
    """With differences; the contact has a part in it."""
    wanted, found = differences(model, text, names, change, **given), forward(model, text, names, **given)
    of = {name: abs(found[name] * value_of(model, name)) for name in names}
    assert of["touch.stiffness"] > 1e-4 * max(of.values())
    assert apart(model, found, wanted) < off


@pytest.mark.parametrize("method", METHODS, ids=["trapezoidal", "generalized"])
@pytest.mark.parametrize(
    ("angle", "stiffness", "damping", "elements"),
    some(
        [
            (1.5, 2e4, 30.0, (3, 4)),
            (1.0, 1e6, 30.0, (6, 5)),
            (0.3, 2e4, 0.0, (4, 3)),
            (1.5, 1e5, 0.0, (2, 6)),
            (1.5, 1e7, 300.0, (3, 4)),
        ]
    ),
)
def test_cables(angle, stiffness, damping, elements, method):
    """Central differences of their forces were up to 6e-6 off, and stiff ones were not solved at all."""
    model = fallen(angle, stiffness, damping, elements)
    agrees(model, FALL, names_of(damping), settings(method))


@pytest.mark.parametrize(("stiffness", "count"), some([(2e4, 2), (1e5, 3), (1e6, 2)]))
def test_several_cables(stiffness, count):
    model = fallen(stiffness=stiffness, count=count, of_cable=0.1)
    agrees(model, FALL, names_of(1.0), settings())


@pytest.mark.parametrize("method", ["trapezoidal index2", "trapezoidal ggl", "generalized index3"])
@pytest.mark.parametrize(
    ("stiffness", "damping", "count"),
    some([(1e5, 30.0, 1), (1e6, 300.0, 3), (1e8, 0.0, 2), (1e6, 0.0, 2)]),
)
def test_cables_beside_a_joint(stiffness, damping, count, method):
    """In stiff contacts corrections grow without their changes being mixed."""
    model = fallen(stiffness=stiffness, damping=damping, count=count)
    hub = model.add_rigid_body("hub", at=(0.6, 0.42, D), mass=0.2, inertia=(1e-3, 1e-3, 1e-3))
    top = model.bodies["top"]
    hub.set_motion(velocity=(0.0, 0.0, -1.0))
    model.connect(top.end, hub.at(*(top.end.initial_position - [0.6, 0.42, D])))
    agrees(model, FALL, names_of(damping), settings(methods()[method]))


@pytest.mark.parametrize("method", ["trapezoidal index1", "generalized index2"])
@pytest.mark.parametrize("stiffness", [1e5, 1e6])
@pytest.mark.parametrize("pair", ["balls", "on plane", "along capsule"])
def test_stiff_bodies_beside_a_joint(pair, stiffness, method):
    model = just_above(pair, 1.3e-3, stiffness=stiffness, damping=0.0)
    given = settings(methods()[method], steps=40, step=2e-4)
    agrees(model, ROLL, BODIES[:-1], given, 100.0 / stiffness)


def grazing(depth, step, **given):
    """The same, so high that in one of the first steps they touch by no more than this."""
    model = fallen(gap=0.02, **given)
    run = ancf.simulate(model, **settings(steps=step + 1), sensors=["touch"])
    return fallen(gap=0.02 - run.sensors.contact_gap("touch")[step] - depth, **given)


@pytest.mark.parametrize("damping", [0.0, 30.0])
@pytest.mark.parametrize("angle", [1.5, 0.4])
@pytest.mark.parametrize(("depth", "step"), [(1e-6, 2), (5e-7, 3), (5e-6, 5)])
def test_cables_that_graze(depth, step, angle, damping):
    """By some micrometres, over which no difference may reach."""
    model = grazing(depth, step, angle=angle, damping=damping, stiffness=1e5)
    agrees(model, FALL, names_of(damping), settings(steps=step + 4), 0.3 * depth)


@pytest.mark.parametrize("name", ["low.EI", "low.rhoA", "low.length", "touch.stiffness", "touch.damping"])
@pytest.mark.parametrize(("angle", "elements"), [(1.5, (3, 4)), (0.4, (4, 2))])
def test_remainders_of_cables(angle, elements, name):
    check_remainders(fallen(angle, elements=elements), name)


def check_remainders(model, name, step=1e-2, method=METHODS[0]):
    """They fall with the square of a change of a number."""
    given, system = settings(method, steps=12), System(model)
    places = np.setdiff1d(np.arange(system.size), system.multipliers)  # those have the round-off of forces

    def states(other):
        return ancf.simulate(other, **given).q[:][:, places]

    slope = ancf.simulate(model, sensitivities=[name], **given).sensitivity(name).dq[:, places]
    found = remainder_slopes(states, model, name, slope, step, noise=1e-14)
    assert len(found) > 0
    assert np.all(np.abs(found - 2.0) < 0.05)


BODIES = ["a.mass", "b.mass", "gravity[2]", "touch.stiffness", "touch.damping"]
ROLL = "integral(norm(position(b.centre))**2) + last(velocity(b.at(0.1, 0, 0))[0])"
TUBE = {"radius": 0.03, "length": 0.3, "axis": (1.0, 0.2, 0.0)}
#: What lies at z = 0 and below, and what falls on it from there.
PAIRS = {
    "balls": (ancf.Sphere(radius=0.1, at=(0, 0, -0.1)), ancf.Sphere(radius=0.05, at=(0.03, 0.02, 0.05))),
    "ball on capsule": (
        ancf.Capsule(radius=0.1, length=0.2, axis=(1, 0.2, 0), at=(0, 0, -0.1)),
        ancf.Sphere(radius=0.05, at=(0.03, 0.02, 0.05)),
    ),
    "ball on torus": (
        ancf.Torus(radius=0.2, tube=0.05, axis=(0, 0.1, 1), at=(0.2, 0, -0.05)),
        ancf.Sphere(radius=0.05, at=(0.0, 0.01, 0.05)),
    ),
    "on plane": (ancf.Plane(normal=(0.05, 0.02, 1.0)), ancf.Capsule(at=(0, 0, 0.035), **TUBE)),
    "on cylinder": (
        ancf.Cylinder(radius=0.1, axis=(0.2, 1.0, 0.1), at=(0, 0, -0.1)),
        ancf.Capsule(at=(0.03, 0, 0.03), **TUBE),
    ),
    "along capsule": (
        ancf.Capsule(radius=0.1, length=0.4, axis=(1.0, 0.19, 0.01), at=(0, 0, -0.1)),
        ancf.Capsule(at=(0.03, 0, 0.03), **TUBE),
    ),
    "in sheave": (
        ancf.Sheave(radius=0.1, groove=0.04, depth=0.06, angle=0.9, axis=(0.1, 1.0, 0.2), at=(0, 0, -0.1)),
        ancf.Capsule(at=(0.03, 0, 0.03), **TUBE),
    ),
}


def dropped(pair, stiffness=2e4, damping=30.0, height=3e-4):
    """A free body that falls on another one, which hangs in a ball joint and a spring."""
    below, above = PAIRS[pair]
    model = ancf.Model(gravity=(0.3, 0.0, -9.81))
    inertia = {"mass": 0.5, "inertia": (0.002, 0.003, 0.004)}
    a = model.add_rigid_body("a", at=(0, 0, -0.1), **inertia)
    b = model.add_rigid_body("b", at=(0.0, 0.0, 0.2 + height), **inertia)
    model.connect(a.at(-0.05, 0, 0), (-0.05, 0, -0.1))
    model.add_spring(a.at(0.2, 0, 0), (0.2, 0, -0.4), stiffness=200.0, length=0.2)
    b.set_motion(velocity=(0.02, 0, -0.5), angular_velocity=(0.2, 0.3, 0.3))
    low = model.add_surface("one", lifted(below, 0.1), on=a)
    top = model.add_surface("two", lifted(above, -0.2), on=b)
    model.add_contact(top, low, stiffness=stiffness, damping=damping, name="touch")
    return model


def lifted(shape, by):
    """The same shape higher."""
    return replace(shape, at=tuple(np.add(shape.place, (0, 0, by))))


def gap_at(model, step):
    run = ancf.simulate(model, **settings(steps=step + 1), sensors=["touch"])
    return run.sensors.contact_gap("touch")[step]


def just_above(pair, gap, step=0, **given):
    """The same at that gap when it begins, or in a step before which nothing touches."""
    height = 0.06
    for _ in range(3):
        height -= gap_at(dropped(pair, height=height, **given), step) - gap
    return dropped(pair, height=height, **given)


@pytest.mark.parametrize(
    ("method", "off"),
    some([("trapezoidal index1", 3e-8), ("generalized index2", 3e-8), ("generalized index3", 1e-6)]),
)
@pytest.mark.parametrize("pair", PAIRS)
def test_bodies(pair, method, off):
    """At index 3 the round-off of runs is larger."""
    model = just_above(pair, 1.3e-3)
    agrees(model, ROLL, BODIES, settings(methods()[method], steps=40), 1e-3, off)


@pytest.mark.parametrize(("depth", "step"), [(1e-6, 3), (1e-5, 2)])
@pytest.mark.parametrize("pair", some([*PAIRS]))
def test_bodies_that_graze(pair, depth, step):
    """By some micrometres in a step."""
    model = just_above(pair, -depth, step)
    given = settings(methods()["trapezoidal index2"], steps=step + 4)
    agrees(model, ROLL, BODIES, given, 100.0 * depth, 3e-8)


@pytest.mark.parametrize("name", ["b.mass", "touch.stiffness"])
@pytest.mark.parametrize("pair", PAIRS)
def test_remainders_of_bodies(pair, name):
    check_remainders(just_above(pair, 1.3e-3), name, 3e-3, methods()["trapezoidal index2"])


@pytest.mark.parametrize("name", ["low.EI", "low.diameter", "touch.stiffness"])
@pytest.mark.parametrize(("angle", "elements"), [(1.5, (4, 3)), (1.2, (5, 4)), (1.5, (3, 6))])
def test_equilibria_of_cables(angle, elements, name):
    """One hangs on the other: differences of their forces were up to 1e-7 off there, too."""
    model = fallen(angle, elements=elements, gap=-5e-4)
    top = model.bodies["top"]
    top.set_motion(velocity=(0.0, 0.0, 0.0))
    model.pin(top.start)
    model.pin(top.end)
    model.add_force(top.at(0.35), (0.0, 0.0, -3.0))
    found = ancf.equilibrium(model, sensitivities=[name]).sensitivity(name).position("low.at(0.5)")
    wanted = extrapolated(lambda m: ancf.equilibrium(m).position("low.at(0.5)"), model, name, 1e-4)
    assert np.max(np.abs(found - wanted)) < 5e-9 * np.max(np.abs(wanted))
