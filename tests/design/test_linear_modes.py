"""Undamped modes on which linear models rest: those that nothing resists, and the lowest of stiff ones."""

import numpy as np
import pytest
from linear_cases import body

import ancf
from ancf.errors import ModelError
from ancf.solvers.modes.linear import all_modes
from helpers import square


@pytest.mark.parametrize(
    ("modes", "match"),
    [
        (0, r"linearise\.modes"),
        (1.5, r"linearise\.modes"),
        (1000, r"linearise\.modes"),
        (1, "2 motions have no stiffness"),
    ],
)
def test_wrong_numbers_of_modes(modes, match):
    model = ancf.Model()
    free = model.add_point_mass("free", at=(0, 0, 0), mass=1.0)
    model.hold(free, position="z")
    other = model.add_point_mass("other", at=(1, 0, 0), mass=1.0)
    model.hold(other, position="yz")
    model.add_spring(other, (2, 0, 0), stiffness=3.0)
    with pytest.raises(ModelError, match=match):
        ancf.linearise(model, modes=modes)
    linear = ancf.linearise(model, modes=2)
    assert linear.frequencies_hz == pytest.approx([0.0, 0.0])
    assert np.all(linear.eigenvalues == 0.0)


def test_a_hanging_body_turns_freely():
    """About the line of a rope nothing resists: the double zero is exact, other modes keep their digits."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.2, damping=0.1)
    line = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -2), elements=6, section=section)
    model.pin(line.start)
    load = body(model, (0, 0, -2.2))
    model.connect(line.end, load.at(0, 0, 0.2))
    state = ancf.equilibrium(model)
    linear = ancf.linearise(model, about=state)
    assert linear.frequencies_hz[0] == 0.0
    assert np.all(np.abs(linear.eigenvalues[:2]) < 1e-12)
    wanted = ancf.modes(model, about=state, count=12).frequencies_hz
    assert linear.frequencies_hz[1:12] == pytest.approx(wanted[1:], rel=1e-9)


@pytest.mark.parametrize("stiffness", [1e3, 1e7])
@pytest.mark.parametrize("element", ["cable", "nonlocking"])
def test_low_modes_keep_their_digits(element, stiffness):
    """Of a body on soft springs at a beam that is stiff: M x = mu K x, with the highest mode far above."""
    model = ancf.Model()
    section = square(element, EA=stiffness, EI=stiffness * 1e-4, rhoA=0.4)
    line = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=6, section=section, element=element
    )
    for k, point in enumerate((line.start, line.at(0.5), line.end)):
        for c in np.eye(3):
            model.add_spring(point, point.initial_position + 2.0 * c, stiffness=2e-3 + 1e-4 * k)
    wanted = ancf.modes(model, count=5).frequencies_hz
    linear = ancf.linearise(model)
    low = wanted > 1e-2  # the twist is neutral
    assert np.sum(low) >= 4
    assert linear.frequencies_hz[:5][low] == pytest.approx(wanted[low], rel=1e-8)


def test_modes_are_orthogonal():
    rng = np.random.default_rng(3)
    scale = 10.0 ** np.linspace(0.0, 5.0, 40)
    Q = np.linalg.qr(rng.standard_normal((40, 40)))[0]
    M = np.diag(1.0 + rng.random(40))
    K = np.sqrt(M) @ (Q * scale**2) @ Q.T @ np.sqrt(M)
    values, vectors = all_modes(0.5 * (K + K.T), M)
    np.testing.assert_allclose(vectors.T @ M @ vectors, np.eye(40), rtol=0, atol=1e-13)
    assert values == pytest.approx(scale**2, rel=1e-6)


@pytest.mark.parametrize("heavy", [1.0, 1e12])
@pytest.mark.parametrize("stiffness", [1e4, 1e9])
def test_stiff_beams_turn_freely(stiffness, heavy):
    """The twist of a stiff beam on two pins is neutral, however large the stiffnesses that cancel in it.

    A heavy mass beside it makes the mean frequency small, of which the zero is no share then.
    """
    model = ancf.Model()
    section = square("nonlocking", EA=stiffness, EI=1e-3 * stiffness, rhoA=0.5)
    line = model.add_beam(
        "beam", start=(0, 0, 0), end=(0.6, 0.5, 0.7), elements=4, section=section, element="nonlocking"
    )
    model.pin(line.start)
    model.pin(line.end)
    far = model.add_point_mass("far", at=(5, 0, 0), mass=heavy)
    model.hold(far, position="yz")
    model.add_spring(far, (6, 0, 0), stiffness=heavy)
    linear = ancf.linearise(model)
    assert linear.frequencies_hz[0] == 0.0
    assert linear.frequencies_hz[1] == pytest.approx(1.0 / (2 * np.pi), rel=1e-9)
    assert np.abs(linear.eigenvalues[:2]).max() < 1e-9
