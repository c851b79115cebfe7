"""From what a user gives as a law of the state to a function with an address: compiled, or one in Python."""

from __future__ import annotations

import ast
import ctypes
import inspect
import math
import warnings
from typing import Any

import numba
import numpy as np
from numba import cfunc, njit, types

from ..errors import ModelError
from ..model import checks
from ..model.functions.expression import Expression
from ..model.loads.state_function import StateFunction
from ..model.surroundings.velocity_field import VelocityField

_OPTIONS: dict[str, Any] = {"error_model": "numpy"}
_SIGNATURE = types.float64(types.float64, types.CPointer(types.float64))
_PROTOTYPE = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, ctypes.POINTER(ctypes.c_double))
#: What was given, what has its address and why it is not compiled, by formulas or by the user's function:
#: what has an address must stay.
_LAWS: dict[Any, tuple[Any, Any, str]] = {}

_BINARY: dict[type[ast.AST], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
_COMPARE: dict[type[ast.AST], str] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}


@njit(**_OPTIONS)
def _ramp(t, t0, t1):
    if t1 <= t0:
        return math.nan
    s = min(max((t - t0) / (t1 - t0), 0.0), 1.0)
    return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)


def address_of(function: StateFunction | VelocityField, of_place: bool = False) -> int:
    """Address of a C function ``double law(double t, double data[9])``, see :mod:`ancf.loads.state_force`.

    What numba cannot compile is called in Python; ``function.once`` then says why, and kernels ask for it
    once a step.  ``of_place`` says that it takes t, x, y, z instead of t, r, v.

    Raises
    ------
    ModelError
        A law has no value where it is tried.
    """
    texts = [p.text if isinstance(p, Expression) else float(p) for p in function.parts]
    given = function.law if isinstance(function, VelocityField) else function.given
    key = tuple(texts) or (id(given), of_place)
    if key not in _LAWS:
        _LAWS[key] = given, *_made(function, texts, given, of_place)
    _, law, function.once = _LAWS[key]
    if function.once and isinstance(law, Called):
        law.function = function
    return int(law.address)


def _made(
    function: StateFunction | VelocityField, texts: list[str | float], given: Any, of_place: bool
) -> tuple[Any, str]:
    """What has an address, and why it is called once a step, "" if it is compiled."""
    if texts:
        return cfunc(_SIGNATURE, **_OPTIONS)(python_of(texts)), ""
    if not inspect.isfunction(given):
        return Called(function, of_place), f"{checks.shown(given)} is no plain Python function"
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of numba, about what it then cannot compile
            return _compiled(_of_place(given) if of_place else given), ""
    except Exception as error:  # numba raises all kinds of them
        lines = [line.strip(" -") for line in str(error).splitlines()]
        told = [line for line in lines if line and not line.endswith(":") and "nopython" not in line]
        reason = told[0] if told else type(error).__name__
        return Called(function, of_place), f"numba cannot compile it: {reason}"


class Called:
    """A law in Python with an address, as a compiled one has; what it raises is kept, its force is then none.

    Attributes
    ----------
    address : int
    problem : ModelError or None
        What was wrong when it was called last.
    """

    def __init__(self, function: StateFunction | VelocityField, of_place: bool) -> None:
        self.function, self.of_place = function, of_place
        self.problem: ModelError | None = None
        self._call = _PROTOTYPE(self._called)
        self.address = ctypes.cast(self._call, ctypes.c_void_p).value

    def _called(self, t: float, data: Any) -> float:
        numbers = np.ctypeslib.as_array(data, (9,))
        try:
            r, v = numbers[:3].copy(), numbers[3:6].copy()
            function: Any = self.function
            numbers[6:] = function.at(t, r) if self.of_place else function(t, r, v)
        except ModelError as error:
            numbers[6:], self.problem = math.nan, error
            return 1.0
        return 0.0


def problem_of(function: StateFunction | VelocityField) -> ModelError | None:
    """What was wrong when a law was called last that is called once a step, told once."""
    given = function.law if isinstance(function, VelocityField) else function.given
    law = next((_LAWS[key][1] for key in ((id(given), True), (id(given), False)) if key in _LAWS), None)
    if not isinstance(law, Called):
        return None
    problem, law.problem = law.problem, None
    return problem


def _compiled(function: Any) -> Any:
    law = njit(**_OPTIONS)(function)

    @njit(**_OPTIONS)
    def asked(t, numbers):  # by itself: within the try it would take twice as long to compile
        force = law(t, numbers[:3].copy(), numbers[3:6].copy())
        if len(force) == 3:
            numbers[6], numbers[7], numbers[8] = force[0], force[1], force[2]

    @cfunc(_SIGNATURE, **_OPTIONS)
    def called(t, data):
        numbers = numba.carray(data, 9)
        numbers[6], numbers[7], numbers[8] = math.nan, math.nan, math.nan
        try:  # what is raised here would be lost: a force that is none ends the step
            asked(t, numbers)
        except Exception:
            return 1.0
        return 0.0

    return called


def _of_place(function: Any) -> Any:
    """A function of t, x, y, z as one of t, r and v."""
    inner = njit(**_OPTIONS)(function)
    return lambda t, r, v: inner(t, r[0], r[1], r[2])


def python_of(texts: list[str | float]) -> Any:
    """Three formulas or numbers as one Python function that fills data[6:9].

    They raise nothing: without what a user's function needs they are compiled in a tenth of the time.
    """
    parts = [_source(ast.parse(" ".join(str(text).split()), mode="eval").body) for text in texts]
    lines = (
        "def law(t, data):",
        "    x, y, z, vx, vy, vz = data[0], data[1], data[2], data[3], data[4], data[5]",
        f"    data[6], data[7], data[8] = {', '.join(parts)}",
        "    return 0.0",
    )
    space: dict[str, Any] = {"math": math, "_ramp": _ramp}
    exec("\n".join(lines), space)  # of a tree that model.expression has checked
    return space["law"]


def _source(node: ast.AST) -> str:
    """Python of a part of a formula that numba compiles, with numbers for truth."""
    match node:
        case ast.Constant(value=value):
            return repr(float(value))  # type: ignore[arg-type]
        case ast.Name(id=name):
            return "math.pi" if name == "pi" else name
        case ast.UnaryOp(op=ast.Not(), operand=inner):
            return f"(1.0 if {_source(inner)} == 0.0 else 0.0)"
        case ast.UnaryOp(op=op, operand=inner):
            return f"({'-' if isinstance(op, ast.USub) else '+'}{_source(inner)})"
        case ast.BinOp(left=left, op=op, right=right):
            return f"({_source(left)} {_BINARY[type(op)]} {_source(right)})"
        case ast.BoolOp(op=op, values=values):
            word = " and " if isinstance(op, ast.And) else " or "
            return f"(1.0 if {word.join(f'({_source(v)} != 0.0)' for v in values)} else 0.0)"
        case ast.Compare():
            sides = [_source(side) for side in (node.left, *node.comparators)]
            words = [_COMPARE[type(op)] for op in node.ops]
            pairs = (f"({a} {word} {b})" for a, word, b in zip(sides, words, sides[1:], strict=False))
            return f"(1.0 if {' and '.join(pairs)} else 0.0)"
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return _call(name, [_source(argument) for argument in arguments])
    raise TypeError(f"no formula: {ast.dump(node)}")


def _call(name: str, given: list[str]) -> str:
    if name == "where":
        return f"({given[1]} if {given[0]} != 0.0 else {given[2]})"
    if name == "step":
        return f"(1.0 if {given[0]} >= 0.0 else 0.0)"
    known = {"ramp": "_ramp", "min": "min", "max": "max", "abs": "abs"}
    return f"{known.get(name, f'math.{name}')}({', '.join(given)})"
