"""Slack intervals: of strings in free flight, of ropes whose end is moved, and of made-up histories."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

import ancf
from ancf import ModelError
from ancf.results import slackness
from ancf.results.slackness import SlackInterval, of_ropes

G = 9.81


def thrown(speed, step=1e-3, output_step=None):
    """A mass on a stiff string, thrown upwards from where it hangs."""
    model = ancf.Model(gravity=(0, 0, -G))
    mass = model.add_point_mass("mass", at=(0, 0, -10), mass=2.0)
    mass.set_motion(velocity=(0, 0, speed))
    model.add_spring(mass, (0, 0, 0), stiffness=1e5, slack=True, damping=500.0, name="string")
    calm = ancf.GeneralizedAlpha()
    return ancf.simulate(model, t_end=1.5, step=step, output_step=output_step, integrator=calm)


def moved(amplitude, elements, EI=1e-6):
    """A rope with a mass below, whose upper end is shaken with 2 Hz; it is stiff, and let go at the top."""
    model = ancf.Model(gravity=(0, 0, -G))
    section = ancf.Section(EA=1e7, EI=EI, rhoA=1e-3, axial_damping=2e3)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -1), elements=elements, section=section)
    mass = model.add_point_mass("mass", at=(0, 0, -1), mass=3.0)
    model.connect(mass, rope.end)
    grow = "ramp(t, 0, 1)"
    model.pin(rope.start, displacement=[0, 0, f"{amplitude}*sin(4*pi*t)*{grow}"])
    start = ancf.equilibrium(model)
    return ancf.simulate(model, t_end=1.9, step=5e-4, start=start, integrator=ancf.GeneralizedAlpha(0.5))


class TestFlight:
    @pytest.mark.parametrize("speed", [1.0, 3.0, 5.0])
    @pytest.mark.parametrize("output_step", [None, 5e-3])
    def test_a_string_lasts_as_long_as_the_throw(self, speed, output_step):
        """2 v/g from the start, to the stored times."""
        result = thrown(speed, output_step=output_step)
        first = result.slack_intervals("string")[0]
        assert (first.start, first.tension, first.point) == (0.0, 0.0, "")
        assert first.duration == pytest.approx(2 * speed / G, abs=output_step or 2e-3)
        [same] = [item for item in result.slack_intervals() if item.start == 0.0]
        assert same == first

    @pytest.mark.parametrize(("amplitude", "count"), [(0.02, 0), (0.05, 0), (0.08, 1), (0.1, 1)])
    @pytest.mark.parametrize("elements", [1, 3])
    def test_a_rope_whose_end_falls_faster(self, amplitude, count, elements):
        """Slack from where A w^2 sin(w t) is g, at the earliest where the ramp is over."""
        result = moved(amplitude, elements)
        found = [item for item in result.slack_intervals("rope") if item.start > 1.0]
        assert (len(found) > 0) == (count > 0)
        if found:
            w = 4 * np.pi
            begins = 1.0 + np.arcsin(G / (amplitude * w**2)) / w
            assert found[0].start == pytest.approx(begins, abs=0.02)
            assert found[0].point.startswith("rope.at(")
            assert found[0].tension <= 0.0
            assert found[0].start <= found[0].t <= found[0].end


def made(t, forces, monkeypatch):
    """A history with given forces of two elements of a cable."""
    beam = ancf.Model().add_beam(
        "line", start=(0, 0, 0), end=(4, 0, 0), elements=2, section=ancf.Section(EA=1.0, EI=0.0, rhoA=1.0)
    )
    known = SimpleNamespace(t=np.asarray(t), springs={}, bodies={"line": beam})
    rows = np.arange(len(t))
    monkeypatch.setattr(
        slackness, "pieces", lambda *_: [(rows[:2], {"line": forces[:2]}), (rows[2:], {"line": forces[2:]})]
    )
    return known


class TestHistories:
    @pytest.mark.parametrize("below", [0.0, 2.0])
    def test_crossings_lie_on_straight_lines(self, monkeypatch, below):
        forces = np.array([[5.0, 8.0], [1.0, -3.0], [-1.0, -1.0], [5.0, 5.0], [9.0, 3.0]])
        known = made([0.0, 1.0, 2.0, 4.0, 5.0], forces, monkeypatch)
        [item] = slackness.slack_intervals(known, below=below)
        assert item.start == pytest.approx((5.0 - below) / 8.0)
        assert item.end == pytest.approx(2.0 + 2.0 * (1.0 + below) / 6.0)
        assert (item.tension, item.t, item.point, item.below) == (-3.0, 1.0, "line.at(3)", below)
        assert ("is slack from" in str(item)) == (below == 0.0)

    @pytest.mark.parametrize("seed", range(4))
    def test_as_many_as_there_are(self, monkeypatch, seed):
        rng = np.random.default_rng(seed)
        forces = rng.integers(-3, 9, (40, 2)).astype(float)
        known = made(np.arange(40.0), forces, monkeypatch)
        found = slackness.slack_intervals(known, below=1.0)
        low = "".join("s" if row.min() <= 1.0 else " " for row in forces)
        assert len(found) == len(low.split())
        assert [item.tension for item in found] == [
            min(forces[int(np.ceil(i.start)) : int(i.end) + 1].min(axis=1)) for i in found
        ]

    def test_of_nothing(self, monkeypatch):
        assert slackness.slack_intervals(SimpleNamespace(t=np.zeros(0), springs={}, bodies={})) == []


class TestAsked:
    @pytest.mark.parametrize(
        ("of", "where"),
        [
            ("strng", "unknown cable or slack spring 'strng'|did you mean"),
            (["string", "mass"], "slack_intervals.of"),
            (3.0, "is no cable and no spring"),
        ],
    )
    def test_of_what_there_is_not(self, of, where):
        with pytest.raises(ModelError, match=where):
            thrown(1.0).slack_intervals(of)

    def test_limits(self):
        with pytest.raises(ModelError, match=r"slack_intervals\.below"):
            thrown(1.0).slack_intervals(below=-1.0)

    @pytest.mark.parametrize(("EI", "count"), [(1e-6, 1), (1e3, 0)])
    def test_beams_are_not_told_unasked(self, EI, count):
        """A rod that bears what pulls it is pressed, not slack."""
        result = moved(0.1, 2, EI)
        assert (len(of_ropes(result)) > 0) == bool(count)
        assert len(result.slack_intervals()) > 0

    @pytest.mark.parametrize("most", [20, 1])
    def test_tables_of_commands(self, call, tmp_path, monkeypatch, most):
        monkeypatch.setattr("ancf.cli.info_result.MOST_SLACK", most)
        (tmp_path / "m.toml").write_text(
            """
gravity = [0, 0, -9.81]
[[bodies]]
type = "point_mass"
name = "mass"
at = [0, 0, -1]
mass = 2.0
motion = { velocity = [0, 0, 2.0] }
[[connections]]
type = "spring"
name = "string"
a = "mass"
b = [0, 0, 0]
stiffness = 1e5
slack = true
[simulation]
t_end = 2.0
step = 1e-3
""",
            "utf-8",
        )
        assert call("run", tmp_path / "m.toml", "-o", tmp_path / "out").code == 0
        told = json.loads((tmp_path / "out" / "summary.json").read_text("utf-8"))["slack"]
        result = ancf.load(tmp_path / "out" / "results.h5")
        assert [SlackInterval(**item) for item in told] == result.slack_intervals()
        assert told[0]["end"] == pytest.approx(4.0 / G, abs=2e-3)
        out = call("info", tmp_path / "out" / "results.h5").out
        rows = [line for line in out.splitlines() if "string" in line and f"{told[0]['end']:.6g}" in line]
        assert len(rows) == 1
        assert ("more slack interval" in out) == (len(told) > most)
