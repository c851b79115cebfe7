"""A bead slides down a slack wire over a ground, on which both may come to lie, from anywhere on the wire.

On the way it comes off the wire by more than an element is long, and what closes this gap stays as long as
it is however much mass is added to the stiffness.
"""

import numpy as np
import pytest

import ancf


def wire_with_bead(seed):
    """A random wire of 4 to 5 m, hard or soft, light or heavy, with a bead of 0.03 to 16 kg."""
    random = np.random.default_rng(seed)
    u = random.uniform
    model = ancf.Model(gravity=(0, 0, -9.81))
    EA, EI = 10 ** u(3, 6), 10 ** u(-3, 0)
    random.random()
    diameter = u(0.01, 0.04)
    rope = ancf.Section(EA=EA, EI=EI, rhoA=10 ** u(-1.5, 0.5), diameter=diameter)
    rise = u(-1, 1)
    length, elements = np.hypot(4, rise) * u(1.0, 1.3), int(random.integers(6, 40))
    given = {"start": (0, 0, 0), "end": (4, 0, rise), "length": length, "elements": elements}
    wire = model.add_beam("wire", **given, section=rope)
    model.pin(wire.start)
    model.pin(wire.end)
    x = u(0.3, 3.7)
    bead = model.add_point_mass("bead", at=(x, 0, rise * x / 4), mass=10 ** u(-1.5, 1.2))
    joint = model.slide(bead, along=wire)
    friction = 0.0 if random.random() < 0.5 else u(0.1, 0.6)
    height = min(0, rise) - u(-0.1, 1.2)
    given = {"height": height, "stiffness": 10 ** u(3, 6.5), "damping": 100.0}
    model.add_ground("floor", **given, friction=friction)
    return model, bead, joint, wire


@pytest.mark.parametrize("seed", [2, 13, 25, 46, 115, 139, 148])
def test_it_comes_to_rest(seed):
    model, bead, joint, wire = wire_with_bead(seed)
    state = ancf.equilibrium(model)
    s = float(state.arc_length(joint))
    assert 0.0 < s < wire.length
    gap = state.position(bead) - state.position(wire.at(s))
    assert np.abs(gap).max() < 1e-8
    result = ancf.simulate(model, t_end=0.02, step=1e-3, start=state)
    for point in (bead, wire.at(0.3 * wire.length), wire.at(0.7 * wire.length)):
        motion = result.position(point)
        assert np.abs(motion - motion[0]).max() < 1e-9
