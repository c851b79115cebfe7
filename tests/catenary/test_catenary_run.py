"""Runs along a line: independent numbers, contact that only pushes, pantographs, profiles, bad input."""

import json
import re
import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import ancf
from ancf import ModelError, catenary
from ancf.catenary import Butterworth, Mesh, Span, form, read_line, reference_run, rows, run, statistics
from ancf.catenary.answers.passing import in_window
from ancf.catenary.answers.references import reference_case
from ancf.catenary.answers.statistics import mean_force_target
from ancf.catenary.vehicles.travel import make_travel
from overhead_lines import COARSE, LENGTHS, STAGGER, STEP, collector, droppers, short_line
from places import DATA

#: A model that shares nothing with this package: linear strings in a plane, tests/overhead_oracle.py.
ORACLE = json.loads((DATA / "catenary_runs.json").read_text(encoding="utf-8"))
#: The same model, trains of two pantographs.
TRAINS = json.loads((DATA / "overhead_oracle.json").read_text(encoding="utf-8"))
#: The filter of these numbers.
FILTER = Butterworth(4)
#: Contact stiffness of the standard, N/m.
STIFFNESS = 50e3


@cache
def reference(speed_kmh):
    return reference_run("en50318-2002", speed_kmh)


@cache
def short_form():
    return form(short_line(), COARSE)


@cache
def plain():
    return run(short_form(), speed=40.0, pantograph=collector(), step=STEP)


def quick(**changes):
    """One run along the short line."""
    given = {"speed": 40.0, "pantograph": collector(), "step": STEP}
    return run(short_form(), **(given | changes)) if changes else plain()


class TestReferenceCase:
    """EN 50318:2002 on its own mesh and step."""

    @pytest.mark.parametrize("speed", [250, 300])
    def test_all_rows_are_inside(self, speed):
        outside = [row for row in rows(reference(speed), "en50318-2002") if not row["inside"]]
        assert not outside

    @pytest.mark.parametrize("speed", [250, 300])
    @pytest.mark.parametrize(
        ("key", "name", "relative"),
        [
            ("mean_force", "mean", 2e-3),
            ("deviation", "sigma", 0.02),
            ("deviation_0_5", "sigma_0_5", 0.02),
            ("maximum", "max", 0.015),
            ("uplift", "uplift", 0.02),
        ],
    )
    def test_as_an_independent_model_has_it(self, speed, key, name, relative):
        """What is left is geometry: tension that varies a little, droppers that tilt."""
        found = statistics(reference(speed), filter=FILTER)[key].value
        assert found == pytest.approx(ORACLE[f"en50318-2002.{speed}"][name], rel=relative)

    @pytest.mark.filterwarnings("ignore:contact of pantograph.* chatters:UserWarning")
    def test_joint_is_the_limit_of_a_stiff_contact(self):
        """The standard's 50 kN/m is soft: with the head it swings at 13 Hz, below the filter."""
        shape = form(read_line("en50318-2002").excerpt(0, 7), COARSE)
        given = {"speed": 250 / 3.6, "pantograph": "en50318-2002", "window": (180.0, 240.0)}
        joint = run(shape, contact="joint", step=1e-3, integrator=damped(0.3), **given)
        stiff = run(shape, contact_stiffness=2e6, step=5e-4, integrator=damped(0.6), **given)
        soft = run(shape, step=1e-3, **given)
        sigma = [statistics(done)["deviation"].value for done in (joint, stiff, soft)]
        assert sigma[0] == pytest.approx(sigma[1], rel=0.02)
        assert sigma[2] > 1.08 * sigma[1]

    @pytest.mark.filterwarnings("ignore:mesh.contact. elements of 2 m:UserWarning")
    def test_joint_on_the_contact_stiffness_is_the_penalty(self):
        shape = form(read_line("en50318-2002").excerpt(0, 7), COARSE)
        given = {"speed": 300 / 3.6, "pantograph": "en50318-2002", "window": (180.0, 240.0)}
        joint = run(shape, contact="joint", contact_stiffness=STIFFNESS, **given)
        _assert_close(joint, run(shape, **given), 0.02)

    def test_finer_changes_little(self):
        """Half the elements and half the step: standard deviation and mean force change by less than 1 %."""
        line = read_line("en50318-2002")
        coarse = run(
            form(line, Mesh(contact=1.0, messenger=2.0)),
            speed=250 / 3.6,
            pantograph="en50318-2002",
            window=(240.0, 360.0),
            step=2e-3,
        )
        _assert_close(coarse, reference(250), 0.01)

    @pytest.mark.slow
    def test_finer_still_changes_less(self):
        line = read_line("en50318-2002")
        fine = run(
            form(line, Mesh(contact=0.25, messenger=0.5)),
            speed=300 / 3.6,
            pantograph="en50318-2002",
            window=(240.0, 360.0),
            step=5e-4,
        )
        _assert_close(fine, reference(300), 5e-3)


class TestTrain:
    """The default mesh is right for the pantograph that runs through the waves of the one ahead."""

    @pytest.mark.parametrize(
        ("name", "train"),
        [
            ("en50318-2002", "en50318-2002.250.train-200"),
            pytest.param("en50318-2018-ac-simple", "en50318-2018.320.train-90", marks=pytest.mark.slow),
        ],
    )
    @pytest.mark.filterwarnings("ignore:run.window")  # as short as the line can be
    def test_as_the_independent_model_has_it(self, name, train):
        wanted, kmh = TRAINS[train], float(train.split(".")[1])
        unit = catenary.find_pantograph(reference_case(name).pantograph)
        unit = replace(unit, static_force=wanted["force"], aerodynamic=0.0, relaxed_at="nominal")
        done = run(
            read_line(name).excerpt(0, wanted["spans"]),
            speed=kmh / 3.6,
            pantograph=unit,
            spacing=wanted["spacing"],
            start=wanted["start"],
            window=tuple(wanted["window"]),
            until=wanted["window"][1] + 25.0,
        )
        for k, which in enumerate(("first", "second")):
            found = statistics(done, k, FILTER)
            assert found["deviation"].value == pytest.approx(wanted[which]["sigma"], rel=0.02)
            assert found["mean_force"].value == pytest.approx(wanted[which]["mean"], rel=5e-3)

    @pytest.mark.slow
    @pytest.mark.parametrize("kmh", [250, 275, 300, 320])
    @pytest.mark.parametrize("spacing", [90.0, 200.0])
    @pytest.mark.parametrize(("name", "spans"), [("en50318-2002", 10), ("en50318-2018-ac-simple", 16)])
    @pytest.mark.filterwarnings("ignore:run.window")
    def test_a_finer_mesh_has_the_same(self, name, spans, spacing, kmh):
        given = read_line(name)
        height, stagger = float(given.system_height[0]), float(given.stagger[0])
        line = replace(given, spans=given.spans[:1] * spans, system_height=height, stagger=stagger)
        unit = catenary.find_pantograph(reference_case(name).pantograph)
        runs = [
            run(line, speed=kmh / 3.6, pantograph=unit, spacing=spacing, mesh=mesh)
            for mesh in (None, Mesh(contact=0.25, messenger=0.5))
        ]
        for k in (0, 1):
            default, fine = (statistics(done, k, FILTER) for done in runs)
            assert default["deviation"].value == pytest.approx(fine["deviation"].value, rel=0.02)
            assert default["mean_force"].value == pytest.approx(fine["mean_force"].value, rel=1e-3)


def damped(radius):
    """The integrator of a run with this spectral radius."""
    return ancf.GeneralizedAlpha(radius, newton=ancf.Newton(tolerance=1e-9, corotate=False))


def _assert_close(one, other, relative):
    for key in ("deviation", "mean_force"):
        values = [statistics(done)[key].value for done in (one, other)]
        assert values[0] == pytest.approx(values[1], rel=relative)


class TestContact:
    def test_starts_in_equilibrium(self):
        """At a crawl the force stays the static force."""
        done = quick(speed=((0.0, 0.01), (0.4, 0.01), (1.0, 60.0)))
        early = done.recordings[0].force[done.t <= 0.4]
        assert early == pytest.approx(np.full(early.size, 120.0), abs=0.02)

    def test_starts_in_equilibrium_at_the_force_of_the_speed(self):
        unit = collector(aerodynamic=0.01)
        force = quick(pantograph=unit).recordings[0].force
        assert force[0] == pytest.approx(120.0 + 0.01 * 40.0**2, abs=1e-3)

    def test_force_is_stiffness_times_overlap(self):
        done = quick().recordings[0]
        overlap = np.maximum(done.strip - done.height, 0.0)
        assert done.force == pytest.approx(STIFFNESS * overlap, abs=1e-6)
        assert np.ptp(done.force) > 50.0

    @pytest.mark.filterwarnings("ignore:contact of pantograph.* chatters:UserWarning")
    @pytest.mark.parametrize("contact", ["penalty", "joint"])
    def test_lost_contact_is_regained_and_never_pulls(self, contact):
        """A light touch at speed: the strip leaves the wire, stays below it, and comes back."""
        done = quick(speed=60.0, pantograph=collector(static_force=25.0), contact=contact).recordings[0]
        assert np.min(done.force) == 0.0
        lost = done.force == 0.0
        changes = np.diff(lost.astype(int))
        assert np.sum(changes == 1) >= 2
        assert np.sum(changes == -1) >= 2
        assert np.min(done.height[lost] - done.strip[lost]) > -1e-7
        assert np.max(done.height[lost] - done.strip[lost]) > 1e-4
        assert np.max(done.height[~lost] - done.strip[~lost]) < 1e-7

    @pytest.mark.filterwarnings("ignore:contact of pantograph.* chatters:UserWarning")
    def test_loss_is_reported(self):
        done = quick(speed=60.0, pantograph=collector(static_force=25.0))
        found = statistics(done)
        assert found["loss"].value > 1.0
        assert found["loss_longest"].value > 0.0
        assert found["raw_minimum"].value == 0.0

    def test_a_taut_dropper_can_go_slack_and_never_pushes(self):
        assert np.min(quick().dropper_force) == 0.0
        assert np.max(quick().dropper_force[0]) > 20.0

    def test_contact_point_follows_the_stagger(self):
        """Unequal spans: sideways the contact point is where the wire hangs at rest, within 1 cm."""
        done = quick().recordings[0]
        wire = short_form().contact.position
        assert done.stagger == pytest.approx(np.interp(done.position, wire[:, 0], wire[:, 1]), abs=0.01)
        supports = np.cumsum((0.0, *LENGTHS))
        for x, side in list(zip(supports, STAGGER, strict=True))[1:4]:
            assert np.interp(x, done.position, done.stagger) == pytest.approx(side, abs=1e-3)

    def test_uplift_begins_at_rest_and_the_passing_pantograph_lifts(self):
        done = quick()
        assert np.abs(done.uplift[0, 3:]).max() < 1e-3  # far ahead of the pantograph
        passing = np.argmin(np.abs(done.recordings[0].position - 66.0))
        assert done.uplift[passing, 2] > 0.01
        assert np.abs(done.uplift[:, [0, -1]]).max() < 1e-9  # the anchors


class TestTravel:
    def test_profile_is_integrated(self):
        profile = ((0.0, 20.0), (1.0, 40.0), (2.0, 30.0))
        done = quick(speed=profile)
        t = done.t
        parts = [20.0 * t + 10.0 * t**2, 30.0 + 40.0 * (t - 1) - 5.0 * (t - 1) ** 2, 65.0 + 30.0 * (t - 2)]
        expected = 10.0 + np.select([t <= 1.0, t <= 2.0], parts[:2], parts[2])
        assert done.recordings[0].position == pytest.approx(expected, abs=1e-9)
        assert done.speed == pytest.approx((expected[-1] - 10.0) / t[-1])

    @pytest.mark.parametrize(
        "profile", [30.0, ((0.0, 20.0), (2.0, 60.0)), ((0.0, 50.0), (1.0, 10.0), (1.5, 40.0))]
    )
    def test_time_is_when_the_way_is_gone(self, profile):
        travel = make_travel(profile)
        for t in (0.0, 0.3, 1.0, 1.2, 1.9, 2.0, 7.5):
            assert travel.time(float(travel.distance(t))) == pytest.approx(t, abs=1e-12)
            way = np.trapezoid(travel.speed(np.linspace(0.0, t, 30_001)), dx=t / 30_000)
            assert travel.distance(t) == pytest.approx(way, rel=1e-4, abs=1e-12)

    @pytest.mark.parametrize("speeds", [(20.0, 60.0), (70.0, 25.0)])
    def test_the_law_is_that_of_each_moment(self, speeds):
        """Its mean over the window; at the mean speed it asks for less."""
        profile = ((0.0, speeds[0]), (3.0, speeds[1]))
        done = quick(speed=profile, window=(70.0, 140.0), until=142.0)
        found = statistics(done)
        speed = make_travel(profile).speed(done.t)[in_window(done, 0)]
        asked = [mean_force_target(3.6 * v) for v in speed]
        assert found["mean_force_law_ac"].value == pytest.approx(np.mean(asked), rel=1e-4)
        assert np.mean(asked) > mean_force_target(found["speed"].value) * (1.0 + 1e-3)

    def test_constant_profile_is_the_speed(self):
        constant, single = quick(speed=((0.0, 40.0), (1.0, 40.0))), quick()
        assert constant.recordings[0].force == pytest.approx(single.recordings[0].force, abs=1e-6)

    def test_lift_follows_the_speed(self):
        """Braking from 60 to 20 m/s with the aerodynamic force alone in the end much smaller."""
        unit = collector(static_force=40.0, aerodynamic=0.03)
        done = quick(speed=((0.0, 60.0), (1.0, 20.0)), pantograph=unit)
        force, t = done.recordings[0].force, done.t
        assert force[0] == pytest.approx(40.0 + 0.03 * 60.0**2, abs=1e-2)
        assert np.mean(force[t > t[-1] - 0.8]) == pytest.approx(40.0 + 0.03 * 20.0**2, rel=0.1)


class TestSeveral:
    """Two pantographs 120 m apart on twelve spans of 30 m."""

    GAP, AT, WINDOW = 120.0, 10.0, (180.0, 190.0)

    @staticmethod
    @cache
    def shape():
        spans = [Span(length=30.0, droppers=droppers(30.0))] * 12
        return form(short_line(spans=spans, stagger=0.2), COARSE)

    @classmethod
    @cache
    def done(cls, start, spacing=None):
        unit = collector()
        return run(
            cls.shape(),
            speed=40.0,
            pantograph=unit,
            spacing=spacing,
            start=start,
            window=cls.WINDOW,
            step=STEP,
        )

    def test_keep_their_distance(self):
        first, second = self.done(self.AT, self.GAP).recordings
        assert first.position - second.position == pytest.approx(np.full(first.position.size, self.GAP))
        assert second.position[0] == self.AT
        assert [first.force[0], second.force[0]] == pytest.approx([120.0, 120.0], abs=1e-3)

    def test_the_first_hardly_knows_of_the_second(self):
        """Waves run ahead of the second too; they change less than half of what it meets itself."""
        both = self.done(self.AT, self.GAP).recordings
        alone = [self.done(self.AT + self.GAP).recordings[0].force, self.done(self.AT).recordings[0].force]
        changes = []
        for one, other in zip(both, alone, strict=True):
            count = min(one.force.size, other.size)
            changes.append(np.abs(one.force[:count] - other[:count]).max())
        assert changes[0] < 0.5 * changes[1]

    def test_the_second_runs_into_the_waves_of_the_first(self):
        second = self.done(self.AT, self.GAP).recordings[1].force
        alone = self.done(self.AT).recordings[0].force
        count = min(second.size, alone.size)
        change = np.abs(second[:count] - alone[:count])
        assert change[: int(0.2 / STEP)].max() < 0.5  # they have not met yet
        assert change.max() > 10.0

    def test_both_are_evaluated_over_the_same_track(self):
        done = self.done(self.AT, self.GAP)
        for k, recording in enumerate(done.recordings):
            inside = recording.position[statistics(done, k).window]
            assert inside[[0, -1]] == pytest.approx(self.WINDOW, abs=0.1)

    def test_different_ones(self):
        heavy = collector(static_force=140.0, name="other")
        done = run(
            self.shape(),
            speed=40.0,
            pantograph=[collector(), heavy],
            spacing=self.GAP,
            start=self.AT,
            window=self.WINDOW,
            step=STEP,
        )
        assert [p.name for p in done.pantographs] == ["test", "other"]
        assert [r.force[0] for r in done.recordings] == pytest.approx([120.0, 140.0], abs=1e-3)


class TestRecord:
    def test_every_step_is_recorded(self):
        done = quick()
        count = len(done.t)
        assert np.diff(done.t) == pytest.approx(np.full(count - 1, STEP))
        assert done.uplift.shape == (count, len(LENGTHS) + 1)
        assert done.dropper_force.shape == (count, 5 * len(LENGTHS))
        assert done.dropper_force[0, 10:] == pytest.approx(short_form().dropper_force[10:], abs=1.0)

    def test_settings_say_how(self):
        done = quick()
        settings = done.settings
        assert settings["step [s]"] == STEP
        assert settings["contact"] == "penalty"
        assert settings["contact stiffness [N/m]"] == STIFFNESS
        assert settings["steps"] == len(done.t) - 1
        assert done.real_time_factor == pytest.approx(done.simulated_seconds / done.cpu_seconds)

    def test_a_stiffer_contact_gives_less(self):
        soft, hard = (quick(contact_stiffness=k).recordings[0] for k in (25e3, 100e3))
        for done, k in ((soft, 25e3), (hard, 100e3)):
            assert done.strip[0] - done.height[0] == pytest.approx(120.0 / k, rel=1e-4)


class TestMeanHeight:
    """The lowest spring takes nothing from the mean: it follows the law of the window's speed."""

    @pytest.mark.parametrize("profile", [((0.0, 25.0), (1.5, 55.0)), ((0.0, 60.0), (1.0, 35.0)), 45.0])
    def test_mean_force_is_that_of_the_law(self, profile):
        unit = collector(static_force=70.0, aerodynamic=0.02, stiffness=(160.0, 4200.0), relaxed_at="mean")
        given = {"speed": profile, "pantograph": unit, "window": (80.0, 140.0), "until": 150.0}
        found = statistics(quick(start=10.0, **given))
        v = found["speed"].value / 3.6
        last = profile if isinstance(profile, float) else profile[-1][1]
        assert v == pytest.approx(last, rel=0.02)
        assert found["mean_force"].value == pytest.approx(70.0 + 0.02 * v**2, rel=0.04)
        assert found["mean_force_law_ac"].value == pytest.approx(mean_force_target(3.6 * v), rel=2e-3)
        assert found["speed_ratio"].value == pytest.approx(v / 121.716, rel=1e-4)

    def test_trial_run_counts(self):
        unit = collector(relaxed_at="mean")
        done = quick(pantograph=unit)
        key = "CPU time of the trial run for the mean height [s]"
        assert 0.0 < done.settings[key] < done.cpu_seconds
        assert done.cpu_seconds == done.settings[key] + done.result.stats.cpu_seconds
        assert done.real_time_factor == pytest.approx(done.simulated_seconds / done.cpu_seconds)
        assert key not in quick().settings

    @pytest.mark.parametrize("relaxed_at", ["start", "mean"])
    def test_no_lowest_spring(self, relaxed_at):
        """A damper carries the lowest mass in motion only; in equilibrium the wire carries the lift."""
        unit = collector(stiffness=(0.0, 4200.0), relaxed_at=relaxed_at)
        done = quick(pantograph=unit)
        assert done.recordings[0].force[0] == pytest.approx(120.0, abs=0.05)
        assert statistics(done)["mean_force"].value == pytest.approx(120.0, rel=0.03)


class TestDroppersThatPush:
    def test_are_never_slack(self):
        line = short_line(droppers=catenary.Droppers(stiffness=1e5, slack=False))
        done = run(form(line, COARSE), speed=40.0, pantograph=collector(), step=STEP)
        found = statistics(done)
        assert np.min(done.dropper_force) < 0.0
        assert [found[f"slack_{key}"].value for key in ("droppers", "number", "longest")] == [0.0] * 3
        assert statistics(quick())["slack_droppers"].value > 0.0


CAUTIONS = {
    "above the wave speed": ({"speed": 130.0}, "468 km/h.*438 km/h: no wave"),
    "at the wave speed": ({"speed": 438.0 / 3.6}, "438 km/h is 0.9996 of the wave speed"),
    "near the wave speed": ({"speed": [(0.0, 60.0), (1.0, 112.0)]}, "403 km/h is 0.92.. of the wave speed"),
    "long step": ({"step": 8e-3}, "run.step: 8 ms is long.*take 4 ms"),
    "window behind the start": ({"start": 20.0, "window": (30.0, 98.0)}, "begins 10 m after the place"),
    "chatter": ({"contact_stiffness": 1e7}, "contact of pantograph: is lost .* it chatters"),
}


class TestCautions:
    @pytest.mark.parametrize("case", CAUTIONS)
    def test_says_what_is_not_to_be_trusted(self, case):
        changes, text = CAUTIONS[case]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            run(short_form(), **({"speed": 40.0, "pantograph": collector(), "step": STEP} | changes))
        found = [one for one in caught if re.search(text, str(one.message))]
        assert len(found) == 1
        assert found[0].filename == __file__

    def test_long_elements(self):
        shape = form(short_line(), Mesh(contact=4.0, messenger=3.0))
        with pytest.warns(
            UserWarning, match=r"mesh.contact: elements of 4 m.* take 2\.\d+ m or less"
        ) as caught:
            run(shape, speed=70.0, pantograph=collector(), step=STEP)
        assert len(caught) == 1

    @pytest.mark.parametrize("speed", [40.0, 75.0])
    def test_nothing_about_an_ordinary_run(self, speed):
        """Warnings are errors in these tests: the step of 4 ms and a start 50 m away are in order."""
        quick(speed=speed, step=4e-3, start=16.0, window=(66.0, 98.0))


class TestSpeed:
    def test_near_the_wave_speed_is_reported(self):
        with pytest.warns(UserWarning, match="mesh.contact"):  # waves ahead are short
            found = statistics(quick(speed=90.0))["speed_ratio"]
        assert found.value == pytest.approx(90.0 / 121.716, rel=1e-4)
        assert found.inside is False
        assert statistics(quick())["speed_ratio"].inside is True


WRONG = {
    "speed zero": ({"speed": 0.0}, "run.speed"),
    "speed not a number": ({"speed": float("nan")}, "run.speed"),
    "profile that starts late": ({"speed": [(1.0, 20.0), (2.0, 30.0)]}, "run.speed[0][0]"),
    "profile that goes back": ({"speed": [(0.0, 20.0), (2.0, 30.0), (1.0, 30.0)]}, "run.speed[2][0]"),
    "profile that stops": ({"speed": [(0.0, 20.0), (1.0, 0.0)]}, "run.speed[1][1]"),
    "profile of one column": ({"speed": [1.0, 2.0]}, "run.speed[0]"),
    "unknown pantograph": ({"pantograph": "dsa-380"}, "pantograph"),
    "no pantograph": ({"pantograph": None}, "pantograph"),
    "number of pantographs": ({"pantograph": 2}, "pantograph"),
    "one of two pantographs missing": ({"pantograph": [collector(), None], "spacing": 15.0}, "pantograph"),
    "start before the line": ({"start": -1.0}, "run.start"),
    "start behind the line": ({"start": 170.0}, "run.start"),
    "start behind the window": ({"start": 70.0, "window": (66.0, 98.0)}, "run.start"),
    "spacing too long": ({"spacing": 100.0, "window": (66.0, 98.0)}, "run.start"),
    "spacing longer than what is left": ({"spacing": 50.0, "window": (66.0, 98.0)}, "run.window"),
    "no span left for the train": ({"spacing": 120.0}, "run.window"),
    "spacing zero": ({"spacing": 0.0}, "run.spacing"),
    "one of two spacings wrong": ({"spacing": [10.0, -1.0]}, "run.spacing[1]"),
    "more pantographs than places": ({"pantograph": [collector(), collector()]}, "run.spacing"),
    "window backwards": ({"window": (90.0, 80.0)}, "run.window"),
    "window outside": ({"window": (90.0, 200.0)}, "run.window"),
    "window at the end": ({"window": (100.0, 160.0)}, "run.window"),
    "unknown contact": ({"contact": "glue"}, "run.contact"),
    "contact without stiffness": ({"contact_stiffness": 0.0}, "run.contact_stiffness"),
    "contact with less than no damping": ({"contact_damping": -1.0}, "run.contact_damping"),
    "step zero": ({"step": 0.0}, "run.step"),
    "mesh of a form": ({"mesh": COARSE}, "run.mesh"),
    "strip too short": ({"pantograph": collector(strip_length=0.45)}, "line.stagger[2]"),
}


class TestWrongInput:
    @pytest.mark.parametrize("case", WRONG)
    def test_is_named(self, case):
        changes, where = WRONG[case]
        given = {"speed": 40.0, "pantograph": collector(), "step": STEP} | changes
        with pytest.raises(ModelError) as caught:
            run(short_form(), **given)
        assert caught.value.where == where

    def test_unknown_line(self):
        with pytest.raises(ModelError, match="en50318-2002"):
            run("en50318-2003", speed=40.0)

    def test_unknown_case(self):
        with pytest.raises(ModelError, match="en50318-2002"):
            reference_run("paper", 250.0)

    @pytest.mark.parametrize(
        ("changes", "where"),
        [
            ({"masses": (15.0, 0.0)}, "pantograph.test.masses[1]"),
            ({"masses": ()}, "pantograph.test.stiffness"),
            ({"stiffness": (50.0,)}, "pantograph.test.stiffness"),
            ({"stiffness": (50.0, 0.0)}, "pantograph.test.stiffness[1]"),
            ({"stiffness": (0.0, 4200.0), "damping": (0.0, 10.0)}, "pantograph.test.stiffness[0]"),
            ({"damping": (90.0, -1.0)}, "pantograph.test.damping[1]"),
            ({"static_force": 0.0}, "pantograph.test.static_force"),
            ({"aerodynamic": -0.01}, "pantograph.test.aerodynamic"),
            ({"strip_length": 0.0}, "pantograph.test.strip_length"),
            ({"relaxed_at": "top"}, "pantograph.test.relaxed_at"),
        ],
    )
    def test_pantograph(self, changes, where):
        with pytest.raises(ModelError) as caught:
            collector(**changes)
        assert caught.value.where == where

    def test_catalogue_is_sound(self):
        known = catenary.pantographs()
        assert {"en50318-2002", "benchmark-2015", "dsa380", "paper-7.5"} <= set(known)
        assert known["benchmark-2015"].force(275 / 3.6) == pytest.approx(mean_force_target(275.0), rel=1e-4)
