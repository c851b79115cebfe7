"""Gradients through joints: the adjoint against forward sensitivities and differences, all formulations."""

import itertools

import numpy as np
import pytest
from backwards import apart, differences, differences_of, followed, forward
from jointed import arms, machine, methods

import ancf
from ancf.paper import sliding
from ancf.sensitivity import blocks
from ancf.sensitivity.adjoint import Adjoint
from ancf.sensitivity.adjoint_joints import JoinedAdjoint, adjoint_of
from ancf.solvers.status import SLOW
from ancf.system.system import System
from helpers import some
from slopes import extrapolated, remainder_slopes

ARMS = ["gravity", "hub.inertia", "arm.mass", "hub.mass", "hinge.b[2]"]
OF_ARMS = [
    "integral(position(arm.centre)[2])",
    "integral(norm(multiplier(hinge))**2)",
    "last(velocity(arm.centre)[0]) + mean(t * multiplier(elbow)[2])",
    "integral(multiplier(elbow)[4]**2)",
]
PARTS = ["wire.EI", "wire.axial_damping", "hub.mass", "tip.mass", "gravity", "stay.length", "wire.start[1]"]
PARTS += ["coil.stiffness", "ring.viscous"]
OF_PARTS = [
    "integral(norm(velocity(bob))**2)",
    "integral(norm(multiplier(hinge))**2) + integral(norm(multiplier(clamp))**2)",
    "integral(normal_force(ring)[2]**2)",
    "last(position(tip)[2]) + 10 * last(arc_rate(bead)) + last(arc_length(ring))",
]
BEAMS = [f"{body}.{name}" for body in ("carrier", "slider") for name in ("E", "rho", "length")]
BEAMS += ["tip.mass", "gravity[2]"]


@pytest.fixture(autouse=True)
def backwards_alone(monkeypatch, request):
    """No gradient of these tests may go forwards, but that which is about it."""
    if request.function is not test_what_it_cannot_solve_goes_forwards:
        monkeypatch.setattr("ancf.design.gradient._forward", None)


def settings(method, steps=31):
    return {"t_end": 1e-3 * steps + 4e-4, "step": 1e-3, "integrator": method}


@pytest.mark.parametrize("method", some([*methods()]))
@pytest.mark.parametrize("text", OF_ARMS)
def test_rows(text, method):
    """Hinges and rigid bodies, by numbers of masses and of the rows themselves."""
    model, given = arms(), settings(methods()[method])
    _, slope = ancf.gradient(model, text, ARMS, **given)
    assert apart(model, slope, forward(model, text, ARMS, **given)) < 5e-10


@pytest.mark.parametrize("method", some([*methods()]))
@pytest.mark.parametrize(
    "sliding", [{}, {"friction": 0.4, "friction_velocity": 0.2}, {"release": (0, 1, 0)}, {"damped": False}]
)
def test_mechanisms(sliding, method):
    """Damped cables, clamps, local axes, a driven support, sliding joints with mass and friction."""
    model, given = machine(**sliding), settings(methods()[method])
    chosen = {"trapezoidal ggl": OF_PARTS, "generalized index3": OF_PARTS[:3]}
    names = [name for name in PARTS if sliding.get("damped", True) or "damping" not in name]
    wanted = followed(model, names, **given)
    for text in chosen.get(method, OF_PARTS[::3]):
        _, slope = ancf.gradient(model, text, names, **given)
        assert apart(model, slope, wanted(text)) < 3e-7, text


@pytest.mark.parametrize("method", ["trapezoidal index2", "generalized index3", "trapezoidal index1"])
def test_against_differences(method):
    names, given = ["wire.EI", "hub.mass", "gravity"], settings(methods()[method])
    wanted = differences_of(machine(), names, **given)
    for text in OF_PARTS[:3]:
        _, slope = ancf.gradient(machine(), text, names, **given)
        assert apart(machine(), slope, wanted(text)) < 1e-9, text


def test_shifted_positions_against_differences():
    """GGL of rigid bodies; that the shifts go through the factors of a step is a part of the derivative."""
    names, given = ["hub.inertia", "gravity", "arm.mass"], settings(methods()["trapezoidal ggl"])
    wanted = differences_of(arms(), names, **given)
    for text in OF_ARMS:
        _, slope = ancf.gradient(arms(), text, names, **given)
        assert apart(arms(), slope, wanted(text)) < 3e-8, text


@pytest.mark.parametrize("method", ["trapezoidal index2", "generalized index3"])
def test_example_of_the_paper(method):
    """Example 7.4, while the joint slides over an end of an element, against differences."""
    model, text = sliding.build(4, 1), "integral(norm(velocity(slider.end))**2) + last(arc_length(joint))"
    given = {"t_end": 0.2, "step": 2e-3, "integrator": methods()[method]}
    _, slope = ancf.gradient(model, text, BEAMS, **given)
    wanted = differences(model, text, BEAMS, **given)
    for name in BEAMS:  # each by itself; steps that end with a tolerance differ by more
        assert abs(slope[name] - wanted[name]) < 1e-7 * abs(wanted[name]), name


@pytest.mark.parametrize("name", ["hub.inertia", "gravity", "arm.mass"])
def test_taylor(name):
    """What a derivative leaves falls with the square of the change."""
    given = settings(methods()["generalized index2"])
    _, slope = ancf.gradient(arms(), OF_ARMS[1], [name], **given)

    def value(model):
        return ancf.gradient(model, OF_ARMS[1], [], **given)[0]

    found = remainder_slopes(value, arms(), name, slope[name], noise=1e-12)
    assert len(found) == 0 or np.all(np.abs(found - 2.0) < 0.05)


@pytest.mark.parametrize("steps", [1, 2, 7, 8, 17])
def test_any_number_of_steps(steps):
    """Multipliers of a step begin with those of later ones, of which the last step has none."""
    model, given = machine(), settings(methods()["trapezoidal ggl"], steps)
    _, slope = ancf.gradient(model, OF_PARTS[1], PARTS, **given)
    assert apart(model, slope, forward(model, OF_PARTS[1], PARTS, **given)) < 3e-10


def test_steps_taken_again_give_the_same(monkeypatch):
    given = settings(ancf.Trapezoidal(), 90)
    first = ancf.gradient(machine(), OF_PARTS[1], PARTS, **given)
    monkeypatch.setattr(blocks, "KEPT", 0.0)
    again = ancf.gradient(machine(), OF_PARTS[1], PARTS, **given)
    assert again[0] == first[0]
    assert again[1] == pytest.approx(first[1], rel=1e-10)


def test_from_an_equilibrium():
    model, names = sliding.build(4, 1), ["carrier.E", "tip.mass", "carrier.length"]
    text, given = "integral(norm(velocity(slider.end))**2)", settings(methods()["generalized index3"])

    def value(other, names=()):
        start = ancf.equilibrium(other, of=["carrier"], sensitivities=names)
        return ancf.gradient(other, text, names, start=start, **given)

    _, slope = value(model, names)
    wanted = {name: extrapolated(lambda m: value(m)[0], model, name, 2e-2) for name in names}
    assert apart(model, slope, wanted) < 2e-9


def chain(links):
    """Rigid bodies on hinges in a row, whose factors have lost digits at its end."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    bodies = [
        model.add_rigid_body(f"b{k}", at=(k + 0.5, 0, 0), mass=1.0, inertia=(0.01, 0.1, 0.1))
        for k in range(links)
    ]
    model.hinge(bodies[0].at(-0.5, 0, 0), (0.0, 0.0, 0.0), axis=(0, 1, 0), name="first")
    for mine, other in itertools.pairwise(bodies):
        model.hinge(mine.at(0.5, 0, 0), other.at(-0.5, 0, 0), axis=(0, 1, 0))
    return model


@pytest.mark.parametrize("links", [3, 10])
@pytest.mark.parametrize("method", ["trapezoidal ggl", "generalized index3"])
def test_chains(links, method):
    """Round-off of multipliers that hardly count does not keep corrections from their end."""
    model, names, given = chain(links), ["b0.mass", "b2.mass", "gravity[2]"], settings(methods()[method], 300)
    for text in (f"integral(position(b{links - 1}.centre)[2])", "integral(norm(multiplier(first))**2)"):
        _, slope = ancf.gradient(model, text, names, **given)
        assert apart(model, slope, forward(model, text, names, **given)) < 1e-10, text


def test_what_it_cannot_solve_goes_forwards(monkeypatch):
    given = settings(methods()["trapezoidal ggl"])
    wanted = forward(arms(), OF_ARMS[0], ARMS, **given)
    monkeypatch.setattr(JoinedAdjoint, "_back", lambda *_: SLOW)
    _, slope = ancf.gradient(arms(), OF_ARMS[0], ARMS, **given)
    assert slope == pytest.approx(wanted, rel=1e-12)


def drawn(t, r, v):
    """A law that numba does not compile."""
    return [0.0, float(str(0.3 * t)), 0.0]


def test_which_models_have_one():
    """Rows of joints, but nothing that differences are taken of, and no joint that has come to an end."""
    assert adjoint_of(System(arms())) is JoinedAdjoint
    assert adjoint_of(System(machine())) is JoinedAdjoint
    assert adjoint_of(System(sliding.build())) is JoinedAdjoint
    model = machine()
    model.add_moment(model.bodies["hub"], (0.0, "0.1*t", 0.0), name="turn")
    assert adjoint_of(System(model)) is JoinedAdjoint
    model.add_force(model.bodies["hub"], drawn)
    assert adjoint_of(System(model)) is None
    hung = ancf.Model(gravity=(0.0, 0.0, -9.81))
    rope = hung.add_beam(
        "rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=9.0, EI=1.0, rhoA=1.0)
    )
    hung.clamp(rope.start)
    assert adjoint_of(System(hung)) is Adjoint
    ended = System(sliding.build())
    ended.parts["slides"].mode[:] = 1
    assert adjoint_of(ended) is None
