"""Derivatives of damped forces by the shape, in motion: the matrices against differences of the forces."""

import numpy as np
import pytest

import ancf
from ancf.sensitivity.base import matrices_of
from ancf.solvers.derivatives.directions import products_along
from ancf.system.core import residual
from ancf.system.system import System

DAMPINGS = {
    "axial": {"axial_damping": 50.0},
    "bending": {"bending_damping": 1.0},
    "both": {"axial_damping": 5.0, "bending_damping": 2.0},
    "springs": {},
}


def damped(elements, strain, damping):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=100.0, EI=1.0, rhoA=0.1, **damping)
    ends = {"start": (0, 0, 0), "end": (1.2, 0.3, 0)}
    beam = model.add_beam("beam", **ends, elements=elements, section=section, strain=strain)
    model.add_spring(beam.at(0.77), (0.5, 0.5, 1), stiffness=10.0, damping=30.0, length=0.3)
    return model


@pytest.mark.parametrize("elements", [2, 9])
@pytest.mark.parametrize("strain", ["material", "paper"])
@pytest.mark.parametrize("damping", DAMPINGS)
def test_along_a_direction(damping, strain, elements):
    check(System(damped(elements, strain, DAMPINGS[damping])), elements)


@pytest.mark.parametrize("elements", [1, 2, 9])
@pytest.mark.parametrize("element", ["original", "nonlocking"])
@pytest.mark.parametrize("damping", ["axial", "bending", "both"])
def test_of_solid_beams(damping, element, elements):
    """A damped one, askew to the axes, beside one without."""
    model, given = ancf.Model(gravity=(0, 0, -9.81)), DAMPINGS[damping]
    bar = ancf.Section.rectangle(0.3, 0.2, E=1e4, rho=500.0, nu=0.3, **given)
    ends = {"start": (0, 0, 0), "end": (1.2, 0.3, 0.1)}
    model.add_beam("first", **ends, elements=elements, section=bar, element=element)
    free = ancf.Section.rectangle(0.1, 0.2, E=1e4, rho=500.0)
    model.add_beam("second", start=(2, 0, 0), end=(1, 1, 0), elements=3, section=free, element=element)
    check(System(model), elements)


def check(system, seed):
    """What products with the matrices are, along random directions, against differences of the forces."""
    core, m = system.core, matrices_of(system.core, system.size, moving=True)
    assert len(m.lossy) == 0
    assert len(m.W)
    rng = np.random.default_rng(seed)

    def shaken(by):
        x = np.zeros(system.size)
        x[: system.n] = by * rng.uniform(-1, 1, system.n) * system.numbering.used()
        return x

    q, v, zero = system.initial_shape() + shaken(0.02), shaken(0.5), np.zeros(system.size)
    d, found = np.stack([shaken(1.0), shaken(1.0), shaken(1.0)]), np.empty(system.size)
    products_along(core, m, q, v, zero, d.copy(), np.zeros((0, 3, 3)), zero.copy(), found)

    def force(e):
        r = np.empty(system.size)
        residual(core.batches, core.ws, q + e * d[0], v + e * d[1], e * d[2], zero, r)
        return r

    def central(e):
        return (force(e) - force(-e)) / (2 * e)

    wanted = (64 * central(6e-5) - 20 * central(1.2e-4) + central(2.4e-4)) / 45
    assert np.max(np.abs(found - wanted)) < 1e-8 * np.max(np.abs(wanted))
