"""Study files: TOML with a model or a line, parameters, sampling and outputs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationError

from ..columns import read_columns
from ..errors import ModelError
from ..model import checks
from ..model.file import read_toml
from ..model.file.fields import Entry, checked
from ..model.file.kinds import STUDY, refuse
from ..model.file.messages import combined, of_validation
from ..model.file.paths import PathError
from ..reading import inputs_told
from .cases import ModelCase
from .distributions import distribution_of
from .extras import pandas
from .fingerprints import fingerprints
from .lines import LineCase
from .run_settings import beside_file
from .sampling import DESIGN, METHODS, sample

if TYPE_CHECKING:
    from pandas import DataFrame


class GridEntry(Entry):
    """Evenly spaced values."""

    low: float = Field(description="First value [of the parameter].")
    high: float = Field(description="Last value [of the parameter].")
    count: int = Field(ge=2, le=100_000, description="How many.")
    spacing: Literal["linear", "log"] = Field(
        "linear", description="Whether they or their logarithms are even."
    )


class ParameterEntry(Entry):
    """What varies."""

    path: str = Field(description="Path of a number of the model or line file, such as sections.rope.EA.")
    name: str | None = Field(None, description="Its column in the table, default the path.")
    unit: str | None = Field(None, description="For the report, default that of the path.")
    values: list[float | int | str] | None = Field(None, description="Some values [of the parameter].")
    grid: GridEntry | None = Field(None, description="Evenly spaced values.")
    distribution: Annotated[Any, checked(lambda v: distribution_of(v, ""))] = Field(
        None, description="A table with type: uniform, normal, lognormal, triangular or discrete."
    )


class CorrelationEntry(Entry):
    """Two parameters that vary together."""

    between: Annotated[list[str], Field(min_length=2, max_length=2)] = Field(description="Two names.")
    value: Annotated[float, Field(ge=-1, le=1)] = Field(description="Correlation of their normal scores [-].")


class SamplingEntry(Entry):
    """How the parameters vary."""

    method: Literal[METHODS] = Field(description="How the cases are made.")  # type: ignore[valid-type]
    count: int | None = Field(None, ge=1, description="Cases, base points or trajectories.")
    seed: int = Field(0, ge=0, description="The same seed makes the same cases.")
    file: str | None = Field(None, description="CSV file of a list, beside the study file.")


class OutputEntry(Entry):
    """What is kept of a case."""

    name: str = Field(description="Its column in the table.")
    formula: str = Field(description="Formula of sensors or statistics, such as max(tension(cable.start)).")
    unit: str | None = Field(None, description="For the report, default what the formula tells.")


class StudyEntry(Entry):
    """A study file."""

    title: str = Field("", description="Title of the report.")
    model: str | None = Field(None, description="Model file, beside the study file.")
    line: str | None = Field(None, description="Line file, or a name of the catalogue.")
    run: dict[str, Any] | None = Field(None, description="Settings of a run along the line, speed in km/h.")
    parameters: list[ParameterEntry] = Field(min_length=1, description="What varies.")
    correlations: list[CorrelationEntry] = Field([], description="What varies together.")
    sampling: SamplingEntry = Field(description="How it varies.")
    outputs: list[OutputEntry] = Field(min_length=1, description="What is kept.")


TABLES: dict[str, type[Entry]] = {
    "parameters": ParameterEntry,
    "correlations": CorrelationEntry,
    "sampling": SamplingEntry,
    "outputs": OutputEntry,
    "grid": GridEntry,
}


@dataclass(frozen=True)
class StudyFile:
    """A study file, read.

    Parameters
    ----------
    title : str
    case : FileCase
        Called with the values of a case.
    samples : DataFrame
        A row for each case.
    units : mapping
        Of the columns whose unit is known.
    """

    title: str
    case: FileCase
    samples: DataFrame
    units: Mapping[str, str]


@dataclass(frozen=True)
class FileCase:
    """The function of a study file; two files with the same model and outputs are the same study.

    Parameters
    ----------
    inner : ModelCase or LineCase
    files : mapping
        Fingerprints of the files that were read for it, by their paths.
    """

    inner: ModelCase | LineCase
    files: Mapping[str, str] = field(default_factory=dict)

    def __call__(self, /, **values: Any) -> dict[str, float]:
        """Outputs of a case."""
        return self.inner(**values)

    def identity(self) -> dict[str, Any]:
        """What makes the study, whatever its cases are."""
        from hashlib import sha256

        from ..files import to_json

        plain = to_json(self.inner.tables)
        made: dict[str, Any] = {
            "model": sha256(plain.encode("utf-8")).hexdigest()[:16],
            "outputs": dict(self.inner.outputs),
            "parameters": dict(sorted(self.inner.paths.items())),
        }
        if isinstance(self.inner, LineCase):
            made["run"] = dict(self.inner.run) if self.inner.run is not None else None
            if ".csv" in plain:  # what its tables say counts too
                line = repr(self.inner.read({})[0])
                made["line"] = sha256(line.encode("utf-8")).hexdigest()[:16]
        return made


def read_study_file(path: str | Path) -> StudyFile:
    """Read a study file, its model or line file and its list, and try the first case without computing it.

    Raises
    ------
    ModelError
        Something is wrong; ``where`` is the path in the file, for several problems the file.
    """
    path = Path(path)
    data = read_toml(path, "study file")
    refuse(path, data, STUDY)
    try:
        entry = StudyEntry.model_validate(data)
    except ValidationError as error:
        raise combined(of_validation(error, _entry_at), str(path)) from None
    names = _names(entry)
    with inputs_told() as read:
        case = _case(entry, path, {name: p.path for name, p in zip(names, entry.parameters, strict=True)})
    samples = _samples(entry, names, path)
    from .study import rows_of

    with inputs_told() as checked_too:
        try:
            case.check(rows_of(samples)[0])
        except PathError as error:
            raise _of_path(error, entry) from None
    title = entry.title or str(case.tables.get("title", ""))
    made = FileCase(case, fingerprints([*read, *checked_too]))
    return StudyFile(title, made, samples, _units(entry, names, case))


def _of_path(error: PathError, entry: StudyEntry) -> ModelError:
    """The error of a path of the model or line with its place in the study file."""
    places = [k for k, given in enumerate(entry.parameters) if given.path == error.where]
    if not places:
        return error
    return ModelError(f"parameters[{places[0]}].path", f'"{error.where}": {error.what}', error.hint)


def _entry_at(parts: tuple[int | str, ...]) -> type[Entry]:
    entry: type[Entry] = StudyEntry
    for part in parts:
        entry = TABLES.get(str(part), entry)
    return entry


def _names(entry: StudyEntry) -> list[str]:
    from .study import CASE, MESSAGE, STATUS

    names = [p.path if p.name is None else p.name for p in entry.parameters]
    outputs = [o.name for o in entry.outputs]
    own = (CASE, STATUS, MESSAGE)
    for group, found in (("parameters", names), ("outputs", outputs)):
        for k, name in enumerate(found):
            if name in found[:k] or name in own or (group == "outputs" and name in names):
                raise ModelError(f"{group}[{k}].name", f'"{name}" is the name of another column already')
    return names


def _units(entry: StudyEntry, names: list[str], case: ModelCase | LineCase) -> dict[str, str]:
    """Units of the columns as the file gives them, else as paths and formulas tell."""
    known = case.units()
    found = {
        name: known.at(p.path) if p.unit is None else p.unit
        for name, p in zip(names, entry.parameters, strict=True)
    }
    found |= {o.name: known.of(o.formula) if o.unit is None else o.unit for o in entry.outputs}
    return {name: unit for name, unit in found.items() if unit is not None}


def _case(entry: StudyEntry, path: Path, paths: dict[str, str]) -> ModelCase | LineCase:
    outputs = tuple((o.name, o.formula) for o in entry.outputs)
    if (entry.model is None) == (entry.line is None):
        what = "is missing" if entry.model is None else "stands beside line"
        raise ModelError("model", what, 'give one of both: model = "file.toml" or line = "file.toml"')
    if entry.model is not None:
        if entry.run is not None:
            raise ModelError("run", "has no effect on a model", "its file has [simulation]")
        return ModelCase(read_toml(path.parent / entry.model, "model file"), outputs, paths)
    from ..catenary.lines.catalogue import line_names, path_of

    line = entry.line or ""
    file = path_of(line) if line in line_names() else path.parent / line
    run = None if entry.run is None else beside_file(entry.run, path.parent)
    return LineCase(read_toml(file, "line file"), outputs, run, paths, str(file))


def _samples(entry: StudyEntry, names: list[str], path: Path) -> DataFrame:
    sampling = entry.sampling
    if sampling.method == "list":
        return _listed(sampling, names, path)
    if sampling.file is not None:
        raise ModelError(
            "sampling.file", f'has no effect with "{sampling.method}"', 'method = "list" reads it'
        )
    kinds = {name: _kind(p, k) for k, (name, p) in enumerate(zip(names, entry.parameters, strict=True))}
    pairs = {}
    for k, given in enumerate(entry.correlations):
        for name in given.between:
            if name not in names:
                what = f'there is no parameter "{name}"'
                raise ModelError(f"correlations[{k}].between", what, checks.nearest(name, names))
        pair = (given.between[0], given.between[1])
        if pair in pairs or pair[::-1] in pairs:
            raise ModelError(f"correlations[{k}].between", f"{pair[0]} and {pair[1]} have one already")
        pairs[pair] = given.value
    try:
        return sample(
            kinds, method=sampling.method, count=sampling.count, seed=sampling.seed, correlations=pairs
        )
    except ModelError as error:
        raise ModelError(_place(error.where, names), error.what, error.hint) from None


def _place(where: str, names: list[str]) -> str:
    """Place in the file of what :func:`sample` found wrong."""
    inside = where.removeprefix("sample.")
    if inside in names:
        return f"parameters[{names.index(inside)}]"
    return inside if inside.startswith("correlations") else f"sampling.{inside}"


def _kind(given: ParameterEntry, k: int) -> Any:
    where = f"parameters[{k}]"
    ways = [key for key in ("values", "grid", "distribution") if getattr(given, key) is not None]
    if len(ways) != 1:
        what = f"has {' and '.join(ways)}" if ways else "says nothing of how it varies"
        raise ModelError(where, what, "give one of values, grid and distribution")
    if given.values is not None:
        return list(given.values)
    if given.grid is None:
        return distribution_of(given.distribution, f"{where}.distribution")
    grid = given.grid
    if grid.spacing == "linear":
        return np.linspace(grid.low, grid.high, grid.count).tolist()
    if grid.low <= 0 or grid.high <= 0:
        raise ModelError(f"{where}.grid", "must be positive for a logarithmic spacing")
    return np.geomspace(grid.low, grid.high, grid.count).tolist()


def _listed(sampling: SamplingEntry, names: list[str], path: Path) -> DataFrame:
    if sampling.file is None:
        raise ModelError("sampling.file", "is missing: a list is a CSV file with a column for each parameter")
    file = path.parent / sampling.file
    table = read_columns(file, "sampling.file")
    missing = [name for name in names if name not in table]
    extra = [name for name in table if name not in names]
    if missing or extra:
        parts = [f"lacks {checks.listed(missing)}"] if missing else []
        parts += [f"has {checks.listed(extra)}, which is no parameter"] if extra else []
        hint = checks.nearest(missing[0], extra) if missing else ""
        raise ModelError("sampling.file", f"{file} {' and '.join(parts)}", hint)
    made = pandas().DataFrame({name: table[name] for name in names})
    if sampling.count is not None:
        made = made.head(sampling.count)
    made.attrs = {DESIGN: {"method": "list", "count": len(made), "parameters": _described(names)}}
    return made


def _described(names: list[str]) -> Mapping[str, Any]:
    return {name: {"type": "list"} for name in names}
