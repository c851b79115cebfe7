"""Derivatives by places of clamped cables, whose clamps turn with them, in models with all around them."""

import numpy as np
import pytest

import ancf
from slopes import extrapolated, once

GIVEN = {"t_end": 0.025, "step": 1e-3, "integrator": ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-13))}
NAMES = ["rope.end[2]", "rope.start[1]", "rope.length"]
TURN = {"rotation": "0.2*(1-cos(15*t))", "axis": (0.6, 0.0, 0.8)}


#: In a good one of them no held number changes by round-off.
WAYS = [(0.234, 0.51, 0.085), (1.0, 0.0, 0.0), (-0.3, -0.5, 0.1)]


def clamped(end=WAYS[0], *, bending=0.01, turns=False, body=True, elements=3):
    """A cable at a clamp, perhaps one that turns, and a rigid body that has nothing to do with it."""
    model = ancf.Model(gravity=(-4.0, -6.6, -1.2))
    section = ancf.Section(EA=155.0, EI=1.36, rhoA=1.95, bending_damping=bending)
    start = np.array([1.136, 0.1097, -0.5526])
    rope = model.add_beam("rope", start=start, end=start + end, elements=elements, section=section)
    model.clamp(rope.start, **(TURN if turns else {}))
    if body:
        model.add_rigid_body("body", at=(0, 1, 0), mass=1.5, inertia=(0.3, 0.4, 0.5))
    return model


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("bending", "way"), [(0.0, 0), (1e-3, 0), (1e-2, 1), (1e-2, 2), (0.1, 0)])
@pytest.mark.parametrize(("turns", "body"), [(False, True), (True, False), (True, True)])
def test_against_differences(turns, body, bending, way, name):
    """Of what damps bending, forces change within 1e-2 rad of an element: wider differences were 1e-3 off."""
    model = clamped(WAYS[way], bending=bending, turns=turns, body=body)
    run = once(lambda other: ancf.simulate(other, **GIVEN))
    found = ancf.simulate(model, sensitivities=[name], **GIVEN).sensitivity(name)
    for question in ("position", "velocity"):
        wanted = extrapolated(lambda other, ask=question: getattr(run(other), ask)("rope.end"), model, name)
        largest = np.max(np.abs(wanted))
        assert np.max(np.abs(getattr(found, question)("rope.end") - wanted)) < 1e-6 * largest


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("name", NAMES)
def test_what_nothing_acts_on(name, seed):
    """Of some directions, by round-off of the axes, bodies far away had the derivative of their weight."""
    way = np.random.default_rng(seed).standard_normal(3)
    model = clamped(way, turns=True, elements=1 + seed % 3)
    found = ancf.simulate(model, sensitivities=[name], **GIVEN).sensitivity(name)
    assert np.max(np.abs(found.velocity("body"))) < 1e-10
    assert np.max(np.abs(found.velocity("rope.end"))) > 1e-2
