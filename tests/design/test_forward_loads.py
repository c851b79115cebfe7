"""Forward sensitivities of loads that depend on the state, over meshes, steps and methods."""

import numpy as np
import pytest
from backwards import apart, differences, forward
from jointed import arms, methods

import ancf
from ancf.system.system import System
from helpers import some
from slopes import remainder_slopes

TIGHT = ancf.Newton(tolerance=1e-14, modified=False)
METHODS = [ancf.Trapezoidal(newton=TIGHT), ancf.GeneralizedAlpha(rho_inf=0.6, newton=TIGHT)]
LAW = ("-0.3*x*vx + sin(2*y)", "exp(0.3*z)*vy - 0.2*x**2", "0.1*vx*vz - z**3 - tanh(vz)")
TIP = "integral(norm(velocity(beam.end))**2)"


def python_law(t, r, v):
    return (-0.3 * r[2] * v[1], np.sin(3.0 * r[0]) - v[0] * v[0], -0.5 * np.tanh(v[2]) * v[2] ** 2)


def loaded(load, elements, damping=0.05):
    """A cable, or a beam with sections, and a load on it."""
    model = ancf.Model(gravity=(0.0, 0.3, -9.81))
    if load == "section follower":
        section = ancf.Section.rectangle(0.1, 0.05, E=1e8, rho=900.0)
        given = {"start": (0, 0, 0), "end": (1.2, 0.3, 0), "elements": elements, "section": section}
        beam = model.add_beam("beam", element="nonlocking", **given)
        model.clamp(beam.start)
        model.add_follower_force(beam.end, (-300.0, "100*cos(30*t)", 50.0), name="jet")
        return model
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, diameter=0.02, damping=damping)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0.1, 0), elements=elements, section=section)
    model.pin(beam.start)
    if load == "follower":
        model.add_follower_force(beam.end, ("3*cos(9*t)", 0.0, 0.0), name="jet")
    elif load == "pressure":
        model.add_pressure(beam, "4*sin(30*t)", (0.0, 1.0, 0.0), name="blow")
    elif load == "formula":
        model.add_force(beam.end, LAW)
        model.add_distributed_load(beam, LAW)
    else:
        model.add_force(beam.end, python_law)
    return model


LOADS = ["follower", "section follower", "pressure", "formula", "function"]


def names_of(load):
    own = ["beam.E", "beam.rho"] if load == "section follower" else ["beam.EI", "beam.rhoA", "beam.damping"]
    return [*own, "gravity[2]", "beam.length"]


def settings(method=METHODS[0], steps=40, step=1e-3):
    return {"t_end": steps * step, "step": step, "integrator": method}


@pytest.mark.parametrize("method", METHODS, ids=["trapezoidal", "generalized"])
@pytest.mark.parametrize(("elements", "step"), some([(2, 2e-3), (5, 1e-3)]))
@pytest.mark.parametrize("load", LOADS)
def test_of_runs(load, elements, step, method):
    """Central differences of such forces over some micrometres were up to 2e-6 off."""
    model, given = loaded(load, elements), settings(method, step=step)
    found = forward(model, TIP, names_of(load), **given)
    assert apart(model, found, differences(model, TIP, names_of(load), 1e-3, **given)) < 1e-8


@pytest.mark.parametrize("method", ["trapezoidal index1", "generalized index2", "generalized index3"])
def test_beside_joints(method):
    """A follower force on an arm on hinges, and a law that its speed damps."""
    model = arms()
    model.add_follower_force(model.bodies["arm"].at(0.3, 0, 0), (0.0, 1.0, 2.0), name="jet")
    model.add_force(model.bodies["arm"].at(0.1, 0, 0), ("-0.4*vx*z", "sin(x)", "-0.3*vz*abs(vz)"))
    names, text = (
        ["gravity[2]", "hub.inertia", "arm.mass", "jet.force[1]"],
        "integral(position(arm.centre)[2])",
    )
    given = settings(methods()[method])
    wanted = differences(model, text, names, 1e-3, **given)
    assert apart(model, forward(model, text, names, **given), wanted) < 1e-8


@pytest.mark.parametrize("load", LOADS)
def test_remainders(load):
    """They fall with the square of a change."""
    model, given = loaded(load, 3), settings(steps=20)
    places = np.arange(System(model).n)
    for name in names_of(load)[:2]:
        slope = ancf.simulate(model, sensitivities=[name], **given).sensitivity(name).dq[:, places]

        def states(other):
            return ancf.simulate(other, **given).q[:][:, places]

        found = remainder_slopes(states, model, name, slope, noise=1e-14)
        assert len(found) > 0
        assert np.all(np.abs(found - 2.0) < 0.05)
