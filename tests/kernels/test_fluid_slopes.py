"""The slopes of the work of fluids' forces, by the state and by numbers of fluids and sections."""

import pytest

import ancf
from ancf.system.system import System
from sloped import SPEEDS, WAVES, afloat, at_time, check_slopes, in_waves, under_gusts
from strained import states

TIME = 1.37


def moved(model, seed=3):
    system = System(model)
    q, v, a, x, _ = states(system, seed)
    given = q, v, 0.01 * a
    at_time(system, TIME, given)
    return system, given, x


@pytest.mark.parametrize("surface", [{}, {"below": 0.03}, {"above": -0.5, "below": 0.3}], ids=str)
@pytest.mark.parametrize("speed", SPEEDS)
def test_of_flows(speed, surface):
    system, given, x = moved(afloat(velocity=SPEEDS[speed], **surface))
    share = 3e-8 if speed == "formulas" else 1e-9  # whose own rates are differences
    by_q, by_v, by_a = check_slopes(system, "fluid", given, x, 1e-4, share)
    assert min(by_v, by_a) > 0.0
    assert by_q > 0.0


@pytest.mark.parametrize("speed", ["still", "sheared"])
@pytest.mark.parametrize("waves", WAVES)
def test_of_waves(waves, speed):
    system, given, x = moved(in_waves(waves, velocity=SPEEDS[speed]))
    check_slopes(system, "fluid", given, x, 1e-4)


def test_of_gusts_over_waves():
    """The air has the waves as its lower surface."""
    system, given, x = moved(under_gusts())
    check_slopes(system, "fluid", given, x, 1e-4)


def test_of_solid_beams():
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    bar = ancf.Section.circle(0.2, E=1e7, rho=900.0, drag=(1.1, 0.2), added_mass=(1.0, 0.0))
    model.add_beam("bar", element="nonlocking", start=(0, 0, -1), end=(1, 0, 1), elements=2, section=bar)
    model.add_fluid("sea", density=1025.0, velocity=(0.5, 0.2, 0.1), below=0.0)
    system, given, x = moved(model)
    check_slopes(system, "fluid", given, x, 1e-4)
