"""What the window takes of a run: filter before cut, supports at its ends, droppers in it, heights."""

import dataclasses

import numpy as np
import pytest
from scipy import signal

import ancf
import catenary_stand_in as stand_in
from ancf.catenary.answers.passing import (
    dropper_forces,
    dropper_places,
    droppers_in_window,
    in_window,
    passing_time,
    speeds_in_window,
    uplift_at_supports,
    uplift_in_window,
)
from ancf.catenary.answers.signals import Butterworth
from ancf.catenary.answers.statistics import statistics

#: Track interval that is evaluated, m, and its supports: two spans of 60 m.
WINDOW, NUMBERS = (240.0, 360.0), (5, 6, 7)


def made(speed=60.0, **more):
    """A run past ten spans, a sample each millisecond."""
    return stand_in.run(speed=speed, step=1e-3, **more)


def inside(run):
    """Whether the pantograph is in the window, at each step."""
    x = run.recordings[0].position
    return (x >= WINDOW[0]) & (x <= WINDOW[1])


def with_record(run, **changes):
    """The run with another history of its pantograph."""
    return dataclasses.replace(run, recordings=[dataclasses.replace(run.recordings[0], **changes)])


class TestWindow:
    """Which samples it holds, with two pantographs 100 m apart at 60 m/s, a sample each millisecond."""

    def test_samples_at_both_ends_count(self):
        run = made()
        x = np.linspace(0.0, 600.0, len(run.t))
        run = with_record(dataclasses.replace(run, window=(x[4000], x[6000])), position=x)
        assert in_window(run) == slice(4000, 6001)

    @pytest.mark.parametrize("begin", [230.0, 239.99, 240.05, 241.0, 300.0])
    def test_a_run_that_begins_inside_is_refused(self, begin):
        """It has not seen all of the window; a step of 60 mm is let pass."""
        run = made()
        position = run.recordings[0].position
        run = with_record(run, position=position - position[0] + begin)
        if begin <= 240.06:
            assert in_window(run).start == max(0, round((240.0 - begin) / 0.06 + 0.499))
            return
        with pytest.raises(ancf.ModelError, match=f"the run covers {begin:g} m"):
            in_window(run)

    def test_speeds_are_those_of_the_pantograph(self):
        """The second one is slower in this record."""
        run = made(count=2, spacing=100.0)
        first, second = run.recordings
        second = dataclasses.replace(second, position=200.0 + 0.5 * (first.position - first.position[0]))
        run = dataclasses.replace(run, recordings=[first, second])
        for k, speed in ((0, 60.0), (1, 30.0)):
            assert speeds_in_window(run, k) == pytest.approx(speed)
            assert len(speeds_in_window(run, k)) == pytest.approx(120.0 / speed / 1e-3, abs=2)

    def test_time_of_a_passing(self):
        run = made(count=2, spacing=100.0)
        starts = [recording.position[0] for recording in run.recordings]
        assert starts[0] - starts[1] == pytest.approx(100.0)
        for k, start in enumerate(starts):
            assert passing_time(run, 300.0, k) == pytest.approx(run.t[0] + (300.0 - start) / 60.0, abs=6e-4)
            assert passing_time(run, start - 1.0, k) is None
            assert passing_time(run, run.recordings[k].position[-1] + 1.0, k) is None


class TestFilterBeforeCut:
    """100 N in the window, 200 N around it: the filter knows of the steps at its ends."""

    def run(self):
        run = made()
        return with_record(run, force=np.where(inside(run), 100.0, 200.0))

    def test_half_of_a_step_is_left_at_its_place(self):
        """Forward and backward a filter makes a step odd about its place: there is its middle."""
        found = statistics(self.run())
        assert found.force[found.window][[0, -1]] == pytest.approx([150.0, 150.0], abs=4.0)
        assert found["maximum"].value == pytest.approx(150.0, abs=4.0)
        assert found["raw_maximum"].value == 100.0

    @pytest.mark.parametrize("order", [2, 4, 6])
    def test_deviation_is_that_of_the_whole_record(self, order):
        run = self.run()
        sections = signal.butter(order, 20.0, fs=1e3, output="sos")
        cut = signal.sosfiltfilt(sections, run.recordings[0].force)[inside(run)]
        found = statistics(run, filter=Butterworth(order))
        assert found["deviation"].value == pytest.approx(cut.std(), rel=1e-6)
        assert found["mean_force"].value == pytest.approx(cut.mean(), rel=1e-9)
        assert cut.std() > 3.0

    def test_bands_and_height_too(self):
        run = self.run()
        run = with_record(run, height=1e-3 * run.recordings[0].force)
        found = statistics(run)
        for key in ("deviation_0_2", "deviation_0_5", "deviation_5_20"):
            assert found[key].value > 1.0
        assert found["height_range"].value > 50.0
        assert found["raw_height_range"].value == pytest.approx(0.0)


def test_height_on_a_gradient():
    """It climbs with the wire; over the nominal height it is the range of a level line, filter by filter."""
    level, steep = made(), made()
    steep.form.line.height_at = lambda x: 4e-3 * np.asarray(x)
    climbed = steep.recordings[0].height + 4e-3 * steep.recordings[0].position
    found = statistics(with_record(steep, height=climbed))
    wanted = statistics(level)["height_range"].value
    assert found["height_range_over_nominal"].value == pytest.approx(wanted, rel=1e-6)
    assert found["height_range"].value > 1e3 * 4e-3 * np.ptp(WINDOW) - wanted
    assert "height_range_over_nominal" not in [q.key for q in statistics(level).quantities]


class TestEndsOfARecord:
    """A record is continued beyond its ends, turned about them: a straight line stays one."""

    @pytest.mark.parametrize("cut_off", [2.0, 5.0, 20.0])
    @pytest.mark.parametrize("order", [2, 4, 6])
    def test_a_ramp_passes_to_the_ends(self, order, cut_off):
        t = np.arange(3000) / 1000.0
        ramp = 100.0 + 50.0 * t
        error = np.abs(Butterworth(order).low_pass(ramp, 1000.0, cut_off) - ramp)
        delay = order / (2 * np.pi * cut_off)  # s, of one pass; without a margin two thirds of it are seen
        assert error.max() < 0.05 * 50.0 * delay


class TestHeight:
    @pytest.mark.parametrize("frequency", [45.0, 80.0, 150.0])
    def test_range_is_below_twenty_hertz(self, frequency):
        """The made-up wire swings by 44 mm; what shakes above the filter is in the raw range alone."""
        run = made()
        shake = 5e-3 * np.sin(2 * np.pi * frequency * run.t)
        found = statistics(with_record(run, height=run.recordings[0].height + shake))
        assert found["height_range"].value == pytest.approx(44.0, abs=0.1)
        assert found["raw_height_range"].value == pytest.approx(54.0, abs=0.5)


class TestSupports:
    def uplift(self, run, heights):
        """A bump of its own height at each support while the pantograph passes it."""
        distance = run.recordings[0].position[:, None] - run.form.line.supports
        return dataclasses.replace(run, uplift=heights * np.exp(-((distance / 5.0) ** 2)))

    @pytest.mark.parametrize("highest", NUMBERS)
    def test_each_support_of_the_window_counts_also_at_its_ends(self, highest):
        heights = np.full(11, 0.02)
        heights[highest - 1] = 0.07
        heights[[3, 7]] = 0.09  # beside the window
        run = self.uplift(made(), heights)
        assert [s.number for s in uplift_in_window(run)] == list(NUMBERS)
        assert statistics(run)["uplift"].value == pytest.approx(70.0, rel=1e-3)

    @pytest.mark.parametrize(
        ("where", "counts"), [(-29.0, True), (29.0, True), (-31.0, False), (31.0, False)]
    )
    def test_passing_is_from_middle_to_middle(self, where, counts):
        """Of the spans of 60 m: the wire may be highest well before or behind the support."""
        run = made()
        distance = run.recordings[0].position[:, None] - run.form.line.supports
        uplift = np.where(np.abs(distance - where) < 0.5, 0.08, 0.01)
        found = uplift_at_supports(dataclasses.replace(run, uplift=uplift))
        assert {s.uplift for s in found if s.number in NUMBERS} == {0.08 if counts else 0.01}

    def test_each_support_has_its_own_uplift(self):
        heights = 0.01 * (2.0 + np.arange(11))
        run = self.uplift(made(), heights)
        for found in uplift_at_supports(run):
            assert found.uplift == pytest.approx(heights[found.number - 1], rel=1e-3)
            assert found.position == 60.0 * (found.number - 1)


class TestDroppers:
    def test_only_while_the_pantograph_is_in_the_window(self):
        """What a dropper of the window does before and after is not counted."""
        run = made()
        force = np.full_like(run.dropper_force, 80.0)
        force[~inside(run)] = 500.0
        force[:100] = 0.0  # slack, long before
        middle = np.flatnonzero(inside(run))
        force[middle[400:460], 40] = 0.0  # a dropper of span 5, for 60 ms
        found = statistics(dataclasses.replace(run, dropper_force=force))
        assert found["dropper_maximum"].value == 80.0
        assert found["slack_droppers"].value == found["slack_number"].value == 1
        assert found["slack_longest"].value == pytest.approx(60.0)

    def test_those_that_push_are_never_slack(self):
        """A rod that carries nothing for a moment is no dropper that went slack."""
        run = made()
        force = np.full_like(run.dropper_force, 80.0)
        force[100:160], force[200:230] = 0.0, -20.0
        run = dataclasses.replace(run, dropper_force=force)
        (found, *_) = dropper_forces(run)
        assert (found.largest, found.smallest) == (80.0, -20.0)
        assert found.slack.seconds == pytest.approx(0.06 + 0.03)
        run.form.line.droppers.slack = False
        assert dropper_forces(run)[0].slack.seconds == 0.0

    def test_one_at_a_support_belongs_to_the_span_that_begins_there(self):
        run = made()
        run.form.line.dropper_x = run.form.line.dropper_x.copy()
        run.form.line.dropper_x[9] = 60.0
        assert dropper_places(run)[8:11] == [(1, 9, 55.0), (2, 1, 60.0), (2, 2, 70.5)]

    def test_only_those_of_the_window(self):
        run = made()
        force = np.full_like(run.dropper_force, 80.0)
        outside = (run.form.line.dropper_x < WINDOW[0]) | (run.form.line.dropper_x > WINDOW[1])
        force[:, outside] = 900.0
        run = dataclasses.replace(run, dropper_force=force)
        assert {d.span for d in droppers_in_window(run)} == {5, 6}
        assert statistics(run)["dropper_maximum"].value == 80.0
