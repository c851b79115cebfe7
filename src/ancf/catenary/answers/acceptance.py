"""What EN 50367, EN 50119 and the TSI Energy ask of a run, with verdicts.

The limits are those that are read in public sources and in practice; none has been checked against a copy of
the standards, which their tags say.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from . import passing
from .clamp_strain import ALLOWED, clamp_strains, strain_below_strip, strained
from .quantity import Quantity, shown
from .signals import at_zero, sample_rate
from .statistics import (
    LARGEST_DEVIATION,
    LARGEST_SPEED_RATIO,
    MEAN_FORCE_LAW,
    Statistics,
    mean_force_target,
    statistics,
)

if TYPE_CHECKING:
    from .run_data import Run

KMH, MM = 3.6, 1e3
#: Speed up to which the slower of two rules holds, this one included, km/h.
SLOW = 200.0
#: By which a speed counts as one of those, km/h: what is read off positions has the round-off of these, and
#: 200 km/h is no short number in m/s.
SAME_SPEED = 0.01
#: Least mean force, N: a v^2 (v in km/h) + b by power supply (EN 50367).
LEAST_MEAN = {"AC": (0.00047, 60.0), "DC 3 kV": (0.00096, 90.0), "DC 1.5 kV": (0.00112, 70.0)}
#: Largest mean force below SLOW where it is another law: AC.
MOST_MEAN_SLOW = {"AC": (0.00047, 90.0)}
#: Largest force by power supply, N: up to SLOW, above (EN 50119).
LARGEST = {"AC": (300.0, 350.0), "DC 3 kV": (300.0, 400.0), "DC 1.5 kV": (300.0, 400.0)}
#: Losses of contact that count as arcs, s (EN 50317), and their share of the time, % (EN 50367): up to this
#: speed in km/h, above it.
ARC, ARCING, FAST = 5e-3, {"AC": (0.1, 0.2), "DC 3 kV": (0.2, 0.2), "DC 1.5 kV": (0.2, 0.2)}, 250.0
#: Space for the uplift of a steady arm over the largest uplift, without and with a stop (EN 50119).
FREE, STOPPED = 2.0, 1.5
#: Forces of the table of times, N.
LEVELS = (100.0, 150.0, 200.0, 250.0, 300.0, 350.0)


def acceptance(
    run: Run, pantograph: int = 0, supply: str = "AC", found: Statistics | None = None
) -> list[Quantity]:
    """The quantities that are accepted or not, of one pantograph over the window.

    Parameters
    ----------
    run : Run
    pantograph : int
        Its place in ``run.recordings``.
    supply : "AC", "DC 3 kV" or "DC 1.5 kV"
        Which law the mean force has to follow.
    found : Statistics, optional
        Of this pantograph; computed when not given.

    Raises
    ------
    ModelError
        The supply is none of these, or the run does not cover its window.

    """
    passing.check_run(run, "acceptance", pantograph)
    checks.choice(supply, "acceptance.supply", tuple(MEAN_FORCE_LAW))
    if found is None:
        numbers = statistics(run, pantograph)
    else:
        numbers = checks.kind(found, "acceptance.found", Statistics, "leave it out, it is computed")
    return [
        *_forces(run, pantograph, supply, numbers),
        _arcing(run, pantograph, supply, numbers),
        *_uplift(run, pantograph),
        *_strain(run, pantograph, numbers),
        Quantity(
            "speed_ratio", "speed / wave speed", "", numbers["speed_ratio"].value, high=LARGEST_SPEED_RATIO,
            tag="practice",
        ),
    ]  # fmt: skip


def verdict(found: Sequence[Quantity]) -> str:
    """One sentence on the quantities of a pantograph: "outside: standard deviation (34.2 > 32.3 N)"."""
    outside = [q for q in found if q.inside is False]
    if not outside:
        return "inside all limits"
    return "outside: " + ", ".join(_missed(q) for q in outside)


def footnote(found: Statistics) -> str:
    """What a smallest force below zero means; nothing of others."""
    if found["minimum"].value >= 0.0:
        return ""
    return (
        "A smallest force below 0 is the filter's, which overshoots where contact is lost or found again: "
        f"the unfiltered smallest force is {shown(found['raw_minimum'].value, 'N')} N, a strip does not pull."
    )


def _missed(q: Quantity) -> str:
    sign, limit = ("<", q.low) if q.low is not None and q.value < q.low else (">", q.high)
    unit = "e-6" if q.unit == "1e-6" else f" {q.unit}" if q.unit else ""
    texts = shown(q.value, q.unit), shown(limit, q.unit)
    if texts[0] == texts[1]:
        texts = f"{q.value:.6g}", f"{limit:.6g}"
    return f"{q.name.partition(',')[0]} ({texts[0]} {sign} {texts[1]}{unit})"


def _outwards(limit: float, side: int) -> float:
    """A limit of the mean force, N, to the next tenth outwards: pantographs are set to follow the law."""
    tenths = 10.0 * limit - 1e-6 * side
    return float(np.ceil(tenths) if side > 0 else np.floor(tenths)) / 10.0


def _up_to(speed: float, limit: float) -> bool:
    """Whether a speed is at most the one up to which a rule holds, km/h."""
    return speed <= limit + SAME_SPEED


def _forces(run: Run, k: int, supply: str, found: Statistics) -> Iterator[Quantity]:
    speeds = KMH * passing.speeds_in_window(run, k)
    square = float(np.sqrt(np.mean(speeds**2)))
    slow = _up_to(square, SLOW)
    slope, base = LEAST_MEAN[supply]
    least, most = slope * square**2 + base, mean_force_target(square, supply)
    if slow and supply in MOST_MEAN_SLOW:
        slope, base = MOST_MEAN_SLOW[supply]
        most = slope * square**2 + base
    mean, sigma = found["mean_force"].value, found["deviation"].value
    name = f"mean force Fm, {supply}"
    yield Quantity("mean_force", name, "N", mean, low=_outwards(least, -1), high=_outwards(most, 1), tag="U")
    name = "standard deviation, at most 0.3 Fm"
    yield Quantity("deviation", name, "N", sigma, high=LARGEST_DEVIATION * mean, tag="U")
    highest = LARGEST[supply][0 if slow else 1]
    yield Quantity(
        "maximum", "largest force, below 20 Hz", "N", found["maximum"].value, high=highest, tag="U"
    )
    yield Quantity("minimum", "smallest force, below 20 Hz", "N", found["minimum"].value, low=0.0, tag="U")


def _arcing(run: Run, k: int, supply: str, found: Statistics) -> Quantity:
    """NQ: share of the time of losses that last long enough to be seen as arcs."""
    step = 1.0 / sample_rate(run.t)
    lost = at_zero(run.recordings[k].force[found.window], step)
    lengths = step * (lost.bounds[:, 1] - lost.bounds[:, 0])
    share = 100.0 * float(np.sum(lengths[lengths >= ARC - 1e-9])) / (step * lost.count)
    limit = ARCING[supply][0 if _up_to(found["speed"].value, FAST) else 1]
    name = f"NQ, losses of {1e3 * ARC:g} ms and more"
    return Quantity("arcing", name, "%", share, high=limit, tag="U")


def _uplift(run: Run, k: int) -> Iterator[Quantity]:
    """Space that the uplift S0 needs against the stops of the arms of the window, if they have some."""
    supports = passing.uplift_in_window(run, k)
    if not supports:
        return
    most = MM * max(s.uplift for s in supports)
    stops = _stops(run, [s.position for s in supports])
    yield Quantity("uplift", "uplift at support S0", "mm", most)
    if stops:
        name = f"space for uplift, {STOPPED:g} S0, with the stops of the arms"
        yield Quantity("uplift_space", name, "mm", STOPPED * most, high=MM * min(stops), tag="U")
    else:
        yield Quantity("uplift_space", f"space for uplift, {FREE:g} S0", "mm", FREE * most)


def _stops(run: Run, places: list[float]) -> list[float]:
    """Uplifts in m at which stops at some supports meet the wire."""
    line = run.form.line
    starts = getattr(line, "starts", (0.0,))
    found = []
    for start, part in zip(starts, line.parts, strict=True):
        arms = (
            part.steady_arm if isinstance(part.steady_arm, tuple) else [part.steady_arm] * len(part.supports)
        )
        for x, arm in zip(part.supports, arms, strict=True):
            stop = getattr(arm, "uplift_stop", None)
            if stop is not None and any(abs(start + x - place) < passing.SAME_PLACE for place in places):
                found.append(float(stop))
    return found


def _strain(run: Run, k: int, found: Statistics) -> Iterator[Quantity]:
    """Bending of the contact wire; nothing of a wire without bending stiffness."""
    if not strained(run):
        return
    window = found.window
    below = strain_below_strip(run, k)[window]
    at_strip = 1e6 * float(np.max(below))
    name = "bending strain of the contact wire below the strip"
    yield Quantity("strip_strain", name, "1e-6", at_strip, high=1e6 * ALLOWED, tag="practice")
    clamps = clamp_strains(run)
    if clamps:
        name = "its change at clamps, all pantographs"
        largest = 1e6 * max(c.change for c in clamps)
        yield Quantity("clamp_strain", name, "1e-6", largest, high=1e6 * ALLOWED, tag="practice")


def time_above(run: Run, levels: tuple[float, ...] = LEVELS, pantograph: int = 0) -> FloatArray:
    """Share of the time in the window with a contact force above some levels in N, below 20 Hz, per cent.

    Raises
    ------
    ModelError
        A level is no finite number.

    """
    limits = checks.array(levels, "time_above.levels", (None,))
    if not limits.size:
        raise ModelError("time_above.levels", "is empty")
    found = statistics(run, pantograph)
    force = found.force[found.window]
    shares: FloatArray = 100.0 * np.mean(force[:, None] > limits, axis=0)
    return shares
