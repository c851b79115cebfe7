"""Random cables in water and wind, on winches, on what they touch, by all methods: one motion."""

import numpy as np
import pytest

import ancf
from helpers import some
from random_seas import Sea

pytestmark = pytest.mark.filterwarnings("ignore:.*set_motion asks")

T_END, STEP = 0.03, 4e-4
#: Waves, currents, profiles, formulas; grounds, drums, balls, planes, cables; winches, loads, springs.
SMOOTH = [0, 3, 6, 7, 8, 12, 13, 15]
#: The same with friction, which knows its limits a step late: of first order.
ROUGH = [4, 5, 6, 8, 9, 12, 13, 15, 16]


def ends(seed, friction, **how):
    """Places of all points of a sea at the end, and how far they went."""
    sea = Sea(seed, friction)
    run = ancf.simulate(sea.model, t_end=T_END, output_step=T_END, **how)
    found = np.array([run.position(point)[-1] for point in sea.points])
    return found, np.abs(found - [point.initial_position for point in sea.points]).max()


def apart(seed, friction):
    """Of a run by small adaptive steps, in ways: two steps of two methods, and explicit ones."""
    wanted, way = ends(seed, friction, step=STEP, integrator=ancf.Radau(tolerance=1e-9))
    methods = {
        "coarse": {"step": STEP},
        "fine": {"step": STEP / 4},
        "damped": {"step": STEP / 4, "integrator": ancf.GeneralizedAlpha(rho_inf=0.8)},
        "explicit": {"step": 1e-5, "integrator": ancf.Explicit(check=False)},
    }
    return {k: np.abs(ends(seed, friction, **how)[0] - wanted).max() / way for k, how in methods.items()}


@pytest.mark.parametrize("seed", some(SMOOTH))
def test_without_friction(seed):
    off = apart(seed, friction=False)
    assert 12.0 < off["coarse"] / off["fine"] < 24.0
    assert off["fine"] < 5e-5
    assert off["damped"] < 1.5 * off["fine"]
    assert off["explicit"] < 1e-6


@pytest.mark.parametrize("seed", some(ROUGH))
def test_with_friction(seed):
    """What slips is the same with all steps, but for the lag of its limit."""
    off = apart(seed, friction=True)
    assert 1.5 * off["fine"] < off["coarse"] < 3e-3
    assert off["damped"] < 1.1 * off["fine"]
    assert off["fine"] < 5e-4
    assert off["explicit"] < 1.5e-4
