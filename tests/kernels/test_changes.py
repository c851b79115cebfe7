"""Batches whose forces are the difference of those of two others."""

import numpy as np
import pytest

from ancf.batches import Batches
from ancf.compiled import traits
from ancf.elements.cable_columns import AXIAL, BENDING, DAMPED, EA_L, EI_L, INV_L, MASS, VISCOUS
from ancf.system.core import residual
from ancf.system.system import System
from strained import SECTIONS, cable, states

ROWS = {
    "EA": [EA_L],
    "EI": [EI_L],
    "mass": [MASS],
    "drag": [VISCOUS],
    "dampings": [4, 5, VISCOUS],
    "all": list(range(2, 8)),
}


def forces(system, batch, states):
    r = np.empty(system.size)
    residual(Batches([batch]), system.core.ws, *states, np.zeros(system.size), r)
    return r


def changed(batch, rows, rng, slope=True):
    """The batch with other constants in these rows; dampings also where there are none."""
    data, slopes, groups = batch.lane_data.copy(), batch.lane_slope.copy(), batch.groups.copy()
    size = np.where(data[:, rows] == 0.0, 0.3, data[:, rows])
    data[:, rows] += size * rng.uniform(0.1, 0.5, data[:, rows].shape)
    if slope:
        slopes += rng.uniform(0.1, 0.5, slopes.shape)
    groups[:, DAMPED] = 15
    return batch._replace(lane_data=data, lane_slope=slopes, groups=groups)


@pytest.mark.parametrize("shape", ["straight", "bent"])
@pytest.mark.parametrize("strain", ["paper", "material"])
@pytest.mark.parametrize("rows", ROWS)
@pytest.mark.parametrize("section", SECTIONS)
def test_forces_are_the_difference(section, rows, strain, shape):
    model, _ = cable(strain, 11, shape, **SECTIONS[section])
    system = System(model)
    batch = system.parts["cable"]
    q, v, a, _, rng = states(system, 7)
    other = changed(batch, ROWS[rows], rng, slope=rows == "all")
    found = traits(batch).change(batch, other, 3.0)
    mine, theirs = (forces(system, one, (q, v, a)) for one in (batch, other))
    wanted = 3.0 * (theirs - mine)
    assert np.any(wanted)
    width = 1e-11 * np.abs(wanted).max() + 1e-13 * np.abs(theirs).max()
    np.testing.assert_allclose(forces(system, found, (q, v, a)), wanted, rtol=0, atol=width)


def test_what_does_not_change_is_left_out():
    system = System(cable("material", 9, "straight", **SECTIONS["all"])[0])
    batch, rng = system.parts["cable"], np.random.default_rng(1)
    for rows, axial, bending in (("EA", 5, 0), ("EI", 0, 3), ("mass", 0, 0)):
        other = changed(batch, ROWS[rows], rng, slope=False)
        groups = traits(batch).change(batch, other, 1.0).groups
        assert groups[0, AXIAL] == axial
        assert groups[0, BENDING] == bending


def test_lengths_are_not_linear():
    system = System(cable("material", 9, "straight")[0])
    batch, rng = system.parts["cable"], np.random.default_rng(1)
    assert traits(batch).change(batch, changed(batch, [INV_L], rng), 1.0) is None
