"""Random worlds with machinery by all methods: one motion, with a quarter of the step 1/16 of the error."""

import numpy as np
import pytest

import ancf
from helpers import some
from random_gear import Gear

T_END = 0.02
#: Those in which nothing meets within the time, or only gently: an impact has no order of two.
SEEDS = [2, 4, 8, 9, 10, 14, 15, 16, 17, 19, 20, 21]


def ends(gear, **how):
    """Places of all points at the end."""
    run = ancf.simulate(gear.model, t_end=T_END, output_step=T_END, **how)
    return np.array([run.position(point)[-1] for point in gear.points])


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("seed", some(SEEDS))
def test_all_methods_agree(seed):
    """Strips, slides, guides, joints of all kinds, rails and torsion springs, without friction."""
    gear = Gear(seed, rough=False)
    wanted = ends(gear, step=1e-4, integrator=ancf.Radau(tolerance=1e-9))
    way = np.abs(wanted - [point.initial_position for point in gear.points]).max()
    coarse, fine = (np.abs(ends(gear, step=step) - wanted).max() for step in (4e-4, 1e-4))
    assert 10.0 < coarse / fine < 30.0
    assert fine < 1e-4 * way
    smooth = ends(gear, step=1e-4, integrator=ancf.GeneralizedAlpha(rho_inf=0.8))
    assert np.abs(smooth - wanted).max() < 1.5 * fine
