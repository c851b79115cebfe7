"""StateFunction: a force that depends on time and on the place and velocity of the point where it acts."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..functions.expression import STATE, Expression, depends_on_state
from ..functions.function import TimeFunction, plain

#: What a formula of the state may depend on.
NAMES = ("t", *STATE)


class StateFunction:
    """Three numbers that depend on t, on a position and on a velocity.

    Parameters
    ----------
    given : callable or list
        A Python function of t in s, r (3,) in m and v (3,) in m/s that returns three numbers, compiled by
        numba if it can be, else called once a step; or three numbers and formulas of t, x, y, z, vx, vy, vz.
    where : str
        Place in the model, for messages.
    position : (3,) m
        Where it is tried, at rest and at t = 0.
    size : float, m
        Size of the model.

    Attributes
    ----------
    once : str or None
        Why numba cannot compile it and it is called once a step; "" if it is compiled, None before a model
        with it was computed.

    Raises
    ------
    ModelError
        It cannot be evaluated there.
    """

    __slots__ = ("given", "once", "parts", "size", "where")
    constant = False

    def __init__(self, given: Any, where: str, position: FloatArray, size: float) -> None:
        self._take(given, where, size)
        self(0.0, np.asarray(position), np.zeros(3))

    def _take(self, given: Any, where: str, size: float) -> None:
        self.given, self.where, self.size = given, where, size
        self.once: str | None = None
        self.parts = [] if callable(given) else _formulas(given, where)

    def __getstate__(self) -> Any:
        return self.given, self.where, self.size

    def __setstate__(self, state: Any) -> None:
        self._take(*state)

    def __deepcopy__(self, memo: dict[int, Any]) -> StateFunction:
        return self  # it never changes

    def __call__(self, t: float, r: FloatArray, v: FloatArray) -> FloatArray:
        """Value (3,) at the time t, s, the position r, m, and the velocity v, m/s, both (3,)."""
        value = self._given(t, r, v) if callable(self.given) else self._formulas(t, r, v)
        if not np.all(np.isfinite(value)):
            what = f"is {value.tolist()} at t = {t:.6g} s, r = {checks.spot(r)} m, v = {checks.spot(v)} m/s"
            raise ModelError(self.where, f"{what}, must be finite", "it is asked for at rest too")
        return value

    def depends_on_place(self, position: FloatArray) -> bool:
        """Whether the force at rest is another one somewhere around a position (3,), m."""
        still, here = np.zeros(3), self(0.0, position, np.zeros(3))
        around = (position + s * self.size * e for e in np.eye(3) for s in (-0.1, 0.1))
        return any(bool(np.any(self(0.0, place, still) != here)) for place in around)

    def describe(self) -> Any:
        """Plain JSON-able form; a Python function as ``<function name>``."""
        return plain(self.given)

    def _formulas(self, t: float, r: FloatArray, v: FloatArray) -> FloatArray:
        state = dict(zip(NAMES, (t, *r.tolist(), *v.tolist()), strict=True))
        return np.array([p.at(state) if isinstance(p, Expression) else p for p in self.parts])

    def _given(self, t: float, r: FloatArray, v: FloatArray) -> FloatArray:
        try:
            with np.errstate(all="ignore"):
                value = np.asarray(self.given(t, r.copy(), v.copy()))
        except Exception as error:
            what = f"the function raised {type(error).__name__}: {error}"
            what = f"at t = {t:.6g} s, r = {checks.spot(r)} m {what}"
            raise ModelError(self.where, what) from error
        if value.dtype.kind not in "iuf" or value.shape != (3,):
            shape = f"shape {value.shape}" if value.dtype.kind in "iuf" else checks.shown(value.tolist())
            what = f"the function of t, r, v returned {shape}, wanted (3,)"
            what = f"at t = {t:.6g} s, r = {checks.spot(r)} m {what}"
            raise ModelError(self.where, what)
        return value.astype(np.float64)


def force_function(
    given: Any, where: str, position: FloatArray, size: Callable[[], float], unit: str | None = None
) -> TimeFunction | StateFunction:
    """A function of time, or of the state if it takes three arguments or names x ... vz.

    ``size``: gives that of the model, m; it is asked for if the force is such a law. ``unit``: N or N/m.
    """
    if _is_law(given):
        return StateFunction(given, where, position, size())
    return TimeFunction(given, 3, where, unit)


def check_force(given: Any, where: str) -> None:
    """Raise ModelError if what a file gives for a force is neither of both."""
    if _is_law(given):
        _formulas(given, where)
    else:
        TimeFunction(given, 3, where)


def _is_law(given: Any) -> bool:
    if isinstance(given, TimeFunction | str):
        return False
    if isinstance(given, Sequence):
        return len(given) == 3 and any(isinstance(part, str) and depends_on_state(part) for part in given)
    return callable(given) and _arguments(given) == 3


def _formulas(given: Sequence[Any], where: str) -> list[Expression | float]:
    return [
        Expression(part, f"{where}[{i}]", NAMES)
        if isinstance(part, str)
        else checks.number(part, f"{where}[{i}]")
        for i, part in enumerate(given)
    ]


def _arguments(function: Callable[..., Any]) -> int:
    """Number of arguments that a function must be given."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return 1
    kinds = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    return sum(p.kind in kinds and p.default is p.empty for p in parameters)
