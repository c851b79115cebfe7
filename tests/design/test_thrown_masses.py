"""Derivatives of the motion of thrown masses by how fast they are thrown, beside closed forms."""

import numpy as np
import pytest

import ancf

STEP, END = 2e-3, 0.3
EXACT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14, modified=False))


def thrown(stiffness, mass):
    """Two masses on springs without length, of which one is thrown."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    for name, place in (("still", (0.0, 1.0, 0.0)), ("ball", (0.3, 0.0, 1.0))):
        body = model.add_point_mass(name, at=place, mass=mass)
        model.add_spring(body, (0, 0, 0), stiffness=stiffness, length=0.0)
    model.bodies["ball"].set_motion(velocity=(1.0, 0.5, 0.2))
    return model


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize(("stiffness", "mass"), [(50.0, 2.0), (3.0, 0.7)])
def test_on_a_spring(stiffness, mass, axis):
    """The trapezoidal rule turns (w x, v) by 2 atan(w h/2) in a step: sin/w of x and cos of v, exactly."""
    name, w = f"ball.velocity[{axis}]", np.sqrt(stiffness / mass)
    given = {"t_end": END, "step": STEP, "integrator": EXACT}
    own = ancf.simulate(thrown(stiffness, mass), sensitivities=[name], **given).sensitivity(name)
    turned = 2.0 * np.arctan(0.5 * w * STEP) * np.arange(round(END / STEP) + 1)
    unit = np.eye(3)[axis]
    assert own.position("ball") == pytest.approx(np.outer(np.sin(turned) / w, unit), abs=1e-10)
    assert own.velocity("ball") == pytest.approx(np.outer(np.cos(turned), unit), abs=1e-9)
    assert not np.any(own.position("still"))
