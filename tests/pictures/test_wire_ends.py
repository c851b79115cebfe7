"""The scale of contact forces in the viewer: what happens on the end spans of a line does not set it."""

from functools import cache

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.viz.scene import make_scene
from ancf.viz.view import wire_ends
from ancf.viz.view.curves import curves
from ancf.viz.view.encode import Numbers, plain_curve
from ancf.viz.view.histories import Histories
from overhead_lines import COARSE, STEP, collector, short_line

#: The train stops where its first pantograph is on the last span, or before.
GIVEN = {"speed": 40.0, "pantograph": collector(), "step": STEP}


@cache
def line():
    return catenary.form(short_line(), COARSE)


@cache
def run(count):
    spans = line().line.spans
    spacing = 0.5 * spans[0].length
    return catenary.run(
        line(),
        **GIVEN,
        spacing=[spacing] * (count - 1),
        start=0.2 * spans[0].length,
        window=(85.0, 105.0),
        until=line().line.length - 5.0 - spacing * (count - 1),
    )


def names(result):
    return [c.name for c in result.model.connections if isinstance(c, ancf.model.surfaces.contact.Contact)]


class TestScale:
    @pytest.mark.parametrize("count", [1, 2])
    @pytest.mark.parametrize("spike", [5e3, -5e3, 0.0])
    def test_is_that_between_the_outer_supports(self, count, spike):
        made = run(count)
        spans, length = made.form.line.spans, made.form.line.length
        states = Histories(made.result)
        for name, recording in zip(names(made.result), made.recordings, strict=True):
            x, force = recording.position, made.result.sensors.contact_force(name)
            inside = (x >= spans[0].length) & (x <= length - spans[-1].length)
            assert inside.any()
            changed = np.where(inside, force, force + spike)
            low, high = wire_ends.scale(made.result, states, name, changed)
            # places of supports are those within half a metre: wires bend and stagger
            less = force[(x >= spans[0].length + 0.5) & (x <= length - spans[-1].length - 0.5)]
            more = force[(x >= spans[0].length - 0.5) & (x <= length - spans[-1].length + 0.5)]
            assert more.min() <= low <= less.min()
            assert less.max() <= high <= more.max()

    @pytest.mark.parametrize("count", [1, 2])
    def test_goes_with_the_curves(self, count):
        made = run(count)
        states = Histories(made.result)
        found = [c for c in curves(made.result, states, [], make_scene(made.result)) if c.unit == "N"]
        forces = {c.name: c for c in found if c.panel == "contact force"}
        assert set(forces) == set(names(made.result))
        for name, curve in forces.items():
            force = made.result.sensors.contact_force(name)
            assert curve.scale == wire_ends.scale(made.result, states, name, force)
            assert plain_curve(curve, Numbers())["scale"] == curve.scale
        assert all(c.scale is None for c in found if c.name not in forces)


def pushed(places, speed):
    """A head that runs along a wire of 10 m from 1 m on, and points of the wire, recorded in this order."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e5, EI=1.0, rhoA=0.5)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(10, 0, 0), elements=20, length=9.99, section=section)
    model.pin(wire.start)
    model.pin(wire.end)
    head = model.add_point_mass("head", at=(1, 0, -0.02), mass=1.0)
    model.hold(head, position="xy", displacement=[f"{speed}*t", 0, 0])
    model.add_force(head, (0, 0, 30.0))
    touch = model.add_contact(head, wire, stiffness=5e4, strip=(0, 1, 0), name="touch")
    return ancf.simulate(model, t_end=0.5, step=1e-3, sensors=[touch, *map(wire.at, places)])


@pytest.mark.parametrize("order", [(2, 4, 6, 8), (8, 6, 4, 2), (4, 8, 2, 6), (6, 2, 8, 4)])
def test_supports_may_be_recorded_in_any_order(order):
    """From 2 m on the head is past the first of them, and it stops before the last one."""
    result = pushed([float(x) for x in order], 8.0)
    force = result.sensors.contact_force("touch")
    inside = 1.0 + 8.0 * result.sensors.t >= 2.0
    changed = np.where(inside, force, 1e4)
    low, high = wire_ends.scale(result, Histories(result), "touch", changed)
    assert (low, high) == pytest.approx((force[inside].min(), force[inside].max()), abs=0.5)


@pytest.mark.parametrize("points", [0, 1, 3])
@pytest.mark.parametrize("speed", [2.0, 8.0])
def test_wires_without_recorded_supports_have_none(points, speed):
    result = pushed([2.0 * (k + 1) for k in range(points)], speed)
    force = result.sensors.contact_force("touch")
    assert wire_ends.scale(result, Histories(result), "touch", force) is None
