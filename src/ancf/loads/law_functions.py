"""From what a user gives as a law of the state to a compiled function with an address."""

from __future__ import annotations

import ast
import inspect
import math
from typing import Any

import numba
from numba import cfunc, njit, types

from ..errors import ModelError
from ..model import checks
from ..model.expression import Expression
from ..model.state_function import StateFunction
from ..model.velocity_field import VelocityField

_OPTIONS: dict[str, Any] = {"error_model": "numpy"}
_SIGNATURE = types.float64(types.float64, types.CPointer(types.float64))
#: Compiled laws, by formulas or by the user's function; what has an address must stay.
_LAWS: dict[Any, Any] = {}

HINT = "write it with numbers, numpy and math alone, or as formulas of t, x, y, z, vx, vy, vz"
PLACE_HINT = "write it with numbers, numpy and math alone, or as formulas of t, x, y, z"

_BINARY: dict[type[ast.AST], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
_COMPARE: dict[type[ast.AST], str] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}


def _ramp(t, t0, t1):
    if t1 <= t0:
        return math.nan
    s = min(max((t - t0) / (t1 - t0), 0.0), 1.0)
    return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)


def address_of(function: StateFunction | VelocityField, of_place: bool = False) -> int:
    """Address of a C function ``double law(double t, double data[9])``, see :mod:`ancf.loads.state_force`.

    ``of_place`` says that a Python function takes t, x, y, z instead of t, r, v.

    Raises
    ------
    ModelError
        The law cannot be compiled.
    """
    texts = [p.text if isinstance(p, Expression) else float(p) for p in function.parts]
    key = tuple(texts) or (function.given, of_place)
    hint = PLACE_HINT if of_place else HINT
    if not texts and not inspect.isfunction(function.given):
        what = f"{checks.shown(function.given)} is no plain Python function, which numba could compile"
        raise ModelError(function.where, what, hint)
    try:
        if key not in _LAWS:
            given = _of_place(function.given) if of_place and not texts else function.given
            _LAWS[key] = _compiled(python_of(texts) if texts else given)
    except Exception as error:  # numba raises all kinds of them
        lines = [line.strip() for line in str(error).splitlines() if line.strip()] or [type(error).__name__]
        reason = next((line for line in lines if "nopython" not in line), lines[0])
        raise ModelError(function.where, f"numba cannot compile the law: {reason}", hint) from None
    return int(_LAWS[key].address)


def _compiled(function: Any) -> Any:
    law = njit(**_OPTIONS)(function)

    @cfunc(_SIGNATURE, **_OPTIONS)
    def called(t, data):
        numbers = numba.carray(data, 9)
        numbers[6], numbers[7], numbers[8] = math.nan, math.nan, math.nan
        try:  # what is raised here would be lost: a force that is none ends the step
            force = law(t, numbers[:3].copy(), numbers[3:6].copy())
            if len(force) == 3:
                numbers[6], numbers[7], numbers[8] = force[0], force[1], force[2]
        except Exception:
            return 1.0
        return 0.0

    return called


def _of_place(function: Any) -> Any:
    """A function of t, x, y, z as one of t, r and v."""
    inner = njit(**_OPTIONS)(function)
    return lambda t, r, v: inner(t, r[0], r[1], r[2])


def python_of(texts: list[str | float]) -> Any:
    """Three formulas or numbers as one Python function of t, r and v."""
    parts = [_source(ast.parse(" ".join(str(text).split()), mode="eval").body) for text in texts]
    lines = (
        "def law(t, r, v):",
        "    x, y, z, vx, vy, vz = r[0], r[1], r[2], v[0], v[1], v[2]",
        f"    return ({', '.join(parts)})",
    )
    space: dict[str, Any] = {"math": math, "_ramp": njit(**_OPTIONS)(_ramp)}
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
