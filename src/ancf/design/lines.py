"""One case of a study of an overhead line: its form or a run of pantographs, and its outputs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ModelError
from ..model import checks
from .cases import check_paths
from .formulas import Formula, Vocabulary
from .run_settings import PANTOGRAPH, check_pantographs
from .units import FileUnits

if TYPE_CHECKING:
    from ..catenary import Line, Route, Statistics
    from ..catenary.answers.run_data import Run
    from ..catenary.forms.route_form import AnyForm

#: Arrays of a line at rest: their names in formulas, and the fields of the form.
OF_FORM = {
    "dropper_length": "dropper_length",
    "dropper_unstretched": "cut_length",
    "dropper_load": "dropper_load",
    "contact_height": "contact_height",
    "support_load": "support_load",
}
#: Arrays of a run beside its statistics.
OF_RUN = ("uplift", "dropper_force")
#: Quantities of the statistics of a contact force by their keys; sigma is short for the first deviation.
OF_FORCE = (
    "mean_force",
    "deviation",
    "mean_plus_3_sigma",
    "mean_minus_3_sigma",
    "maximum",
    "minimum",
    "raw_maximum",
    "raw_minimum",
    "relative_deviation",
    "deviation_0_2",
    "deviation_0_5",
    "deviation_5_20",
)
STATISTICS = (
    *OF_FORCE,
    "loss",
    "loss_number",
    "loss_longest",
    "dropper_maximum",
    "slack_droppers",
    "slack_number",
    "slack_longest",
    "height_range",
    "raw_height_range",
)
SIGMA, HIGHEST = "sigma", "uplift_maximum"
#: Units of them all.
UNITS: dict[str, str | None] = {
    **dict.fromkeys((*OF_FORCE, SIGMA, "dropper_maximum"), "N"),
    **dict.fromkeys(("dropper_load", "support_load", "dropper_force"), "N"),
    **dict.fromkeys(("dropper_length", "dropper_unstretched", "contact_height"), "m"),
    **dict.fromkeys(("uplift", HIGHEST, "height_range", "raw_height_range"), "mm"),
    **dict.fromkeys(("relative_deviation", "loss_number", "slack_droppers", "slack_number"), ""),
    **{"loss": "%", "loss_longest": "ms", "slack_longest": "ms"},
}
RUN = "run."
#: Settings of the table [run]: those of ``ancf catenary run``, and the pantograph that is evaluated.
SETTINGS = (
    *("speed", "pantograph", "spacing", "start", "window", "until", "contact", "contact_stiffness"),
    *("step", "mesh", "reduce", "evaluated"),
)

OF_SETTINGS: dict[str, str | None] = {
    **dict.fromkeys(RUN + key for key in SETTINGS),
    **dict.fromkeys((RUN + key for key in ("spacing", "start", "until")), "m"),
    **{RUN + "speed": "km/h", RUN + "step": "s", RUN + "contact_stiffness": "N/m"},
}


@dataclass(frozen=True)
class LineCase:
    """Calls a line file with other values; what it is called with are paths, ``run.speed`` of the run.

    Parameters
    ----------
    tables : dict
        The line file.
    outputs : tuple of (str, str)
        Names and formulas.
    run : mapping or None
        Settings of the run, speed in km/h; without it the line is at rest.
    paths : mapping
        Path by name of a parameter, where they differ.
    source : str
        Path of the line file, beside which its tables of supports lie.
    """

    tables: dict[str, Any]
    outputs: tuple[tuple[str, str], ...]
    run: Mapping[str, Any] | None = None
    paths: Mapping[str, str] = field(default_factory=dict)
    source: str = "line"

    def __getstate__(self) -> dict[str, Any]:
        """Without the compiled formulas, which each process compiles for itself."""
        return {key: value for key, value in self.__dict__.items() if key != "formulas"}

    @cached_property
    def formulas(self) -> list[tuple[str, Formula]]:
        """The outputs, compiled.

        Raises
        ------
        ModelError
            One is no formula.
        """
        names = (*OF_FORM, *((SIGMA, HIGHEST, *STATISTICS, *OF_RUN) if self.run is not None else ()))
        words = Vocabulary(names)
        return [(name, Formula(text, f"outputs.{name}", words)) for name, text in self.outputs]

    def units(self) -> FileUnits:
        """Units of what stands in the file and in formulas."""
        from ..catenary.lines.entries import LineEntry
        from ..catenary.lines.file import with_states

        return FileUnits(with_states(self.tables), LineEntry.model_json_schema(), UNITS, OF_SETTINGS)

    def read(self, values: Mapping[str, Any]) -> tuple[Line | Route, dict[str, Any]]:
        """The line with these values, by name, and the settings of its run."""
        from ..catenary.lines.file import other_values, parse_track

        given = {self.paths.get(name, name): value for name, value in values.items()}
        settings = dict(self.run or {})
        for path in [path for path in given if path.startswith(RUN)]:
            settings[path.removeprefix(RUN)] = given.pop(path)
        for key in settings:
            if key not in SETTINGS:
                what = f"unknown key, allowed: {checks.listed(SETTINGS)}"
                raise ModelError(RUN + key, what, checks.nearest(key, SETTINGS))
        return parse_track(other_values(self.tables, given), self.source), settings

    def check(self, values: Mapping[str, Any]) -> None:
        """Find what is wrong with all cases, without computing; a wrong value is the matter of its case.

        Raises
        ------
        ModelError
            The line file, a path or a formula.
        """
        from ..catenary.forms.form import check

        line, settings = self.read({})
        check_paths(self.read, values)
        varied = {path for path in self.paths.values() if path.startswith(RUN)}
        if self.run is None and varied:
            raise ModelError("run", "is missing: a parameter is one of a run")
        if self.run is not None:
            checks.positive(settings.get("speed"), "run.speed")
        if RUN + PANTOGRAPH not in varied:
            check_pantographs(settings)
        for one in line.parts:
            check(one)
        _ = self.formulas

    def __call__(self, /, **values: Any) -> dict[str, float]:
        """Outputs of the case with these values."""
        line, settings = self.read(values)
        answers = _AtRest(line) if self.run is None else _Passing(line, settings)
        return {name: formula(answers) for name, formula in self.formulas}


class _AtRest:
    """The form of a line."""

    def __init__(self, line: Line | Route) -> None:
        from .. import catenary

        self.form: AnyForm = catenary.form(line)

    def value(self, name: str) -> Any:
        """An array of the form, SI units."""
        forms = getattr(self.form, "forms", (self.form,))
        return np.concatenate([getattr(one, OF_FORM[name]) for one in forms])

    def ask(self, quantity: str, item: str) -> Any:
        """Nothing is asked of items."""
        raise AssertionError(quantity)


class _Passing(_AtRest):
    """A run along a line."""

    def __init__(self, line: Line | Route, settings: dict[str, Any]) -> None:
        from .. import catenary

        given = dict(settings)
        speed = checks.positive(given.pop("speed", None), "run.speed") / 3.6
        evaluated = given.pop("evaluated", 0)
        if "mesh" in given:
            contact, messenger = checks.array(given["mesh"], "run.mesh", (2,)).tolist()
            given["mesh"] = catenary.Mesh(contact=contact, messenger=messenger)
        self.done: Run = catenary.run(line, speed=speed, **given)
        count = len(self.done.recordings)
        self.found: Statistics = catenary.statistics(
            self.done, checks.integer(evaluated, "run.evaluated", 0, count - 1)
        )
        self.form = self.done.form

    def value(self, name: str) -> Any:
        """A number of the statistics in its unit, mm for uplifts, or an array."""
        if name == "uplift":
            return 1e3 * np.max(self.done.uplift, axis=0)
        if name == "dropper_force":
            return np.max(self.done.dropper_force, axis=0)
        if name in OF_FORM:
            return super().value(name)
        key = {SIGMA: "deviation", HIGHEST: "uplift"}.get(name, name)
        try:
            return self.found[key].value
        except KeyError:
            raise ModelError(f"outputs: {name}", "is not to be had of this run") from None
