"""Gradients through loads, grounds, contacts and damped beams: the adjoint against forward sensitivities."""

import pytest
from backwards import apart, differences, forward
from jointed import arms, methods

import ancf
from ancf.sensitivity.adjoint import Adjoint
from ancf.sensitivity.adjoint_joints import JoinedAdjoint, adjoint_of
from ancf.sensitivity.adjoint_sloped import SlopedAdjoint
from ancf.system.system import System

TIGHT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14, modified=False))
METHODS = [TIGHT, ancf.GeneralizedAlpha(rho_inf=0.7, newton=TIGHT.newton)]
TIP = "integral(norm(velocity(beam.end))**2)"
OF_CABLE = ["beam.EI", "beam.rhoA", "gravity[2]", "beam.length"]
OF_BAR = ["beam.E", "beam.rho", "gravity[2]", "beam.length"]
LAW = ("-0.3*x*vx + sin(2*y)", "exp(0.3*z)*vy - 0.2*x**2", "0.1*vx*vz - z**3")
STRIP = {"strip": (0.0, 1.0, 0.0), "normal": (0.0, 0.0, 1.0), "name": "strip"}
OF_LINE = ["wire.EA", "wire.rhoA", "head.mass", "lift.stiffness", "strip.stiffness", "dropper2.length"]


@pytest.fixture(autouse=True)
def backwards_alone(monkeypatch):
    """No gradient of these tests may go forwards."""
    monkeypatch.setattr("ancf.design.gradient._forward", None)


def settings(method=TIGHT, steps=40, step=1e-3):
    return {"t_end": steps * step, "step": step, "integrator": method}


def agree(model, text, names, given, off=1e-9):
    _, slope = ancf.gradient(model, text, names, **given)
    assert apart(model, slope, forward(model, text, names, **given)) < off


def cable(elements=3, **damping):
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, diameter=0.02, **damping)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
    model.pin(beam.start)
    return model, beam


def bar(element="nonlocking", elements=2, **damping):
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section.rectangle(0.1, 0.05, E=1e8, rho=900.0, **damping)
    given = {"start": (0, 0, 0), "end": (1.2, 0.3, 0), "elements": elements, "section": section}
    beam = model.add_beam("beam", element=element, **given)
    model.clamp(beam.start)
    return model, beam


def with_moment():
    model, beam = cable()
    model.add_moment(beam.end, (0.0, "0.4*sin(20*t)", 0.1), name="turn")
    return model, OF_CABLE


def with_section_moment():
    model, beam = bar()
    model.add_moment(beam.end, (80.0, "90*sin(50*t)", 50.0), name="turn")
    return model, OF_BAR


def with_follower():
    model, beam = cable()
    model.add_follower_force(beam.end, ("2*cos(9*t)", 0.0, 0.0), name="jet")
    return model, OF_CABLE


def with_section_follower():
    model, beam = bar()
    model.add_follower_force(beam.end, (-300.0, 100.0, 50.0), name="jet")
    return model, [*OF_BAR, "jet.force[0]"]


def with_pressure():
    model, beam = cable(damping=0.1)
    model.add_pressure(beam, "3*sin(30*t)", (0.0, 1.0, 0.0))
    return model, OF_CABLE


def with_laws():
    model, beam = cable()
    model.add_force(beam.end, LAW)
    model.add_distributed_load(beam, LAW)
    return model, OF_CABLE


LOADS = [with_moment, with_section_moment, with_follower, with_section_follower, with_pressure, with_laws]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("made", LOADS)
def test_loads(made, method):
    """Closed forms both ways, of laws differences of order four."""
    (model, names), given = made(), settings(method)
    assert adjoint_of(System(model)) is SlopedAdjoint
    _, slope = ancf.gradient(model, TIP, names, **given)
    assert apart(model, slope, differences(model, TIP, names, 1e-2, **given)) < 3e-9
    assert apart(model, slope, forward(model, TIP, names, **given)) < 1e-9


@pytest.mark.parametrize("method", ["trapezoidal ggl", "generalized index2", "generalized index3"])
def test_loads_beside_joints(method):
    """A moment in fixed axes and a follower force on bodies on hinges."""
    model = arms()
    model.add_moment(model.bodies["hub"], (0.2, "0.3*sin(9*t)", 0.1))
    model.add_follower_force(model.bodies["arm"].at(0.3, 0, 0), (0.0, 1.0, 2.0), name="jet")
    assert adjoint_of(System(model)) is JoinedAdjoint
    text = "integral(position(arm.centre)[2]) + integral(norm(multiplier(elbow))**2)"
    agree(
        model,
        text,
        ["gravity[2]", "hub.inertia", "arm.mass", "jet.force[1]"],
        settings(methods()[method]),
        3e-9,
    )


def test_grounds():
    """On the branch of each step, against small differences of runs; forward ones reach over its kink."""
    model, _ = cable()
    model.add_ground("floor", height=-0.003, stiffness=2e4, damping=300.0)
    assert adjoint_of(System(model)) is SlopedAdjoint
    names, given = ["beam.EI", "gravity[2]", "floor.stiffness", "floor.damping"], settings(steps=60)
    _, slope = ancf.gradient(model, TIP, names, **given)
    assert apart(model, slope, differences(model, TIP, names, 1e-5, **given)) < 1e-7


def contact_line(stiffness=5e3, damping=30.0, elements=6, **more):
    """A tight wire on droppers, and a collector on a spring that goes along it."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e5, EI=2.0, rhoA=1.0, damping=0.05)
    given = {"start": (0, 0, 0), "end": (6, 0, 0), "elements": elements, "length": 5.95}
    wire = model.add_beam("wire", section=section, **given)
    model.pin(wire.start)
    model.pin(wire.end)
    for k in range(5):
        dropper = {"stiffness": 2e3, "length": 0.49, "damping": 1.0, "name": f"dropper{k}"}
        model.add_spring(wire.at((1.0 + k) * 5.95 / 6), (1.0 + k, 0, 0.5), **dropper)
    head = model.add_point_mass("head", at=(1.037, 0, 0.001), mass=4.0)
    foot = model.add_point_mass("foot", at=(1.037, 0, -0.5), mass=1.0)
    model.pin(foot, displacement=("20*t", 0, 0))
    model.hold(head, position="xy", displacement=("20*t", 0, 0))
    model.add_spring(head, foot, stiffness=300.0, length=0.75, damping=10.0, name="lift")
    model.add_contact(head, wire, stiffness=stiffness, damping=damping, **STRIP, **more)
    return model


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("damping", "step"), [(30.0, 1e-3), (0.0, 2e-3)])
def test_contacts(damping, step, method):
    """Of a strip with a wire on droppers, which opens and closes, stiff beside the masses of a step."""
    model, given = contact_line(5e4, damping), settings(method, step=step)
    assert adjoint_of(System(model)) is SlopedAdjoint
    agree(model, "integral(norm(velocity(wire.at(3)))**2) + mean(position(head)[2])", OF_LINE, given, 1e-9)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("stiffness", [5e5, 5e6])
def test_forwards_along_a_stiff_strip(stiffness, method):
    """Far stiffer than what holds it: the contact is not in the matrix of a step."""
    model, text = contact_line(stiffness), "integral(norm(velocity(head))**2) + mean(position(head)[2])"
    agree(model, text, OF_LINE, settings(method), 1e-9)


@pytest.mark.parametrize("stiffness", [5e3, 5e4])
def test_contacts_against_differences(stiffness):
    """Of runs whose parameters change so little that no contact opens in another step."""
    names, given = ["head.mass", "lift.stiffness", "strip.stiffness"], settings()
    model, text = contact_line(stiffness), "integral(norm(velocity(head))**2)"
    _, slope = ancf.gradient(model, text, names, **given)
    assert apart(model, slope, differences(model, text, names, 1e-5, **given)) < 3e-7


@pytest.mark.parametrize("method", ["trapezoidal index1", "trapezoidal ggl", "generalized index2"])
@pytest.mark.parametrize(("stiffness", "damping", "elements"), [(5e3, 30.0, 6), (5e4, 0.0, 4)])
def test_contacts_beside_joints(stiffness, damping, elements, method):
    """A body hangs from the collector in a ball joint: the contact opens, closes and is stiff."""
    model = contact_line(stiffness, damping, elements)
    head = model.bodies["head"]
    bob = model.add_rigid_body("bob", at=(1.037, 0, -0.3), mass=0.5, inertia=(0.02, 0.03, 0.01))
    model.connect(head, bob.at(0, 0, 0.301), name="ball")
    for body in (head, bob):
        body.set_motion(velocity=(20.0, 0, 0))
    assert adjoint_of(System(model)) is JoinedAdjoint
    text = "integral(norm(velocity(head))**2) + mean(position(bob.centre)[2])"
    agree(model, text, ["bob.mass", *OF_LINE], settings(methods()[method]), 3e-8)


def fallen(stiffness, damping, elements):
    """A cable with a body at its end, which falls onto the ground."""
    model, beam = cable(elements)
    hub = model.add_rigid_body("hub", at=(1.1, 0, 0), mass=0.2, inertia=(1e-3, 1e-3, 1e-3))
    model.connect(beam.end, hub.at(-0.1, 0, 0), name="ball")
    model.add_ground("floor", height=-0.003, stiffness=stiffness, damping=damping)
    return model


@pytest.mark.parametrize("method", ["trapezoidal index2", "trapezoidal ggl", "generalized index3"])
@pytest.mark.parametrize(("stiffness", "damping", "elements"), [(2e4, 300.0, 3), (3e5, 10.0, 2)])
def test_grounds_beside_joints(stiffness, damping, elements, method):
    model = fallen(stiffness, damping, elements)
    assert adjoint_of(System(model)) is JoinedAdjoint
    names = ["floor.stiffness", "hub.mass", "beam.EI", "gravity[2]", "floor.damping"]
    given = settings(methods()[method], steps=60)
    _, slope = ancf.gradient(model, TIP, names, **given)
    assert abs(slope["floor.stiffness"]) * stiffness > 1e-3 * abs(slope["gravity[2]"]) * 9.81
    assert apart(model, slope, differences(model, TIP, names, 1e-5, **given)) < 1e-7


@pytest.mark.parametrize("element", ["original", "nonlocking"])
@pytest.mark.parametrize(
    "damping",
    [
        {"axial_damping": 5e3},
        {"bending_damping": 3.0},
        {"axial_damping": 5e3, "bending_damping": 3.0, "damping": 1.0},
    ],
)
def test_damped_solid_beams(damping, element):
    model, beam = bar(element, **damping)
    model.add_force(beam.end, (0.0, "300*sin(40*t)", "200*cos(30*t)"))
    assert adjoint_of(System(model)) is Adjoint
    agree(model, TIP, [*OF_BAR, *(f"beam.{name}" for name in damping)], settings(), 1e-8)


@pytest.mark.parametrize("damping", [0.05, 2.0])
def test_damped_torsion_springs(damping):
    """Between bodies on a hinge, and against the ground."""
    model = arms()
    hub, arm = model.bodies["hub"], model.bodies["arm"]
    model.add_torsion_spring(hub, arm, axis=(0, 1, 0.3), stiffness=3.0, damping=damping, name="coil")
    assert adjoint_of(System(model)) is JoinedAdjoint
    text = "integral(position(arm.centre)[2]) + integral(norm(multiplier(hinge))**2)"
    given = settings(methods()["generalized index2"])
    agree(
        model, text, ["gravity[2]", "hub.inertia", "arm.mass", "coil.damping", "coil.stiffness"], given, 3e-9
    )


@pytest.mark.parametrize("damping", [30.0, 0.0])
@pytest.mark.parametrize("quantity", ["contact_force", "contact_gap"])
def test_what_is_asked_of_contacts(quantity, damping):
    """Backwards by closed forms; forwards what is asked at stored times is differenced along the state."""
    model, text = contact_line(damping=damping), f"integral({quantity}(strip)**2)"
    names = ["head.mass", "lift.stiffness", "strip.stiffness", "wire.EA"]
    _, slope = ancf.gradient(model, text, names, **settings())
    assert apart(model, slope, forward(model, text, names, **settings())) < 1e-9
    assert apart(model, slope, differences(model, text, names, 1e-5, **settings())) < 3e-7


@pytest.mark.parametrize("stiffness", [5e3, 5e4])
@pytest.mark.parametrize("damping", [30.0, 0.0])
def test_forwards_where_a_head_grazes_the_wire(damping, stiffness):
    """In some steps less than a micrometre parts them, over which no difference may reach."""
    model, text = (
        contact_line(stiffness, damping),
        "last(position(head)[2]) + integral(norm(velocity(head))**2)",
    )
    names = ["head.mass", "strip.stiffness", "wire.EA"]
    wanted = differences(model, text, names, 1e-6, **settings())
    assert apart(model, forward(model, text, names, **settings()), wanted) < 1e-6
