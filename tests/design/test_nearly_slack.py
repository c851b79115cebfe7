"""Springs that are slack but for a hair's breadth in a step are differentiated on the branch of that step."""

import numpy as np
import pytest

import ancf

STEP, STEPS = 1e-3, 12
NAMES = ["rope.length", "rope.stiffness", "head.mass"]


def hung(extension, mass=0.5):
    """A mass between a spring and a slack one that is just taut, and goes slack at once."""
    model = ancf.Model()
    head = model.add_point_mass("head", at=(0, 0, 0), mass=mass)
    head.set_motion(velocity=(0, 0, 0.2))
    model.add_spring(head, (0, 0, 1), stiffness=800.0, length=0.8, name="above")
    model.add_spring(
        head, (0.1, 0, 1), stiffness=2e5, length=np.hypot(1.0, 0.1) - extension, slack=True, name="rope"
    )
    return model


@pytest.mark.parametrize("extension", [1e-11, 1e-9, 1e-7, 1e-6, 1e-5])
@pytest.mark.parametrize("method", [ancf.Trapezoidal(), ancf.GeneralizedAlpha(0.8)], ids=["T", "alpha"])
def test_both_ways(extension, method):
    """The force at the start is k times the extension, its slope by the length -k, however little that is."""
    model = hung(extension)
    given = {"t_end": STEPS * STEP, "step": STEP, "integrator": method}
    result = ancf.simulate(model, sensitivities=NAMES, **given)
    text = "last(position(head)[2])"
    _, slope = ancf.gradient(model, text, NAMES, **given)
    for name in NAMES:
        own = result.sensitivity(name).position("head")[-1, 2]
        assert own == pytest.approx(slope[name], rel=1e-9), name
    accelerated = result.sensitivity("rope.length").velocity("head")[1, 2]
    assert abs(accelerated) > 0.1 * STEP * 2e5 / 0.5 / 4  # what the taut rope does in the first step
