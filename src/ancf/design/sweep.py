"""A sweep over speeds and distances of pantographs: a study of one line, and its report."""

from __future__ import annotations

import hashlib
import itertools
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..catenary import Line, Mesh, Route, acceptance, form
from ..catenary import run as run_line
from ..catenary.broken import chosen
from ..errors import ModelError
from ..model import checks
from .extras import pandas
from .study import Step, study

if TYPE_CHECKING:
    from pandas import DataFrame

    from ..catenary.forms.route_form import AnyForm

#: Columns of what varies: km/h, m.
SPEED, SPACING = "speed_kmh", "spacing_m"
#: Values of one option; more is a slip.
MOST_VALUES = 10_000


def values_of(text: str, where: str) -> list[float]:
    """Numbers of "160:320:20" (first, last, step; both ends included), "200,250", or both mixed.

    Raises
    ------
    ModelError
        A part is no number or no range, is not above 0, or comes twice.
    """
    found: list[float] = []
    for part in text.split(","):
        numbers = [_number(word, where, part) for word in part.split(":")]
        if len(numbers) == 1:
            found.append(numbers[0])
        elif len(numbers) == 3:
            found += _range(*numbers, where=where, part=part)
        else:
            raise ModelError(where, f'"{part}" is no number and no range', "write 250, or 160:320:20")
    for value in found:
        checks.positive(value, where)
        if found.count(value) > 1:
            raise ModelError(where, f"{value:g} is given twice")
    return found


def _number(word: str, where: str, part: str) -> float:
    try:
        return checks.number(float(word), where)
    except ValueError:
        raise ModelError(where, f'"{part}" is no number and no range', "write 250, or 160:320:20") from None


def _range(low: float, high: float, step: float, *, where: str, part: str) -> list[float]:
    hint = "write first:last:step, such as 160:320:20"
    if not step > 0.0:
        raise ModelError(where, f'"{part}" has a step of {step:g}, must be > 0', hint)
    if not low < high:
        raise ModelError(where, f'"{part}" is empty: it begins at {low:g}, not below {high:g}', hint)
    count = (high - low) / step
    if count > MOST_VALUES:
        raise ModelError(where, f'"{part}" has more than {MOST_VALUES} values')
    if abs(count - round(count)) > 1e-9 * max(count, 1.0):
        what = f'"{part}" does not end at {high:g}: the steps from {low:g} on are {step:g}'
        raise ModelError(
            where, what, f"the last is {low + int(count) * step:g} or {low + (int(count) + 1) * step:g}"
        )
    return [low + k * step for k in range(round(count) + 1)]


@dataclass(frozen=True)
class SweepCase:
    """Runs pantographs along a line at a speed and a distance; its form is found once in each process.

    Parameters
    ----------
    line : Line or Route
    settings : mapping
        Of :func:`ancf.catenary.run`, but for speed, spacing and mesh.
    supply : str
        Of :func:`ancf.catenary.acceptance`.
    mesh : Mesh
    """

    line: Line | Route
    settings: Mapping[str, Any]
    supply: str = "AC"
    mesh: Mesh = field(default_factory=Mesh)

    def __getstate__(self) -> dict[str, Any]:
        """Without the form, which each process finds for itself."""
        return {key: value for key, value in self.__dict__.items() if key != "form"}

    @cached_property
    def form(self) -> AnyForm:
        """The line at rest."""
        return form(self.line, self.mesh)

    def identity(self) -> dict[str, Any]:
        """What makes the study, whatever its cases are."""
        with np.printoptions(threshold=sys.maxsize, floatmode="unique"):
            text = repr((self.line, sorted(self.settings.items()), self.supply, self.mesh))
        return {"sweep": self.line.title, "hash": hashlib.sha256(text.encode("utf-8")).hexdigest()[:16]}

    def __call__(self, /, **values: Any) -> dict[str, float]:
        """Quantities that are accepted or not, of each pantograph by its number, and whether all are."""
        given = {"spacing": values[SPACING]} if SPACING in values else {}
        done = run_line(self.form, speed=values[SPEED] / 3.6, **given, **self.settings)
        found: dict[str, float] = {}
        for k in range(len(done.recordings)):
            rows = acceptance(done, k, self.supply)
            found |= {f"{q.key}_{k + 1}": q.value for q in rows}
            for q in rows:
                if q.key == "mean_force" and q.low is not None and q.high is not None:
                    found |= {f"mean_force_low_{k + 1}": q.low, f"mean_force_high_{k + 1}": q.high}
            judged = [q for q in rows if q.inside is not None]
            found |= {f"outside_{q.key}_{k + 1}": float(not q.inside) for q in judged}
            found[f"accepted_{k + 1}"] = float(all(q.inside is not False for q in rows))
        return found


def sweep(
    line: Line | Route,
    speeds: Sequence[float],
    spacings: Sequence[float] = (),
    *,
    folder: str | Path | None = None,
    workers: int | None = None,
    retry: bool = False,
    supply: str = "AC",
    mesh: Mesh | None = None,
    progress: Callable[[Step], None] | None = None,
    **settings: Any,
) -> DataFrame:
    """Run pantographs along a line at all speeds and distances, in parallel and safe against any end.

    Parameters
    ----------
    line : Line or Route
    speeds : sequence of float, km/h
    spacings : sequence of float, m
        Distances of a second pantograph behind the first; default none.
    folder : path, optional
        For the journal, from which the same call goes on, and the table; see :func:`ancf.study`.
    workers, retry, progress
        See :func:`ancf.study`.
    supply : "AC", "DC 3 kV" or "DC 1.5 kV"
        By whose law the mean force is accepted.
    mesh : Mesh
    settings
        Of :func:`ancf.catenary.run`.

    Returns
    -------
    DataFrame
        A row for each case: ``speed_kmh``, ``spacing_m`` if distances are given, then the quantities of
        :func:`ancf.catenary.acceptance` with the number of the pantograph behind their key, ``accepted_1``
        and so on, ``status`` and ``message``.

    Raises
    ------
    ModelError
        What is given is wrong, or the folder holds another study.
    """
    for k, speed in enumerate(speeds):
        checks.positive(speed, f"sweep.speeds[{k}]")
    for k, spacing in enumerate(spacings):
        checks.positive(spacing, f"sweep.spacings[{k}]")
    chosen(line, settings.get("broken_droppers", ()), "sweep.broken_droppers")
    if not len(speeds):
        raise ModelError("sweep.speeds", "is empty")
    rows = [{SPEED: float(v), SPACING: float(d)} for v, d in itertools.product(speeds, spacings)]
    samples = pandas().DataFrame(rows or [{SPEED: float(v)} for v in speeds])
    case = SweepCase(line, settings, supply, Mesh() if mesh is None else mesh)
    return study(
        case,
        samples,
        folder=folder,
        workers=workers,
        retry=retry,
        report=False,
        progress=progress,
        title=line.title,
    )
