"""Gradients through contacts with surfaces: the adjoint against forward sensitivities and differences."""

import numpy as np
import pytest
from backwards import apart, differences, forward
from jointed import methods

import ancf
from ancf.sensitivity.adjoint_joints import JoinedAdjoint, adjoint_of
from ancf.sensitivity.adjoint_sloped import SlopedAdjoint
from ancf.system.system import System
from helpers import some

TIGHT = ancf.Newton(tolerance=1e-14, modified=False)
METHODS = [
    ancf.Trapezoidal(newton=TIGHT),
    ancf.GeneralizedAlpha(rho_inf=0.7, newton=TIGHT),
]
TIP = "integral(norm(velocity(beam.end))**2)"
NAMES = ["beam.EI", "gravity[2]", "touch.stiffness", "touch.damping", "beam.length", "touch.radius"]
GROOVE = {"radius": 0.1, "groove": 0.015, "depth": 0.03}
#: Surfaces on which the cable falls.
BELOW = {
    "plane": {"at": (0, 0, -0.0115), "normal": (0.0, 0.02, 1.0)},
    "cylinder": {"radius": 0.1, "axis": (0.1, 1.0, 0.05), "at": (0.5, 0, -0.113)},
    "can": {"radius": 0.1, "axis": (0.1, 1.0, 0.05), "length": 0.05, "at": (0.5, 0.03, -0.113)},
    "sphere": {"radius": 0.2, "at": (0.5, 0.03, -0.213)},
    "torus": {"radius": 0.3, "tube": 0.05, "axis": (0.0, 1.0, 0.1), "at": (0.5, 0.01, -0.36)},
    "sheave": GROOVE | {"axis": (-0.02, 1.0, 0), "at": (0.5, 0.01, -0.113)},
}


@pytest.fixture(autouse=True)
def backwards_alone(monkeypatch):
    """No gradient of these tests may go forwards."""
    monkeypatch.setattr("ancf.design.gradient._forward", None)


def settings(method=METHODS[0], steps=60):
    return {"t_end": steps * 1e-3, "step": 1e-3, "integrator": method}


def falling(shape, stiffness=2e4, damping=30.0, **damped):
    """A cable that falls on a surface."""
    model = ancf.Model(gravity=(0.0, 0.3, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, diameter=0.02, **damped)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0.02, 0), elements=4, section=section)
    model.pin(beam.start)
    below = model.add_surface("below", {"can": "cylinder"}.get(shape, shape), **BELOW[shape])
    model.add_contact(beam, below, stiffness=stiffness, damping=damping, name="touch")
    return model


@pytest.mark.parametrize(
    ("damped", "method"),
    [({}, METHODS[0]), ({"damping": 0.1, "bending_damping": 0.01}, METHODS[1])],
    ids=["trapezoidal", "damped generalized"],
)
@pytest.mark.parametrize("shape", BELOW)
def test_surfaces_at_rest(shape, damped, method):
    """Against differences of runs so small that no point begins to touch in another step."""
    model, given = falling(shape, **damped), settings(method)
    assert adjoint_of(System(model)) is SlopedAdjoint
    _, slope = ancf.gradient(model, TIP, NAMES, **given)
    assert abs(slope["touch.radius"]) * 0.01 > 1e-3 * abs(slope["gravity[2]"]) * 9.81
    assert apart(model, slope, differences(model, TIP, NAMES, 1e-6, **given)) < 1e-7


@pytest.mark.parametrize("shape", BELOW)
def test_as_forwards(shape):
    """Also where a point touches by some micrometres."""
    model, given = falling(shape), settings()
    _, slope = ancf.gradient(model, TIP, NAMES, **given)
    assert apart(model, slope, forward(model, TIP, NAMES, **given)) < 1e-9


@pytest.mark.parametrize("damping", [0.0, 300.0])
def test_stiff_surfaces(damping):
    model, given = falling("sphere", 1e6, damping), settings()
    names = [name for name in NAMES if damping or name != "touch.damping"]  # it may not be negative
    _, slope = ancf.gradient(model, TIP, names, **given)
    assert apart(model, slope, differences(model, TIP, names, 1e-7, **given)) < 1e-6


def over_a_pulley(shape="sheave", damping=30.0, stiffness=2e4):
    """A cable that falls on a surface which swings with its block on a hinge."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    block = model.add_rigid_body("block", at=(0.5, 0, -0.113), mass=0.3, inertia=(2e-3, 3e-3, 2e-3))
    model.hinge(block.at(0.02, 0, 0), (0.52, 0, -0.113), axis=(0, 1, 0.1), name="hinge")
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, diameter=0.02)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0.02, 0), elements=4, section=section)
    shapes = BELOW[shape] | {"at": (0.001, 0.01, 0)}
    on = model.add_surface("wheel", shape, on=block, **shapes)
    model.add_contact(beam, on, stiffness=stiffness, damping=damping, name="touch")
    model.pin(beam.start)
    return model


@pytest.mark.parametrize("method", some(["trapezoidal ggl", "trapezoidal index1", "generalized index2"]))
@pytest.mark.parametrize(("shape", "damping", "stiffness"), [("sheave", 30.0, 2e4), ("cylinder", 0.0, 1e5)])
def test_surfaces_on_bodies(shape, damping, stiffness, method):
    """A body on a hinge, whose surface a cable presses: both move."""
    model, given = over_a_pulley(shape, damping, stiffness), settings(methods()[method])
    assert adjoint_of(System(model)) is JoinedAdjoint
    names = [*NAMES, "block.mass", "block.inertia"]
    if damping == 0.0:
        names.remove("touch.damping")
    text = TIP + " + integral(norm(velocity(block.at(0.1, 0, 0)))**2)"
    _, slope = ancf.gradient(model, text, names, **given)
    assert apart(model, slope, forward(model, text, names, **given)) < 1e-5
    assert apart(model, slope, differences(model, text, names, 1e-6, **given)) < 1e-6


def test_taylor_remainders():
    """What is left of a change of the damping and of the stiffness is quadratic in it."""
    model, given, names = falling("sphere"), settings(), ["touch.stiffness", "touch.damping"]
    value, slope = ancf.gradient(model, TIP, names, **given)
    for name in names:
        p, left = ancf.model.vary.value_of(model, name), []
        for h in (1e-2, 5e-3, 2.5e-3):
            other = ancf.model.vary.varied(model, name, p * (1.0 + h))
            left.append(abs(ancf.gradient(other, TIP, [], **given)[0] - value - slope[name] * p * h))
        assert np.log2(left[0] / left[1]) > 1.9
        assert np.log2(left[1] / left[2]) > 1.9


@pytest.mark.parametrize("quantity", ["twist", "curvature", "bending_moment"])
def test_of_bends(quantity):
    """A twist depends on all sections from the start, the size of a bend near zero is not smooth."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section.circle(diameter=0.05, E=2e8, rho=2e3, nu=0.3)
    given = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 3, "section": section}
    beam = model.add_beam("beam", element="nonlocking", **given)
    model.clamp(beam.start)
    model.add_moment(beam.end, (0.5, 0.2, 0.0))
    ball = model.add_surface("ball", ancf.Sphere(radius=0.2, at=(0.5, 0.01, -0.2245)))
    model.add_contact(beam, ball, stiffness=2000.0, name="touch")
    text, names = f"integral({quantity}(beam.at(0.8))**2)", ["beam.E", "beam.rho"]
    _, slope = ancf.gradient(model, text, names, **settings(steps=12))
    assert apart(model, slope, differences(model, text, names, 1e-4, **settings(steps=12))) < 1e-7
