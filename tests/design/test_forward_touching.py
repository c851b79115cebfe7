"""Forward sensitivities of cables and bodies that touch: closed forms, against differences of runs.

Parameters of these change so little that nothing touches in another step.
"""

import numpy as np
import pytest
from backwards import apart, differences, forward

import ancf
from slopes import remainder_slopes

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
    wanted = differences(model, text, names, change, **given)
    assert apart(model, forward(model, text, names, **given), wanted) < off


@pytest.mark.parametrize("method", METHODS, ids=["trapezoidal", "generalized"])
@pytest.mark.parametrize(
    ("angle", "stiffness", "damping", "elements"),
    [
        (1.5, 2e4, 30.0, (3, 4)),
        (0.3, 2e4, 0.0, (4, 3)),
        (1.0, 1e6, 30.0, (6, 5)),
        (1.5, 1e5, 0.0, (2, 6)),
        (1.5, 1e7, 300.0, (3, 4)),
    ],
)
def test_cables(angle, stiffness, damping, elements, method):
    """Central differences of their forces were up to 6e-6 off, and stiff ones were not solved at all."""
    model = fallen(angle, stiffness, damping, elements)
    agrees(model, FALL, names_of(damping), settings(method))


@pytest.mark.parametrize(("stiffness", "count"), [(2e4, 2), (1e5, 3), (1e6, 2)])
def test_several_cables(stiffness, count):
    model = fallen(stiffness=stiffness, count=count, of_cable=0.1)
    agrees(model, FALL, names_of(1.0), settings())


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


def check_remainders(model, name, step=1e-2):
    """They fall with the square of a change of a number."""
    given = settings(steps=12)
    run = ancf.simulate(model, sensitivities=[name], **given)
    found = remainder_slopes(
        lambda m: ancf.simulate(m, **given).q[:], model, name, run.sensitivity(name).dq, step, noise=3e-13
    )
    assert len(found) > 0
    assert np.all(np.abs(found - 2.0) < 0.05)
