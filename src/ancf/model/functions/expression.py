"""Formulas of time in the model file: a small safe language, evaluated on whole arrays of times."""

from __future__ import annotations

import ast
import operator
import re
import warnings
from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ..checks import nearest

Compiled = Callable[[Any], Any]
MAX_LENGTH = 5000
#: What numbers of NumPy are shown as, and what to do about it where texts are put together.
NUMPY_NUMBER = re.compile(r"(np|numpy)\.\w+\(")
NUMPY_SHOWN = "NumPy shows its numbers so: put float(...) of them into the text"


def _ramp(t: Any, t0: Any, t1: Any) -> Any:
    if np.any(np.asarray(t1) <= np.asarray(t0)):
        raise ValueError("ramp(t, t0, t1) needs t0 < t1")
    s = np.clip((t - t0) / (t1 - t0), 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


def _step(t: Any) -> Any:
    return np.where(np.asarray(t) >= 0.0, 1.0, 0.0)


def _where(condition: Any, a: Any, b: Any) -> Any:
    return np.where(np.asarray(condition) != 0.0, a, b)


def _truth(value: Any) -> Any:
    return np.where(np.asarray(value) != 0.0, 1.0, 0.0)


CONSTANTS = {"pi": np.float64(np.pi)}
# name: (function, least arguments, most arguments)
FUNCTIONS: dict[str, tuple[Callable[..., Any], int, int]] = {
    "sin": (np.sin, 1, 1),
    "cos": (np.cos, 1, 1),
    "tan": (np.tan, 1, 1),
    "tanh": (np.tanh, 1, 1),
    "exp": (np.exp, 1, 1),
    "log": (np.log, 1, 1),
    "sqrt": (np.sqrt, 1, 1),
    "abs": (np.abs, 1, 1),
    "min": (lambda *v: reduce(np.minimum, v), 2, 20),
    "max": (lambda *v: reduce(np.maximum, v), 2, 20),
    "where": (_where, 3, 3),
    "ramp": (_ramp, 3, 3),
    "step": (_step, 1, 1),
}
OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: np.true_divide,
    ast.Pow: np.power,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Not: lambda v: 1.0 - _truth(v),
    ast.And: lambda *v: reduce(np.minimum, map(_truth, v)),
    ast.Or: lambda *v: reduce(np.maximum, map(_truth, v)),
    ast.Lt: np.less,
    ast.LtE: np.less_equal,
    ast.Gt: np.greater,
    ast.GtE: np.greater_equal,
    ast.Eq: np.equal,
    ast.NotEq: np.not_equal,
}
#: A number with a unit behind it, as "20 ms" or "5%".
QUANTITY = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?\s*[A-Za-zµμ°Ω%][\wµμ°Ω/^*%.² ³-]*")
#: A number and a name behind it, as "2t" or "2 pi".
FACTOR = re.compile(r"(?<![\w.])(\d+\.?\d*|\.\d+)\s*([A-Za-z]\w*)")
#: Names of the state of a point in formulas: its position in m, its velocity in m/s.
STATE = ("x", "y", "z", "vx", "vy", "vz")


class Expression:
    """A formula of t, such as ``"10*sin(2*pi*t)"``, compiled once.

    Parameters
    ----------
    text : str
        The formula.
    where : str
        Place for messages.
    names : tuple of str
        What it may depend on; with more than "t" it is asked by :meth:`at` or :meth:`under`.

    Raises
    ------
    ModelError
        It is no formula, or uses an unknown name.

    """

    __slots__ = ("_compiled", "names", "text", "used", "uses_t", "where")

    def __init__(self, text: str, where: str, names: tuple[str, ...] = ("t",)) -> None:
        self.text, self.where, self.names = text, where, names
        try:
            tree = _parse(text, where, (*names, *CONSTANTS, *FUNCTIONS))
            self._compiled = self._compile(tree)
        except (RecursionError, MemoryError):
            raise ModelError(where, "the formula is nested too deeply") from None
        found = dict.fromkeys(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
        self.used = tuple(name for name in found if name in names)
        self.uses_t = "t" in self.used

    def __call__(self, times: FloatArray) -> FloatArray:
        """Values (n,) at the times (n,); may hold non-finite numbers."""
        return np.array(np.broadcast_to(self._evaluate(times), times.shape), dtype=np.float64)

    def under(self, values: Mapping[str, float], times: FloatArray) -> FloatArray:
        """Values (n,) at the times (n,) where its other names have these values."""
        given = {**values, "t": times}
        return np.array(np.broadcast_to(self._evaluate(given), times.shape), dtype=np.float64)

    def at(self, state: Mapping[str, float]) -> float:
        """Value where its names have these values; may be not finite."""
        return float(self._evaluate(state))

    def _evaluate(self, given: Any) -> Any:
        try:
            with np.errstate(all="ignore"):
                return self._compiled(given)
        except ValueError as error:
            raise ModelError(self.where, f"{self._quoted}: {error}") from None
        except RecursionError:
            raise ModelError(self.where, f"{self._quoted} is nested too deeply") from None

    @property
    def _known(self) -> str:
        return ", ".join([*self.names, *CONSTANTS, *(f"{name}()" for name in sorted(FUNCTIONS))])

    @property
    def _quoted(self) -> str:
        return _quoted(self.text)

    def _compile(self, node: ast.AST) -> Compiled:
        match node:
            case ast.Constant(value=value) if isinstance(value, int | float) and not isinstance(value, bool):
                return self._constant(value)
            case ast.Name(id=name):
                return self._name(name)
            case ast.UnaryOp(op=op, operand=inner) if type(op) in OPERATORS:
                return _apply(OPERATORS[type(op)], [self._compile(inner)])
            case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATORS:
                return _apply(OPERATORS[type(op)], [self._compile(left), self._compile(right)])
            case ast.BoolOp(op=op, values=parts):
                return _apply(OPERATORS[type(op)], [self._compile(part) for part in parts])
            case ast.Compare():
                return self._compare(node)
            case ast.Call():
                return self._call(node)
        raise self._unknown(node)

    def _constant(self, value: float) -> Compiled:
        try:
            clean = np.float64(value)
        except OverflowError:
            raise ModelError(self.where, f"{self._quoted}: a number is too large") from None
        return lambda t: clean

    def _name(self, name: str) -> Compiled:
        if self.names == ("t",) == (name,):
            return lambda t: t
        if name in self.names:
            return lambda given: _number(given[name])
        if name in CONSTANTS:
            return lambda t: CONSTANTS[name]
        if name in FUNCTIONS:
            raise ModelError(self.where, f"{self._quoted}: {name} is a function, write {name}(...)")
        raise self._unknown_name(name)

    def _compare(self, node: ast.Compare) -> Compiled:
        sides = [self._compile(side) for side in (node.left, *node.comparators)]
        if not all(type(op) in OPERATORS for op in node.ops):
            raise self._unknown(node)
        pairs = [
            _apply(OPERATORS[type(op)], [sides[i], sides[i + 1]], truth=True) for i, op in enumerate(node.ops)
        ]
        return _apply(OPERATORS[ast.And], pairs)

    def _call(self, node: ast.Call) -> Compiled:
        if not isinstance(node.func, ast.Name):
            raise self._unknown(node)
        name = node.func.id
        if name in self.names or name in CONSTANTS:
            raise self._unknown(node)
        if name not in FUNCTIONS:
            raise self._unknown_name(name)
        function, least, most = FUNCTIONS[name]
        if node.keywords or not least <= len(node.args) <= most:
            wanted = f"{least}" if least == most else f"{least} or more"
            raise ModelError(self.where, f"{self._quoted}: {name}() takes {wanted} arguments")
        return _apply(function, [self._compile(argument) for argument in node.args])

    def _unknown_name(self, name: str) -> ModelError:
        hint = nearest(name, [*self.names, *CONSTANTS, *FUNCTIONS])
        if not hint and self.names[:1] == ("t",):  # of the state or a place no input is known
            hint = (
                "an input of a model stands in [[inputs]] of its file; in Python give what add_input returned"
            )
        return ModelError(self.where, f'{self._quoted}: unknown name "{name}", known are {self._known}', hint)

    def _unknown(self, node: ast.AST) -> ModelError:
        hints: list[tuple[type[ast.AST], str]] = [
            (ast.BinOp, "write ** for a power" if "^" in self.text else ""),
            (ast.Call, NUMPY_SHOWN if NUMPY_NUMBER.match(ast.unparse(node)) else "write * for a product"),
            (ast.IfExp, "write where(condition, a, b)"),
        ]
        hint = next((text for kind, text in hints if isinstance(node, kind)), "")
        part = ast.unparse(node)
        return ModelError(
            self.where, f'{self._quoted}: "{part}" is not allowed, known are {self._known}', hint
        )


def _number(value: Any) -> Any:
    return value if isinstance(value, np.ndarray) else np.float64(value)


def _apply(function: Callable[..., Any], parts: list[Compiled], truth: bool = False) -> Compiled:
    if truth:
        return lambda t: np.where(function(*(part(t) for part in parts)), 1.0, 0.0)
    return lambda t: function(*(part(t) for part in parts))


def _quoted(text: str) -> str:
    return f'"{text}"' if len(text) <= 100 else f'"{text[:97]}..."'


def _parse(text: str, where: str, known: tuple[str, ...] = ()) -> ast.expr:
    flat = " ".join(text.split())
    if not flat:
        raise ModelError(where, "the formula is empty")
    if len(flat) > MAX_LENGTH:
        raise ModelError(where, f"the formula has {len(flat)} characters, at most {MAX_LENGTH}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(flat, mode="eval").body
    except (SyntaxError, ValueError) as error:
        column = getattr(error, "offset", None)
        place = f" at column {column}" if column else ""
        what = getattr(error, "msg", str(error))
        hint = f"write * for a product: {product}" if (product := _multiplied(flat, known)) else ""
        if QUANTITY.fullmatch(flat) and not hint:
            hint = "give the number alone, in units of the SI"
            raise ModelError(
                where, f"{_quoted(flat)} is a number with a unit, must be a number", hint
            ) from None
        raise ModelError(where, f"{_quoted(flat)} is no formula of t: {what}{place}", hint) from None


def _multiplied(text: str, known: tuple[str, ...]) -> str:
    """The first number of a text that has a known name right behind it, as a product; "" if there is none."""
    found = (match for match in FACTOR.finditer(text) if match[2] in known)
    return next((f"{match[1]}*{match[2]}" for match in found), "")


def depends_on_state(text: str) -> bool:
    """Whether a text is a formula with a name of the state of a point."""
    try:
        tree = _parse(text, "")
    except (ModelError, RecursionError, MemoryError):
        return False
    return any(isinstance(node, ast.Name) and node.id in STATE for node in ast.walk(tree))
