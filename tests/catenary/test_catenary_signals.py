"""Filters, spectrum, histogram, loss of contact and statistics against closed forms."""

import dataclasses

import numpy as np
import pytest

import catenary_stand_in as stand_in
from ancf import ModelError
from ancf.catenary.answers.passing import dropper_forces, dropper_places, in_window, uplift_at_supports
from ancf.catenary.answers.signals import Butterworth, at_zero, histogram, sample_rate, spectrum
from ancf.catenary.answers.statistics import mean_force_target, statistics

RATE = 1000.0
T = np.arange(12000) / RATE
MIDDLE = slice(3000, 9000)  # 6 s: whole periods of every frequency below, far from the ends


def parts(x, frequency, t=T[MIDDLE]):
    """Complex amplitude of one frequency: amplitude of the sine, phase in its argument."""
    return 2j * np.mean(x * np.exp(-2j * np.pi * frequency * t))


def gain(frequency, cut_off, order, rate=RATE):
    """Gain of one Butterworth pass, mapped by the bilinear rule."""
    ratio = np.tan(np.pi * frequency / rate) / np.tan(np.pi * cut_off / rate)
    return 1 / np.sqrt(1 + ratio ** (2 * order))


def sine(frequency):
    return np.sin(2 * np.pi * frequency * T)


class TestLowPass:
    def test_ten_hertz_passes(self):
        below = Butterworth().low_pass(sine(10.0), RATE)
        assert np.max(np.abs(below - sine(10.0))[MIDDLE]) < 1e-3

    @pytest.mark.parametrize("order", [2, 4, 6])
    @pytest.mark.parametrize("frequency", [5.0, 15.0, 20.0, 25.0, 40.0])
    def test_gain_and_no_phase(self, frequency, order):
        found = parts(Butterworth(order).low_pass(sine(frequency), RATE)[MIDDLE], frequency)
        assert found.real == pytest.approx(gain(frequency, 20.0, order) ** 2, rel=1e-6, abs=1e-9)
        assert abs(found.imag) < 1e-9

    def test_forty_hertz_is_down_by_four_thousand(self):
        found = abs(parts(Butterworth().low_pass(sine(40.0), RATE)[MIDDLE], 40.0))
        assert found == pytest.approx(1 / (1 + 2**12), rel=0.05)

    def test_forward_only_lags(self):
        found = parts(Butterworth(zero_phase=False).low_pass(sine(20.0), RATE)[MIDDLE], 20.0)
        assert abs(found) == pytest.approx(np.sqrt(0.5), rel=1e-6)
        # an eighth of a turn for each order: three quarters behind is one quarter ahead
        assert np.angle(found) == pytest.approx(np.pi / 2, abs=1e-6)

    @pytest.mark.parametrize("zero_phase", [True, False])
    def test_a_constant_passes_to_the_ends(self, zero_phase):
        constant = np.full(500, 117.3)
        np.testing.assert_allclose(Butterworth(6, zero_phase).low_pass(constant, RATE), constant, rtol=1e-9)

    def test_a_short_record(self):
        short = np.array([1.0, 2.0, 3.0])
        assert np.all(np.isfinite(Butterworth().low_pass(short, RATE)))


class TestBands:
    def test_side_by_side_they_add_up(self):
        x = np.random.default_rng(5).normal(100.0, 20.0, T.size)
        chosen = Butterworth()
        together = chosen.low_pass(chosen.low_pass(x, RATE, 20.0), RATE, 5.0) + chosen.band(
            x, RATE, 5.0, 20.0
        )
        np.testing.assert_allclose(together[MIDDLE], chosen.low_pass(x, RATE, 20.0)[MIDDLE], atol=1e-6)

    def test_each_takes_its_own(self):
        x = 30 * sine(1.0) + 20 * sine(3.0) + 10 * sine(10.0) + 7 * sine(60.0) + 100
        for band, left in (((0, 2), 30.0), ((0, 5), np.hypot(30, 20)), ((5, 20), 10.0)):
            deviation = np.std(Butterworth().band(x, RATE, *band)[MIDDLE])
            assert deviation == pytest.approx(left / np.sqrt(2), rel=3e-3)

    def test_high_pass_takes_the_mean(self):
        found = Butterworth().high_pass(sine(10.0) + 50.0, RATE, 5.0)[MIDDLE]
        assert np.max(np.abs(found - sine(10.0)[MIDDLE])) < 1e-3


class TestBadInput:
    def test_cut_off_above_half_the_rate(self):
        with pytest.raises(ModelError, match="below half the sample rate 30 Hz, is 20 Hz"):
            Butterworth().low_pass(np.ones(50), 30.0)

    @pytest.mark.parametrize("order", [0, 21, 2.5, True])
    def test_order(self, order):
        with pytest.raises(ModelError, match=r"filter\.order"):
            Butterworth(order)

    @pytest.mark.parametrize("band", [(5, 5), (20, 5), (-1, 5)])
    def test_band(self, band):
        with pytest.raises(ModelError, match="0 <= low < high"):
            Butterworth().band(np.ones(50), RATE, *band)

    def test_uneven_times(self):
        with pytest.raises(ModelError, match="not evenly spaced"):
            sample_rate(np.array([0.0, 0.1, 0.3]))
        with pytest.raises(ModelError, match="increasing"):
            sample_rate(np.array([0.0, 0.0]))
        assert sample_rate(T) == pytest.approx(RATE)


class TestSpectrum:
    @pytest.mark.parametrize("taper", ["hann", "boxcar"])
    def test_amplitude_of_a_line(self, taper):
        found = spectrum(115 + 30 * sine(2.0)[:4000] + 4 * sine(12.0)[:4000], RATE, taper)
        at = {round(f, 6): a for f, a in zip(found.frequency, found.amplitude, strict=True)}
        assert at[2.0] == pytest.approx(30.0)
        assert at[12.0] == pytest.approx(4.0)
        assert at[7.0] < 1e-9

    @pytest.mark.parametrize("count", [2000, 2001])
    def test_density_holds_the_variance(self, count):
        x = np.random.default_rng(1).normal(0.0, 3.0, count)
        found = spectrum(x, RATE, "boxcar")
        assert np.sum(found.density) * found.frequency[1] == pytest.approx(np.var(x), rel=1e-9)


class TestHistogram:
    def test_even_spread(self):
        found = histogram(np.linspace(0.0, 99.99, 10000), 10.0)
        np.testing.assert_allclose(found.edges, np.arange(0, 101, 10))
        np.testing.assert_allclose(found.share, 10.0, atol=0.02)

    def test_below_zero_and_one_value(self):
        found = histogram(np.array([-5.0, -5.0, 12.0, 10.0]), 10.0)
        np.testing.assert_allclose(found.edges, [-10, 0, 10, 20])
        np.testing.assert_allclose(found.share, [50, 0, 50])
        np.testing.assert_allclose(histogram(np.full(7, 20.0)).share, [100])


class TestLoss:
    def test_intervals(self):
        found = at_zero(np.array([0.0, 0.0, 5.0, 0.0, 3.0, 2.0, 0.0, 0.0, 0.0, 1.0]), 0.001)
        assert found.number == 3
        assert found.longest == pytest.approx(0.003)
        assert found.seconds == pytest.approx(0.006)
        assert found.percent == pytest.approx(60.0)
        assert found.bounds.tolist() == [[0, 2], [3, 4], [6, 9]]

    def test_none_and_all(self):
        none, always = at_zero(np.ones(5), 0.1), at_zero(np.zeros(5), 0.1)
        assert (none.number, none.longest, none.percent) == (0, 0.0, 0.0)
        assert (always.number, always.percent) == (1, 100.0)
        assert always.longest == pytest.approx(0.5)


def known(force=None, **more):
    """A run at 60 m/s, one second a span, whose force is a function of the time in the window."""
    made = stand_in.run(speed=60.0, step=0.001, **more)
    if force is None:
        return made
    records = [
        dataclasses.replace(r, force=force(made.t - float(np.interp(240.0, r.position, made.t))))
        for r in made.recordings
    ]
    return dataclasses.replace(made, recordings=records)


def two_lines(t):
    return 110 + 30 * np.sin(2 * np.pi * t) + 14 * np.sin(20 * np.pi * t) + 9 * np.sin(200 * np.pi * t)


class TestStatistics:
    def test_force(self):
        found = statistics(known(two_lines))
        deviation = np.sqrt((30**2 + 14**2) / 2)
        for key, value in {
            "mean_force": 110.0,
            "deviation": deviation,
            "mean_plus_3_sigma": 110 + 3 * deviation,
            "mean_minus_3_sigma": 110 - 3 * deviation,
            "relative_deviation": deviation / 110,
            "deviation_0_2": 30 / np.sqrt(2),
            "deviation_0_5": 30 / np.sqrt(2),
            "deviation_5_20": 14 / np.sqrt(2),
            "loss": 0.0,
            "height_range": 44.0,
        }.items():
            assert found[key].value == pytest.approx(value, rel=2e-3), key
        slow = np.linspace(0, 2, 20001)
        extremes = 110 + 30 * np.sin(2 * np.pi * slow) + 14 * np.sin(20 * np.pi * slow)
        assert found["maximum"].value == pytest.approx(extremes.max(), rel=1e-3)
        assert found["minimum"].value == pytest.approx(extremes.min(), rel=2e-3)
        assert found["raw_maximum"].value > extremes.max() + 5

    def test_loss_in_the_window_only(self):
        def lost(t):
            inside = ((t > 0.5) & (t < 0.53)) | ((t > 1.2) & (t < 1.21)) | (t < -0.3) | (t > 2.3)
            return np.where(inside, 0.0, 100.0)

        found = statistics(known(lost))
        assert found["loss_number"].value == 2
        assert found["loss_longest"].value == pytest.approx(30.0, abs=1.1)
        assert found["loss"].value == pytest.approx(2.0, abs=0.1)

    def test_limits_of_practice(self):
        found = statistics(known(two_lines))
        assert found["relative_deviation"].inside is True
        assert (
            statistics(known(lambda t: 50 + 40 * np.sin(t * 2 * np.pi)))["relative_deviation"].inside is False
        )
        assert found["speed_ratio"].value == pytest.approx(60 / np.sqrt(20e3 / 1.35))
        assert found["wave_speed"].value == pytest.approx(438.18, abs=0.01)

    @pytest.mark.parametrize(
        ("supply", "target"), [("AC", 130.625), ("DC 3 kV", 170.625), ("DC 1.5 kV", 200.625)]
    )
    def test_mean_force_law(self, supply, target):
        assert mean_force_target(250.0, supply) == pytest.approx(target)

    def test_unknown_quantity(self):
        with pytest.raises(KeyError):
            statistics(known())["sigma"]


class TestLine:
    def test_uplift_of_each_pantograph(self):
        made = known(count=2)
        for k, highest in ((0, 52.0), (1, 54.6)):
            assert statistics(made, k)["uplift"].value == pytest.approx(highest, abs=0.1)
        assert [s.number for s in uplift_at_supports(made, 0)] == [5, 6, 7, 8, 9, 10]
        assert [s.number for s in uplift_at_supports(made, 1)] == [2, 3, 4, 5, 6, 7, 8, 9, 10]

    def test_one_close_behind_does_not_count_twice(self):
        """Two pantographs within one span: each gets the uplift of its own passing."""
        made = known(count=2, spacing=25.0)
        uplift = 0.0 * made.uplift
        behind = made.recordings[1].position
        uplift[:, 5] = np.where(np.abs(behind - 300.0) < 5.0, 0.08, 0.03)
        made = dataclasses.replace(made, uplift=uplift)
        assert statistics(made, 0)["uplift"].value == pytest.approx(30.0)
        assert statistics(made, 1)["uplift"].value == pytest.approx(80.0)

    def test_droppers(self):
        made = known()
        places = dropper_places(made)
        assert places[0] == (1, 1, 5.0)
        assert places[17] == (2, 9, 115.0)
        forces = dropper_forces(made)
        assert forces[20].rest == pytest.approx(86.1)
        tension = made.dropper_force[:, 20]
        assert forces[20].largest == tension.max()
        assert forces[20].slack.seconds == pytest.approx(np.sum(tension == 0) * 0.001)
        found = statistics(made)
        assert found["slack_droppers"].value == 18
        assert len(found.droppers) == 18

    def test_window(self):
        made = known()
        part = in_window(made)
        position = made.recordings[0].position[part]
        assert position[0] == pytest.approx(240.0, abs=0.07)
        assert position[-1] == pytest.approx(360.0, abs=0.07)
        with pytest.raises(ModelError, match="the run covers 25 m"):
            statistics(dataclasses.replace(made, window=(540.0, 600.0)))


class TestRun:
    def test_shapes(self):
        made = known()
        with pytest.raises(ModelError, match=r"run\.uplift: must have the shape \(\d+, 11\)"):
            dataclasses.replace(made, uplift=made.uplift[:, :-1])
        with pytest.raises(ModelError, match=r'recording "en50318-2002"\.force: must have the shape'):
            dataclasses.replace(made.recordings[0], force=made.t[:-1])
        with pytest.raises(ModelError, match="1 recordings of 0 pantographs"):
            dataclasses.replace(made, pantographs=[])
        with pytest.raises(ModelError, match=r"run\.window: is empty"):
            dataclasses.replace(made, window=(300.0, 300.0))

    def test_no_nan(self):
        made = known()
        with pytest.raises(ModelError, match=r"run\.dropper_force: holds a value that is not finite"):
            dataclasses.replace(made, dropper_force=np.nan * made.dropper_force)
