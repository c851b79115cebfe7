"""A heavy point at the steep end of a rope: the energy that the trapezoidal rule makes there is of its steps.

The rule keeps the energy of linear vibrations only. A trolley that turns near a support leaves a rope that
shakes; what a step does not resolve of it gains energy from nowhere, with a sliding joint and without one.
"""

from functools import cache

import numpy as np
import pytest

import ancf

SPAN, LENGTH = 30.0, 30.6
SECTION = ancf.Section(EA=2e6, EI=20.0, rhoA=0.1)


def ropeway(x, mass=80.0, elements=30, joint=True):
    """The ropeway of the tutorial; without a joint the trolley is tied to the rope at s = ``joint``."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    ends = {"start": (0, 0, 2.0), "end": (SPAN, 0, 0)}
    rope = model.add_beam("rope", **ends, length=LENGTH, elements=elements, section=SECTION)
    model.pin(rope.start)
    model.pin(rope.end)
    trolley = model.add_point_mass("trolley", at=(x, 0, 2.0 * (1 - x / SPAN)), mass=mass)
    if joint is True:
        model.slide(trolley, along=rope, tolerance=5.0, name="wheel")
    else:
        model.add_spring(trolley, rope.at(joint), stiffness=1e6, length=0.0)
    return model


def held(x, **more):
    model = ropeway(x, **more)
    model.hold("trolley", position="x")
    return ancf.equilibrium(model)


def gap(model, start, time, step):
    """What the energies miss at most, J, and what moves, J."""
    try:
        result = ancf.simulate(model, t_end=getattr(start, "t", 0.0) + time, step=step, start=start)
    except ancf.SolveError as error:
        result = error.result
    return np.abs(result.energy.drift).max(), result.energy.kinetic[0] + np.ptp(result.energy.kinetic)


@pytest.mark.parametrize("mass", [20.0, 80.0, 200.0])
@pytest.mark.parametrize("x", [1.0, 2.0, 28.5])
def test_order_two_in_the_step(x, mass):
    """From rest at a steep place, over several elements."""
    start = held(x, mass=mass)
    gaps = [gap(ropeway(x, mass), start, 0.8, h)[0] for h in (4e-3, 2e-3, 1e-3, 5e-4)]
    assert gaps[2] / gaps[3] == pytest.approx(4.0, rel=0.2)
    assert gaps[1] / gaps[3] > 10.0


@cache
def turning():
    """The trolley just before its turn at the other end, by steps that make no energy; and its place."""
    run = ancf.simulate(ropeway(3.0), t_end=5.8, step=2e-4, start=held(3.0), output_step=0.2)
    assert np.abs(run.energy.drift).max() < 1e-4 * run.energy.kinetic.max()
    return run.state(-1), float(run.arc_length("wheel")[-1])


@pytest.mark.filterwarnings("ignore:energies of the run do not add up")
def test_it_is_the_rope():
    """From one state, with the joint and with a spring in its stead: 2 ms make energy, 0.1 ms do not."""
    start, s = turning()
    assert 28.0 < s < LENGTH
    for joint in (True, s):
        model = ropeway(3.0, joint=joint)
        (large, _), (small, moved) = (gap(model, start, 0.8, h) for h in (2e-3, 1e-4))
        assert large > 30 * small
        assert small < 1e-2 * moved
