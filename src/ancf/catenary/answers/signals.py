"""Filters, spectrum, histogram and loss of contact of an evenly sampled record."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks

Kind = Literal["lowpass", "highpass"]

#: Upper end of the frequencies that are evaluated, Hz (EN 50317, EN 50318).
CUT_OFF = 20.0
#: Bands in which the standard deviation is read, Hz.
BANDS = ((0.0, 20.0), (0.0, 2.0), (0.0, 5.0), (5.0, 20.0))


def sample_rate(t: FloatArray, where: str = "run.t") -> float:
    """Samples per second of evenly spaced times (n,) s.

    Raises
    ------
    ModelError
        Fewer than two times, or steps that differ.

    """
    steps = np.diff(t)
    if not len(steps) or np.min(steps) <= 0:
        raise ModelError(where, "needs at least two increasing times")
    step = (t[-1] - t[0]) / len(steps)
    if np.max(np.abs(steps - step)) > 1e-3 * step:
        what = f"is not evenly spaced: steps from {np.min(steps):.6g} s to {np.max(steps):.6g} s"
        raise ModelError(where, what, "filters need a constant step")
    return float(1.0 / step)


@dataclass(frozen=True)
class Butterworth:
    """Butterworth filter.

    Forward and backward it shifts no phase, and its gain is that of one pass squared: at the cut-off
    1/2 (6 dB down), below it ``1 / (1 + (f / cut_off)^(2 order))`` but for the bilinear map. Low pass and
    high pass of one cut-off then add up to the signal, so that bands side by side do as well.

    Parameters
    ----------
    order : int
        Of one pass.
    zero_phase : bool
        Forward and backward; otherwise forward only, as a filter in a measuring chain works.

    """

    order: int = 6
    zero_phase: bool = True

    def __post_init__(self) -> None:
        if isinstance(self.order, bool) or not isinstance(self.order, int) or not 1 <= self.order <= 20:
            raise ModelError("filter.order", f"must be a whole number from 1 to 20, is {self.order!r}")

    @property
    def text(self) -> str:
        """What the filter is, for a report."""
        kind = "forward and backward, no phase shift, gain 1/2" if self.zero_phase else "forward, gain 0.71"
        return f"Butterworth, order {self.order}, {kind} at the cut-off"

    def low_pass(self, x: FloatArray, rate: float, cut_off: float = CUT_OFF) -> FloatArray:
        """Part of x (n,) below a frequency, Hz; `rate` in samples per second."""
        return self._pass(x, rate, cut_off, "lowpass")

    def high_pass(self, x: FloatArray, rate: float, cut_off: float) -> FloatArray:
        """Part of x (n,) above a frequency, Hz; `rate` in samples per second."""
        return self._pass(x, rate, cut_off, "highpass")

    def band(self, x: FloatArray, rate: float, low: float, high: float) -> FloatArray:
        """Part of x (n,) between two frequencies, Hz: low pass, then high pass unless `low` is 0."""
        if not 0 <= low < high:
            raise ModelError("filter.band", f"must be 0 <= low < high, is {low:g} Hz to {high:g} Hz")
        below = self.low_pass(x, rate, high)
        return self.high_pass(below, rate, low) if low else below

    def band_back(
        self, weights: FloatArray, rate: float, low: float = 0.0, high: float = CUT_OFF
    ) -> FloatArray:
        """Derivatives (n,) of ``weights @ band(x, rate, low, high)`` by x: the filters transposed."""
        below = self._back(weights, rate, low, "highpass") if low else weights
        return self._back(below, rate, high, "lowpass")

    def _pass(self, x: FloatArray, rate: float, cut_off: float, kind: Kind) -> FloatArray:
        from scipy import signal

        sections = self._sections(rate, cut_off, kind)
        if self.zero_phase:
            margin = _margin(len(x), rate, cut_off)
            return np.asarray(signal.sosfiltfilt(sections, x, padlen=margin), dtype=np.float64)
        state = signal.sosfilt_zi(sections) * x[0]
        return np.asarray(signal.sosfilt(sections, x, zi=state)[0], dtype=np.float64)

    def _back(self, weights: FloatArray, rate: float, cut_off: float, kind: Kind) -> FloatArray:
        sections = self._sections(rate, cut_off, kind)
        if not self.zero_phase:
            return _once_back(sections, weights)
        n, margin = len(weights), _margin(len(weights), rate, cut_off)
        x = np.pad(weights, margin)
        for _ in range(2):  # each pass is followed by a reversal
            x = _once_back(sections, x[::-1])
        # what is beyond the ends is 2 x_0 - x_k, or 2 x_n - x_(n-k)
        before, made, behind = x[:margin], x[margin : margin + n].copy(), x[margin + n :]
        made[0] += 2.0 * np.sum(before)
        made[-1] += 2.0 * np.sum(behind)
        made[1 : margin + 1] -= before[::-1]
        made[n - 1 - margin : n - 1] -= behind[::-1]
        return made

    def _sections(self, rate: float, cut_off: float, kind: Kind) -> FloatArray:
        from scipy import signal

        if not 0 < cut_off < rate / 2:
            what = f"must be above 0 and below half the sample rate {rate:g} Hz, is {cut_off:g} Hz"
            raise ModelError("filter.cut_off", what, "take a shorter step")
        return np.asarray(signal.butter(self.order, cut_off, kind, fs=rate, output="sos"))


def _margin(n: int, rate: float, cut_off: float) -> int:
    """Samples beyond each end: one period of the cut-off, mirrored, lets the start-up die out there."""
    return min(n - 1, int(np.ceil(rate / cut_off)))


def _once_back(sections: FloatArray, weights: FloatArray) -> FloatArray:
    """One pass transposed; it begins as if the first sample had been there for ever."""
    from scipy import signal

    made = np.asarray(signal.sosfilt(sections, weights[::-1])[::-1], dtype=np.float64).copy()
    of_first = signal.sosfilt(sections, np.zeros(len(weights)), zi=signal.sosfilt_zi(sections))[0]
    made[0] += float(weights @ of_first)
    return made


def filter_of(given: Butterworth | None, where: str) -> Butterworth:
    """The filter that was given, or order 6, forward and backward; ModelError where it is none."""
    if given is None:
        return Butterworth()
    return checks.kind(given, f"{where}.filter", Butterworth, "ancf.catenary.Butterworth(order=4)")


@dataclass(frozen=True)
class Spectrum:
    """One-sided spectrum of a record without its mean.

    Parameters
    ----------
    frequency : (m,) float
        Hz.
    amplitude : (m,) float
        Of the sine at that frequency, in the unit of the record.
    density : (m,) float
        Power spectral density, unit squared per Hz; its integral is the variance.

    """

    frequency: FloatArray
    amplitude: FloatArray
    density: FloatArray


def spectrum(x: FloatArray, rate: float, taper: str = "hann") -> Spectrum:
    """Amplitude and density of x (n,), sampled `rate` times a second.

    Parameters
    ----------
    x : (n,) float
    rate : float
        Samples per second.
    taper : str
        Window of `scipy.signal.get_window` against leakage; "boxcar" for none. Amplitudes of lines
        are right with any of them, the variance as far as the record is stationary.

    """
    from scipy import signal

    weight = signal.get_window(taper, len(x))
    lines = np.abs(np.fft.rfft((x - np.mean(x)) * weight))
    sides = np.full(len(lines), 2.0)
    sides[0] = 1.0
    if len(x) % 2 == 0:
        sides[-1] = 1.0
    density = sides * lines**2 / (rate * np.sum(weight**2))
    frequency = np.asarray(np.fft.rfftfreq(len(x), 1.0 / rate), dtype=np.float64)
    return Spectrum(frequency, sides * lines / np.sum(weight), density)


@dataclass(frozen=True)
class Histogram:
    """Share of the time in bins of equal width.

    Parameters
    ----------
    edges : (m + 1,) float
    share : (m,) float
        Of the time, per cent; the sum is 100.

    """

    edges: FloatArray
    share: FloatArray


def histogram(x: FloatArray, width: float = 10.0) -> Histogram:
    """Share of the time of x (n,) in bins whose edges are multiples of `width`."""
    first, last = np.floor(np.min(x) / width), np.floor(np.max(x) / width) + 1
    edges = width * np.arange(first, last + 1)
    count = np.histogram(x, edges)[0]
    return Histogram(edges, 100.0 * count / len(x))


@dataclass(frozen=True)
class Intervals:
    """When a record is at zero: ``[first, last)`` of each interval, and the step.

    Parameters
    ----------
    bounds : (k, 2) int
        Samples: the first one inside, the first one after.
    count : int
        Samples of the record.
    step : float
        s.

    """

    bounds: npt.NDArray[np.int64]
    count: int
    step: float

    @property
    def number(self) -> int:
        """How many intervals."""
        return len(self.bounds)

    @property
    def seconds(self) -> float:
        """Their duration together, s."""
        return float(self.step * np.sum(self.bounds[:, 1] - self.bounds[:, 0]))

    @property
    def longest(self) -> float:
        """Duration of the longest, s; 0 without any."""
        return float(self.step * np.max(self.bounds[:, 1] - self.bounds[:, 0], initial=0))

    @property
    def percent(self) -> float:
        """Share of the record, per cent."""
        return float(100.0 * np.sum(self.bounds[:, 1] - self.bounds[:, 0]) / self.count)


def at_zero(force: FloatArray, step: float) -> Intervals:
    """Intervals in which a force (n,) that cannot pull (or push) is zero: lost contact, slack dropper."""
    inside = np.concatenate(([0], np.asarray(force) <= 0.0, [0])).astype(np.int8)
    change = np.diff(inside)
    bounds = np.column_stack((np.flatnonzero(change == 1), np.flatnonzero(change == -1)))
    return Intervals(bounds, len(force), step)
