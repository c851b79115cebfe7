"""Several tension lengths along one track: how they rest, how a pantograph is handed over, files, reports."""

from functools import cache

import numpy as np
import pytest
from typer.testing import CliRunner

import ancf
from ancf import ModelError
from ancf.catenary import Conditions, Route, Span, assemble, elasticity, form, read_line, run, statistics
from ancf.catenary.rest import check_track
from ancf.cli.app import app
from overhead_lines import COARSE, STEP, TOML, collector, droppers, short_line
from places import EXAMPLES

LENGTH, SPANS, SHARED = 40.0, 7, 4
#: Where the second tension length begins, m, and where both wires are level, m.
BEGIN = LENGTH * (SPANS - SHARED)
LEVEL = BEGIN + 2 * LENGTH


def section(first, **changes):
    """A level line whose last two supports are raised, or its first two, beside the other one."""
    height, stagger = np.zeros(SPANS + 1), np.full(SPANS + 1, 0.1)
    height[:2] = 0.35, 0.06
    spans = [Span(length=LENGTH, droppers=droppers(LENGTH))] * SPANS
    given = {"spans": spans, "anchors": "tension", "contact_support": "free"}
    given |= {
        "height": tuple(height[::-1] if first else height),
        "stagger": tuple(stagger if first else -stagger),
    }
    return short_line(**(given | changes))


def route(**changes):
    return Route(lines=(section(True, **changes), section(False, **changes)), starts=(0.0, BEGIN))


@cache
def found():
    return form(route(), COARSE)


class TestRoute:
    def test_places(self):
        made = route()
        assert made.length == BEGIN + SPANS * LENGTH
        assert made.supports.tolist() == [*np.arange(8) * LENGTH, *(BEGIN + np.arange(8) * LENGTH)]
        assert made.marks.tolist() == (np.arange(11) * LENGTH).tolist()
        assert made.dropper_x.size == 70
        assert made.dropper_span[[0, 34, 35]].tolist() == [0, 6, 7]
        low, high = made.reach
        assert (low[8], high[7], low[9], high[9]) == (-np.inf, np.inf, BEGIN + 20.0, BEGIN + 60.0)

    @pytest.mark.parametrize("ask", [check_track, form])
    @pytest.mark.parametrize("wrong", [0, 1])
    def test_what_is_wrong_is_said_of_its_section(self, wrong, ask):
        for height in (0.05, 0.2):
            lines = [section(k == 0, **({"system_height": height} if k == wrong else {})) for k in (0, 1)]
            with pytest.raises(ModelError, match=r"the messenger hangs .* below the contact wire") as caught:
                ask(Route(lines=tuple(lines), starts=(0.0, BEGIN)))
            assert caught.value.where.startswith(f"sections[{wrong}].spans[")

    @pytest.mark.parametrize("curved", [(), (0,), (1,), (0, 1)])
    def test_what_is_odd_is_said_of_its_section(self, curved):
        """A versine of 0.75 m leaves strips of 1.45 m."""
        bends = [Span(length=LENGTH, droppers=droppers(LENGTH), radius=LENGTH**2 / 8 / 0.75)] * SPANS
        changes = {"spans": bends, "stagger": 0.0}
        lines = [section(k == 0, **(changes if k in curved else {})) for k in (0, 1)]
        told = check_track(Route(lines=tuple(lines), starts=(0.0, BEGIN)))
        assert [text.partition(":")[0] for text in told] == [
            f"sections[{k}].spans[{j}].radius" for k in curved for j in range(SPANS)
        ]

    def test_height_is_that_of_the_lowest_wire(self):
        made = route()
        assert made.height_at([0.0, BEGIN, LEVEL, BEGIN + 140.0]) == pytest.approx([0.0, 0.0, 0.0, 0.0])
        first = made.lines[0].height_at(BEGIN + 150.0)
        assert first > 0.1
        assert made.height_at(BEGIN + 150.0) == 0.0

    @pytest.mark.parametrize("start", [290.0, 0.0, -10.0, 280.0])
    def test_sections_that_do_not_meet(self, start):
        lines = route().lines
        with pytest.raises(ModelError, match="have to overlap") as caught:
            Route(lines=lines, starts=(0.0, start))
        assert caught.value.where == "sections[1].start"

    @pytest.mark.parametrize(
        ("first", "heights", "said"),
        [
            (True, (0.0,) * (SPANS + 1), r"sections\[0\].height\[7\]: is 0 m: the wire ends 0\.\d+ m below"),
            (
                False,
                (*(-0.2,) * SPANS, 0.3),
                r"sections\[1\].height\[0\]: is -0.2 m: the wire begins 0.2 m below",
            ),
        ],
    )
    def test_sections_whose_wires_do_not_meet(self, first, heights, said):
        """A wire that begins or ends below the other one hands nothing over."""
        lines = [section(True), section(False, height=tuple(np.add(section(False).heights, 0.0)))]
        lines[0 if first else 1] = section(first, height=heights)
        if first:
            lines[1] = section(False, height=(0.35, 0.2, 0.1, 0.1, 0.1, 0.0, 0.0, 0.0))
        with pytest.raises(ModelError, match=said):
            Route(lines=tuple(lines), starts=(0.0, BEGIN))

    def test_other_conditions(self):
        with pytest.raises(ModelError, match=r"sections\[1\]\.conditions"):
            Route(lines=(section(True), section(False, conditions=Conditions(ice=1.0))), starts=(0.0, BEGIN))

    def test_rests_as_its_sections_do(self):
        """The equilibrium of the whole model is where each form by itself says."""
        overhead = assemble(found())
        state = ancf.equilibrium(overhead.model)
        for part, alone in zip(overhead.parts, found().shifted, strict=True):
            assert part.contact.positions(state) == pytest.approx(alone.contact.position, abs=1e-6)
            assert part.messenger.positions(state) == pytest.approx(alone.messenger.position, abs=1e-6)
        assert len(found().schedule()) == 70
        assert str(found()).startswith(f"{found().line.title or 'Overhead line'}, at rest")
        assert repr(found()).startswith("RouteForm(")

    def test_hot(self):
        """Both sections are in the same conditions, and each travels about its own anchor."""
        hot = form(route(conditions=Conditions(temperature=40.0)), COARSE)
        for one in hot.forms:
            travel = np.ptp(one.contact.position[[0, -1], 0]) - SPANS * LENGTH
            assert travel == pytest.approx(17e-6 * 30.0 * SPANS * LENGTH, rel=1e-3)

    def test_elasticity_is_of_the_longest(self):
        whole, alone = (
            elasticity(item, [50.0], points=2, mesh=COARSE) for item in (route(), route().lines[0])
        )
        assert whole.value == pytest.approx(alone.value)
        lifted = elasticity(found(), [50.0], points=2)
        assert lifted.span == whole.span
        assert lifted.value == pytest.approx(whole.value, rel=1e-9)


class TestHandOver:
    def test_force_jumps_by_less_than_two_percent(self):
        """Slowly, so that nothing vibrates: the sum of both contacts stays what lifts the pantograph."""
        unit = collector(damping=(200.0, 50.0))
        window = (LEVEL - 20.0, LEVEL + 20.0)
        with pytest.warns(UserWarning, match="run.window"):
            done = run(
                found(),
                speed=3.0,
                pantograph=unit,
                step=4e-3,
                start=LEVEL - 30.0,
                window=window,
                until=LEVEL + 30.0,
            )
        recording = done.recordings[0]
        inside = np.abs(recording.position - LEVEL) < 20.0
        mean = statistics(done)["mean_force"].value
        assert mean == pytest.approx(120.0, rel=0.01)
        assert np.abs(recording.force[inside] - mean).max() < 0.02 * mean

    @pytest.mark.parametrize("speed", [20.0, 40.0])
    def test_momentum(self, speed):
        """What both contacts take, and what lifts the pantograph, is its momentum, 1e-6 of the impulse."""
        overhead = assemble(found())
        unit = collector(stiffness=(0.0, 4200.0), damping=(90.0, 10.0))
        one = overhead.add_pantograph(unit, speed, start=LEVEL - 60.0)
        masses = [overhead.model.bodies[f"pantograph mass {k}"] for k in (1, 2)]
        result = ancf.simulate(
            overhead.model,
            t_end=120.0 / speed,
            step=5e-4,
            start=ancf.equilibrium(overhead.model),
            integrator=ancf.Trapezoidal(),
            sensors=[*one.sensors(), *masses],
            energy=False,
        )
        sensors, step = result.sensors, 5e-4
        forces = [sensors.contact_force(meter) for meter in one.meters]
        assert np.any((forces[0] > 10.0) & (forces[1] > 10.0))  # they share the strip
        assert forces[0][-1] == 0.0
        assert forces[1][0] == 0.0
        assert forces[0][0] > 50.0
        assert forces[1][-1] > 50.0
        height = sensors.position(masses[0])[:, 2]
        spring = 0.1 * (height - height[0])  # of the faint spring that stands for none
        net = 120.0 - sum(forces) - spring
        pushed = np.sum(0.5 * step * (net[1:] + net[:-1])) - 90.0 * (height[-1] - height[0])
        speeds = [sensors.velocity(m)[[0, -1], 2] for m in masses]
        gained = sum(m.mass * (v[1] - v[0]) for m, v in zip(masses, speeds, strict=True))
        assert gained == pytest.approx(pushed, abs=1e-6 * 120.0 * 120.0 / speed)

    def test_run_is_recorded(self):
        done = run(found(), speed=40.0, pantograph=collector(), step=STEP, spacing=60.0)
        assert done.uplift.shape[1] == 16
        assert done.dropper_force.shape[1] == 70
        for k in (0, 1):
            numbers = statistics(done, k)
            passed = {u.number for u in numbers.supports}
            assert {6, 9, 10} <= passed
            recording = done.recordings[k]
            assert np.all(np.abs(recording.stagger) < 0.13)
            assert np.all(np.isfinite(recording.height))


FILE = TOML.partition("[[spans]]")[0]


class TestFile:
    def path(self, tmp_path, second="start = 64.0"):
        spans = "[[sections.spans]]\nrepeat = 4\nlength = 32.0\ndroppers = {first = 3.0, pitch_max = 7.0}\n"
        rise = "height = [0.0, 0.0, 0.0, 0.02, 0.3]", "height = [0.3, 0.02, 0.0, 0.0, 0.0]"
        text = (
            FILE + f"[[sections]]\nstart = 0.0\n{rise[0]}\n{spans}[[sections]]\n{second}\n{rise[1]}\n{spans}"
        )
        path = tmp_path / "route.toml"
        path.write_text(text.replace('title = "Short line"', 'title = "Two sections"\nanchors = "tension"'))
        return path

    def test_is_a_route(self, tmp_path):
        made = read_line(self.path(tmp_path))
        assert isinstance(made, Route)
        assert made.starts == (0.0, 64.0)
        assert made.lines[1].heights[0] == 0.3

    @pytest.mark.parametrize(
        ("second", "said"),
        [
            ("start = 140.0", "sections[1].start: is 140 m, the section before reaches from 0 to 128 m"),
            ("", "sections[1].start: is missing"),
            ("start = 64.0\nstager = 0.2", "sections[1].stager: unknown key"),
            ("start = 64.0\nstagger = [0.1]", "sections[1].stagger: has 1 values"),
            ('start = 64.0\nsupports = "no.csv"', "sections[1].spans: and supports are given both"),
        ],
    )
    def test_wrong(self, tmp_path, second, said):
        done = CliRunner().invoke(app, ["check", str(self.path(tmp_path, second))])
        assert done.exit_code == 2
        assert said in " ".join(done.output.split())

    def test_commands(self, tmp_path):
        path, out = str(self.path(tmp_path)), tmp_path / "out"
        for command in (["check", path], ["info", path], ["catenary", "form", path, "-o", str(out)]):
            done = CliRunner().invoke(app, command)
            assert done.exit_code == 0, done.output
        assert len((out / "schedule.csv").read_text().splitlines()) == 1 + 2 * 4 * 5
        options = ["--speed", "100", "--pantograph", "en50318-2002", "--step", "0.002", "--mesh", "2", "3"]
        done = CliRunner().invoke(app, ["catenary", "run", path, "-o", str(out), *options])
        assert done.exit_code == 0, done.output
        page = (out / "report.html").read_text()
        assert "section 2: contact wire" in page
        assert "0 to 128, 64 to 192" in page


class TestExample:
    """examples/tension_length.toml: overlap, curve, gradient."""

    def test_rests_and_runs(self):
        line = read_line(EXAMPLES / "tension_length.toml")
        made = form(line, COARSE)
        assert made.dropper_load.min() > 20.0
        curve = made.forms[0].arm_force[3:5, 1] / (0.5 * (52.0 + 52.0) / 4000.0)
        assert curve[1] == pytest.approx(-20e3, rel=2e-3)  # its staggers there are alike
        assert made.contact_height == pytest.approx(
            np.concatenate([one.dropper_height for one in line.lines]), abs=5e-4
        )
        unit, place = "benchmark-2015", {"start": 210.0, "window": (468.0, 572.0)}
        done = run(made, speed=250 / 3.6, pantograph=unit, spacing=200.0, step=2e-3, **place)
        for k in (0, 1):
            number = statistics(done, k)
            assert number["mean_force"].value == pytest.approx(number["mean_force_law_ac"].value, rel=0.02)
            assert number["deviation"].value < 0.3 * number["mean_force"].value
            assert number["loss_number"].value == 0
