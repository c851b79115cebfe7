"""A string that travels through a span between stiff foundations: Skutch's frequency (c^2 - v^2)/(2 l c)."""

from __future__ import annotations

import numpy as np
import pytest

import ancf
from helpers import some

PULL, RHO_A, EA, SPAN, STIFF = 100.0, 0.04, 2e4, 1.0, 2e5


def _middle(speed, end, size):
    """Times and height of the material that passes the middle of the span, after a push."""
    first = -1.0 - speed * end
    section = ancf.Section(EA=EA, EI=1e-4, rhoA=RHO_A)
    stretch = 1 + PULL / EA
    model = ancf.Model()
    string = model.add_beam(
        "string",
        start=(first, 0, 0),
        end=(SPAN + 1.0, 0, 0),
        elements=round((SPAN + 1.0 - first) / size),
        length=(SPAN + 1.0 - first) / stretch,
        section=section,
    )
    string.set_motion(velocity=(speed, 0, 0))
    for point in (string.start, string.end):
        model.pin(point, displacement=(f"{speed}*t", 0, 0))
    outside = f"-{STIFF}*z*(where(x<0, 1, 0) + where(x>{SPAN}, 1, 0))"
    push = f"0.5*exp(-((t - 0.05)/0.02)**2)*where(x>0, 1, 0)*where(x<{SPAN}, 1, 0)"
    model.add_distributed_load(string, ["0", "0", f"{outside} + {push}"])
    run = ancf.simulate(model, t_end=end, step=5e-4, integrator=ancf.GeneralizedAlpha(0.9))
    x = np.arange(first, SPAN + 1.0, size)
    z = np.array([run.position(string.at(a))[:, 2] for a in (x - first) / stretch])
    height = [np.interp(0.5 * SPAN - speed * t, x, z[:, k]) for k, t in enumerate(run.t)]
    late = run.t > 0.15
    return run.t[late], np.array(height)[late]


def _frequency(t, z):
    """From crossings of zero upwards."""
    k = np.nonzero((z[:-1] < 0) & (z[1:] >= 0))[0]
    at = t[k] - z[k] * (t[1] - t[0]) / (z[k + 1] - z[k])
    return (len(at) - 1) / (at[-1] - at[0])


@pytest.mark.parametrize("size", some([0.04, 0.05]))
@pytest.mark.parametrize(("speed", "end"), [(0.0, 1.0), (10.0, 1.0), (20.0, 0.8)])
def test_frequency_falls_with_the_speed(speed, end, size):
    """The waves reach into the foundations, by the root of what is left of the tension over the stiffness."""
    c = np.sqrt(PULL / RHO_A)
    reach = np.sqrt((PULL - RHO_A * speed**2) / STIFF)
    expected = (c**2 - speed**2) / (2 * (SPAN + 2 * reach) * c)
    assert abs(_frequency(*_middle(speed, end, size)) / expected - 1) < 4e-3
