"""Sensitivities of chains that come down on a seabed: whether elements touch it is a kink in all numbers."""

import numpy as np
import pytest

import ancf
from ancf.model.vary import value_of
from slopes import extrapolated, off


def moored(friction=0.0, top=-3.0):
    """A chain without bending stiffness, a third of which lies."""
    chain = ancf.Section(EA=2e8, EI=0.0, rhoA=42.0, diameter=0.1)
    model = ancf.Model(gravity=(0, 0, -9.80665))
    line = model.add_beam(
        "chain", start=(0, 0, -100), end=(290, 4, top), length=320, elements=12, section=chain
    )
    model.pin(line.start, name="anchor")
    model.pin(line.end, name="fairlead")
    model.add_ground("seabed", height=-100.0, stiffness=3e6, damping=3e5, friction=friction)
    return model


def answers(model, names=()):
    """Places and forces of the equilibrium, and their derivatives."""
    state = ancf.equilibrium(model, sensitivities=names)

    def of(one):
        places = [one.position(f"chain.at({s})") for s in (50, 150, 250)]
        return np.concatenate([*places, 1e-4 * one.reaction("fairlead")])

    return of(state), [of(state.sensitivity(name)) for name in names]


@pytest.mark.parametrize(
    ("name", "change", "bar"),
    [
        ("chain.end[0]", 1e-3, 1e-7),
        ("chain.end[2]", 3e-3, 1e-6),
        ("chain.length", 1e-3, 1e-7),
        ("chain.diameter", 1e-4, 1e-4),
        ("chain.EA", 2e5, 1e-6),
        ("seabed.stiffness", 3e4, 1e-4),
        ("gravity[2]", 1e-2, 1e-7),
    ],
)
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_equilibria(friction, name, change, bar):
    """Values a metre apart were compared: places 1e-3 off; numbers of the ground were refused.

    Round-off of the equilibria leaves differences by these fewer digits.
    """
    model = moored(friction)
    (mine,) = answers(model, [name])[1]
    theirs = extrapolated(
        lambda own: answers(own)[0], model, name, step=abs(change / value_of(model, name)), levels=2
    )
    assert off(mine, theirs) < bar


def test_height():
    """So far below its value as other parameters are looked at the ground would let go of the anchor."""
    model = moored()
    (mine,) = answers(model, ["seabed.height"])[1]
    theirs = extrapolated(lambda own: answers(own)[0], model, "seabed.height", step=1e-6, levels=2)
    assert off(mine, theirs) < 1e-6
