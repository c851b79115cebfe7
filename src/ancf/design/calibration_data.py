"""What a calibration is given: bounds, starts and measured columns, checked."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..columns import read_columns
from ..errors import ModelError
from ..model import checks
from ..model.functions.units import KINDS, in_plain_units
from ..viz import style

TIME = "t"
#: Ratio of positive bounds above which the logarithm of a parameter is looked for.
WIDE = 10.0
#: A column that is one question, perhaps of one of its components; those whose unit depends on what is asked.
QUESTION = re.compile(r"(\w+)\([^()]*(?:\([^()]*\))?[^()]*\)(?:\[\d+\])?")
OPEN = "multiplier", "energy"


def is_logarithmic(low: float, high: float) -> bool:
    """Whether the logarithm of a parameter with these bounds is looked for."""
    return low > 0.0 and high > WIDE * low


def bounds_of(parameters: Any, where: str = "calibrate") -> dict[str, tuple[float, float]]:
    """Bounds by name; ModelError if they are none."""
    if not isinstance(parameters, Mapping) or not parameters:
        raise ModelError(f"{where}.parameters", "must be bounds (low, high) by name")
    made = {}
    for name, given in parameters.items():
        low, high = checks.array(given, f"{where}.parameters: {name}", (2,)).tolist()
        if not low < high:
            what = f"has the bounds {low:g} and {high:g}, the first must be below"
            raise ModelError(f"{where}.parameters: {name}", what)
        made[str(name)] = (low, high)
    return made


def start_of(
    start: Mapping[str, float] | None, bounds: dict[str, tuple[float, float]], where: str = "calibrate"
) -> dict[str, float]:
    """Where to begin: what is given, else the middle of the bounds or of their logarithms."""
    given = checks.mapping(start, f"{where}.start", "a number for each parameter")
    for name in given:
        if name not in bounds:
            raise ModelError(f"{where}.start: {name}", "is no parameter", checks.nearest(name, bounds))
    made = {}
    for name, (low, high) in bounds.items():
        middle = float(np.sqrt(low * high)) if is_logarithmic(low, high) else 0.5 * (low + high)
        made[name] = checks.between(given.get(name, middle), f"{where}.start: {name}", low, high)
    return made


def priors_of(
    given: Any, bounds: dict[str, tuple[float, float]], where: str = "calibrate"
) -> dict[str, tuple[float, float]]:
    """Means and standard deviations by name; ModelError if they are none or out of the bounds."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise ModelError(f"{where}.priors", "must be pairs (mean, deviation) by name")
    made = {}
    for name, pair in given.items():
        if name not in bounds:
            raise ModelError(f"{where}.priors: {name}", "is no parameter", checks.nearest(name, bounds))
        mean, deviation = checks.array(pair, f"{where}.priors: {name}", (2,)).tolist()
        checks.between(mean, f"{where}.priors: {name}, its mean", *bounds[name])
        made[str(name)] = mean, checks.positive(deviation, f"{where}.priors: {name}, its deviation")
    return made


def unit_of(column: str) -> str | None:
    """Unit of the package of a column that is the time or one plain question; None of other formulas."""
    question = "t" if column == TIME else found[1] if (found := QUESTION.fullmatch(column)) else ""
    unit = style.UNITS.get(question)
    return unit if question not in OPEN and unit in KINDS else None


def columns_of(data: Any) -> dict[str, FloatArray]:
    """Columns of numbers (n,) of a file, a table or a mapping; ModelError if they are none."""
    where = "calibrate.data"
    if isinstance(data, str | Path):
        found: Mapping[str, Any] = in_plain_units(read_columns(Path(data), where), where, unit_of)
    elif hasattr(data, "columns"):
        found = {str(name): data[name].to_numpy() for name in data.columns}
    elif isinstance(data, Mapping):
        found = data
    else:
        raise ModelError(where, f"must be a file, a table or columns by name, is {checks.shown(data)}")
    made = {str(name): _column(column, f'{where}["{name}"]') for name, column in found.items()}
    if TIME not in made or len(made) < 2:
        what = f'has the columns {checks.listed(made)}: wanted "t" and at least one that was measured'
        named = next((name for name in made if name.lower() in ("time", "times", "seconds")), "")
        hint = f'the times stand under "t", not "{named}"' if named else ""
        raise ModelError(where, what, hint)
    times = made[TIME]
    if len(times) < 1 or not np.all(np.isfinite(times)) or np.any(np.diff(times) <= 0) or times[0] < 0:
        raise ModelError(f'{where}["t"]', "must be increasing times from 0 on, s")
    for name, column in made.items():
        if len(column) != len(times):
            raise ModelError(f'{where}["{name}"]', f"has {len(column)} entries for {len(times)} times")
    return made


def _column(given: Any, where: str) -> FloatArray:
    values = [float("nan") if isinstance(x, str) and not x.strip() else x for x in checks.items(given, where)]
    try:
        return np.array([float(x) for x in values])
    except (TypeError, ValueError):
        wrong = next(x for x in values if not _is_number(x))
        raise ModelError(where, f"must hold numbers, holds {checks.shown(wrong)}") from None


def _is_number(x: Any) -> bool:
    try:
        float(x)
    except (TypeError, ValueError):
        return False
    return True


def numbers_of(given: Any, times: FloatArray, name: str) -> FloatArray:
    """What a model gives for a column, (n,); ModelError if it is not finite numbers at the times."""
    made = np.asarray(given, dtype=np.float64)
    if made.shape != times.shape or not np.all(np.isfinite(made)):
        what = f"must be {len(times)} finite numbers, has the shape {made.shape}"
        raise ModelError(f'calibrate.build: "{name}"', what if made.shape != times.shape else "is not finite")
    return made
