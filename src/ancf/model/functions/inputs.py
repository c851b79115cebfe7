"""Inputs: numbers that are given while a simulation runs, and formulas of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from types import MappingProxyType
from typing import Any

from ...errors import ModelError
from .. import checks
from .expression import CONSTANTS, FUNCTIONS, STATE

#: A name that can stand in a formula.
NAME = re.compile(r"[A-Za-z_]\w*")
#: What stands in square brackets behind a name.
PRINTED = re.compile(r"[^\[\]\x00-\x1f\x7f]{0,40}")
#: Names that mean something else there.
TAKEN = {"t", *STATE, *CONSTANTS, *FUNCTIONS, "and", "or", "not", "in", "is", "if", "else", "lambda"}

#: Inputs that formulas may name where a description or a file is read, by name, with their first values.
_known: ContextVar[Mapping[str, float]] = ContextVar("inputs", default=MappingProxyType({}))


class Signal:
    """A formula of inputs: what sums and products of an :class:`Input` with numbers and others are.

    Parameters
    ----------
    text : str
    inputs : dict of str to float
        Those that it names, with their first values.
    """

    __slots__ = ("inputs", "text")
    __array_ufunc__ = None  # a number of NumPy is not asked to add it to itself

    def __init__(self, text: str, inputs: Mapping[str, float]) -> None:
        self.text, self.inputs = text, dict(inputs)

    def __repr__(self) -> str:
        return f"Signal({self.text!r})"

    def __add__(self, other: Any) -> Signal:
        return self._with("+", other)

    def __radd__(self, other: Any) -> Signal:
        return self._with("+", other, swapped=True)

    def __sub__(self, other: Any) -> Signal:
        return self._with("-", other)

    def __rsub__(self, other: Any) -> Signal:
        return self._with("-", other, swapped=True)

    def __mul__(self, other: Any) -> Signal:
        return self._with("*", other)

    def __rmul__(self, other: Any) -> Signal:
        return self._with("*", other, swapped=True)

    def __truediv__(self, other: Any) -> Signal:
        return self._with("/", other)

    def __neg__(self) -> Signal:
        return Signal(f"-({self.text})", self.inputs)

    def _with(self, sign: str, other: Any, swapped: bool = False) -> Signal:
        text, inputs = _term(other)
        if text is None:
            return NotImplemented  # type: ignore[no-any-return]
        sides = (text, self._bracketed) if swapped else (self._bracketed, text)
        return Signal(f"{sides[0]} {sign} {sides[1]}", self.inputs | inputs)

    @property
    def _bracketed(self) -> str:
        return self.text if NAME.fullmatch(self.text) else f"({self.text})"


class Input(Signal):
    """A number of a model that a controller, a stepper or another program gives while a simulation runs.

    It stands wherever a number or a function of time may in loads and drives, also in sums and products with
    numbers and other inputs: ``(2*u + 1, 0, 0)``.

    Attributes
    ----------
    name : str
    value : float
        What it is until something else is given.
    unit, description : str
        What tables say of it; "" for nothing.
    """

    __slots__ = ("description", "name", "unit", "value")

    def __init__(self, name: str, value: float, unit: str = "", description: str = "") -> None:
        super().__init__(name, {name: value})
        self.name, self.value = name, value
        self.unit, self.description = unit, description

    def described(self) -> dict[str, Any]:
        """What a description of the model holds of it."""
        said = {"unit": self.unit, "description": self.description}
        return {"name": self.name, "value": self.value} | {key: text for key, text in said.items() if text}

    def __repr__(self) -> str:
        return f"Input({self.name!r}, {self.value:g})"

    def __deepcopy__(self, memo: dict[int, Any]) -> Input:
        return self  # it never changes


def make_input(
    where: str,
    name: object,
    value: object,
    taken: Mapping[str, Any],
    unit: object = "",
    description: object = "",
) -> Input:
    """Check what ``Model.add_input`` was given.

    Raises
    ------
    ModelError
        No name that a formula can have, one that is taken, no number, or no unit.
    """
    clean = checks.text(name, f"{where}.name")
    if not NAME.fullmatch(clean) or clean in TAKEN:
        what = f"is {checks.shown(clean)}, must be a name that can stand in a formula"
        hint = "letters, digits and _, no letter of t, x, y, z, vx, vy, vz alone and no function"
        raise ModelError(f"{where}.name", what, hint)
    if clean in taken:
        raise ModelError(f"{where}.name", f'"{clean}" is the name of an input already')
    measured = checks.text(unit, f"{where}.unit").strip()
    if not PRINTED.fullmatch(measured):
        raise ModelError(f"{where}.unit", f"is {checks.shown(unit)}, must be such as N or m/s", "no brackets")
    said = checks.text(description, f"{where}.description").strip()
    return Input(clean, checks.number(value, f"{where}.value"), measured, said)


@contextmanager
def named(inputs: Mapping[str, float]) -> Iterator[None]:
    """Here formulas may name these inputs."""
    token = _known.set(inputs)
    try:
        yield
    finally:
        _known.reset(token)


def known() -> Mapping[str, float]:
    """Inputs that formulas may name now, with their first values."""
    return _known.get()


def _term(other: Any) -> tuple[str | None, dict[str, float]]:
    """Text and inputs of a term, None for what is none."""
    if isinstance(other, Signal):
        return other._bracketed, other.inputs
    try:
        return repr(checks.number(other, "Input")), {}
    except ModelError:
        return None, {}


def first_values(tables: Any) -> dict[str, float]:
    """Names and first values of inputs in tables that are not checked yet; what is wrong is left out."""
    found = {}
    for table in tables if isinstance(tables, list) else []:
        name, value = (table.get("name"), table.get("value", 0.0)) if isinstance(table, Mapping) else ("", 0)
        if isinstance(name, str) and NAME.fullmatch(name) and name not in TAKEN:
            found[name] = float(value) if isinstance(value, int | float) else 0.0
    return found
