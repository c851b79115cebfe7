"""Statistics of a run: contact force, loss of contact, uplift, height, droppers, wave speed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...arrays import FloatArray
from ...errors import UnknownNameError
from ...model import checks
from ..told import Told
from . import passing
from .quantity import Quantity
from .signals import BANDS, CUT_OFF, Butterworth, at_zero, filter_of, sample_rate

if TYPE_CHECKING:
    from .run_data import Run

MM, MS, KMH = 1e3, 1e3, 3.6
#: Largest accepted ratio of standard deviation to mean force (EN 50367).
LARGEST_DEVIATION = 0.3
#: Height that a level line may change, m.
LEVEL = 1e-6
#: Largest usual ratio of speed to wave speed.
LARGEST_SPEED_RATIO = 0.7
#: Mean-force law: 0.00097 v^2 (v in km/h) plus this, N, by power supply.
MEAN_FORCE_SLOPE = 0.00097
MEAN_FORCE_LAW = {"AC": (70.0, "V2"), "DC 3 kV": (110.0, "V"), "DC 1.5 kV": (140.0, "V")}


@dataclass(frozen=True)
class Statistics(Told, Mapping[str, Quantity]):
    """What is read off a run for one pantograph: its quantities by their keys, ``found["mean_force"].value``.

    Parameters
    ----------
    pantograph : str
        Its name.
    quantities : tuple of Quantity
        In the order in which a table shows them.
    filter : Butterworth
        The filter of all bands.
    force : (n,) float
        Contact force over the whole run, low pass at 20 Hz, N.
    window : slice
        Samples that were evaluated.
    supports : list of SupportUplift
        Of all supports it passes.
    droppers : list of DropperForces
        Of the droppers in the window, while it is in the window.

    """

    pantograph: str
    quantities: tuple[Quantity, ...]
    filter: Butterworth
    force: FloatArray = field(repr=False)
    window: slice
    supports: list[passing.SupportUplift] = field(repr=False)
    droppers: list[passing.DropperForces] = field(repr=False)

    def __getitem__(self, key: str) -> Quantity:
        for quantity in self.quantities:
            if isinstance(key, str) and quantity.key == key:
                return quantity
        known = list(self)
        hint = f"{checks.nearest(key, known)} known are {', '.join(known)}".strip()
        raise UnknownNameError("statistics", f"there is no quantity {checks.shown(key)}", hint)

    def __repr__(self) -> str:
        return self.in_a_line()

    def __iter__(self) -> Iterator[str]:
        return (quantity.key for quantity in self.quantities)

    def __len__(self) -> int:
        return len(self.quantities)


def statistics(run: Run, pantograph: int = 0, filter: Butterworth | None = None) -> Statistics:
    """Statistics of one pantograph over the window of a run.

    The whole record is filtered and then cut to the window, so that the filter starts far away from it. Each
    standard deviation is the root of the mean square over the samples of the window.

    Parameters
    ----------
    run : Run
    pantograph : int
        Its place in ``run.recordings``.
    filter : Butterworth, optional
        Order 6, forward and backward, by default.

    Raises
    ------
    ModelError
        The run does not cover the window, its steps are not even, or it has no such pantograph.

    """
    pantograph = passing.check_run(run, "statistics", pantograph)
    chosen = filter_of(filter, "statistics")
    recording, rate = run.recordings[pantograph], sample_rate(run.t)
    window = passing.in_window(run, pantograph)
    force = chosen.low_pass(recording.force, rate)
    supports = passing.uplift_at_supports(run, pantograph)
    droppers = passing.droppers_in_window(run, pantograph)
    quantities = (
        *_force(force[window], recording.force[window]),
        *_bands(recording.force, rate, window, chosen),
        *_loss(recording.force[window], 1.0 / rate),
        *_line(run, passing.uplift_in_window(run, pantograph), droppers),
        *_height(recording.height, rate, window, chosen),
        *_over_nominal(run, pantograph, rate, window, chosen),
        *_speed(run, passing.speeds_in_window(run, pantograph)),
    )
    return Statistics(recording.name, quantities, chosen, force, window, supports, droppers)


def mean_force_target(speed_kmh: float, supply: str = "AC") -> float:
    """Mean contact force that the law of EN 50367 aims at, N."""
    return MEAN_FORCE_SLOPE * speed_kmh**2 + MEAN_FORCE_LAW[supply][0]


def _force(force: FloatArray, raw: FloatArray) -> Iterator[Quantity]:
    mean, deviation = float(np.mean(force)), float(np.std(force))
    yield Quantity("mean_force", "mean force Fm", "N", mean)
    yield Quantity("deviation", "standard deviation 0-20 Hz", "N", deviation)
    yield Quantity("mean_plus_3_sigma", "Fm + 3 sigma", "N", mean + 3 * deviation)
    yield Quantity("mean_minus_3_sigma", "Fm - 3 sigma", "N", mean - 3 * deviation)
    yield Quantity("maximum", "actual maximum", "N", float(np.max(force)))
    yield Quantity("minimum", "actual minimum", "N", float(np.min(force)))
    yield Quantity("raw_maximum", "maximum, unfiltered", "N", float(np.max(raw)))
    yield Quantity("raw_minimum", "minimum, unfiltered", "N", float(np.min(raw)))
    if mean > 0:
        ratio = deviation / mean
        yield Quantity("relative_deviation", "sigma / Fm", "", ratio, high=LARGEST_DEVIATION, tag="U")


def _bands(force: FloatArray, rate: float, window: slice, chosen: Butterworth) -> Iterator[Quantity]:
    for low, high in BANDS[1:]:
        part = chosen.band(force, rate, low, high)[window]
        key, name = f"deviation_{low:g}_{high:g}", f"standard deviation {low:g}-{high:g} Hz"
        yield Quantity(key, name, "N", float(np.std(part)))


def _loss(raw: FloatArray, step: float) -> Iterator[Quantity]:
    lost = at_zero(raw, step)
    yield Quantity("loss", "loss of contact", "%", lost.percent)
    yield Quantity("loss_number", "losses of contact", "count", lost.number)
    yield Quantity("loss_longest", "longest loss of contact", "ms", MS * lost.longest)


def _line(
    run: Run, supports: list[passing.SupportUplift], droppers: list[passing.DropperForces]
) -> Iterator[Quantity]:
    if supports:
        highest = max(s.uplift for s in supports)
        yield Quantity("uplift", "uplift at support", "mm", MM * highest)
    broken = [d for d in droppers if d.broken]
    if broken:
        yield Quantity("broken_droppers", "broken droppers", "count", len(broken))
    if len(droppers) > len(broken):
        largest = max(d.largest for d in droppers if not d.broken)
        yield Quantity("dropper_maximum", "largest dropper force", "N", largest)
        slack = [d.slack for d in droppers if d.slack.number]
        yield Quantity("slack_droppers", "droppers that went slack", "count", len(slack))
        yield Quantity("slack_number", "slack intervals of droppers", "count", sum(s.number for s in slack))
        longest = max((s.longest for s in slack), default=0.0)
        yield Quantity("slack_longest", "longest slack interval", "ms", MS * longest)


def _height(height: FloatArray, rate: float, window: slice, chosen: Butterworth) -> Iterator[Quantity]:
    below = chosen.low_pass(height, rate, CUT_OFF)[window]
    yield Quantity("height_range", "range of contact-point height", "mm", MM * float(np.ptp(below)))
    raw = MM * float(np.ptp(height[window]))
    yield Quantity("raw_height_range", "range of contact-point height, unfiltered", "mm", raw)


def _over_nominal(
    run: Run, pantograph: int, rate: float, window: slice, chosen: Butterworth
) -> Iterator[Quantity]:
    """The same over the nominal height of the wire, where that is not level in the window."""
    recording = run.recordings[pantograph]
    level = np.asarray(run.form.line.height_at(recording.position), dtype=np.float64)
    if float(np.ptp(level[window])) > LEVEL:
        below = chosen.low_pass(recording.height - level, rate, CUT_OFF)[window]
        name = "range of contact-point height over the nominal one"
        yield Quantity("height_range_over_nominal", name, "mm", MM * float(np.ptp(below)))


def _speed(run: Run, speeds: FloatArray) -> Iterator[Quantity]:
    """The law is the mean over the window of what it asks for at each speed (n,), m/s."""
    wave, mean = float(run.form.wave_speed), float(np.mean(speeds))
    yield Quantity("speed", "speed", "km/h", KMH * mean)
    square = KMH * float(np.sqrt(np.mean(speeds**2)))
    for supply, (_, tag) in MEAN_FORCE_LAW.items():
        key = "mean_force_law_" + supply.lower().replace(" ", "_").replace(".", "_")
        value = mean_force_target(square, supply)
        yield Quantity(key, f"mean-force law {supply}", "N", value, tag=tag)
    yield Quantity("wave_speed", "wave speed of the contact wire", "km/h", KMH * wave)
    name = "speed / wave speed"
    yield Quantity("speed_ratio", name, "", mean / wave, high=LARGEST_SPEED_RATIO, tag="practice")
