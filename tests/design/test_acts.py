"""Systems around a number of a model that share what it does not act on, against systems made anew."""

import warnings

import numpy as np
import pytest

import ancf
from ancf.contact.rows import WORKSPACE
from ancf.model.sections.section import DAMPINGS
from ancf.model.vary import names_of, renewal, value_of, varied
from ancf.sensitivity.acts import acts_of
from ancf.sensitivity.alike import OWN, differ
from ancf.sensitivity.family import Family
from ancf.sensitivity.parameters import parameters_of
from ancf.solvers.checkpoint import distinct
from ancf.system.beside import beside
from ancf.system.system import System


def hung():
    """Two cables with dampings, a mass, springs between them and to the ground, forces, a turned clamp."""
    model = ancf.Model(gravity=(0.3, 0.2, -9.81))
    section = ancf.Section(
        EA=1e4, EI=2.0, rhoA=0.3, axial_damping=1.0, bending_damping=0.01, damping=0.02, rotary_inertia=0.001
    )
    model.add_beam("a", start=(0, 0, 0), end=(2, 0.5, 0), elements=9, section=section)
    plain = ancf.Section(EA=2e4, EI=1.0, rhoA=0.2)
    model.add_beam("b", start=(0, 1, 0), end=(2, 1, 0.5), elements=4, section=plain)
    model.add_point_mass("m", at=(3, 1, 0), mass=2.0)
    a, b = model.beams["a"], model.beams["b"]
    model.clamp(a.start)
    model.pin(b.start, displacement=("0", "0", "0.1*t"))
    model.add_spring(a.at(0.7), b.at(1.3), stiffness=20.0, damping=0.1, length=0.9, name="between")
    model.add_spring(b.end, "m", stiffness=30.0, length=0.8, name="mass spring")
    model.add_spring(a.end, (2, 0.5, 2), stiffness=5.0, length=1.0, name="up")
    model.add_force(a.at(1.1), (0, 0, "-sin(t)"), name="push")
    model.add_moment(b.end, (0, "0.1*sin(t)", 0), name="turn")
    model.add_distributed_load(b, (0, 0, -0.5), name="snow")
    return model


def jointed():
    """A cable and a solid beam in a hinge, with a moment: little is known of lengths and places."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=0.3)
    a = model.add_beam("a", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
    solid = ancf.Section.rectangle(width=0.1, height=0.1, E=1e6, rho=500.0, nu=0.3)
    b = model.add_beam("b", start=(1, 0, 0), end=(2, 0, 0), elements=2, section=solid)
    model.pin(a.start)
    model.connect(a.end, b.start)
    model.add_moment(b.at(0.5), (0, 1.0, 0))
    return model


def arrays(system):
    found = distinct({"parts": system.parts, "dead": system.dead._asdict()})
    found |= distinct({"supports": system.supports._asdict()})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # supports hold against motions that are asked for
        q, v = system.initial_state(0.3)
    table = system.inputs.tables(0.0, 0.1, 3, 0.0, 1.0)
    found |= {"q": q, "v": v, "motion": table.motion, "rotation": table.rotation}
    return {key: array for key, array in found.items() if key.rsplit(".", 1)[-1] not in (*OWN, *WORKSPACE)}


def slid():
    """Two cables, one of which slides on the other, with a mass that is tied to it."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=0.3)
    a = model.add_beam("a", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=section)
    b = model.add_beam("b", start=(1, 0, 0), end=(1, 0, 1), elements=2, section=section)
    model.pin(a.start)
    model.pin(a.end)
    model.slide(b.start, along=a, friction=0.2, friction_velocity=0.1, release=(0, 1, 0))
    model.connect(model.add_point_mass("m", at=(1, 0, 1), mass=0.5), b.end)
    return model


def drowned(elements=5, waves=None):
    """A cable that hangs from the air into water, and another one, a buoy and a solid beam in it."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    hull = {"diameter": 0.05, "drag": (1.2, 0.1), "added_mass": (1.0, 0.2)}
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=3.0, axial_damping=1.0, **hull)
    model.add_beam("a", start=(0, 0, -9), end=(2, 0, 1), elements=elements, section=section, length=10.4)
    thin = ancf.Section(EA=1e4, EI=2.0, rhoA=3.0, diameter=0.03, drag=(1.0, 0.0))
    model.add_beam("b", start=(5, 0, -9), end=(6, 0, -8), elements=2, section=thin)
    solid = ancf.Section.rectangle(width=0.1, height=0.1, E=1e6, rho=500.0, **hull)
    model.add_beam("c", start=(8, 0, -9), end=(8, 2, -8), elements=3, section=solid)
    model.add_moment(model.beams["c"].end, (0, "sin(t)", 0))
    model.add_point_mass("buoy", at=(9, 0, -1), mass=1.0, volume=0.02, drag_area=0.1, added_mass=0.5)
    model.pin(model.beams["a"].start)
    model.pin(model.beams["a"].end, displacement=("0.2*sin(t)", 0.0, 0.0))
    model.add_fluid("air", density=1.2, velocity=(8.0, 0, 0), above=0.0, on=["a"])
    model.add_fluid("sea", density=1025.0, velocity=(0.6, 0.2, 0.0), below=0.0, waves=waves)
    return model


def laid():
    """Two cables on a seabed with friction, under pressures, over which a third one with a mass crosses."""
    model = ancf.Model(gravity=(0.1, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=0.3, diameter=0.04, damping=0.1)
    a = model.add_beam("a", start=(0, 0, 0), end=(2, 0.5, 0.1), elements=5, section=section)
    b = model.add_beam("b", start=(1, -1, 0.1), end=(1, 1, 0.2), elements=3, section=section, length=2.1)
    model.add_beam("c", start=(5, 0, 0.01), end=(7, 0, 0), elements=2, section=section)
    m = model.add_point_mass("m", at=(1, 1, 0.2), mass=0.5)
    model.pin(a.start)
    model.add_ground("bed", height=0.0, stiffness=2e4, damping=20.0, friction=0.3, on=["a", "c"])
    model.add_ground("rock", height=-0.1, stiffness=4e4, on=["b"])
    model.add_pressure(a, "4*sin(3*t)", (0, 1, 0), name="wind")
    model.add_pressure(b, 2.0, (1, 0, 0))
    model.add_spring(b.end, m, stiffness=30.0, length=0.1)
    model.add_contact(a, b, stiffness=1e4, damping=3.0, radius=0.02, name="touch")
    return model


def piled():
    """Two balls on a plane, tied to a cable that a third one may touch."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    below = model.add_surface("floor", ancf.Plane())
    for k in range(2):
        at = 0.01 * k, 0.0, 0.1 + 0.2 * k
        ball = model.add_rigid_body(f"b{k}", at=at, mass=0.5, inertia=(0.002, 0.003, 0.004))
        skin = model.add_surface(f"skin{k}", ancf.Sphere(radius=0.1), on=ball)
        model.add_contact(skin, below, stiffness=2e4, damping=30.0, name=f"on{k}")
        below = skin
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=0.3, diameter=0.02)
    a = model.add_beam("a", start=(0, 0, 1), end=(0, 0.5, 1), elements=3, section=section)
    model.add_spring(a.start, model.bodies["b1"].centre, stiffness=10.0, length=0.5)
    return model


def wrapped():
    """A cable and a solid beam over a drum that turns with a body, on a plane with friction."""
    model = ancf.Model(gravity=(0, 0.2, -9.81))
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=0.3, diameter=0.02)
    a = model.add_beam("a", start=(0, 0, 0), end=(1, 0.02, 0), elements=5, section=section, length=1.03)
    solid = ancf.Section.rectangle(width=0.02, height=0.02, E=1e8, rho=500.0)
    b = model.add_beam("b", start=(0, 0.5, 0), end=(1, 0.5, 0), elements=2, section=solid)
    block = model.add_rigid_body("block", at=(0.5, 0, -0.22), mass=0.3, inertia=(2e-3, 3e-3, 2e-3))
    drum = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0, 1, 0)), on=block)
    floor = model.add_surface("floor", ancf.Plane(at=(0, 0, -0.02), normal=(0, 0, 1)))
    model.add_contact(a, drum, stiffness=2e4, damping=3.0, friction=0.3, name="over")
    model.add_contact(b, drum, stiffness=1e4, radius=0.01, name="smooth")
    model.add_contact(b, floor, stiffness=1e4, friction=0.2, radius=0.01, name="on")
    model.pin(a.start)
    model.clamp(b.start)
    return model


def lined():
    """The first two of them on the seabed, without what crosses it."""
    model = laid()
    model.connections = model.connections[:-1]
    return model


def striped():
    """A wire and a collector whose strip touches it."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e5, EI=2.0, rhoA=1.0)
    a = model.add_beam("a", start=(0, 0, 0), end=(8, 0, 0), elements=4, section=section)
    m = model.add_point_mass("m", at=(1, 0, -0.001), mass=4.0)
    model.add_contact(m, a, stiffness=5e3, damping=30.0, strip=(0, 1, 0), normal=(0, 0, 1), name="strip")
    return model


def reeled():
    """A cable that a winch shortens, and another one beside it."""
    model = ancf.Model(gravity=(0.3, 0.2, -9.81))
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=0.3, damping=0.1)
    a = model.add_beam("a", start=(0, 0, 0), end=(0, 0, -2), elements=4, section=section)
    b = model.add_beam("b", start=(1, 0, 0), end=(1, 0, -2), elements=3, section=section)
    m = model.add_point_mass("m", at=(0, 0, -2), mass=2.0)
    model.pin(a.start)
    model.pin(b.start)
    model.winch(a.start, length="2 - 0.1*t", name="drum")
    model.connect(m, a.end)
    model.add_spring(b.end, m, stiffness=30.0, length=0.8, name="between")
    return model


def turned():
    """A cable with a moment between its ends, in an element: its place there goes with the length."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=0.3)
    a = model.add_beam("a", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
    model.pin(a.start)
    model.add_moment(a.at(0.4), (0, 1.0, 0))
    return model


def tied():
    """A cable that hangs in a ball joint in an element of another one, with no node in common."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=0.3)
    a = model.add_beam("a", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
    b = model.add_beam("b", start=(0.4, 0, 0), end=(0.4, 0, -1), elements=3, section=section)
    model.pin(a.start)
    model.connect(a.at(0.4), b.start)
    return model


def gripped():
    """Cables that rub on each other, and a ball that rolls."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=0.3, diameter=0.04)
    a = model.add_beam("a", start=(0, 0, 1), end=(2, 0, 1), elements=4, section=section)
    b = model.add_beam("b", start=(1, -1, 1.03), end=(1, 1, 1.03), elements=3, section=section)
    model.add_contact(a, b, stiffness=1e4, damping=3.0, friction=0.2, name="grip")
    below = model.add_surface("floor", ancf.Plane())
    ball = model.add_rigid_body("ball", at=(0, 0, 0.1), mass=0.5, inertia=(0.002, 0.003, 0.004))
    skin = model.add_surface("skin", ancf.Sphere(radius=0.1), on=ball)
    model.add_contact(skin, below, stiffness=2e4, damping=30.0, friction=0.3, name="roll")
    return model


def rough():
    """The same in waves, which are as fast as gravity makes them."""
    return drowned(4, {"spectrum": "regular", "height": 0.5, "period": 5.0, "depth": 20.0})


#: Numbers of the cables on a seabed that are known.
LAID = (
    "a.length",
    "b.length",
    "c.length",
    "a.start[0]",
    "b.end[2]",
    "bed.height",
    "bed.friction",
    "rock.damping",
)
#: Numbers of all models that are known beside those of each.
KNOWN = {
    hung: ("a.velocity[1]", "a.length", "a.start[0]", "m.mass"),
    jointed: ("a.velocity[1]", "b.rho"),
    slid: ("a.velocity[1]", "a.length"),
    drowned: ("a.length", "a.start[0]", "a.drag[1]", "c.added_mass[0]", "a.diameter", "sea.density"),
    lined: (*LAID, "a.diameter"),
    laid: (*LAID, "touch.stiffness", "touch.damping"),
    striped: ("m.mass", "strip.stiffness", "strip.damping"),
    wrapped: ("a.length", "b.length", "a.diameter", "over.friction", "on.stiffness", "smooth.damping"),
    reeled: ("b.rhoA", "m.mass", "between.stiffness"),
    turned: ("a.velocity[1]",),
    tied: ("b.EI",),
    gripped: ("ball.mass",),
    piled: ("a.length", "a.start[0]", "a.diameter", "b1.mass", "on0.stiffness", "on1.damping"),
}
KNOWN[rough] = KNOWN[drowned]


@pytest.mark.parametrize("build", KNOWN)
def test_they_are_those_made_anew(build):
    model, seen = build(), []
    base = System(model)
    for name in names_of(model):
        acts = acts_of(model, name)
        if acts is None:
            continue
        seen.append(name)
        value = value_of(model, name)
        if value == 0.0 and name.rpartition(".")[2] in DAMPINGS:
            continue  # the elements stay where they are, see test_a_damping_of_zero_beside_another_one
        other = renewal(model, name)[1](1.01 * value + 0.001)
        mine, whole = arrays(beside(base, other, acts)), arrays(System(other, like=base))
        numbers = mine.pop("parts.rubbing.data", None)  # which systems made anew have in common
        assert numbers is None or np.array_equal(numbers, mine["parts.pressing.data"])
        assert mine.keys() == whole.keys()
        for key in mine:
            assert np.array_equal(mine[key], whole[key]), (name, key)
    assert set(KNOWN[build]) <= set(seen)
    for name in ("a.EA", "a.rhoA", "gravity[0]"):
        assert (name in seen) == (build is not reeled), name
    for name in ("a.length", "a.start[0]", "a.diameter"):
        assert (name in seen) == (name in KNOWN[build]), name


@pytest.mark.parametrize("name", ["a.length", "a.start[2]", "b.EI", "m.mass", "between.stiffness", "m.at[0]"])
def test_models_that_share_say_the_same(name):
    """Compiled, the model with all items copied and that which shares some are one."""
    model = hung()
    value = 1.02 * value_of(model, name) + 0.001
    shared, apart = renewal(model, name)[1](value), varied(model, name, value)
    mine, whole = arrays(System(shared)), arrays(System(apart))
    for key in mine:
        assert np.array_equal(mine[key], whole[key]), key
    assert model.bodies["a"] is not apart.bodies["a"]
    assert value_of(model, name) != value


def test_a_point_on_the_body_goes_with_it():
    model = hung()
    made = renewal(model, "a.length")[1](4.0)
    spring = next(one for one in made.connections if one.name == "between")
    assert spring.a.body is made.beams["a"]
    assert spring.a.x == pytest.approx(0.7 * 4.0 / model.beams["a"].length)
    assert spring.b.body is model.beams["b"]


def test_what_is_not_known():
    model = hung()
    assert acts_of(model, "a.EA") is not None
    assert acts_of(model, "push.force") is None
    assert acts_of(model, "between.slack") is None
    assert acts_of(jointed(), "a.length") is None
    assert acts_of(jointed(), "a.start[0]") is None


@pytest.mark.parametrize("build", [drowned, rough])
def test_what_fluids_keep_is_no_number_of_them(build):
    """An end of a cable changes nothing of a fluid whatever these keep for themselves."""
    model = build()
    base = System(model)
    apart = base.parts["fluid"]
    apart.angle[...], apart.numbers[...] = 0.3, 0.2
    for name, acted in (("a.start[0]", set()), ("sea.density", {"fluid"}), ("a.drag[0]", {"fluid"})):
        [parameter] = parameters_of(model, [name], "here")
        other = System(renewal(model, name)[1](1.001 * parameter.value + 1e-3), like=base)
        assert differ(apart, other.parts["fluid"]) == bool(acted)
        assert Family(parameter, base).changed == acted
