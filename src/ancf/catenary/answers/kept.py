"""Runs that were written to folders, read for comparison."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...arrays import FloatArray
from ...columns import read_columns
from ...errors import ModelError
from ...model import checks
from ..broken import told
from .quantity import Quantity
from .state import pulled

SUMMARY = "run.json"
#: Runs that fit beside each other in a table.
MOST = 6


@dataclass(frozen=True)
class Kept:
    """One pantograph of a run in a folder.

    Attributes
    ----------
    name : str
        That of the folder, and of the pantograph if there are several.
    folder : str
        Name of the run.
    place : int
        In the train, the first ahead is 0.
    label : str
        Short name for a column, "before", of several pantographs "before-2".
    line, state : str
        Title, and conditions with the tensions at rest; nothing of runs of earlier versions.
    speed_kmh : float
    window : (float, float)
        Track interval that was evaluated, m.
    acceptance, statistics : list of Quantity
    position, force : (n,)
        Track position, m, and contact force below 20 Hz, N.
    uplift : list of (float, float)
        Track position of each support that was passed, m, and its uplift, mm.

    """

    name: str
    line: str
    speed_kmh: float
    window: tuple[float, float]
    acceptance: list[Quantity]
    statistics: list[Quantity]
    position: FloatArray
    force: FloatArray
    uplift: list[tuple[float, float]]
    state: str = ""
    folder: str = ""
    place: int = 0
    label: str = ""

    @property
    def quantities(self) -> list[Quantity]:
        """What is accepted or not, then all statistics, each key once."""
        known = {quantity.key for quantity in self.acceptance}
        return [*self.acceptance, *(q for q in self.statistics if q.key not in known)]


def read_runs(folders: Sequence[str | Path]) -> list[Kept]:
    """Pantographs of the runs in some folders, one after the other.

    Raises
    ------
    ModelError
        A folder holds no run or stands twice, or there are less than two pantographs or more than six.

    """
    paths = [Path(folder) for folder in folders]
    for k, path in enumerate(paths):
        if path.resolve() in [other.resolve() for other in paths[:k]]:
            raise ModelError(str(path), "stands there twice", "give folders of different runs")
    names = _names(paths)
    found = [kept for path, name in zip(paths, names, strict=True) for kept in read_run(path, name)]
    if not 2 <= len(found) <= MOST:
        what = f"are {len(found)} pantographs in all"
        raise ModelError("compare", what, f"give folders with 2 to {MOST} of them")
    return found


def read_run(folder: str | Path, name: str | None = None) -> list[Kept]:
    """Pantographs of the run in a folder, as ``ancf catenary run -o`` and :func:`write_run` leave it.

    Raises
    ------
    ModelError
        There is none, or a file of it is damaged.

    """
    path = checks.path(folder, "read_run.folder")
    data = _summary(path)
    title = path.name if name is None else checks.text(name, "read_run.name") or path.name
    try:
        several = len(data["pantographs"]) > 1
        return [
            replace(
                _kept(path, data, k, f"{title}, {_numbered(one['name'], k)}" if several else title),
                folder=title,
                label=f"{title}-{k + 1}" if several else title,
            )
            for k, one in enumerate(data["pantographs"])
        ]
    except (KeyError, TypeError, ValueError) as error:
        raise ModelError(str(path / SUMMARY), f"is damaged: {error!r}", "run it again") from None


def _summary(path: Path) -> dict[str, Any]:
    for name in (SUMMARY, "statistics.json"):
        try:
            data = json.loads((path / name).read_text(encoding="utf-8"))
        except FileNotFoundError:
            continue
        except (OSError, ValueError) as error:
            raise ModelError(str(path / name), f"cannot be read: {error}", "run it again") from None
        if not isinstance(data, dict):
            raise ModelError(str(path / name), "holds no run", "a folder that ancf catenary run has written")
        return data
    raise ModelError(str(path), "holds no run of pantographs", "a folder that ancf catenary run has written")


def _numbered(name: str, k: int) -> str:
    """A pantograph with its place in the train, unless its name is that already."""
    return name if name == f"pantograph {k + 1}" else f"{name} ({k + 1})"


def _kept(path: Path, data: dict[str, Any], k: int, name: str) -> Kept:
    one = data["pantographs"][k]
    file = path / f"force_{k + 1}.csv"
    columns = read_columns(file, str(file))
    low, high = data["window_m"]
    return Kept(
        name=name,
        line=str(data["line"]),
        speed_kmh=float(data["speed_kmh"]),
        window=(float(low), float(high)),
        acceptance=[_quantity(row) for row in one["acceptance"]],
        statistics=[_quantity(row) for row in one["statistics"]],
        position=_numbers(columns, "position_m", file),
        force=_numbers(columns, "force_20hz_N", file),
        uplift=[(float(row["position_m"]), float(row["uplift_mm"])) for row in one["uplift_mm"]],
        state=_state(data),
        place=k,
    )


def _state(data: dict[str, Any]) -> str:
    rows = [
        f"{row['wire']} {pulled(row['smallest_N'], row['largest_N'])} N (designed {row['designed_N']:.0f})"
        for row in data.get("tensions", ())
    ]
    broken = told([str(label) for label in data.get("broken_droppers", ())])
    return ", ".join([*filter(None, [data.get("state", ""), broken]), *rows])


def _numbers(columns: dict[str, list[Any]], key: str, file: Path) -> FloatArray:
    import numpy as np

    if key not in columns:
        raise ModelError(f"{file}, column {key}", "is missing", "run it again")
    try:
        return np.array(columns[key], dtype=np.float64)
    except ValueError:
        raise ModelError(f"{file}, column {key}", "holds a text", "run it again") from None


def _quantity(row: dict[str, Any]) -> Quantity:
    value = float("nan") if row["value"] is None else float(row["value"])
    return Quantity(row["key"], row["quantity"], row["unit"], value, row["low"], row["high"], row["tag"])


def _names(paths: list[Path]) -> list[str]:
    """Names of folders, with those above them where they are alike."""
    names = [path.resolve().name for path in paths]
    return [name if names.count(name) == 1 else str(path) for name, path in zip(names, paths, strict=True)]
