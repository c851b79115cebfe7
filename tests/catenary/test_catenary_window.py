"""What the window takes of a run: filter before cut, supports at its ends, droppers in it, heights."""

import dataclasses

import numpy as np
import pytest
from scipy import signal

import catenary_stand_in as stand_in
from ancf.catenary.passing import droppers_in_window, uplift_at_supports, uplift_in_window
from ancf.catenary.signals import Butterworth
from ancf.catenary.statistics import statistics

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

    def test_only_those_of_the_window(self):
        run = made()
        force = np.full_like(run.dropper_force, 80.0)
        outside = (run.form.line.dropper_x < WINDOW[0]) | (run.form.line.dropper_x > WINDOW[1])
        force[:, outside] = 900.0
        run = dataclasses.replace(run, dropper_force=force)
        assert {d.span for d in droppers_in_window(run)} == {5, 6}
        assert statistics(run)["dropper_maximum"].value == 80.0
