"""Figures of the contact force by size and by frequency: histogram and spectrum over the window."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...viz import style
from ..answers.signals import CUT_OFF, histogram, sample_rate, spectrum
from . import marks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .content import Content

BIN = 10.0  # N
HIGHEST = 30.0  # Hz


def size(content: Content) -> tuple[float, float]:
    """Width and height, mm."""
    return marks.WIDTH, 78.0


def draw_histogram(content: Content, figure: Figure) -> None:
    """Share of the time by force below 20 Hz, and the normal distribution of the same mean and deviation."""
    axes = figure.subplots()
    for k, found in enumerate(content.found):
        shares = histogram(found.force[found.window], BIN)
        axes.stairs(shares.share, shares.edges, label=content.name(k), linewidth=1.3, **marks.look(k))
        if not content.several:
            axes.stairs(shares.share, shares.edges, fill=True, color=style.BLUE, alpha=0.15)
    for found in content.found:
        _normal(axes, found["mean_force"].value, found["deviation"].value)
    axes.set(xlabel="contact force below 20 Hz [N]", ylabel=f"share of time per {BIN:g} N [%]")
    axes.set_ylim(bottom=0)
    marks.legend(figure, axes)


def _normal(axes: Axes, mean: float, deviation: float) -> None:
    if deviation <= 0:
        return
    x = np.linspace(mean - 4 * deviation, mean + 4 * deviation, 200)
    share = 100 * BIN * np.exp(-0.5 * ((x - mean) / deviation) ** 2) / (deviation * np.sqrt(2 * np.pi))
    axes.plot(x, share, linewidth=0.8, color=style.GREY, linestyle=":", label="normal distribution")


def draw_spectrum(content: Content, figure: Figure) -> None:
    """Amplitude of the unfiltered force, with the frequencies at which spans and droppers pass."""
    axes = figure.subplots()
    rate = sample_rate(content.run.t)
    for k, found in enumerate(content.found):
        lines = spectrum(content.run.recordings[k].force[found.window], rate)
        below = lines.frequency <= HIGHEST
        axes.plot(lines.frequency[below], lines.amplitude[below], label=content.name(k), **marks.look(k))
    axes.set(xlabel="frequency [Hz]", ylabel="amplitude of the contact force [N]", xlim=(0, HIGHEST))
    axes.set_ylim(bottom=0)
    axes.axvline(CUT_OFF, linestyle="--", label="20 Hz", **marks.FINE)
    _passing(axes, content)
    marks.legend(figure, axes)


def _passing(axes: Axes, content: Content) -> None:
    line, (low, high) = content.run.form.line, content.run.window
    spans = np.diff([x for x in np.unique(np.round(line.supports, 6)) if low - 1e-6 <= x <= high + 1e-6])
    pitch = np.diff([x for x in np.unique(np.round(line.dropper_x, 6)) if low <= x <= high])
    for row, (lengths, name) in enumerate(((spans, "spans"), (pitch, "droppers"))):
        frequency = content.speed_kmh / 3.6 / float(np.median(lengths)) if len(lengths) else HIGHEST
        if frequency >= HIGHEST:
            continue
        axes.axvline(frequency, linestyle=":", **marks.FINE)
        note = f"{name} pass at {frequency:.2g} Hz"
        place: dict[str, Any] = {"xy": (frequency, 1.0), "xycoords": axes.get_xaxis_transform()}
        below = -3 - 10 * row  # slow trains pass both at nearly the same rate
        axes.annotate(note, xytext=(3, below), textcoords="offset points", va="top", fontsize=7, **place)
