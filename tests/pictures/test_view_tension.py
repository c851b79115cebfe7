"""Tensions of cables in the viewer: what their elements carry, and the panels that matter first."""

from functools import cache

import numpy as np
import pytest

import ancf
from ancf.results.tension import along, extremes
from ancf.viz.scene import make_scene
from ancf.viz.view.curves import curves
from ancf.viz.view.histories import Histories
from ancf.viz.view.ranges import ranges
from ancf.viz.view.traces import traces


def hung(elements, x0=0.0, stiffness=1e8, damping=0.0):
    """A stiff rope that hangs in a sharp bow between two pins."""
    section = ancf.Section(EA=stiffness, EI=1.0, rhoA=1.0, axial_damping=damping)
    model = ancf.Model(gravity=(0, 0, -9.81), title="Bow")
    rope = model.add_beam(
        "rope", start=(x0, 0, 0), end=(x0 + 2.0, 0, 0), length=8.0, elements=elements, section=section
    )
    model.pin(rope.start)
    model.pin(rope.end)
    return model


@cache
def swung(elements, x0=0.0, damping=0.0):
    model = hung(elements, x0, damping=damping)
    rope = model.bodies["rope"]
    model.add_force(rope.at(4.0), ("20*sin(3*t)", 0.0, 0.0))
    rest = ancf.equilibrium(model)
    return ancf.simulate(model, t_end=0.4, step=4e-3, start=rest, sensors=[rope.end, rope.at(4.0)])


CASES = [(6, 0.0), (8, 0.0), (13, 0.0), (8, 1e3)]


class TestAlong:
    @pytest.mark.parametrize(("elements", "damping"), CASES)
    def test_extremes_are_those_that_verify_tells(self, elements, damping):
        result = swung(elements, damping=damping)
        rope = result.bodies["rope"]
        low, high = extremes(result, [rope])["rope"]
        (found,) = ranges(Histories(result), make_scene(result))
        thread = make_scene(result, frames=10_000).threads[0]
        for values in (found.values["tension"], thread.values["tension"]):
            assert values.min() >= low - 1e-9 * high
            assert values.max() <= high + 1e-9 * high
        x = 0.5 * (rope.node_x[1:] + rope.node_x[:-1])
        middles = along(result, rope, x)
        assert (middles.min(), middles.max()) == pytest.approx((low, high), rel=1e-9)
        nodes = np.stack([result.tension(rope.at(float(s))) for s in rope.node_x])
        assert nodes.max() - nodes.min() > 1.2 * (high - low)  # there they waver

    @pytest.mark.parametrize("elements", [1, 2, 5])
    def test_is_straight_between_middles_and_constant_beyond(self, elements):
        result = swung(max(elements, 2)) if elements > 1 else _one()
        rope = result.bodies["rope"]
        x = np.linspace(0.0, rope.length, 23)
        middles = 0.5 * (rope.node_x[1:] + rope.node_x[:-1])
        known = np.stack([result.tension(rope.at(float(s))) for s in middles], axis=1)
        wanted = np.stack([np.interp(x, middles, row) for row in known])
        assert along(result, rope, x) == pytest.approx(wanted, rel=1e-9, abs=1e-9 * np.abs(known).max())


def _one():
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=1.0)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=1, section=section)
    model.pin(rope.start)
    return ancf.simulate(model, t_end=0.05, step=1e-3)


class TestPanels:
    @pytest.mark.parametrize("x0", [0.0, 3.0, 60.0, -400.0])
    def test_paths_far_from_the_origin_count_from_their_place(self, x0):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e4, EI=0.1, rhoA=1.0)
        rope = model.add_beam("rope", start=(x0, 0, 0), end=(x0 + 1.0, 0, 0), elements=2, section=section)
        model.pin(rope.start)
        result = ancf.simulate(model, t_end=0.2, step=2e-3)
        found = _curves(result)
        near = abs(x0) > 20.0
        panel = f"x, z {'displacement ' if near else ''}of rope.end"
        (x, z) = [c for c in found if c.panel == panel]
        path = result.position("rope.end")
        assert x.values == pytest.approx(path[:, 0] - near * path[0, 0], abs=1e-9)
        assert z.values == pytest.approx(path[:, 2] - near * path[0, 2], abs=1e-9)

    @pytest.mark.parametrize(("pull", "first"), [(0.0, True), (1e5, False)])
    def test_tensions_of_sensors_come_first_if_they_change(self, pull, first):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e6, EI=0.1, rhoA=1.0)
        rope = model.add_beam("rope", start=(0, 0, 0), end=(10, 0, 0), elements=4, section=section)
        model.pin(rope.start)
        model.hold(rope.end, position="yz")
        model.add_force(rope.end, (pull + 10.0, 0.0, 0.0))
        rest = ancf.equilibrium(model)
        model.add_force(rope.at(5.0), (0.0, 0.0, "50*sin(20*t)"))
        result = ancf.simulate(model, t_end=0.3, step=1e-3, start=rest, sensors=[rope.end, rope.at(2.5)])
        panels = list(dict.fromkeys(c.panel for c in _curves(result)))
        at = panels.index("tension of sensors")
        assert at == 0 if first else at > panels.index("energy, potential from the start")


def _curves(result):
    scene, states = make_scene(result), Histories(result)
    return curves(result, states, traces(states, scene, None), scene)


class TestTable:
    @pytest.mark.parametrize(("elements", "stiffness"), [(6, 1e8), (10, 1e8), (60, 1e3)])
    def test_forces_that_waver_are_marked(self, call, tmp_path, elements, stiffness):
        path = tmp_path / "bow.toml"
        path.write_text(
            f"""
            gravity = [0.0, 0.0, -9.81]
            supports = [{{ type = "pin", point = "rope.start" }}, {{ type = "pin", point = "rope.end" }}]
            [[bodies]]
            name = "rope"
            start = [0.0, 0.0, 0.0]
            end = [2.0, 0.0, 0.0]
            length = 8.0
            elements = {elements}
            section = {{ EA = {stiffness}, EI = 1.0, rhoA = 1.0 }}
            [equilibrium]
            """
        )
        done = call("run", path, "-o", tmp_path / "out")
        assert done.code == 0, done.err
        wavers = "waver within its elements" in done.out
        assert wavers == (stiffness > 1e4)
        rows = [line.split() for line in done.out.splitlines() if line.startswith("rope.")]
        assert len(rows) == 3
        assert all(row[4].startswith("~") == wavers for row in rows)
        assert ("~ wavers within elements" in done.out) == wavers
