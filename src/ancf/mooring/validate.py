"""Mooring lines computed and compared with MoorPy, MoorDyn, OrcaFlex's list and a measured chain."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

from .. import validation
from ..catenary.answers.quantity import Quantity
from ..validation import Group, Progress
from ..viz import style
from . import cases

CASE = "mooring"
TITLE = "Mooring lines against other programs and measurements"


def references() -> dict[str, Any]:
    """The stored numbers with their origins."""
    return tomllib.loads(files(__package__).joinpath("references.toml").read_text(encoding="utf-8"))


def compare(progress: Progress | None = None) -> list[Group]:
    """Compute all cases and put them beside their references; ``progress(done, of)`` is called after each."""
    found = references()
    measured = found["measured"]
    makers: dict[str, Callable[[], dict[str, float]]] = {
        "catenary": lambda: cases.catenary(0.0),
        "rubbing catenary": lambda: cases.catenary(0.1),
        "chain": cases.forces_of_chain,
        "heaving chain": cases.heaving_chain,
    }
    places = [(float(T), k) for T in measured["periods"] for k in range(len(measured["radii"]))]
    total = len(makers) + len(places)
    numbers: dict[str, dict[str, float]] = {}
    for name, make in makers.items():
        numbers[name] = make()
        if progress is not None:
            progress(len(numbers), total)
    groups = [
        Group(g["title"], g["source"], [_row(row, numbers[row["case"]][row["key"]]) for row in g["row"]])
        for g in found["group"]
    ]
    peaks = []
    for number, (period, k) in enumerate(places):
        peaks.append(cases.mean_peak(measured["radii"][k], period))
        if progress is not None:
            progress(len(makers) + number + 1, total)
    return [*groups, _measured(measured, places, peaks)]


def _row(row: dict[str, Any], value: float) -> Quantity:
    reference = row["value"]
    within = row["within"] if "within" in row else row["share"] * reference
    return Quantity(
        row["key"], row["name"], row["unit"], value, reference - within, reference + within, "program"
    )


def _measured(given: dict[str, Any], places: list[tuple[float, int]], peaks: list[float]) -> Group:
    """A row for each motion, and the error of all of them."""
    printed = [row for rows in given["periods"].values() for row in rows]
    rows = []
    for (period, k), peak in zip(places, peaks, strict=True):
        name = f"peak, r = {given['radii'][k]:g} m, T = {period:g} s"
        rows.append(Quantity("peak", name, "N", peak))
    error = math.sqrt(sum((a - b) ** 2 for a, b in zip(peaks, printed, strict=True)) / len(peaks))
    rows.append(
        Quantity("rmse", "root mean square error of all", "N", error, None, given["most"], "measured")
    )
    return Group(
        given["title"], given["source"], rows, [*printed, math.nan], lambda: _picture(given, peaks, printed)
    )


def _picture(given: dict[str, Any], peaks: list[float], printed: list[float]) -> str:
    """Peaks over the radius of the circle, computed and measured, of each period."""
    count = len(given["radii"])
    with style.new_figure(120.0, 80.0) as figure:
        axes = figure.subplots()
        for n, period in enumerate(given["periods"]):
            mine = slice(n * count, (n + 1) * count)
            look = style.look(n)
            axes.plot(given["radii"], peaks[mine], color=look.color, label=f"T = {float(period):g} s")
            axes.plot(given["radii"], printed[mine], "o", color=look.color, ms=4.0)
        axes.plot([], [], "o", color=style.GREY, ms=4.0, label="measured")
        axes.set_xlabel("radius of the circle [m]")
        axes.set_ylabel("mean of the peaks of the force [N]")
        style.legend_above(figure, axes)
        text = style.svg(figure)
    return text


def write(groups: list[Group], folder: Path, report: bool = True) -> list[Path]:
    """Write ``validate.json`` and, if wanted, ``report.html``; returns the files."""
    return validation.write(CASE, TITLE, groups, folder, report)
