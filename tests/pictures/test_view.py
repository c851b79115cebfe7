"""The page that ``ancf view`` writes: what is in it."""

import re
from dataclasses import replace
from html.parser import HTMLParser
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

import ancf
import viewed
from ancf.system.system import System
from ancf.viz.scene import Marker, Scene, Thread, make_scene
from ancf.viz.view import page, view_page
from ancf.viz.view.curve import decimated
from ancf.viz.view.curves import _energies
from ancf.viz.view.encode import color_limits
from ancf.viz.view.histories import STATES, Histories
from ancf.viz.view.page import plotly_script
from ancf.viz.view.traces import Trace, most_moved
from helpers import rotation
from viewed import STRIP, array_of, data_of


@pytest.fixture(scope="module")
def cantilever(tmp_path_factory):
    return viewed.cantilever(tmp_path_factory.mktemp("cantilever"))


@pytest.fixture(scope="module")
def bead():
    return viewed.bead()


class Elements(HTMLParser):
    """Checks that elements close in order; keeps the addresses that a browser would ask for."""

    VOID = frozenset({"meta", "link", "input", "br"})

    def __init__(self, text):
        super().__init__()
        self.open, self.addresses, self.seen = [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.seen.append(tag)
        self.addresses += [value for key, value in attrs if key in ("src", "href")]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


class TestPage:
    def test_html_is_whole_and_asks_for_nothing(self, cantilever):
        text = view_page(cantilever)
        parsed = Elements(text)
        assert parsed.open == []
        assert parsed.seen.count("script") == 3
        assert parsed.addresses == ["data:,"]
        rest = text.replace(plotly_script(), "")
        assert not re.search(r"https?://|@import|url\(|fetch\(|import\(", rest)
        assert "{{" not in rest

    def test_title_is_escaped(self, cantilever):
        text = view_page(cantilever)
        assert "<title>Größe &lt;1&gt; &amp; &lt;/script&gt;</title>" in text
        assert "<1>" not in text.replace(plotly_script(), "")

    def test_script_of_a_name_stays_text(self, cantilever):
        """A name that looks like the end of the script, or like a comment in it, is data."""
        name = "</script><!--<script>"
        scene = make_scene(cantilever, frames=2, points=4)
        text = page(replace(scene, threads=[replace(scene.threads[0], name=name)]), "x")
        assert Elements(text).seen.count("script") == 3
        assert data_of(text)["scene"]["threads"][0]["name"] == name
        assert name not in text

    def test_positions_and_colours_come_back(self, cantilever):
        scene = make_scene(cantilever, frames=50, points=60)
        data = data_of(page(scene, "x"))
        [thread], [wanted] = data["scene"]["threads"], scene.threads
        assert wanted.position.shape[0] == 50
        close = array_of(data, thread["position"])
        np.testing.assert_array_equal(close, wanted.position.astype(np.float32).astype(float))
        np.testing.assert_allclose(array_of(data, data["scene"]["t"]), scene.t, rtol=1e-7)
        for name, values in wanted.values.items():
            step = np.ptp(values) / 65535
            assert np.abs(array_of(data, thread["values"][name]) - values).max() <= 0.51 * step

    def test_outline_comes_back(self):
        rng = np.random.default_rng(3)
        centre = rng.uniform(0, 100, (4, 5, 3))
        corners = centre[:, :, None] + 0.01 * rng.uniform(-1, 1, (4, 5, 4, 3))
        scene = Scene("", np.arange(4.0), [Thread("a", "original", np.arange(5.0), centre, {}, corners)])
        data = data_of(page(scene, "x"))
        [thread] = data["scene"]["threads"]
        found = array_of(data, thread["outline"]) + centre[:, :, None]
        assert np.abs(found - corners).max() < 1e-6

    def test_what_rests_is_kept_once(self, bead):
        data = data_of(view_page(bead))
        kept = {group["kind"]: group["position"]["shape"] for group in data["scene"]["markers"]}
        count = len(array_of(data, data["scene"]["t"]))
        assert kept["pin"] == [1, 2, 3]
        assert kept["point mass"] == [count, 1, 3]

    def test_guides_of_a_moving_mass_are_left_out(self):
        t, way = np.arange(3.0), np.arange(9.0).reshape(3, 3)
        still = np.zeros((3, 3))
        markers = [Marker("m", "point mass", way), Marker("h", "hold", way), Marker("p", "pin", still)]
        scene = Scene("", t, [Thread("a", "cable", np.arange(2.0), np.zeros((3, 2, 3)))], [], markers)
        found = data_of(page(scene, "x"))["scene"]["markers"]
        assert [(group["kind"], group["names"]) for group in found] == [("point mass", ["m"]), ("pin", ["p"])]

    def test_size(self, cantilever):
        assert len(view_page(cantilever)) < len(plotly_script()) + 2_000_000

    def test_words_about_the_run(self, cantilever, tmp_path):
        text = view_page(cantilever, file="results.h5", frames=20)
        assert '<span class="badge good">complete</span>' in text
        assert f"ancf {ancf.__version__}" in text
        assert "results.h5: 20 of 201 states" in text

    def test_a_run_that_failed_says_so(self, cantilever, tmp_path):
        copy = tmp_path / "failed.h5"
        cantilever.save(copy)
        with h5py.File(copy, "r+", libver="latest") as file:
            file["status"][()] = 2
            file["time"].resize(101, axis=0)
        text = view_page(ancf.load(copy))
        assert '<span class="badge bad">failed at t = 0.1 s of 0.2 s</span>' in text

    def test_state_has_neither_curves_nor_traces(self, cantilever, bead):
        data = data_of(view_page(cantilever.state(-1)))
        assert data["curves"] == data["traces"] == []
        assert data["scene"]["threads"][0]["position"]["shape"][0] == 1

    def test_mode_swings(self, cantilever):
        start = cantilever.state(0)
        modes = ancf.modes(start.model, about=start, count=2)
        data = data_of(view_page(modes, mode=1, frames=33))
        position = array_of(data, data["scene"]["threads"][0]["position"])
        t = array_of(data, data["scene"]["t"])
        assert t[-1] == pytest.approx(1 / modes.frequencies_hz[1], rel=1e-6)
        np.testing.assert_allclose(position[8] + position[24], 2 * position[0], atol=1e-6)
        assert data["scene"]["quantities"] == []
        assert [trace["name"] for trace in data["traces"]] == ["beam.end"]


def bodies_that_turned():
    """Two turned rigid bodies: a state, and the rotations."""
    model, turns = ancf.Model(), (rotation((0, 0, 1), 0.7), rotation((1, 2, -0.5), 2.1))
    for k, turn in enumerate(turns):
        model.add_rigid_body(f"body {k}", at=(2.0 * k, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.25), axes=turn)
    system = System(model)
    return ancf.State(system, 0.0, *system.initial_state()), turns


class TestBodyAxes:
    def test_are_the_columns_of_the_rotation(self):
        """From the centre to where a point of each axis is."""
        state, turns = bodies_that_turned()
        scene = make_scene(state)
        data = data_of(page(scene, "x"))
        triads = data["scene"]["triads"]
        centre, axes = (array_of(data, triads[key])[0] for key in ("centre", "axes"))
        for k, turn in enumerate(turns):
            size = scene.triads[k].size
            assert axes[k] / size == pytest.approx(turn, abs=1e-6)
            for j, corner in enumerate(size * np.eye(3)):
                point = state.system.model.bodies[f"body {k}"].at(*corner)
                assert centre[k] + axes[k][:, j] == pytest.approx(state.position(point), abs=1e-5)


class TestHistories:
    @pytest.mark.parametrize("count", [STATES - 1, STATES, STATES + 1, 2 * STATES + 1, 70_000])
    def test_velocities_are_those_of_the_times(self, count):
        """Beyond so many states every second, third, ... one is kept, of all arrays alike."""
        state, _ = bodies_that_turned()
        t = np.linspace(0.0, 3.0, count)
        q, v = (np.repeat(a[None, :3], count, axis=0) for a in (state.q, state.v))
        q[:, 0], v[:, 0] = np.sin(5 * t), 5 * np.cos(5 * t)
        model = ancf.Model()
        body = model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
        whole = SimpleNamespace(
            model=model,
            bodies={"mass": body},
            slots={"mass": np.array([[0]])},
            springs={},
            joints={},
            arcs={},
            lengths={},
            t=t,
            q=q,
            v=v,
        )
        kept = Histories(whole)
        assert count / 5 < len(kept.t) <= STATES
        assert kept.position("mass")[:, 0] == pytest.approx(np.sin(5 * kept.t), abs=1e-12)
        assert kept.velocity("mass")[:, 0] == pytest.approx(5 * np.cos(5 * kept.t), abs=1e-12)


class TestChoice:
    def test_default_traces_are_those_that_move(self, cantilever, bead):
        assert [trace["name"] for trace in data_of(view_page(cantilever))["traces"]] == ["beam.end"]
        assert [trace["name"] for trace in data_of(view_page(bead))["traces"]] == ["bead"]

    @pytest.mark.filterwarnings("ignore:energies of the run do not add up")  # a rope that is pressed together
    def test_middle_of_a_body_whose_ends_are_held(self):
        model = ancf.Model(gravity=(0.0, 0.0, -9.81))
        beam = model.add_beam("rope", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=STRIP, length=2.1)
        model.pin(beam.start)
        model.pin(beam.end)
        result = ancf.simulate(model, t_end=0.05, step=1e-3)
        assert [trace["name"] for trace in data_of(view_page(result))["traces"]] == ["rope.at(1.05)"]

    def test_trace_that_is_asked_for(self, cantilever):
        data = data_of(view_page(cantilever, trace=["beam.at(0.3)", "beam.end"]))
        assert [trace["name"] for trace in data["traces"]] == ["beam.at(0.3)", "beam.end"]
        wanted = cantilever.position("beam.at(0.3)")
        assert np.abs(array_of(data, data["traces"][0]["position"]) - wanted).max() < 1e-7

    def test_paths_of_one_form_are_shown_once(self):
        """Points of a body that moves without turning, wherever they are; another form is another path."""
        t = np.linspace(0.0, 1.0, 9)
        path = np.stack([np.cos(6 * t), 0 * t, np.sin(6 * t)], axis=1)
        scene = Scene("", t, threads=[Thread("a", "cable", np.zeros(9), 3 * path[None], {}, None)])
        given = [
            Trace("a", t, path),
            Trace("b", t, path + np.array([5.0, 1.0, 0.0])),
            Trace("c", t, path[::-1]),
        ]
        assert [trace.name for trace in most_moved(given, scene)] == ["a", "c"]

    def test_colour_limits(self):
        values = np.linspace(2.0, 5.0, 1000)
        assert color_limits([values[:10], values[10:]]) == (2.0, 5.0, False)
        low, high, clipped = color_limits([np.append(values, 1e6)])
        assert clipped
        assert 2.0 <= low < 2.1
        assert 4.9 < high <= 5.1
        low, high, clipped = color_limits([np.full(9, 7.0)])
        assert low == 7.0 < high
        assert not clipped


class TestCurves:
    def test_decimation_keeps_the_extremes(self):
        t = np.linspace(0.0, 1.0, 100_001)
        values = np.sin(300 * t)
        values[77_777], values[12_345] = 9.0, -8.0
        few, found = decimated(t, values, 2000)
        assert len(few) <= 2000
        assert (np.diff(few) > 0).all()
        assert (few[0], few[-1]) == (0.0, 1.0)
        assert (found.max(), found.min()) == (9.0, -8.0)
        np.testing.assert_array_equal(values[np.searchsorted(t, few)], found)

    def curves(self, result, **options):
        data = data_of(view_page(result, **options))
        return {
            (c["panel"], c["name"]): tuple(array_of(data, c[key]) for key in ("t", "values"))
            for c in data["curves"]
        }

    def test_energies(self, cantilever):
        found = self.curves(cantilever)
        t, total = found["energy, potential from the start", "total"]
        np.testing.assert_allclose(t, cantilever.t, rtol=1e-6)
        wanted = cantilever.energy.total - cantilever.energy.potential[0]
        np.testing.assert_allclose(total, wanted, atol=1e-6)

    def test_potential_energy_is_counted_from_the_start(self):
        """Its zero is where the model has z = 0, kilometres away perhaps."""
        t = np.linspace(0.0, 1.0, 3)
        parts = {"kinetic": 1 + t, "strain": 2 * t, "potential": 1e6 - 3 * t}
        found = {c.name: c.values for c in _energies(SimpleNamespace(t=t, energy=SimpleNamespace(**parts)))}
        assert found["potential"] == pytest.approx(-3 * t)
        assert found["total"] == pytest.approx(np.ones(3))

    def test_traced_points_joints_and_sensors(self, bead):
        found = self.curves(bead)
        x = found["x, z of bead", "x"][1]
        np.testing.assert_allclose(x, bead.position("bead")[:, 0], rtol=1e-6)
        np.testing.assert_allclose(found["arc length", "ring"][1], bead.arc_length("ring"), rtol=1e-6)
        force = np.linalg.norm(bead.multiplier("ring")[:, :3], axis=1)
        np.testing.assert_allclose(found["joint force", "ring"][1], force, rtol=1e-5)
        np.testing.assert_allclose(
            found["spring force", "string"][1], bead.spring_force("string"), rtol=1e-5, atol=1e-6
        )
        moved = bead.position("wire.at(2)")
        np.testing.assert_allclose(
            found["z displacement of sensors", "wire.at(2)"][1], moved[:, 2] - moved[0, 2], atol=1e-6
        )

    def test_part_of_a_run(self, cantilever):
        data = data_of(view_page(cantilever, start=0.05, end=0.1))
        curves, traces = ([(p, array_of(data, p["t"])) for p in data[key]] for key in ("curves", "traces"))
        for _, t in [*curves, *traces]:
            assert t == pytest.approx(np.linspace(0.05, 0.1, 51), rel=1e-6)

    def test_a_long_way_has_its_own_panel(self):
        model = ancf.Model()
        mass = model.add_point_mass("cart", at=(0, 0, 0), mass=1.0)
        model.pin(mass, displacement=("30*t", "0", "0.01*sin(9*t)"))
        rope = ancf.Section(EA=1e4, EI=0.01, rhoA=0.1)
        wire = model.add_beam("wire", start=(0, 1, 0), end=(4, 1, 0), elements=4, section=rope)
        model.pin(wire.start)
        model.pin(wire.end)
        result = ancf.simulate(model, t_end=0.5, step=5e-3, energy=False)
        panels = [panel for panel, _ in self.curves(result)]
        assert panels == ["z of cart", "x of cart"]
