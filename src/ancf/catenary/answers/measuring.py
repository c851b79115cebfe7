"""A measuring pantograph (EN 50317): what its sensors make of the contact force, beside the true one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from .passing import check_run, in_window
from .signals import CUT_OFF, Butterworth, filter_of, sample_rate

if TYPE_CHECKING:
    from .run_data import Run

#: Limits of EN 50317 for the distance between samples, m; not yet checked against a copy of the standard.
FARTHEST = 0.4


@dataclass(frozen=True, kw_only=True)
class MeasuringHead:
    """Sensors of a measuring pantograph: forces below the strip, and an accelerometer on it.

    Parameters
    ----------
    mass : float, kg
        What moves above the force sensors; default the head of the pantograph.
    corrected_mass : float, kg
        By which the force is corrected for inertia; default `mass`, 0 for none.
    force_band, acceleration_band : float, Hz
        Up to where the sensors follow, as a low pass of second order; default endless.
    force_noise, acceleration_noise : float, N and m/s^2
        Standard deviation of the noise of each sample.
    rate : float, Hz
        Samples per second; default those of the run.
    delay : float, s
        By which the accelerometer is late against the force sensors.
    seed : int
        Of the noise.

    Raises
    ------
    ModelError
        A value is out of range.

    """

    mass: float | None = None
    corrected_mass: float | None = None
    force_band: float | None = None
    acceleration_band: float | None = None
    force_noise: float = 0.0
    acceleration_noise: float = 0.0
    rate: float | None = None
    delay: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        for key in ("mass", "force_band", "acceleration_band", "rate"):
            if getattr(self, key) is not None:
                checks.positive(getattr(self, key), f"measuring.{key}")
        for key in ("force_noise", "acceleration_noise", "delay"):
            checks.non_negative(getattr(self, key), f"measuring.{key}")
        if self.corrected_mass is not None:
            checks.non_negative(self.corrected_mass, "measuring.corrected_mass")
        checks.integer(self.seed, "measuring.seed", 0, 2**32 - 1)

    def check(self, own: float, speed: float) -> None:
        """Raise ModelError if a run of `own` samples per second, at most `speed` in m/s, is not measured."""
        rate = own if self.rate is None else self.rate
        apart = speed / rate
        if rate > own * (1.0 + 1e-9):
            raise ModelError("measuring.rate", f"is {rate:g} Hz, the run has {own:g}", "take a shorter step")
        if rate <= 2.0 * CUT_OFF or apart > FARTHEST:
            what = f"is {rate:g} Hz: samples are {apart:.3g} m apart, at most {FARTHEST:g} m may be"
            raise ModelError("measuring.rate", what, f"and more than {2.0 * CUT_OFF:g} Hz for the filter")
        for key in ("force_band", "acceleration_band"):
            band = getattr(self, key)
            if band is not None and band >= own / 2.0:
                what = f"is {band:g} Hz, must be below {own / 2.0:g} Hz, half the run's rate"
                raise ModelError(f"measuring.{key}", what)


@dataclass(frozen=True)
class Measured:
    """Contact force as it was measured, and as it was; both below 20 Hz.

    Parameters
    ----------
    t, position : (n,) float
        s, m.
    force, true : (n,) float
        N.
    window : slice
        Samples that are evaluated.

    """

    t: FloatArray
    position: FloatArray
    force: FloatArray
    true: FloatArray
    window: slice

    @property
    def error(self) -> FloatArray:
        """Measured less true force (n,) in the window, N."""
        made: FloatArray = (self.force - self.true)[self.window]
        return made

    @property
    def mean_error(self) -> float:
        """Of the mean force, N."""
        return float(np.mean(self.error))

    @property
    def deviation_error(self) -> float:
        """Of the standard deviation, N."""
        return float(np.std(self.force[self.window]) - np.std(self.true[self.window]))

    @property
    def largest_error(self) -> float:
        """Of a value, N."""
        return float(np.max(np.abs(self.error)))


def measure(
    run: Run, pantograph: int = 0, head: MeasuringHead | None = None, filter: Butterworth | None = None
) -> Measured:
    """What the sensors of a pantograph would have measured in a run.

    The sensors below the strip feel the contact force, the inertia of what is above them and the wind on it,
    ``S = F + m a - k v^2``; measured is ``S - m' a + k v^2`` of what they and the accelerometer say, sampled
    and then filtered as the true force is.

    Parameters
    ----------
    run : Run
    pantograph : int
        Its place in ``run.recordings``.
    head : MeasuringHead
        Default one without errors.
    filter : Butterworth
        Order 6, forward and backward, by default.

    Raises
    ------
    ModelError
        The samples are too few: more than 0.4 m apart, or fewer than two in a period of 20 Hz; bands beyond
        half of the run's rate.

    """
    pantograph = check_run(run, "measure", pantograph)
    given: object = head
    if given is not None and not isinstance(given, MeasuringHead):
        what = f"must be a MeasuringHead, is {checks.shown(head)}"
        raise ModelError("measure.head", what, "ancf.catenary.MeasuringHead(force_noise=2.0)")
    sensors, chosen = head or MeasuringHead(), filter_of(filter, "measure")
    recording, unit, rate = run.recordings[pantograph], run.pantographs[pantograph], sample_rate(run.t)
    mass = unit.masses[-1] if sensors.mass is None else sensors.mass
    corrected = mass if sensors.corrected_mass is None else sensors.corrected_mass
    speed = np.gradient(recording.position, run.t)
    sensors.check(rate, float(np.max(np.abs(speed))))
    wind = unit.aerodynamics[-1] * speed**2
    acceleration = np.gradient(np.gradient(recording.strip, run.t), run.t)
    felt = _followed(recording.force + mass * acceleration - wind, rate, sensors.force_band)
    shaken = _followed(acceleration, rate, sensors.acceleration_band)
    shaken = np.interp(run.t - sensors.delay, run.t, shaken)
    samples = rate if sensors.rate is None else sensors.rate
    t = _samples(run, samples)
    rng = np.random.default_rng(sensors.seed)
    felt = np.interp(t, run.t, felt) + sensors.force_noise * rng.normal(size=t.size)
    shaken = np.interp(t, run.t, shaken) + sensors.acceleration_noise * rng.normal(size=t.size)
    force = felt - corrected * shaken + np.interp(t, run.t, wind)
    true = np.interp(t, run.t, recording.force)
    position = np.interp(t, run.t, recording.position)
    inside = in_window(run, pantograph)
    low, high = run.t[inside.start] - 1e-9, run.t[inside.stop - 1] + 1e-9
    within = np.flatnonzero((t >= low) & (t <= high))
    window = slice(int(within[0]), int(within[-1]) + 1)
    return Measured(t, position, chosen.low_pass(force, samples), chosen.low_pass(true, samples), window)


def _samples(run: Run, rate: float) -> FloatArray:
    """Times (n,) of the samples, s."""
    count = int(np.floor((run.t[-1] - run.t[0]) * rate + 1e-9))
    t: FloatArray = run.t[0] + np.arange(count + 1) / rate
    return t


def _followed(x: FloatArray, rate: float, band: float | None) -> FloatArray:
    """A signal as a sensor follows it."""
    if band is None:
        return x
    return Butterworth(order=2, zero_phase=False).low_pass(x, rate, band)
