"""What a number of a run's statistics changes by with each sample of the contact force, or with an uplift."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .passing import in_window, uplift_in_window
from .signals import BANDS, Butterworth, sample_rate

if TYPE_CHECKING:
    from .run_data import Run

MM = 1e3
OF_BANDS = {f"deviation_{low:g}_{high:g}": (low, high) for low, high in BANDS[1:]}
#: Numbers with derivatives, as :func:`ancf.catenary.slopes` has them.
NUMBERS = (
    *("mean_force", "deviation", "mean_plus_3_sigma", "mean_minus_3_sigma", "maximum", "minimum"),
    *("raw_maximum", "raw_minimum", "relative_deviation", *OF_BANDS, "uplift"),
)


class Weights(NamedTuple):
    """A number of a run and its derivatives by what was recorded."""

    value: float
    force: FloatArray  # (n,) by the contact force of the pantograph at all samples, unit per N
    lifted: tuple[int, int] | None  # sample and support of the uplift that it is, in mm, or None


def weights_of(run: Run, number: str, pantograph: int, chosen: Butterworth) -> Weights:
    """Of one of NUMBERS.

    Raises
    ------
    ModelError
        There is no such number, or the run does not cover the window.
    """
    window, rate = in_window(run, pantograph), sample_rate(run.t)
    raw = run.recordings[pantograph].force
    made = np.zeros_like(raw)
    if number == "uplift":
        if not uplift_in_window(run, pantograph):
            raise ModelError("gradient.objective", "there is no support in the window", "take a longer one")
        most = max(uplift_in_window(run, pantograph), key=lambda one: one.uplift)
        column = most.number - 1
        return Weights(MM * most.uplift, made, (int(np.argmax(run.uplift[:, column] == most.uplift)), column))
    if number.startswith("raw"):
        value, made[window] = extreme_of(raw[window], number)
        return Weights(value, made, None)
    low, high = OF_BANDS.get(number, BANDS[0])
    found = of_filtered(chosen.band(raw, rate, low, high)[window])
    value, made[window] = found.get(number, found["deviation"])
    return Weights(value, chosen.band_back(made, rate, low, high), None)


def extreme_of(x: FloatArray, number: str) -> tuple[float, FloatArray]:
    """The largest or the least of samples, as a name ends, and its derivatives by them."""
    k, made = int(np.argmax(x) if number.endswith("maximum") else np.argmin(x)), np.zeros_like(x)
    made[k] = 1.0
    return float(x[k]), made


def of_filtered(x: FloatArray) -> dict[str, tuple[float, FloatArray]]:
    """Numbers of a filtered force (n,) and their derivatives (n,) by its samples."""
    mean, sigma, n = float(np.mean(x)), float(np.std(x)), len(x)
    means = np.full(n, 1.0 / n)
    sigmas = (x - mean) / (n * sigma) if sigma > 0.0 else np.zeros(n)
    return {
        "mean_force": (mean, means),
        "deviation": (sigma, sigmas),
        "mean_plus_3_sigma": (mean + 3.0 * sigma, means + 3.0 * sigmas),
        "mean_minus_3_sigma": (mean - 3.0 * sigma, means - 3.0 * sigmas),
        "maximum": extreme_of(x, "maximum"),
        "minimum": extreme_of(x, "minimum"),
        "relative_deviation": (sigma / mean, (sigmas - sigma * means / mean) / mean),
    }
