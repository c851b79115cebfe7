"""Every question of a result has a derivative, or says why not: none that is new stays without an answer."""

import inspect
from functools import cache

import numpy as np
import pytest
from backwards import value_in
from jointed import NEWTON, machine

import ancf
from ancf.design.gradient import UNKNOWN
from ancf.results.result import Result
from ancf.results.state import State
from ancf.sensitivity.answers import Face
from ancf.viz.pictures.questions import CONTACT, JOINT, POINT, QUANTITIES, SLIDE, SPRING, SUPPORT, TORSION
from slopes import extrapolated, once

METHOD = ancf.GeneralizedAlpha(rho_inf=0.8, newton=NEWTON, formulation="index2")
GIVEN = {"t_end": 0.0124, "step": 1e-3, "integrator": METHOD}
#: What is no number of a state, and what draws, writes or describes.
OTHERS = {
    "animate",
    "compare",
    "contact_line",
    "derived",
    "fixed",
    "has_angle",
    "has_angles",
    "has_travel",
    "held_supports",
    "plot",
    "plot_shape",
    "rubs",
}
OTHERS |= {"save", "sensitivity", "slack_intervals", "state", "to_csv", "to_excel", "to_pandas", "to_xarray"}
OTHERS |= {"view", "input", "input_changes"}  # inputs are given


def twisting():
    """A rigid body on a hinge with a torsion spring."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    body = model.add_rigid_body("hub", at=(1, 0, 0), mass=0.8, inertia=(0.02, 0.03, 0.04))
    model.hinge(body.at(-0.2, 0, 0), (0.8, 0, 0), (0, 1, 0), name="hinge")
    model.add_torsion_spring(body, (1, 0, 0), axis=(0, 1, 0), stiffness=4.0, damping=0.1, name="coil")
    return model, ["hub.mass", "coil.stiffness"]


def guided():
    """A carriage on an inclined rail and a spring, and a body that hangs from it on a universal joint."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    cart = model.add_rigid_body("cart", at=(0, 0, 0), mass=1.2, inertia=(0.02, 0.03, 0.04))
    hung = model.add_rigid_body("hung", at=(0.1, 0.05, -0.3), mass=0.5, inertia=(0.01, 0.02, 0.02))
    model.prismatic(cart, (0, 0, 0), axis=(0.8, 0, 0.6), name="guide")
    arms = {"axis_a": (1, 0, 0), "axis_b": (0, 1, 0)}
    model.universal(hung.at(-0.1, -0.05, 0.2), cart.at(0, 0, -0.1), **arms, name="cross")
    model.add_spring(cart, (1, 0.2, 0.9), stiffness=30.0, damping=0.4, length=0.4, name="coil")
    return model, ["cart.mass", "coil.stiffness", "gravity"]


def beam():
    """A solid beam on a clamp and a spring, with a mass on a strip under it and a sphere below."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    steel = ancf.Section.circle(diameter=0.05, E=2e8, rho=2e3, nu=0.3)
    bar = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=steel, element="nonlocking"
    )
    model.clamp(bar.start, name="wall")
    model.add_moment(bar.end, (0.5, 0.2, 0.0))
    model.add_spring(bar.end, (1, 0.2, 0.5), stiffness=30.0, damping=0.4, length=0.4, name="coil")
    ball = model.add_surface("ball", ancf.Sphere(radius=0.2, at=(0.5, 0, -0.2245)))
    model.add_contact(bar, ball, stiffness=2000.0, name="strip")
    return model, ["beam.E", "beam.rho"]


def both():
    return machine(), ["wire.EI", "hub.mass"]


def winched():
    """A cable that a winch pays out: its material is that of other lengths at every step."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=500.0, EI=0.05, rhoA=0.2, axial_damping=0.1)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(0.6, 0, -0.8), elements=3, section=section)
    model.pin(rope.start)
    model.winch(rope.start, length="1 + 0.4*sin(30*t)**2")
    return model, ["rope.EA", "rope.rhoA"]


#: What quantities are asked of, by what they are asked of.
ITEMS = {
    POINT: (beam, "beam.at(0.7)"),
    SPRING: (both, "coil"),
    TORSION: (twisting, "coil"),
    CONTACT: (beam, "strip"),
    SLIDE: (both, "ring"),
    JOINT: (both, "hinge"),
    SUPPORT: (both, "anchor"),
}
#: Those that are asked of joints of a kind.
OF_KINDS = dict.fromkeys(("joint_angles", "joint_rates"), (guided, "cross"))
OF_KINDS |= dict.fromkeys(("joint_displacement", "joint_velocity"), (guided, "guide"))
CASES = [
    (name, noun)
    for name, question in QUANTITIES.items()
    for noun in ((CONTACT,) if CONTACT in question.nouns else question.nouns)
    if noun in ITEMS and not (noun == CONTACT and name == "arc_length")
]
#: A joint of every kind has a moment: on the ground, between bodies, of a cable.
JOINTS = ["hinge", "clamp"]


@cache
def runs(build):
    """Runs of models that are varied alike for all questions of one of them."""
    return once(lambda model: ancf.simulate(model, **GIVEN))


def agree(build, text, names):
    value, slope = ancf.gradient(build()[0], text, names, **GIVEN)
    for name in names:
        wanted = extrapolated(value_in(runs(build), text), build()[0], name, 2e-2)
        assert abs(slope[name] - wanted) < 1e-6 * abs(wanted) + 1e-12 * abs(value), (text, name)


@pytest.mark.parametrize(("quantity", "noun"), CASES)
def test_gradient_of_every_quantity(quantity, noun):
    build, item = OF_KINDS.get(quantity, ITEMS[noun])
    asked = f"{quantity}({item})"
    text = f"integral(norm({asked})**2)" if QUANTITIES[quantity].vector else f"integral({asked}**2)"
    model, names = build()
    if quantity in UNKNOWN:
        with pytest.raises(ancf.ModelError, match=rf"gradient.objective: {quantity}\({item}\) has no deriv"):
            ancf.gradient(model, text, names, **GIVEN)
    else:
        agree(build, text, names)


@pytest.mark.parametrize("quantity", ["position", "velocity", "slope", "tension", "strain", "curvature"])
def test_on_a_cable_with_a_winch(quantity):
    """By the material of the length at each time: of sensitivities, gradients, and what these are of."""
    point, (model, names) = "rope.at(0.3)", winched()
    result = ancf.simulate(model, sensitivities=names, sensors=[point], **GIVEN)
    for known in (result, result.sensors):
        values = getattr(known, quantity)(point)
        for name in names:

            def asked(one, here=known is result):
                run = ancf.simulate(one, sensors=[point], **GIVEN)
                return getattr(run if here else run.sensors, quantity)(point)

            wanted = extrapolated(asked, winched()[0], name, 2e-2)
            found = getattr(known.sensitivity(name), quantity)(point)
            assert np.max(np.abs(found - wanted)) < 1e-6 * np.max(np.abs(wanted)), name
    if quantity not in QUANTITIES:  # slopes are not asked by formulas
        return
    text = f"integral({quantity}({point})[0]**2)" if values.ndim > 1 else f"integral({quantity}({point})**2)"
    square = (values[:, 0] if values.ndim > 1 else values) ** 2
    value, _ = ancf.gradient(model, text, [], **GIVEN)
    assert value == pytest.approx(np.trapezoid(square, result.t), rel=1e-12)
    agree(winched, text, names)


@pytest.mark.parametrize("joint", JOINTS)
def test_moments_of_joints(joint):
    agree(both, f"integral(norm(joint_moment({joint}))**2)", ["wire.EI", "hub.mass", "gravity"])


@pytest.mark.parametrize("joint", JOINTS)
def test_moments_of_joints_forwards(joint):
    """Of the result, of what sensors recorded, and of the last state."""
    names = ["hub.mass"]
    result = ancf.simulate(machine(), sensitivities=names, sensors=[joint], **GIVEN)

    def moment(model):
        return ancf.simulate(model, **GIVEN).joint_moment(joint)

    wanted = extrapolated(moment, machine(), names[0], 2e-2)
    size = np.max(np.abs(wanted))
    own = result.sensitivity(names[0])
    assert np.max(np.abs(own.joint_moment(joint) - wanted)) < 1e-6 * size
    assert np.max(np.abs(own.state(-1).joint_moment(joint) - wanted[-1])) < 1e-6 * size
    recorded = result.sensors.sensitivity(names[0]).joint_moment(joint)
    assert np.max(np.abs(recorded - wanted)) < 1e-6 * size


def test_moment_of_a_clamp_at_rest():
    """Of an equilibrium, against differences of it."""
    state = ancf.equilibrium(beam()[0], sensitivities=["beam.rho"])
    found = state.sensitivity("beam.rho").reaction_moment("wall")
    wanted = extrapolated(lambda m: ancf.equilibrium(m).reaction_moment("wall"), beam()[0], "beam.rho", 2e-2)
    assert np.max(np.abs(found - wanted)) < 1e-6 * np.max(np.abs(wanted))


@pytest.mark.parametrize("kind", [Result, State])
def test_none_is_left_out(kind):
    """What a result or a state answers for an item, a sensitivity does too: a number or why not."""
    asked = {name for name, own in inspect.getmembers(kind) if callable(own) and not name.startswith("_")}
    assert {name for name in asked - OTHERS if not hasattr(Face, name)} == set()


@pytest.mark.parametrize(("question", "item"), [("reaction", "anchor"), ("reaction_moment", "anchor")])
def test_reactions_in_motion(question, item):
    """Of stored states, by the equations of motion of each; sensors have none."""
    result = ancf.simulate(machine(), sensitivities=["hub.mass"], sensors=[item], **GIVEN)
    found = getattr(result.sensitivity("hub.mass"), question)(item)
    assert found.shape == (len(result.t), 3)
    assert np.isfinite(found).all()
    with pytest.raises(ancf.ModelError, match=rf"sensitivity.{question}: .* stored states"):
        getattr(result.sensors.sensitivity("hub.mass"), question)(item)


def test_accelerations_of_states():
    """Those of the stored states are the rates of their velocities."""
    result = ancf.simulate(machine(), sensitivities=["hub.mass"], **{**GIVEN, "step": 1e-4})
    own = result.sensitivity("hub.mass")
    rates = np.gradient(own.velocity("bob"), result.t, axis=0)[5:-5]
    assert np.max(np.abs(own.acceleration("bob")[5:-5] - rates)) < 0.02 * np.max(np.abs(rates))
