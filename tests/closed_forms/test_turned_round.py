"""Equilibria of what is pressed beyond buckling: notes say which body points backwards in its clamp."""

import numpy as np
import pytest

import ancf
from ancf.results.turned_round import notes
from ancf.system.system import System

HEIGHT, EA = 0.02, 40.0
KINDS = ["material", "paper", "original", "nonlocking"]


def pressed(kind, share, elements, length, across=0.0, at=0.0):
    """A cantilever that is pressed by a share of EA; its Euler load is (pi h/L)^2/48 of EA."""
    model = ancf.Model()
    if kind in ("material", "paper"):
        section, more = ancf.Section(EA=EA, EI=EA * HEIGHT**2 / 12, rhoA=0.1), {"strain": kind}
    else:
        size = {"width": HEIGHT, "height": HEIGHT, "rho": 900.0, "nu": 0.0}
        section, more = ancf.Section.rectangle(E=EA / HEIGHT**2, **size), {"element": kind}
    beam = model.add_beam(
        "rod", start=(at, 0, 0), end=(at + length, 0, 0), elements=elements, section=section, **more
    )
    model.clamp(beam.start)
    model.add_force(beam.end, (-share * EA, 0.0, across * EA))
    return model, beam


def slope(state, beam):
    return float(state.q[state.slots["rod"][0, 1]])


def said(state):
    return [text for text in state.notes if "has turned round in" in text]


class TestPressed:
    @pytest.mark.parametrize("kind", KINDS)
    @pytest.mark.parametrize("elements", [1, 3])
    @pytest.mark.parametrize("share", [0.002, 0.01, 0.03, 0.05])
    def test_is_said_where_the_slope_points_backwards(self, kind, elements, share):
        model, beam = pressed(kind, share, elements, 0.05)
        try:
            state = ancf.equilibrium(model)
        except ancf.SolveError:
            assert share > 0.02  # at 3.3 % of EA it buckles
            return
        assert len(said(state)) == (slope(state, beam) < 0.0)
        assert share > 0.02 or not said(state)

    @pytest.mark.parametrize("kind", ["original", "nonlocking"])
    @pytest.mark.parametrize("share", [0.05, 0.1])
    def test_beams_say_what_has_happened(self, kind, share):
        """Where all three slopes turn together the section is not inside out."""
        model, beam = pressed(kind, share, 3, 0.05)
        state = ancf.equilibrium(model)
        assert state.position(beam.end)[0] < -0.05
        [text] = said(state)
        assert text.startswith('"rod" has turned round in "clamp at rod.start"')
        assert 'stretch="fixed"' in text


class TestBent:
    @pytest.mark.parametrize("kind", KINDS)
    @pytest.mark.parametrize("turns", [0.6, 1.0])
    def test_what_is_rolled_up_is_none(self, kind, turns):
        """Elements that point backwards elsewhere than in the clamp are as they should be."""
        model, beam = pressed(kind, 0.0, 16, 2.0)
        model.add_moment(beam.end, (0.0, -2 * np.pi * turns * EA * HEIGHT**2 / 12 / 2.0, 0.0))
        state = ancf.equilibrium(model, load_steps=10)
        assert slope(state, beam) > 0.9
        assert said(state) == []
        assert state.position(beam.end)[0] < 0.1

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    @pytest.mark.parametrize("turned", [0.5, 3.0])
    def test_clamps_that_turn_may_point_anywhere(self, stretch, turned):
        model, beam = pressed("material", 0.0, 8, 1.0)
        model.supports.clear()
        model.clamp(beam.start, stretch=stretch, rotation_vector=[0, f"{turned} + 0*t", 0])
        state = ancf.equilibrium(model)
        assert slope(state, beam) == pytest.approx(np.cos(turned), abs=1e-9)
        assert said(state) == []


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("way", [-0.4, -0.9])
def test_clamps_that_travel_may_be_anywhere(kind, way):
    """On the other side of the origin as well: what counts is where the slope points."""
    model, beam = pressed(kind, 0.0, 3, 1.0, at=0.2)
    model.supports.clear()
    model.clamp(beam.start, displacement=[f"{way}*ramp(t, 0, 1)", 0, 0])
    state = ancf.simulate(model, t_end=1.0, step=0.01).state()
    assert state.position(beam.start)[0] == pytest.approx(0.2 + way)
    assert slope(state, beam) > 0.0
    assert said(state) == []


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("size", [0.05, 0.9, 1.3])
def test_one_slope_that_points_backwards_is_enough(kind, size):
    """Whatever the others do: that of a state whose other slopes are as at the start."""
    model, _ = pressed(kind, 0.0, 3, 1.0)
    system = System(model)
    start, _ = system.initial_state()
    slots = system.slots["rod"]
    assert notes(system, start) == []
    for node, count in ((0, 1), (1, 0), (3, 0)):
        for slope_slot in slots[node, 1 : 2 if slots.shape[1] == 2 else 4]:
            q = start.copy()
            q[slope_slot : slope_slot + 3] *= -size
            assert len(notes(system, q)) == count
            q[slope_slot : slope_slot + 3] *= -1.0
            assert notes(system, q) == []
