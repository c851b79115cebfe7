"""Equilibria with surfaces that start without a load on them: short elements, slack ropes."""

import math

import numpy as np
import pytest

import ancf

R, D, WEIGHT = 0.2, 0.02, 0.3 * 9.81
AXIS = R + 0.5 * D


def over_a_drum(elements, friction, *, slack=1.0, EI=1e-2, tail=0.4, gravity=9.81, natural="straight", k=1e6):
    """A rope that is drawn over the upper half of a drum, just touching, and is longer than drawn."""
    model = ancf.Model(gravity=(0, 0, -gravity))
    a = np.linspace(0.0, math.pi, 60)
    arc = np.stack([AXIS * np.cos(a), 0.0 * a, AXIS * np.sin(a)], axis=1)
    ends = [[[AXIS, 0, -tail], [AXIS, 0, -0.5 * tail]], [[-AXIS, 0, -0.5 * tail], [-AXIS, 0, -tail]]]
    section = ancf.Section(EA=1e5, EI=EI, rhoA=0.3, diameter=D)
    rope = model.add_beam(
        "rope",
        path=np.concatenate([ends[0], arc, ends[1]]),
        elements=elements,
        section=section,
        length=slack * (math.pi * AXIS + 2.0 * tail),
        natural_shape=natural,
    )
    drum = model.add_surface("drum", ancf.Cylinder(radius=R, axis=(0, 1, 0)))
    contact = model.add_contact(rope, drum, stiffness=k, friction=friction)
    return model, rope, contact


@pytest.mark.parametrize(
    ("elements", "friction"), [(41, 0.15), (104, 0.3), pytest.param(150, 0.3, marks=pytest.mark.slow)]
)
def test_capstan_with_elements_far_shorter_than_the_drum(elements, friction):
    """Drawn with its bend, it has no stiffness across its plane, nor against the drum, until it is taut."""
    model, rope, _ = over_a_drum(elements, friction, EI=1e-3, tail=0.1, gravity=0.0, natural="path", k=1e8)
    hand = model.pin(rope.start)
    model.add_force(rope.end, (0, 0, -1000.0))
    held = float(np.linalg.norm(ancf.equilibrium(model).reaction(hand)))
    assert held == pytest.approx(1000.0 * math.exp(-friction * math.pi), rel=1e-3)


#: Of such ropes every third goes to and fro at a kink when all of its weight comes on at once.
MORE = [(n, slack, 0.3) for n in (23, 24, 25, 28) for slack in (1.08, 1.12)] + [
    (24, 1.1, 0.25),
    (40, 1.1, 0.3),
    (40, 1.3, 0.3),
]


@pytest.mark.parametrize(
    ("elements", "slack", "friction"),
    [
        (24, 1.02, 0.0),
        (24, 1.1, 0.3),
        (37, 1.1, 0.05),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in MORE),
    ],
)
def test_a_slack_rope_lies_on_a_drum(elements, slack, friction):
    """Pins, pressure and friction bear its weight; friction is nowhere above its limit."""
    model, rope, contact = over_a_drum(elements, friction, slack=slack)
    pins = [model.pin(rope.start), model.pin(rope.end)]
    state = ancf.equilibrium(model)
    line = state.contact_line(contact)
    axis = np.array([state.position(rope.at(x)) for x in line.x.tolist()]) * (1.0, 0.0, 1.0)
    normal = axis / np.linalg.norm(axis, axis=1)[:, None]
    share = np.tile(np.polynomial.legendre.leggauss(5)[1] / 2.0, elements) * rope.length / elements
    on_drum = np.sum(share[:, None] * (line.normal[:, None] * normal + line.friction), axis=0)
    borne = on_drum + sum(state.reaction(pin) for pin in pins)
    assert borne == pytest.approx([0.0, 0.0, WEIGHT * rope.length], abs=1e-6)
    assert np.all(np.linalg.norm(line.friction, axis=1) <= friction * line.normal * (1.0 + 1e-6) + 1e-9)
    assert -1e-2 * D < state.contact_gap(contact) < 0.0
