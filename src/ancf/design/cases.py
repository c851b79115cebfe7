"""One case of a study file: a model or a line with other values, computed, and its outputs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..analysis import equilibrium, modes, simulate
from ..arrays import FloatArray
from ..errors import ModelError
from ..model.file.paths import PathError, changed
from ..viz.pictures.questions import QUANTITIES, ask
from ..viz.style import UNITS
from .formulas import Formula, Vocabulary
from .units import FileUnits
from .work import Noted

if TYPE_CHECKING:
    from ..model.file import Study

#: Quantities that need whole states and cannot be recorded at every step.
OF_STATES = ("twist",)
#: How the error of a key says that there is none.
UNKNOWN = "unknown key"
#: States that are stored of a run at most beside its start, for its notes.
STORED = 50
FREQUENCY = "frequency"
OF_MODEL = Vocabulary(("t", FREQUENCY), tuple(QUANTITIES))


@dataclass(frozen=True)
class ModelCase:
    """Calls a model file with other values; what it is called with are paths.

    Parameters
    ----------
    tables : dict
        The model file.
    outputs : tuple of (str, str)
        Names and formulas.
    paths : mapping
        Path by name of a parameter, where they differ.
    """

    tables: dict[str, Any]
    outputs: tuple[tuple[str, str], ...]
    paths: Mapping[str, str] = field(default_factory=dict)

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
        made = [(n, Formula(text, f"outputs.{n}", OF_MODEL)) for n, text in self.outputs]
        for _, formula in made:
            if FREQUENCY in formula.whole:
                what = f'"{formula.text}": {FREQUENCY} has as many entries as there are motions'
                raise ModelError(formula.where, what, f"name one from the lowest, {FREQUENCY}[0]")
        return made

    def units(self) -> FileUnits:
        """Units of what stands in the file and in formulas."""
        from ..model.file import schema

        return FileUnits(self.tables, schema(), UNITS)

    def read(self, values: Mapping[str, Any]) -> Study:
        """The study of the model file with these values, by name."""
        from ..model.file import parse_study

        given = {self.paths.get(name, name): value for name, value in values.items()}
        return parse_study(changed(self.tables, given), "model")

    def check(self, values: Mapping[str, Any]) -> None:
        """Find what is wrong with all cases, without computing; a wrong value is the matter of its case.

        Raises
        ------
        ModelError
            The model file, a path, a formula or what it asks for.
        """
        study = self.read({})
        check_paths(self.read, values)
        if study.simulation is None and study.equilibrium is None:
            hint = "add a table [simulation] with t_end and step, or [equilibrium]"
            raise ModelError("model", "nothing to compute", hint)
        check_asked(study.model, (formula for _, formula in self.formulas))

    def __call__(self, /, **values: Any) -> dict[str, float]:
        """Outputs of the case with these values."""
        study = self.read(values)
        answers = _ModelAnswers(study, self.formulas)
        return Noted({name: formula(answers) for name, formula in self.formulas}, answers.notes())


def histories(study: Study, formulas: Mapping[str, Formula], times: FloatArray) -> dict[str, FloatArray]:
    """Values (n,) of formulas at times (n,), s, of the simulation of a study, linear between its steps.

    Raises
    ------
    ModelError
        A formula asks for what there is not, or gives no history.
    """
    check_asked(study.model, formulas.values())
    answers = _ModelAnswers(study, list(formulas.items()))
    t = np.asarray(answers.value("t"))
    return {name: np.interp(times, t, formula.history(answers)) for name, formula in formulas.items()}


def check_asked(model: Any, formulas: Iterable[Formula]) -> None:
    """Raise ModelError if a formula asks for what a model does not have."""
    for formula in formulas:
        for quantity, item in formula.asked:
            sensor_of(model, quantity, item, formula.where, QUANTITIES[quantity].nouns)


def check_paths(read: Callable[[Mapping[str, Any]], Any], values: Mapping[str, Any]) -> None:
    """Raise ModelError if a value has no place in a file."""
    try:
        read(values)
    except ModelError as error:
        if isinstance(error, PathError) or UNKNOWN in str(error):
            raise


def sensor_of(model: Any, quantity: str, item: str, where: str, nouns: tuple[str, ...]) -> Any:
    """What records an item; ModelError if it is not there, or none of these nouns, which are asked that."""
    from ..viz.pictures.questions import noun_of

    try:
        found = model.sensor(item)
    except ModelError as error:
        raise ModelError(where, f"{quantity}({item}): {error.what}", error.hint) from None
    noun = noun_of(model, found)
    if noun not in nouns:
        raise ModelError(where, f"{quantity}() is asked of a {' or '.join(nouns)}, {item} is a {noun}")
    return found


def _stride(steps: int) -> int:
    """Steps between states that are stored for the notes of a run, so that the last one is."""
    return next(k for k in range(-(-steps // STORED), steps + 1) if steps % k == 0)


class _ModelAnswers:
    """A computed model."""

    def __init__(self, study: Study, formulas: list[tuple[str, Formula]]) -> None:
        self.study, settings = study, study.simulation
        asked = list(dict.fromkeys(pair for _, formula in formulas for pair in formula.asked))
        self._count = 1 + max((f.highest for _, f in formulas if FREQUENCY in f.named), default=-1)
        self._start = self._state()
        self._sampled: Any = None
        self._stored: Any = None
        if settings is None:
            return
        whole = any(quantity in OF_STATES for quantity, _ in asked)
        items = list(dict.fromkeys(item for quantity, item in asked if quantity not in OF_STATES))
        steps = max(1, round(settings.t_end / settings.step))
        result = simulate(
            study.model,
            t_end=settings.t_end,
            step=settings.step,
            start=self._start if settings.start == "equilibrium" else None,
            integrator=settings.integrator,
            output_step=settings.step * (1 if whole else _stride(steps)),
            sensors=items or None,
        )
        self._stored, self._sampled = result, result.sensors if items else result

    def notes(self) -> list[str]:
        """What the result or the equilibrium says of itself, each once."""
        return [text for one in (self._start, self._stored) if one is not None for text in one.notes]

    def _state(self) -> Any:
        settings, given = self.study.simulation, self.study.equilibrium
        if settings is not None and settings.start != "equilibrium":
            return None
        of = None if settings is None else settings.equilibrium_of
        return equilibrium(self.study.model, of=of, load_steps=given.load_steps if given else 1)

    def value(self, name: str) -> Any:
        """Times of the run, or frequencies in Hz about its start."""
        if name == FREQUENCY:
            return modes(self.study.model, about=self._start, count=max(self._count, 1)).frequencies_hz
        return np.zeros(1) if self._sampled is None else self._sampled.t

    def ask(self, quantity: str, item: str) -> Any:
        """History at every step, or the one state of an equilibrium."""
        if self._sampled is None:
            return ask(self._start, quantity, item)[None]
        return ask(self._stored if quantity in OF_STATES else self._sampled, quantity, item)
