"""Derivatives of formulas by all histories that they ask for, by reverse accumulation."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model.functions.expression import CONSTANTS, FUNCTIONS, OPERATORS
from .formulas import LENGTH, REDUCTIONS, Answers, Formula

#: Derivatives of functions of one argument.
RATES: dict[str, Callable[[Any], Any]] = {
    "sin": np.cos,
    "cos": lambda x: -np.sin(x),
    "tan": lambda x: 1.0 / np.cos(x) ** 2,
    "tanh": lambda x: 1.0 - np.tanh(x) ** 2,
    "exp": np.exp,
    "log": lambda x: 1.0 / x,
    "sqrt": lambda x: 0.5 / np.sqrt(x),
    "abs": np.sign,
    "step": lambda x: 0.0 * x,
}
#: The same of operators of two, by each of them.
PAIRS: dict[type[ast.AST], Callable[[Any, Any], tuple[Any, Any]]] = {
    ast.Add: lambda a, b: (1.0, 1.0),
    ast.Sub: lambda a, b: (1.0, -1.0),
    ast.Mult: lambda a, b: (b, a),
    ast.Div: lambda a, b: (1.0 / b, -a / b**2),
    ast.Pow: lambda a, b: (
        b * np.power(a, b - 1.0),
        np.power(a, b) * np.log(np.where(np.asarray(a) > 0.0, a, 1.0)),
    ),
}


class Value:
    """A value in a formula, and how what follows from it goes back to what it is made of."""

    def __init__(self, value: Any, parts: list[tuple[Value, Callable[[Any], Any]]] | None = None) -> None:
        self.value = np.asarray(value, dtype=np.float64)
        self.parts = [] if parts is None else parts
        self.slope = np.zeros_like(self.value)


def gradient_of(formula: Formula, case: Answers) -> tuple[float, dict[Any, FloatArray]]:
    """Value of a formula, and its derivatives by what it asks for: (quantity, item) or a name.

    At kinks, as of ``max``, ``abs`` and ``norm`` at zero, it is one of the derivatives on both sides.

    Raises
    ------
    ModelError
        As of the formula.
    """
    value = formula(case)
    asked: dict[Any, Value] = {}
    with np.errstate(all="ignore"):
        root = _Walk(formula, case, asked).of(ast.parse(" ".join(formula.text.split()), mode="eval").body)
        root.slope = np.ones_like(root.value)
        for node in reversed(_ordered(root)):
            for part, back in node.parts:
                part.slope = part.slope + _fitted(np.asarray(back(node.slope)), part.value.shape)
    for key, node in asked.items():
        if not np.all(np.isfinite(node.slope)):
            what = f'"{formula.text}" has no finite derivative by {key if isinstance(key, str) else key[1]}'
            raise ModelError(formula.where, what, "such as sqrt of zero")
    return value, {key: node.slope for key, node in asked.items() if key != "t"}


def _times(factor: FloatArray) -> Callable[[Any], Any]:
    return lambda g: g * factor


def _ordered(root: Value) -> list[Value]:
    """All values, each behind those that it is made of."""
    made: list[Value] = []
    seen: set[int] = set()

    def visit(node: Value) -> None:
        if id(node) in seen:
            return
        seen.add(id(node))
        for part, _ in node.parts:
            visit(part)
        made.append(node)

    visit(root)
    return made


def _fitted(slope: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    """Sum over what was repeated to fit another value."""
    while slope.ndim > len(shape):
        slope = slope.sum(axis=0)
    for axis, count in enumerate(shape):
        if count == 1 and slope.shape[axis] != 1:
            slope = slope.sum(axis=axis, keepdims=True)
    return np.broadcast_to(slope, shape)


class _Walk:
    def __init__(self, formula: Formula, case: Answers, asked: dict[Any, Value]) -> None:
        self.formula, self.case, self.asked = formula, case, asked

    def of(self, node: ast.AST) -> Value:
        match node:
            case ast.Constant(value=number):
                return Value(number)
            case ast.Name(id=name):
                return (
                    Value(CONSTANTS[name])
                    if name in CONSTANTS
                    else self.known(name, lambda: self.case.value(name))
                )
            case ast.Subscript(value=inner, slice=place):
                return self.entry(self.of(inner), int(ast.literal_eval(place)))
            case ast.UnaryOp(op=op, operand=inner):
                part = self.of(inner)
                sign = {ast.USub: -1.0, ast.UAdd: 1.0}.get(type(op), 0.0)
                return Value(OPERATORS[type(op)](part.value), [(part, lambda g: sign * g)])
            case ast.BinOp(left=left, op=op, right=right):
                a, b = self.of(left), self.of(right)
                by_a, by_b = PAIRS[type(op)](a.value, b.value)
                parts = [(a, lambda g: g * by_a), (b, lambda g: g * by_b)]
                return Value(OPERATORS[type(op)](a.value, b.value), parts)
            case ast.BoolOp(op=op, values=values):
                return Value(OPERATORS[type(op)](*(self.of(part).value for part in values)))
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                return Value(OPERATORS[type(op)](self.of(left).value, self.of(right).value))
            case ast.Call(func=ast.Name(id=name), args=given):
                return self.call(name, given)
        raise AssertionError(ast.dump(node))

    def known(self, key: Any, ask: Callable[[], Any]) -> Value:
        if key not in self.asked:
            self.asked[key] = Value(ask())
        return self.asked[key]

    @staticmethod
    def entry(part: Value, k: int) -> Value:
        def back(g: FloatArray) -> FloatArray:
            slope = np.zeros_like(part.value)
            slope[..., k] = g
            return slope

        return Value(part.value[..., k], [(part, back)])

    def call(self, name: str, given: list[ast.expr]) -> Value:
        if name in self.formula.words.quantities:
            node = given[0]
            plain = isinstance(node, ast.Constant) and isinstance(node.value, str)
            item = str(node.value) if plain and isinstance(node, ast.Constant) else ast.unparse(node)
            return self.known((name, item), lambda: self.case.ask(name, item))
        parts = [self.of(part) for part in given]
        if name == LENGTH:
            x = parts[0]
            size = np.linalg.norm(x.value, axis=-1)
            unit = x.value / np.where(size == 0.0, 1.0, size)[..., None]
            return Value(size, [(x, lambda g: g[..., None] * unit)])
        if name in REDUCTIONS and len(given) == 1 + REDUCTIONS[name][1]:
            return self.reduced(name, parts)
        values = [part.value for part in parts]
        made = FUNCTIONS[name][0](*values)
        if name in RATES:
            rate = RATES[name](values[0])
            return Value(made, [(parts[0], lambda g: g * rate)])
        if name in ("min", "max"):
            taken = [np.asarray(made == value) for value in values]
            return Value(made, [(p, _times(m)) for p, m in zip(parts, taken, strict=True)])
        if name == "where":
            yes = np.asarray(values[0]) != 0.0
            return Value(made, [(parts[1], lambda g: g * yes), (parts[2], lambda g: g * ~yes)])
        return self.ramp(made, parts)

    @staticmethod
    def ramp(made: Any, parts: list[Value]) -> Value:
        """s^3 (10 - 15 s + 6 s^2) with s = (t - t0)/(t1 - t0) from 0 to 1."""
        t, t0, t1 = (part.value for part in parts)
        s = np.clip((t - t0) / (t1 - t0), 0.0, 1.0)
        rate = 30.0 * s**2 * (1.0 - s) ** 2 / (t1 - t0)
        return Value(
            made,
            [
                (parts[0], lambda g: g * rate),
                (parts[1], lambda g: -g * rate * (1.0 - s)),
                (parts[2], lambda g: -g * rate * s),
            ],
        )

    def reduced(self, name: str, parts: list[Value]) -> Value:
        x = parts[0]
        function, _, timely = REDUCTIONS[name]
        more = [part.value for part in parts[1:]]
        t = np.asarray(self.case.value("t")) if timely else None
        made = function(t, x.value, *more) if timely else function(x.value, *more)
        weights = _weights(name, x.value, more, t)
        return Value(made, [(x, lambda g: np.asarray(g) * weights)])


def _weights(name: str, x: FloatArray, more: list[Any], t: Any) -> FloatArray:
    """Derivatives of a reduction of the first axis of x by its rows, of the shape of x."""
    n = len(x)
    if name in ("mean", "first", "last", "integral", "at"):  # linear: what each row alone gives
        row = np.zeros(n)
        if name == "mean":
            row[:] = 1.0 / n
        elif name in ("first", "last"):
            row[0 if name == "first" else -1] = 1.0
        elif name == "integral":
            row[:-1] += 0.5 * np.diff(t)
            row[1:] += 0.5 * np.diff(t)
        else:
            when = float(np.clip(more[0], t[0], t[-1]))
            k = int(np.clip(np.searchsorted(t, when, side="right") - 1, 0, max(n - 2, 0)))
            share = (when - t[k]) / (t[k + 1] - t[k]) if n > 1 else 0.0
            row[k] = 1.0 - share
            if n > 1:
                row[k + 1] += share
        return np.broadcast_to(row.reshape(-1, *[1] * (x.ndim - 1)), x.shape)
    if name == "deviation":
        away, size = x - np.mean(x, axis=0), np.std(x, axis=0)
        return np.asarray(away / (n * np.where(size == 0.0, 1.0, size)))
    if name == "rms":
        size = np.sqrt(np.mean(np.square(x), axis=0))
        return np.asarray(x / (n * np.where(size == 0.0, 1.0, size)))
    if name == "smoothmax":
        w = np.exp(more[0] * (x - np.max(x, axis=0)))
        found: FloatArray = w / np.sum(w, axis=0)
        return found
    weights, columns = np.zeros_like(x), np.arange(int(np.prod(x.shape[1:])))
    flat, rows = weights.reshape(n, -1), x.reshape(n, -1)
    if name in ("max", "range"):
        flat[np.argmax(rows, axis=0), columns] += 1.0
    if name in ("min", "range"):
        flat[np.argmin(rows, axis=0), columns] -= -1.0 if name == "min" else 1.0
    if name == "percentile":
        order, place = np.argsort(rows, axis=0), 0.01 * float(more[0]) * (n - 1)
        low = int(np.clip(np.floor(place), 0, n - 1))
        high, share = min(low + 1, n - 1), place - low
        flat[order[low], columns] += 1.0 - share
        flat[order[high], columns] += share
    return weights
