"""A shaft under torques that keep their axis: Greenhill's frequencies, and what modes() says of its own."""

from __future__ import annotations

import numpy as np
import pytest

import ancf

LENGTH, DIAMETER = 1.0, 0.01


def shaft(share: float, elements: int = 12, modulus: float = 2e9) -> ancf.Model:
    """Pinned at both ends, torques of a share of Greenhill's 2 pi EI/L on them."""
    section = ancf.Section.circle(diameter=DIAMETER, E=modulus, rho=1200.0, nu=0.3)
    model = ancf.Model()
    rod = model.add_beam(
        "rod", start=(0, 0, 0), end=(LENGTH, 0, 0), elements=elements, section=section, element="nonlocking"
    )
    model.pin(rod.start)
    model.hold(rod.end, position="yz")
    model.hold(rod.at(0.5 * LENGTH), twist=True)
    torque = share * 2.0 * np.pi * section.EI / LENGTH
    if share:
        model.add_moment(rod.end, (torque, 0, 0))
        model.add_moment(rod.start, (-torque, 0, 0))
    return model


@pytest.mark.parametrize("modulus", [2e9, 5e9])
def test_a_shaft_buckles_at_greenhill_s_torque(modulus: float) -> None:
    for share, stable in ((0.985, True), (1.015, False)):
        model = shaft(share, modulus=modulus)
        found = ancf.damped_modes(model, about=ancf.equilibrium(model), count=4).eigenvalues
        assert (found.real.max() < 1e-6 * abs(found).max()) == stable


@pytest.mark.parametrize("share", [0.2, 0.5])
def test_modes_say_that_they_have_half_of_a_torque_s_stiffness(share: float) -> None:
    model = shaft(share)
    state = ancf.equilibrium(model)
    half, whole = ancf.modes(model, about=state, count=2), ancf.damped_modes(model, about=state, count=2)
    assert np.all(half.frequencies < 0.99 * np.sort(abs(whole.eigenvalues.imag))[:2])
    [note] = half.notes
    assert note.startswith("moments and loads that follow the motion have no potential")
    assert "ancf.damped_modes" in note


@pytest.mark.parametrize("share", [0.0, 0.002])
def test_modes_say_nothing_of_no_torque_and_of_a_small_one(share: float) -> None:
    model = shaft(share)
    state = ancf.equilibrium(model)
    assert ancf.modes(model, about=state, count=2).notes == []


def test_what_is_stable_with_all_of_its_stiffness_is_sent_there() -> None:
    model = shaft(0.8)
    state = ancf.equilibrium(model)
    assert ancf.damped_modes(model, about=state, count=2).eigenvalues.real.max() < 1e-6
    with pytest.raises(ancf.SolveError, match=r"moments and .* have no potential.*ask ancf\.damped_modes"):
        ancf.modes(model, about=state, count=2)
