"""TimeFunction: a constant, a Python function of t, a formula or a table, behind one face."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from .expression import Expression
from .inputs import Signal, known, named
from .series import Series
from .units import check_kind

Evaluate = Callable[[FloatArray], FloatArray]

#: How a Python function stands in a description.
DESCRIBED = re.compile(r"<function (.*)>", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Missing:
    """A Python function of which a description knows the name alone."""

    name: str

    @classmethod
    def of(cls, text: object) -> Missing | None:
        """From ``<function name>``, or None for anything else."""
        found = DESCRIBED.fullmatch(text) if isinstance(text, str) else None
        return None if found is None else cls(found[1])


class TimeFunction:
    """A value of `size` numbers that may depend on time.

    Parameters
    ----------
    given : number, sequence, str, callable, mapping, Input, Missing or TimeFunction
        A constant; a formula of t (``"sin(2*pi*t)"``) or, for size 3, a list of numbers and formulas; an
        input, or a formula of inputs, in place of a number; a Python function of t in s that returns a
        number or a (3,) array; a :class:`Series` or a table ``{"t": ..., "value": ...}``, also for one
        component; a function that is missing, whose values
        cannot be had.
    size : int
        1 or 3.
    where : str
        Place in the model, for messages.
    unit : str, optional
        Unit of the package that it is in: a series in one of another quantity is refused.

    Attributes
    ----------
    constant : bool
        It does not depend on time, nor on inputs.
    inputs : dict of str to float
        Inputs on which it depends, with their first values.
    series : tuple of Series
        Those that it follows.

    Raises
    ------
    ModelError
        It cannot be evaluated at t = 0, now or at a later time in `table`; or it is in units of another kind.

    """

    __slots__ = ("_evaluate", "_value", "constant", "given", "inputs", "parts", "series", "size", "where")

    def __init__(self, given: Any, size: int, where: str, unit: str | None = None) -> None:
        if size not in (1, 3):
            raise ValueError(f"size is {size}, must be 1 or 3")
        self.size, self.where = size, where
        self.given: Any = given.given if isinstance(given, TimeFunction) else given
        self.inputs: dict[str, float] = {}
        self.parts: list[Expression | Series | float] = []
        self.series: tuple[Series, ...] = ()
        self._value: FloatArray | None = None  # of a constant
        self._evaluate, self.constant = self._interpret(self.given)
        self.check_unit(unit)
        if not self.missing:
            first = self.table(np.zeros(1))[0]
            self._value = first if self.constant else None

    @classmethod
    def from_table(cls, t: Any, value: Any, size: int, where: str) -> TimeFunction:
        """Linear interpolation of values (n,) or (n, 3) at increasing times (n,), constant outside."""
        return cls({"t": t, "value": value}, size, where)

    @property
    def missing(self) -> str:
        """Name of the Python function that a description could not keep, or nothing."""
        return self.given.name if isinstance(self.given, Missing) else ""

    def __deepcopy__(self, memo: dict[int, Any]) -> TimeFunction:
        return self  # it never changes, and what it calls may be anything

    def __reduce__(self) -> Any:
        return _again, (self.given, self.size, self.where, self.inputs)

    def __repr__(self) -> str:
        return f"TimeFunction({checks.shown(self.describe())}, size={self.size})"

    def __call__(self, t: float) -> FloatArray:
        """Values (size,) at the time t in s."""
        if self._value is not None:
            return self._value.copy()
        value: FloatArray = self.table(np.array([t], dtype=np.float64))[0]
        return value

    def table(self, times: FloatArray) -> FloatArray:
        """Values at many times.

        Parameters
        ----------
        times : (n,) array, s
            In any order.

        Returns
        -------
        (n, size) array

        Raises
        ------
        ModelError
            The function raised, returned a wrong shape or a non-finite number; the time is named.

        """
        times = np.asarray(times, dtype=np.float64)
        if self._value is not None:
            return np.tile(self._value, (times.size, 1))
        return self._finite(times, self._evaluate)

    def under(self, inputs: Mapping[str, float], times: FloatArray) -> FloatArray:
        """The same for other values of the inputs on which it depends."""
        if not self.inputs:
            return self.table(times)
        return self._finite(times, lambda at: self._columns(at, inputs))

    @property
    def led(self) -> list[tuple[int, Expression]]:
        """Components that depend on inputs, with their formulas."""
        parts = enumerate(self.parts)
        return [(k, p) for k, p in parts if isinstance(p, Expression) and set(p.used) - {"t"}]

    def _finite(self, times: FloatArray, evaluate: Evaluate) -> FloatArray:
        values = evaluate(times)
        bad = ~np.all(np.isfinite(values), axis=1)
        if np.any(bad):
            first = int(np.argmax(bad))
            shown = values[first].tolist() if self.size > 1 else float(values[first, 0])
            raise ModelError(self.where, f"is {shown} at t = {times[first]:.6g} s, must be finite")
        return values

    def describe(self) -> Any:
        """Plain JSON-able form; a Python function as ``<function name>``."""
        return plain(self.given)

    def _interpret(self, given: Any) -> tuple[Evaluate, bool]:
        if isinstance(given, Missing):
            return self._refuse, False
        if isinstance(given, Mapping | Series):
            return self._from_series(given)
        if isinstance(given, Scaled):
            return given.table, False
        if callable(given):
            return self._from_callable(given), False
        parts = [self._component(given, self.where)] if self.size == 1 else self._components(given)
        self.parts = parts
        used = [name for p in parts if isinstance(p, Expression) for name in p.used if name != "t"]
        self.inputs = {name: self.inputs[name] for name in dict.fromkeys(used)}
        self.series = tuple(p for p in parts if isinstance(p, Series))
        timely = any(isinstance(p, Expression) and p.uses_t for p in parts)
        timely = timely or any(not series.constant for series in self.series)
        return lambda times: self._columns(times, self.inputs), not (timely or self.inputs)

    def check_unit(self, unit: str | None) -> None:
        """Raise ModelError if a series in it is known to be in units of something else than this one's."""
        for k, part in enumerate(self.parts or self.series):
            if isinstance(part, Series):
                place = f"{self.where}[{k}]" if self.parts and self.size > 1 else self.where
                check_kind(part.unit, unit, place)

    def _refuse(self, times: FloatArray) -> FloatArray:
        what = f'is the Python function "{self.missing}", of which a description keeps the name only'
        raise ModelError(self.where, what, "build the model with the script that has it")

    def _components(self, given: Any) -> list[Expression | Series | float]:
        if isinstance(given, str) or not isinstance(given, Sequence | np.ndarray):
            wanted = "a list of 3 numbers or formulas, a function of t or a table"
            raise ModelError(self.where, f"must be {wanted}, is {checks.shown(given)}", _three(given))
        count = 1 if isinstance(given, np.ndarray) and given.ndim == 0 else len(given)
        if count != 3:
            raise ModelError(self.where, f"has {count} components, wanted 3", "along x, y and z")
        return [self._component(part, f"{self.where}[{i}]") for i, part in enumerate(given)]

    def _component(self, part: Any, where: str) -> Expression | Series | float:
        if isinstance(part, Mapping):
            return Series.of(part, where, 1)
        if isinstance(part, Series):
            if part.size != 1:
                raise ModelError(where, f"has {part.size} values at each time, wanted 1")
            return part
        if callable(part) and self.size > 1:
            what = "must be a number, is a function: one of t gives all three components"
            raise ModelError(where, what, "such as lambda t: (0.1*t, 0.0, 0.0)")
        if not isinstance(part, str | Signal):
            return checks.number(part, where)
        there = part.inputs if isinstance(part, Signal) else known()
        self.inputs |= there
        text = part.text if isinstance(part, Signal) else part
        return Expression(text, where, ("t", *there))

    def _columns(self, times: FloatArray, inputs: Mapping[str, float]) -> FloatArray:
        columns = []
        for part in self.parts:
            if isinstance(part, Series):
                columns.append(part(times)[:, 0])
            elif not isinstance(part, Expression):
                columns.append(np.full(times.shape, part))
            elif part.names == ("t",):
                columns.append(part(times))
            else:
                columns.append(part.under(inputs, times))
        return np.column_stack(columns)

    def _from_callable(self, function: Callable[[float], Any]) -> Evaluate:
        def evaluate(times: FloatArray) -> FloatArray:
            at = times.tolist()
            # one array of all answers when they are as they should be; else one by one, to say what is wrong
            with contextlib.suppress(Exception), np.errstate(all="ignore"):
                rows = np.array([function(t) for t in at])
                shapes = ((times.size, self.size), *(((times.size,),) if self.size == 1 else ()))
                if rows.dtype.kind in "iuf" and rows.shape in shapes and np.all(np.isfinite(rows)):
                    return rows.astype(np.float64).reshape(times.size, self.size)
            return np.array([call(function, t, self.size, self.where, "t", " s") for t in at])

        return evaluate

    def _from_series(self, given: Mapping[str, Any] | Series) -> tuple[Evaluate, bool]:
        if isinstance(given, Mapping):
            given = Series.of(given, self.where, self.size)
        if given.size != self.size:
            what = f"has {given.size} values at each time, wanted {self.size}"
            raise ModelError(self.where, what, "a series may stand for one component of three")
        self.series = (given,)
        return given, given.constant


class Scaled:
    """A function of time times a number; a class, to be pickled."""

    def __init__(self, given: TimeFunction, factor: float) -> None:
        self.given, self.factor = given, factor

    def __call__(self, t: float) -> Any:
        """A number, or (3,), at the time t in s."""
        value = self.factor * self.given(t)
        return float(value[0]) if self.given.size == 1 else value

    def table(self, times: FloatArray) -> FloatArray:
        """Values (n, size) at many times, see :meth:`TimeFunction.table`."""
        return self.factor * self.given.table(times)


def call(
    function: Callable[[float], Any], at: float, size: int, where: str, symbol: str, unit: str
) -> FloatArray:
    """Call a user's function of one number; (size,) array, or a ModelError that says what came back."""
    place = f"at {symbol} = {at:.6g}{unit}"
    try:
        with np.errstate(all="ignore"):
            got = function(at)
    except Exception as error:
        raise ModelError(where, f"{place} the function raised {type(error).__name__}: {error}") from error
    try:
        value = np.asarray(got)
    except ValueError:
        value = np.asarray(None)
    if value.dtype.kind not in "iuf":
        raise ModelError(where, f"{place} the function returned {checks.shown(got)}, wanted {_wanted(size)}")
    if value.shape != (size,) and not (size == 1 and value.shape == ()):
        raise ModelError(where, f"{place} the function returned shape {value.shape}, wanted {_wanted(size)}")
    if not np.all(np.isfinite(value)):
        raise ModelError(where, f"{place} the function returned {checks.shown(got)}, must be finite")
    return value.astype(np.float64).reshape(size)


def _three(given: Any) -> str:
    """How one value is written as three."""
    if isinstance(given, str) and given.lower().endswith((".csv", ".txt", ".dat")):
        return 'a column of a file: ancf.Series.read("file.csv", "column"), one for each direction'
    if isinstance(given, str):
        return f'along x it is ["{given}", 0, 0]'
    return f"along x it is ({given:g}, 0, 0)" if isinstance(given, int | float) else ""


def _wanted(size: int) -> str:
    return "a number" if size == 1 else f"({size},)"


def plain(given: Any) -> Any:
    """JSON-able form of what a user gave for a function; a Python function as ``<function name>``."""
    if isinstance(given, Missing):
        return f"<function {given.name}>"
    if isinstance(given, Signal):
        return given.text
    if isinstance(given, Series):
        return given.describe()
    if isinstance(given, np.ndarray | np.generic):
        return given.tolist()
    if isinstance(given, Mapping):
        return {str(key): plain(value) for key, value in given.items()}
    if isinstance(given, list | tuple):
        return [plain(part) for part in given]
    if callable(given):
        return f"<function {getattr(given, '__name__', type(given).__name__)}>"
    return given


def check_inputs(item: Any, there: Mapping[str, Any]) -> None:
    """Raise ModelError if a function of an item depends on an input that its model does not have."""
    for function in _driven(item):
        for name in function.inputs:
            if name not in there:
                what = f'depends on the input "{name}", which this model does not have'
                raise ModelError(function.where, what, f'model.add_input("{name}") makes it')


def refuse_inputs(item: Any, *names: str) -> None:
    """Raise ModelError if a function of an item, or of its fields with these names, depends on an input."""
    for function in _driven(item, *names):
        what = f'is a motion given by the input "{next(iter(function.inputs))}", whose velocity nobody knows'
        raise ModelError(function.where, what, "let it drive a force, on a mass that is free to move there")


def _driven(item: Any, *names: str) -> list[TimeFunction]:
    """Functions of an item that depend on inputs."""
    values = (getattr(item, field.name) for field in fields(item) if not names or field.name in names)
    return [value for value in values if isinstance(value, TimeFunction) and value.inputs]


def _again(given: Any, size: int, where: str, inputs: Mapping[str, float]) -> TimeFunction:
    """A function of time that was pickled."""
    with named(inputs):
        return TimeFunction(given, size, where)
