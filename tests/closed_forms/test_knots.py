"""A loose overhand knot without friction (Audoly, Clauvelin and Neukirch 2007, PRL 99, 164301)."""

import tomllib

import numpy as np
import pytest

import ancf
from places import EXAMPLES

PATH = tomllib.loads((EXAMPLES / "knot.toml").read_text(encoding="utf-8"))["bodies"][0]["path"]
TAIL = 0.25  # m more on both sides: many lengths sqrt(EI/T) between the knot and the ends


def pulled(diameter, EI, tension):
    """Curvature in the middle of the loop of a knot that has come to rest, 1/m."""
    model = ancf.Model()
    damping = {"damping": 4.0, "axial_damping": 2.0, "bending_damping": 1e-3}
    section = ancf.Section(EA=1e4, EI=EI, rhoA=0.3, diameter=diameter, **damping)
    (x, *first), (z, *last) = PATH[0], PATH[-1]
    path = [[x - TAIL, *first], *PATH, [z + TAIL, *last]]
    rope = model.add_beam("rope", path=path, elements=240, section=section, natural_shape="straight")
    model.pin(rope.start)
    model.hold(rope.end, position="yz")
    model.add_contact(rope, rope, stiffness=2e6, damping=200.0)
    model.add_force(rope.end, (f"{tension}*min(t/0.3, 1)", 0, 0))
    method = ancf.GeneralizedAlpha(rho_inf=0.8)
    run = ancf.simulate(model, t_end=6.0, step=1e-3, output_step=0.1, integrator=method)
    assert run.energy.kinetic[-1] < 1e-6
    return np.linalg.norm(run.curvature(rope.at(0.5 * rope.length))[-1])


@pytest.mark.slow
def test_the_loop_of_a_thin_rope_is_a_circle():
    """T = EI/(2 R^2) as the rope gets thin against its loop; the expansion is one in sqrt(r/R)."""
    EI, tension = 0.05, 0.05 / (2.0 * 0.08**2)
    radii = {d: 1.0 / pulled(d, EI, tension) for d in (6e-3, 4e-3, 3e-3)}
    small = [np.sqrt(0.5 * d / radius) for d, radius in radii.items()]
    found = [2.0 * tension * radius**2 / EI for radius in radii.values()]
    assert np.all(np.diff(found) < 0.0)  # a thicker rope makes a wider loop
    assert found[-1] < 1.25
    assert np.polyfit(small, found, 2)[-1] == pytest.approx(1.0, abs=0.04)
