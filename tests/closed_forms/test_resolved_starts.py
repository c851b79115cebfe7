"""Starts whose accelerations no step can resolve: what is let go falls, however short its elements."""

import numpy as np
import pytest

import ancf
from ancf.solvers.step.scheme import Scheme
from ancf.solvers.step.unresolved import resolve

G = 9.81


def let_go(elements, length, step, steps, **integrator):
    """A straight level cable that is hinged at its start, after so many steps."""
    model = ancf.Model(gravity=(0, 0, -G))
    section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=1000.0)
    cable = model.add_beam("cable", start=(0, 0, 0), end=(length, 0, 0), elements=elements, section=section)
    model.pin(cable.start)
    return ancf.simulate(model, t_end=steps * step, step=step, output_step=steps * step, **integrator)


@pytest.mark.parametrize(
    ("elements", "length", "step", "rho"),
    [(50_000, 10.0, 1e-3, None), (30_000, 4.0, 1e-3, 0.8), (40_000, 4.0, 5e-4, None)],
)
def test_very_short_elements_fall(elements, length, step, rho):
    """Beyond what bending and tension reach in that time it falls by g t^2/2, and no step is halved."""
    given = {} if rho is None else {"integrator": ancf.GeneralizedAlpha(rho_inf=rho)}
    result = let_go(elements, length, step, 6, **given)
    assert result.stats.retries == 0
    assert result.stats.newton_iterations < 5 * result.stats.steps
    t = result.t[-1]
    for x in (0.5 * length, 0.8 * length, length):
        assert result.position(f"cable.at({x})")[-1, 2] == pytest.approx(-0.5 * G * t**2, rel=2e-4)
    if rho is None:  # the other one takes energy out of what it does not resolve
        energy = result.energy
        assert abs(energy.drift[-1]) < 1e-5 * abs(energy.potential[-1] - energy.potential[0])


@pytest.mark.parametrize("scheme", [Scheme(0.25, 0.5, 0.0, 0.0), Scheme(0.3025, 0.6, 0.1, 0.2)])
@pytest.mark.parametrize(("k", "c", "h"), [(40.0, 0.0, 1e-2), (4e6, 300.0, 1e-2), (2e3, 5.0, 0.1)])
def test_accelerations_that_belong_to_a_step(scheme, k, c, h):
    """A mass that hangs on a relaxed spring and is let go: a = f/(m + G c + B k), free sideways."""
    mass = 0.7
    model = ancf.Model(gravity=(0, 2.0, -G))
    point = model.add_point_mass("weight", at=(0, 0, -2), mass=mass)
    model.add_spring(point, (0, 0, 0), stiffness=k, damping=c, length=2.0)
    live = ancf.stepper(model, step=h)
    run = live._run
    now = run.system.inputs.tables(-h, h, 1, 0.0, np.inf, run.now()[:2], still=True)
    assert run.memory.a[:3] == pytest.approx([0.0, 2.0, -G])
    share = (1.0 - scheme.alpha_f) / (1.0 - scheme.alpha_m)
    fall = mass * -G / (mass + scheme.gamma * h * share * c + scheme.beta * h**2 * share * k)
    left = (2.0**2 - G * fall) / (2.0**2 + G**2)  # of M a
    assert not resolve(run.system, run.system.core, run.memory, now, h, scheme, 1.0001 * left)
    assert run.memory.a[:3] == pytest.approx([0.0, 2.0, -G])
    assert resolve(run.system, run.system.core, run.memory, now, h, scheme, 0.9999 * left)
    assert run.memory.a[:3] == pytest.approx([0.0, 2.0, fall], rel=1e-12)
    assert run.memory.abar[:3] == pytest.approx([0.0, 2.0, fall], rel=1e-12)
