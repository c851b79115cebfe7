"""Calibration files: TOML with a model, measured histories and the bounds of parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import Field, ValidationError

from ..arrays import FloatArray
from ..errors import ModelError
from ..model.file import read_toml
from ..model.file.fields import Entry, Positive
from ..model.file.kinds import CALIBRATION, refuse
from ..model.file.messages import combined, of_validation
from .calibrate import calibrate
from .calibration_data import TIME, columns_of
from .cases import OF_MODEL, ModelCase, check_asked, check_paths, histories
from .fit import Fit
from .formulas import Formula


class BoundsEntry(Entry):
    """A parameter that is looked for."""

    path: str = Field(description="Path of a number of the model file, such as sections.rope.EI.")
    name: str | None = Field(None, description="What it is called, default the path.")
    low: float = Field(description="Lower bound [of the parameter].")
    high: float = Field(description="Upper bound [of the parameter].")
    start: float | None = Field(None, description="Where to begin [of the parameter].")
    prior: tuple[float, float] | None = Field(
        None, description="Mean and standard deviation of what is known before [of the parameter]."
    )


class CalibrationEntry(Entry):
    """A calibration file."""

    title: str = Field("", description="Title of the report.")
    model: str = Field(description="Model file with [simulation], beside this file.")
    data: str = Field(description="CSV file with a column t and columns whose names are formulas.")
    parameters: list[BoundsEntry] = Field(min_length=1, description="What is looked for.")
    deviations: dict[str, Positive] | None = Field(None, description="Of the noise, by column [as it].")


@dataclass(frozen=True)
class FileBuild:
    """The model file with other values, as numbers at the times of the data.

    Parameters
    ----------
    case : ModelCase
    columns : tuple of str
        Formulas.
    times : (n,) s
    """

    case: ModelCase
    columns: tuple[str, ...]
    times: FloatArray = field(repr=False)

    def __call__(self, /, **values: Any) -> dict[str, FloatArray]:
        """Columns (n,) with these values."""
        return histories(self.case.read(values), self.formulas(), self.times)

    def formulas(self) -> dict[str, Formula]:
        """The columns, compiled."""
        return {name: Formula(name, f'data["{name}"]', OF_MODEL) for name in self.columns}


@dataclass(frozen=True)
class CalibrationFile:
    """A calibration file, read.

    Parameters
    ----------
    title : str
    build : FileBuild
    data : dict of str to ndarray
    bounds, start, deviations, priors : mappings
    """

    title: str
    build: FileBuild
    data: dict[str, FloatArray]
    bounds: dict[str, tuple[float, float]]
    start: dict[str, float]
    deviations: Mapping[str, float] | None
    priors: dict[str, tuple[float, float]]

    def fit(self, workers: int) -> Fit:
        """Look for the parameters."""
        more: dict[str, Any] = {"start": self.start, "deviations": self.deviations, "priors": self.priors}
        return calibrate(self.build, self.data, self.bounds, workers=workers, **more)


def read_calibration(path: str | Path) -> CalibrationFile:
    """Read a calibration file, its model and its data, and check that they fit.

    Raises
    ------
    ModelError
        Something is wrong; ``where`` is the path in the file, for several problems the file.
    """
    path = Path(path)
    data = read_toml(path, "calibration file")
    refuse(path, data, CALIBRATION)
    try:
        entry = CalibrationEntry.model_validate(data)
    except ValidationError as error:
        raise combined(of_validation(error, _entry_at), str(path)) from None
    names = [p.path if p.name is None else p.name for p in entry.parameters]
    for k, name in enumerate(names):
        if name in names[:k]:
            raise ModelError(f"parameters[{k}].name", f'"{name}" is the name of another one already')
    columns = columns_of(path.parent / entry.data)
    times = columns[TIME]
    case = ModelCase(
        read_toml(path.parent / entry.model, "model file"),
        (),
        {name: p.path for name, p in zip(names, entry.parameters, strict=True)},
    )
    study = case.read({})
    check_paths(case.read, {name: p.low for name, p in zip(names, entry.parameters, strict=True)})
    if study.simulation is None:
        raise ModelError("model", "simulates nothing", "add a table [simulation] with t_end and step")
    end = study.simulation.t_end
    if times[-1] > end * (1.0 + 1e-9):
        raise ModelError("data", f"go on to t = {times[-1]:g} s, simulation.t_end of the model is {end:g} s")
    build = FileBuild(case, tuple(name for name in columns if name != TIME), times)
    check_asked(study.model, build.formulas().values())
    return CalibrationFile(
        entry.title,
        build,
        columns,
        {name: (p.low, p.high) for name, p in zip(names, entry.parameters, strict=True)},
        {name: p.start for name, p in zip(names, entry.parameters, strict=True) if p.start is not None},
        entry.deviations,
        {name: p.prior for name, p in zip(names, entry.parameters, strict=True) if p.prior is not None},
    )


def _entry_at(parts: tuple[int | str, ...]) -> type[Entry]:
    return BoundsEntry if "parameters" in parts else CalibrationEntry


def table_of(fit: Fit) -> tuple[list[str], list[list[float]]]:
    """Head and rows of a table of the data, the model and what is left, over all times."""
    times = np.unique(np.concatenate([*fit.t.values()]))
    head, columns = ["t"], [times]
    for name in fit.measured:
        for kind in ("measured", "predicted"):
            column = np.full(len(times), np.nan)
            column[np.searchsorted(times, fit.t[name])] = getattr(fit, kind)[name]
            head.append(f"{kind} {name}")
            columns.append(column)
    return head, np.stack(columns, axis=1).tolist()
