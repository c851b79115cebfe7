"""Strains and moments count from the natural shape: a cable that was made curved has none at rest."""

import numpy as np
import pytest

import ancf
from ancf.system.system import System
from helpers import cable, shaken


def at_start(shape, strain, elements):
    """The initial state of a free cable, and its points."""
    system = System(cable(shape, elements=elements, strain=strain)[0])
    q, beam = shaken(system, size=0.0), system.model.bodies["beam"]
    points = [beam.at(x) for x in np.linspace(0.0, beam.length, 8)]
    return ancf.State(system, 0.0, q, np.zeros_like(q)), beam, points


@pytest.mark.parametrize("strain", ["paper", "material"])
@pytest.mark.parametrize("elements", [1, 2, 5])
class TestNaturalShape:
    def test_curved_it_carries_nothing(self, strain, elements):
        """To round-off: also what the elements cannot draw of the curve is no strain."""
        state, _, points = at_start("curved", strain, elements)
        for point in points:
            assert abs(state.strain(point)) < 1e-13
            assert abs(state.tension(point)) < 1e-11
            assert state.bending_moment(point) == pytest.approx(0.0, abs=1e-12)
            assert state.curvature(point) > 0.1

    def test_stretched_it_has_the_strain_of_the_stretch(self, strain, elements):
        state, beam, points = at_start("curved and stretched", strain, elements)
        stretch = beam.stretch
        wanted = 0.5 * (stretch**2 - 1.0) if strain == "paper" else stretch - 1.0
        assert wanted > 0.1
        assert [state.strain(point) for point in points] == pytest.approx([wanted] * 8, rel=3e-3)
