"""Optimisation files: TOML with a line, a run along it, what shall be least and what may change."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import Field, ValidationError

from ..errors import ModelError
from ..model import checks
from ..model.file import read_toml
from ..model.file.fields import Entry
from ..model.file.kinds import OPTIMISATION, refuse
from ..model.file.messages import combined, of_validation
from .descent import least
from .droppers import OF_RUN, Droppers, LineOptimum, LineRuns, Tried
from .formulas import Formula
from .lines import SETTINGS
from .run_settings import beside_file, check_pantographs

KEY = "dropper_lengths"


class DroppersEntry(Entry):
    """Droppers that are made longer or shorter alike."""

    name: str = Field(description="What the parameter is called.")
    droppers: list[str] = Field(min_length=1, description='Such as "6-1": span and number, from 1.')
    low: float = Field(description="Least change of their natural lengths [m].")
    high: float = Field(description="Largest change [m].")
    start: float = Field(0.0, description="Where to begin [m].")


class LimitEntry(Entry):
    """A number that has to stay between bounds."""

    formula: str = Field(description="Formula of numbers of the run, such as uplift_maximum [its unit].")
    low: float | None = Field(None, description="Least value [its unit].")
    high: float | None = Field(None, description="Largest value [its unit].")


class OptimisationEntry(Entry):
    """An optimisation file."""

    title: str = Field("", description="Title.")
    line: str = Field(description="Line file, beside this file.")
    objective: str = Field("sigma", description="Formula of what shall be least [its unit].")
    most: int = Field(30, ge=1, le=10_000, description="Steps of the search at most.")
    run: dict[str, Any] = Field(description="Settings of the run, speed in km/h; a table mesh.")
    parameters: list[DroppersEntry] = Field(min_length=1, description="Lengths that are looked for.")
    constraints: list[LimitEntry] = Field(default_factory=list, description="Numbers within bounds.")


@dataclass(frozen=True)
class OptimisationFile:
    """An optimisation file, read.

    Parameters
    ----------
    title : str
    path : Path
        Of the line file.
    line : Line
    parameters : dict of str to Droppers
    settings : dict
        Of :func:`ancf.catenary.run`.
    mesh : Mesh or None
    formulas : list of Formula
        Objective and constraints.
    limits : dict
    most : int
    """

    title: str
    path: Path
    line: Any
    parameters: dict[str, Droppers]
    settings: dict[str, Any]
    mesh: Any
    formulas: list[Formula]
    limits: dict[str, tuple[float | None, float | None]]
    most: int

    def search(self, report: Callable[[Tried], None] | None = None) -> LineOptimum:
        """Look for the lengths."""
        runs = LineRuns(self.line, self.parameters, self.settings, self.formulas, self.mesh, report)
        return least(runs, self.limits, self.most)

    def optimum_text(self, found: LineOptimum) -> str:
        """The line file with the lengths of an optimum, which stand before its first table."""
        text = self.path.read_text(encoding="utf-8")
        numbers = ", ".join(repr(x) for x in found.lengths.tolist())
        line = f"{KEY} = [{numbers}]  # m\n\n"
        table = re.search(r"^\s*\[", text, re.MULTILINE)
        cut = len(text) if table is None else table.start()
        return text[:cut] + line + text[cut:].lstrip("\n")


def read_optimisation(path: str | Path) -> OptimisationFile:
    """Read an optimisation file and its line, and check that they fit.

    Raises
    ------
    ModelError
        Something is wrong; ``where`` is the path in the file, for several problems the file.
    """
    from ..catenary.broken import place_of
    from ..catenary.forms.mesh import Mesh
    from ..catenary.lines.file import parse_line

    path = Path(path)
    data = read_toml(path, "optimisation file")
    refuse(path, data, OPTIMISATION)
    try:
        entry = OptimisationEntry.model_validate(data)
    except ValidationError as error:
        raise combined(of_validation(error, _entry_at), str(path)) from None
    tables = read_toml(path.parent / entry.line, "line file")
    if KEY in tables:
        hint = "leave them out there: the search begins with the design, and with start of each parameter"
        raise ModelError("line", f"{entry.line} has {KEY} already", hint)
    line = parse_line(tables, "line")
    if not hasattr(line, "dropper_span"):
        raise ModelError("line", "is a route, whose runs have no derivatives", "take one tension length")
    parameters: dict[str, Droppers] = {}
    for k, p in enumerate(entry.parameters):
        where = f"parameters[{k}]"
        if p.name in parameters:
            raise ModelError(f"{where}.name", f'"{p.name}" is the name of another one already')
        if not p.low < p.high or not p.low <= p.start <= p.high:
            what = f"low = {p.low:g}, start = {p.start:g}, high = {p.high:g} m do not ascend"
            raise ModelError(where, what)
        for label in p.droppers:
            place_of(line, label, f"{where}.droppers")
        parameters[p.name] = Droppers(tuple(p.droppers), p.low, p.high, p.start)
    settings = beside_file(entry.run, path.parent)
    mesh = settings.pop("mesh", None)
    for key in settings:
        if key not in SETTINGS:
            what = f"unknown key, allowed: {checks.listed((*SETTINGS, 'mesh'))}"
            raise ModelError(f"run.{key}", what, checks.nearest(key, SETTINGS))
    settings["speed"] = checks.positive(settings.get("speed"), "run.speed") / 3.6
    check_pantographs(settings)
    limits = {item.formula: (item.low, item.high) for item in entry.constraints}
    texts = [(entry.objective, "objective")]
    texts += [(item.formula, f"constraints[{k}].formula") for k, item in enumerate(entry.constraints)]
    return OptimisationFile(
        title=entry.title,
        path=path.parent / entry.line,
        line=line,
        parameters=parameters,
        settings=settings,
        mesh=None if mesh is None else _mesh(mesh, Mesh),
        formulas=[Formula(text, where, OF_RUN) for text, where in texts],
        limits=limits,
        most=entry.most,
    )


def _mesh(given: Any, kind: Any) -> Any:
    if not isinstance(given, dict):
        raise ModelError("run.mesh", f"must be a table, is {checks.shown(given)}", "contact = 1.0")
    names = list(kind.__dataclass_fields__)
    for key in given:
        if key not in names:
            raise ModelError(f"run.mesh.{key}", f"unknown key, allowed: {checks.listed(names)}")
    return kind(**given)


def _entry_at(parts: tuple[int | str, ...]) -> type[Entry]:
    if "parameters" in parts:
        return DroppersEntry
    return LimitEntry if "constraints" in parts else OptimisationEntry
