"""What was given to the inputs of a model while a run went on, as a history that results keep."""

from __future__ import annotations

import json
from array import array
from collections.abc import Iterable, Mapping
from typing import Any, Protocol

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model.functions.inputs import Input
from ..model.model import Model
from ..model.names import unknown
from ..model.tables import number
from .remembered import Remembered

#: Data set of a results file, and its attribute with the names of the columns.
DATA, NAMES = "inputs", "names"
#: Times that differ by so many units of the last digit are the same.
DIGITS = 8.0


class Given:
    """Values of inputs, each row from its time on until that of the next one.

    Parameters
    ----------
    names : iterable of str
    rows : (n, 1 + inputs), optional
        Times, s, which increase, and values; the first row has those at the start.
    """

    def __init__(self, names: Iterable[str], rows: Any = ()) -> None:
        self.names = tuple(names)
        self._rows = array("d", np.ravel(rows).tolist())

    @classmethod
    def begun(cls, t: float, values: Mapping[str, float]) -> Given:
        """Inputs that have these values at the start of a run at t, s."""
        return cls(values, [t, *values.values()])

    def note(self, t: float, values: Mapping[str, float]) -> None:
        """The inputs have these values from t on, s; what was noted for then or later is replaced."""
        rows, width = self._rows, 1 + len(self.names)
        while len(rows) > width and rows[-width] >= t:  # what acts at the start stays
            del rows[-width:]
        rows.append(t)
        rows.extend(values.values())

    def until(self, t: float, values: Mapping[str, float]) -> Given:
        """A history that goes on at t, s, with the values that the inputs have then."""
        rows = self.rows
        before = rows[: max(int(np.searchsorted(rows[:, 0], _before(t))), 1)]
        made = Given(self.names, before)
        if before[-1, 1:].tolist() != [*values.values()]:
            made.note(t, values)
        return made

    def back(self, t: float, values: Mapping[str, float]) -> None:
        """Forget what was given after t, s, when the inputs had these values."""
        self._rows = self.until(t, values)._rows

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self._rows) // (1 + len(self.names))

    @property
    def rows(self) -> FloatArray:
        """Times and values, shape (n, 1 + inputs), a copy."""
        return self.since(0)

    def since(self, row: int) -> FloatArray:
        """Rows from one on."""
        width = 1 + len(self.names)
        return np.array(self._rows[row * width :]).reshape(-1, width)

    def acting(self, times: FloatArray) -> FloatArray:
        """Values under which states at some times (n,) came about, (n, inputs): those given before them."""
        rows = self.rows
        found = np.searchsorted(rows[:, 0], _before(times)) - 1
        values: FloatArray = rows[np.maximum(found, 0), 1:]
        return values


def _before(t: Any) -> Any:
    """Just before a time."""
    return t - DIGITS * np.spacing(np.abs(t))


class Kept(Protocol):
    """A store, as far as it keeps inputs."""

    @property
    def given(self) -> Given | None:
        """Their history; None: nobody led the run."""
        ...


class Led:
    """Questions about the inputs of a model whose history is kept."""

    model: Model

    @property
    def t(self) -> FloatArray:
        """Times."""
        raise NotImplementedError

    def _kept(self) -> Given | None:
        """What was given, as far as it is known."""
        raise NotImplementedError

    def _history(self) -> Given:
        """What was given."""
        if (found := self._kept()) is not None:
            return found
        hint = "simulate it again with this version"
        raise ModelError("input", "inputs were given while the run went on, and the file keeps none", hint)

    def _led(self) -> bool:
        """Whether something was given."""
        raise NotImplementedError

    def input(self, name: Input | str) -> FloatArray:
        """Values of an input of the model, shape (n,), in the unit of what it is multiplied with.

        They are those under which the states came about: what a controller gives at a time holds from the
        next step on, and is here from the next step on. Without anybody who leads the run it is constant.

        Parameters
        ----------
        name : Input or str

        Raises
        ------
        ModelError
            The model has no such input, or the file is of a version that did not keep what was given.
        """
        return self._history().acting(self.t)[:, self._place(name)]

    def input_changes(self, name: Input | str) -> tuple[FloatArray, FloatArray]:
        """When an input was given another value, and which: times, s, (m,), and values (m,).

        The first one is that of the start; each holds from its time on until the next.

        Raises
        ------
        ModelError
            As of :meth:`input`.
        """
        rows = self._history().rows[:, [0, 1 + self._place(name)]]
        kept = np.concatenate([[True], np.diff(rows[:, 1]) != 0.0])
        return rows[kept, 0], rows[kept, 1]

    def _inputs_said(self) -> list[str]:
        """Smallest and largest value of each input that was given, a text for each."""
        return [self._said(item) for item in self.model.inputs.values()] if self._led() else []

    def _said(self, item: Input) -> str:
        values = self.input_changes(item)[1]
        values = values[np.isfinite(values)]
        ends = dict.fromkeys(map(number, (values.min(), values.max())))
        return f"{item.name} {' to '.join(ends)} {item.unit}".rstrip()

    def _place(self, name: Any) -> int:
        """Column of an input."""
        label, names = getattr(name, "name", name), self._history().names
        if not isinstance(label, str) or label not in self.model.inputs or label not in names:
            raise unknown("input", "input", str(label), names)
        return names.index(label)


def history_of(store: Kept, model: Model, last: Remembered, controlled: bool) -> Given | None:
    """History of the inputs of a model: what was kept, or the one value of a run that nobody led.

    Parameters
    ----------
    store : Kept
    model : Model
    last : Remembered
        What goes with the last state.
    controlled : bool
        A controller may have given some; then there is nothing where nothing was kept.
    """
    if store.given is not None or controlled:
        return store.given
    values = {name: last.inputs.get(name, item.value) for name, item in model.inputs.items()}
    return Given.begun(0.0, values)


def gone_on(
    old: Given | None, start: float, t: float, values: Mapping[str, float], led: bool
) -> Given | None:
    """History of a run from ``start`` that goes on at ``t``, s; what nobody has kept is no number."""
    if old is None and not led:
        return None
    return (old or Given.begun(start, dict.fromkeys(values, np.nan))).until(t, values)


def create(file: Any, given: Given | None) -> None:
    """Make the data set of a results file, empty; none without a history."""
    if given is not None and given.names:
        width = 1 + len(given.names)
        made = file.create_dataset(DATA, (0, width), "f8", maxshape=(None, width), chunks=(512, width))
        made.attrs[NAMES] = json.dumps(given.names)


def read(file: Any) -> Given | None:
    """The history in a results file, which may still be written.

    Raises
    ------
    ValueError
        It is none.
    """
    if DATA not in file:
        return None
    data = file[DATA]
    data.refresh()
    names, rows = json.loads(data.attrs[NAMES]), np.asarray(data[...], dtype=np.float64)
    if not len(rows):
        return None
    fits = isinstance(names, list) and rows.ndim == 2 and rows.shape[1] == 1 + len(names)
    if not fits or not np.all(np.diff(rows[:, 0]) >= 0.0) or np.any(np.isinf(rows)):
        raise ValueError("its inputs are not as they should be")
    return Given(map(str, names), rows)
