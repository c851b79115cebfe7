"""Sensitivities by a number that changes how a support moves, beside friction that remembers the way.

Such a number is followed by itself, not in compiled code: against extrapolated differences of whole runs,
which begin in equilibria, where points are just at their limits.
"""

import numpy as np
import pytest

import ancf
from helpers import some
from slopes import off

TIGHT = ancf.Newton(tolerance=1e-14, modified=False)
METHODS = {"trapezoidal": ancf.Trapezoidal(newton=TIGHT), "alpha": ancf.GeneralizedAlpha(0.8, newton=TIGHT)}


def moved(y):
    """How the end of a support moves that depends on the number."""
    return f"{y}*sin(6*t)**2", f"{0.02 + y * y}*sin(9*t)**2", 0.0


def on_bed(y, elements, friction, stick=5e4, rise=0.0, **shape):
    """A mooring on a ground, heavier and moved further with the number."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e5, EI=1.0, rhoA=5.0 + y, diameter=0.05)
    height = {
        "x": [-1.0, 6.0, 15.0],
        "y": [-2.0, 2.0],
        "z": [[-5.0, -5.0], [-5.0, -5.0 + rise], [-5.0, -5.0]],
    }
    given = {"stiffness": 2e5, "damping": 1e4, "friction": friction, "stick": stick}
    model.add_ground("on", height=height if rise else -5.0, **given)
    line = model.add_beam("line", elements=elements, section=section, **shape)
    model.pin(line.start, name="left")
    model.pin(line.end, displacement=moved(y))
    return model


def on_drum(y, elements, friction, radius=0.2):
    """A rope over a drum, pulled by a larger force and by its other end with the number."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=5e3, EI=0.05, rhoA=0.2, diameter=0.02)
    line = model.add_beam("line", start=(-0.8, 0, 0), end=(0.6, 0.02, 0), elements=elements, section=section)
    drum = model.add_surface(
        "drum", ancf.Cylinder(radius=radius, axis=(0, 1, 0), at=(0, 0, -0.0102 - radius))
    )
    model.add_contact(line, drum, stiffness=1e5, damping=30.0, friction=friction, name="on")
    model.pin(line.start, name="left", displacement=moved(-y))
    model.add_force(line.end, ("0", "0", f"-{3.0 + 20.0 * y} - sin(9*t)"))
    return model


BENT, STRAIGHT = [(0, 0, -5), (8, 0, -5), (14, 0.5, 0)], {"start": (0, 0, -4.995), "end": (14, 0.5, 0)}
CASES = {
    "path": (0.05, lambda y: on_bed(y, 6, 0.4, path=BENT)),
    "long": (0.05, lambda y: on_bed(y, 8, 0.8, length=17.0, **STRAIGHT)),
    "rough": (0.05, lambda y: on_bed(y, 6, 0.35 + y, 5e4 * (1.0 + y), path=BENT)),
    "longer": (0.05, lambda y: on_bed(y, 8, 0.8, length=16.95 + y, **STRAIGHT)),
    "hill": (0.05, lambda y: on_bed(y, 6, 0.4, rise=2.0 * y, path=BENT)),
    "drum": (0.01, lambda y: on_drum(y, 8, 0.3)),
    "rougher drum": (0.01, lambda y: on_drum(y, 8, 0.2 + 10.0 * y)),
    "wider drum": (0.01, lambda y: on_drum(y, 8, 0.3, 0.2 + y)),
    "slippery drum": (0.01, lambda y: on_drum(y, 6, 0.05)),
}
#: Whose friction does not change, and which have few kinks near.
STUCK = "path", "long", "longer", "hill"


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
@pytest.mark.parametrize("name", some(CASES))
def test_runs_from_equilibria(name, method):
    """And a second run that goes on from the first."""
    (at, build), width = CASES[name], 1e-6 if "drum" in name else 1e-5
    lean = {"lean": (at, build), "fast": (at / 3, lambda y: build(3 * y))}
    given = {"step": 2e-3, "integrator": method}

    def runs(y, **asked):
        model = build(y)
        first = ancf.simulate(model, start=ancf.equilibrium(model, **asked), t_end=0.03, **given, **asked)
        return ancf.simulate(model, start=first.state(), t_end=0.06, **given, **asked)

    run = runs(at, sensitivities=lean)
    mine, fast = (np.asarray(run.sensitivity(one).dq) for one in lean)
    near, far = ((runs(at + h).q[:] - runs(at - h).q[:]) / (2.0 * h) for h in (width, 2 * width))
    assert off(mine, (4.0 * near - far) / 3.0) < (1e-7 if name in STUCK else 1e-6)
    assert off(fast, 3.0 * mine) < 1e-7
