"""A line and its mirror image carry alike: what is to the left in one is to the right in the other.

Curves, staggers, cant and wind change their sign, and nothing that counts does.
"""

from dataclasses import replace

import numpy as np
import pytest

from ancf import catenary
from ancf.catenary import Conditions, Span, SteadyArm
from ancf.catenary.forms.along_track import curve_pull
from ancf.catenary.forms.first_guess import first_guess
from overhead_lines import COARSE, STEP, collector, droppers, short_line

ARMS = {
    "held": SteadyArm(vertical=150.0),
    "sprung": SteadyArm(vertical=150.0, lateral=4e4),
    "hinged": SteadyArm(length=1.1, mass=0.8),
}
LENGTHS = (38.0, 42.0, 36.0, 40.0)


def curved(arm, side):
    """Four spans in a canted curve to the left, side = 1, or to the right, side = -1."""
    plain = short_line()
    return short_line(
        spans=[Span(length=x, droppers=droppers(x), radius=side * 700.0) for x in LENGTHS],
        stagger=tuple(-side * y for y in (0.2, 0.25, 0.15, 0.22, 0.2)),
        cant=side * 0.06,
        steady_arm=ARMS[arm],
        contact_support="free",
        anchors="tension",
        contact_wire=replace(plain.contact_wire, diameter=0.013),
        messenger_wire=replace(plain.messenger_wire, diameter=0.0105),
    )


@pytest.mark.parametrize("arm", ARMS)
def test_elasticity(arm):
    """What holds the wire sideways adds nothing to the vertical stiffness of an arm, and takes nothing."""
    left, right = (catenary.elasticity(curved(arm, side), mesh=COARSE).value for side in (1, -1))
    np.testing.assert_allclose(left, right, rtol=2e-4)


@pytest.mark.parametrize("arm", ARMS)
def test_runs_in_wind(arm):
    given = {"mesh": COARSE, "step": STEP, "start": 20.0, "window": (70.0, 100.0), "until": 110.0}
    runs = []
    for side in (1, -1):
        line = replace(curved(arm, side), conditions=Conditions(temperature=25.0, wind=side * 12.0))
        runs.append(catenary.run(line, speed=50.0, pantograph=collector(), **given))
    left, right = runs
    force = [run.recordings[0].force for run in runs]
    assert np.std(force[0]) > 20.0
    np.testing.assert_allclose(*force, rtol=0, atol=0.05)
    np.testing.assert_allclose(left.uplift, right.uplift, rtol=0, atol=1e-5)


def test_pull_of_curves_on_lines_of_any_lengths():
    """Places of nodes are rounded, and sums of spans are not: no piece of a line is beyond its last span."""
    random, beyond = np.random.default_rng(3), 0
    for _ in range(60):
        lengths = random.uniform(30.0, 50.0, random.integers(2, 8)).round(3).tolist()
        radii = random.choice([-900.0, 1200.0, None], len(lengths)).tolist()
        spans = [Span(length=x, droppers=droppers(x), radius=r) for x, r in zip(lengths, radii, strict=True)]
        line = short_line(spans=spans, stagger=0.1)
        shape = first_guess(line, COARSE).contact
        pieces = curve_pull(line, shape, "contact")
        total = sum(load * (b - a) for a, b, load in pieces)
        wanted = sum(20e3 * x / r for x, r in zip(lengths, radii, strict=True) if r is not None)
        assert total == pytest.approx(wanted, abs=1e-3)
        beyond += bool(shape.nodes.x[-1] > line.length)
    assert beyond > 3
