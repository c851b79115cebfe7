"""VelocityField: velocity of a fluid, the same everywhere, a profile over z, or a law of time and place."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..functions.expression import Expression, depends_on_state
from ..functions.function import Missing, TimeFunction, plain

#: What a formula of a velocity may depend on.
NAMES = ("t", "x", "y", "z")
_NOWHERE = np.zeros(3)
#: Step of the differences that give the acceleration of a fluid, s.
STEP = 1e-4


class VelocityField:
    """Three numbers, m/s, that may depend on t in s and on the place x, y, z in m.

    Parameters
    ----------
    given : (3,), function of time, dict, list of formulas or callable
        What a function of time may be; ``{"z": (n,), "velocity": (n, 3)}``, linear between the heights and
        constant outside; formulas of t, x, y, z; or a Python function of t, x, y, z that returns three
        numbers, compiled by numba if it can be, else called once a step.
    where : str
        Place in the model, for messages.

    Attributes
    ----------
    uniform : TimeFunction
        The part that is the same everywhere.
    heights, profile : ndarray, shapes (n,) and (n, 3)
        The profile, empty if there is none.
    parts : list of Expression and float
        Formulas of the place, if it was given so.
    law : callable or None
        A Python function of t, x, y, z.
    once : str or None
        Why numba cannot compile it and it is called once a step; "" if it is compiled, None before a model
        with it was computed.

    Raises
    ------
    ModelError
        It is none of these, or cannot be evaluated at t = 0 in the origin.
    """

    __slots__ = ("_functions", "given", "heights", "law", "once", "parts", "profile", "uniform", "where")

    def __init__(self, given: Any, where: str) -> None:
        self.given: Any = given.given if isinstance(given, VelocityField | TimeFunction) else given
        self.where = where
        self.heights, self.profile = np.zeros(0), np.zeros((0, 3))
        self.parts: list[Expression | float] = []
        self.law: Any = None
        self.once: str | None = None
        given, rest = self.given, [0.0, 0.0, 0.0]
        if isinstance(given, Mapping) and not {"t", "value"} & set(given):
            self._read_profile(given)
        elif callable(given) and not isinstance(given, Missing) and _arguments(given) == len(NAMES):
            self.law = given
            self.at(0.0, _NOWHERE)
        elif _is_formula(given):
            self.parts = [
                Expression(part, f"{where}[{i}]", NAMES)
                if isinstance(part, str)
                else checks.number(part, f"{where}[{i}]")
                for i, part in enumerate(given)
            ]
            self.at(0.0, _NOWHERE)
        else:
            rest = given
        self.uniform = TimeFunction(rest, 3, where, "m/s")
        self._functions: list[TimeFunction] = []

    def __reduce__(self) -> Any:
        return VelocityField, (self.given, self.where)

    def __deepcopy__(self, memo: dict[int, Any]) -> VelocityField:
        return self  # it never changes

    def functions(self) -> list[TimeFunction]:
        """The part that is the same everywhere, its acceleration, and a clock (t, 1, 0).

        They are the same ones whenever they are asked for: a model with another number, which has the same
        field, has the same inputs.
        """
        if not self._functions:
            clock = TimeFunction(["t", 1.0, 0.0], 3, self.where)
            self._functions = [self.uniform, _rate(self.uniform), clock]
        return self._functions

    @property
    def missing(self) -> str:
        """Name of the Python function that a description could not keep, or nothing."""
        return self.uniform.missing

    @property
    def moves(self) -> bool:
        """Whether the fluid moves at some time and place."""
        still = self.uniform.constant and not np.any(self.uniform(0.0))
        return not still or bool(np.any(self.profile)) or bool(self.parts) or self.law is not None

    def at(self, t: float, r: FloatArray) -> FloatArray:
        """Velocity (3,) at the time t and the place r (3,)."""
        if self.law is not None:
            value = self._called(t, r)
        elif self.parts:
            state = dict(zip(NAMES, (t, *r.tolist()), strict=True))
            value = np.array([p.at(state) if isinstance(p, Expression) else p for p in self.parts])
        else:
            columns = [np.interp(r[2], self.heights, c) for c in self.profile.T] if len(self.heights) else 0.0
            value = self.uniform(t) + np.asarray(columns)
        if not np.all(np.isfinite(value)):
            what = f"is {value.tolist()} at t = {t:.6g} s, r = {checks.spot(r)} m, must be finite"
            raise ModelError(self.where, what)
        return value

    def describe(self) -> Any:
        """Plain JSON-able form; a Python function as ``<function name>``."""
        return plain(self.given)

    def _read_profile(self, given: Mapping[str, Any]) -> None:
        if set(given) != {"z", "velocity"}:
            what = f'a profile has the keys "z" and "velocity", not {sorted(map(str, given))}'
            hint = '{"z": [0, -50], "velocity": [[1, 0, 0], [0.2, 0, 0]]}; over time {"t": ..., "value": ...}'
            raise ModelError(self.where, what, hint)
        z = checks.array(given["z"], f"{self.where}.z", (None,))
        if np.ndim(given["velocity"]) == 1:
            what = f"has one number at each height, wanted three: {checks.shown(given['velocity'])}"
            raise ModelError(f"{self.where}.velocity", what, "along x it is [[1.0, 0, 0], ...]")
        velocity = checks.array(given["velocity"], f"{self.where}.velocity", (None, 3))
        checks.increasing(z, f"{self.where}.z", "heights", " m")
        if len(velocity) != len(z):
            what = f"has {len(velocity)} values for {len(z)} heights"
            raise ModelError(f"{self.where}.velocity", what)
        self.heights, self.profile = z, velocity

    def _called(self, t: float, r: FloatArray) -> FloatArray:
        try:
            with np.errstate(all="ignore"):
                value = np.asarray(self.law(t, *r.tolist()), dtype=object)
        except Exception as error:
            what = f"the function raised {type(error).__name__}: {error}"
            what = f"at t = {t:.6g} s, r = {checks.spot(r)} m {what}"
            raise ModelError(self.where, what) from error
        if value.shape != (3,) or not all(isinstance(part, int | float | np.number) for part in value):
            what = f"the function of t, x, y, z returned {checks.shown(value.tolist())}, wanted three numbers"
            raise ModelError(self.where, what)
        return value.astype(np.float64)


def _rate(function: TimeFunction) -> TimeFunction:
    if function.constant or function.missing:
        return TimeFunction([0.0, 0.0, 0.0], 3, function.where)

    def across(t: float, steps: int) -> FloatArray:
        return function(t + steps * STEP) - function(t - steps * STEP)

    def rate(t: float) -> FloatArray:  # sixth order: gusts may be as fast as the steps of fast models
        change: FloatArray = 45.0 * across(t, 1) - 9.0 * across(t, 2) + across(t, 3)
        return change / (60.0 * STEP)

    return TimeFunction(rate, 3, function.where)


def _is_formula(given: Any) -> bool:
    if isinstance(given, str) or not isinstance(given, Sequence) or len(given) != 3:
        return False
    return any(isinstance(part, str) and depends_on_state(part) for part in given)


def _arguments(function: Any) -> int:
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return 1
    kinds = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    return sum(p.kind in kinds and p.default is p.empty for p in parameters)
