"""Formulas of what a case gives, such as ``max(tension(cable.start))``: a small safe language, no Python."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..errors import ModelError, SolveError
from ..model.checks import listed, nearest
from ..model.functions.expression import CONSTANTS, FUNCTIONS, OPERATORS
from .meant import meant_by
from .work import NotFiniteError

MOST_CHARACTERS = 2000


class Answers(Protocol):
    """A finished case."""

    def value(self, name: str) -> Any:
        """A number or an array by its name; times are the first axis of histories."""
        ...

    def ask(self, quantity: str, item: str) -> Any:
        """History of a quantity of a point, spring, joint or contact; times are the first axis."""
        ...


@dataclass(frozen=True)
class Vocabulary:
    """What formulas of one sort of cases may name.

    Parameters
    ----------
    names : tuple of str
        Numbers and arrays.
    quantities : tuple of str
        What is asked of an item: ``tension(cable.start)``.
    """

    names: tuple[str, ...]
    quantities: tuple[str, ...] = ()


def _trapezoid(t: Any, x: Any) -> Any:
    return np.trapezoid(x, t, axis=0)


def _at(t: Any, x: Any, when: Any) -> Any:
    rows = np.asarray(x, dtype=np.float64)
    columns = rows.reshape(len(rows), -1).T
    return np.stack([np.interp(when, t, column) for column in columns]).reshape(rows.shape[1:])


def _smooth_maximum(x: Any, sharpness: Any) -> Any:
    """log(mean(exp(k x)))/k: below the maximum, by log(n)/k at most."""
    most = np.max(x, axis=0)
    return most + np.log(np.mean(np.exp(sharpness * (x - most)), axis=0)) / sharpness


#: Of a history to a number: the name, what it does, further arguments, whether it wants the times.
REDUCTIONS: dict[str, tuple[Callable[..., Any], int, bool]] = {
    "max": (lambda x: np.max(x, axis=0), 0, False),
    "min": (lambda x: np.min(x, axis=0), 0, False),
    "mean": (lambda x: np.mean(x, axis=0), 0, False),
    "deviation": (lambda x: np.std(x, axis=0), 0, False),
    "rms": (lambda x: np.sqrt(np.mean(np.square(x), axis=0)), 0, False),
    "range": (lambda x: np.ptp(x, axis=0), 0, False),
    "first": (lambda x: x[0], 0, False),
    "last": (lambda x: x[-1], 0, False),
    "percentile": (lambda x, p: np.percentile(x, p, axis=0), 1, False),
    "smoothmax": (_smooth_maximum, 1, False),
    "integral": (_trapezoid, 0, True),
    "at": (_at, 1, True),
}
#: Of vectors to their length.
LENGTH = "norm"


class Formula:
    """A formula, compiled once.

    Parameters
    ----------
    text : str
    where : str
        Place in the study file, for messages.
    words : Vocabulary

    Attributes
    ----------
    asked : list of (str, str)
        Quantities and items that it asks for.
    named : set of str
        Names that it uses.
    highest : int
        Largest index of a name, -1 without any.
    whole : set of str
        Names of which it uses more than entries counted from the first.

    Raises
    ------
    ModelError
        It is no formula, or names what there is not.
    """

    def __init__(self, text: str, where: str, words: Vocabulary) -> None:
        self.text, self.where, self.words = text, where, words
        self.asked: list[tuple[str, str]] = []
        self.named: set[str] = set()
        self.highest = -1
        self.whole: set[str] = set()
        try:
            tree = ast.parse(" ".join(text.split())[:MOST_CHARACTERS], mode="eval").body
            self._compiled = self._compile(tree)
        except (SyntaxError, ValueError) as error:
            if isinstance(error, ModelError):
                raise
            what = f'"{text}" is no formula: {getattr(error, "msg", error)}'
            raise ModelError(where, what, meant_by(text)) from None
        except (RecursionError, MemoryError):
            raise ModelError(where, "the formula is nested too deeply") from None

    def __call__(self, case: Answers) -> float:
        """Its value for a finished case.

        Raises
        ------
        ModelError
            It is not one finite number.
        """
        with np.errstate(all="ignore"):
            found = np.asarray(self._computed(case))
        if found.size != 1 or found.dtype.kind not in "iufb":
            what = f'"{self.text}" gives {_shape(found)}, must give one number'
            raise ModelError(self.where, what, self._one_number(found, case))
        number = float(found.reshape(-1)[0])
        if not math.isfinite(number):
            raise NotFiniteError(self.where, f'"{self.text}" is {number}, must be a finite number')
        return number

    def _computed(self, case: Answers) -> Any:
        """What it gives; an error of what it asks for names it as well."""
        try:
            return self._compiled(case)
        except (ModelError, SolveError) as error:
            if error.where == self.where:
                raise
            raise type(error)(f"{self.where}: {error.where}", error.what, error.hint) from None
        except (TypeError, ValueError) as error:  # of what NumPy does not take, such as a percentile of 300
            raise ModelError(self.where, f'"{self.text}": {error}') from None

    def _one_number(self, found: Any, case: Answers) -> str:
        """What to write for one number of a history, of a list, of vectors, as which it was found."""
        if not found.ndim or not found.size:
            return ""
        times = np.size(case.value("t")) if "t" in self.words.names else 0
        tree = ast.parse(" ".join(self.text.split()), mode="eval").body
        whole = self.text if isinstance(tree, ast.Call | ast.Name | ast.Subscript) else f"({self.text})"
        entry = f"{whole}[{found.shape[-1] - 1}]"
        inner = entry if found.ndim > 1 else self.text
        if found.shape[0] == times:
            return f"such as last({inner}), max({inner}) or mean({inner})"
        return f"such as max({inner}) or {entry}"

    def history(self, case: Answers) -> Any:
        """Its values (n,) at the times of the case.

        Raises
        ------
        ModelError
            It gives something else.
        """
        with np.errstate(all="ignore"):
            found = np.asarray(self._computed(case), dtype=np.float64)
        times = np.asarray(case.value("t"))
        if found.shape != times.shape:
            what = f'"{self.text}" gives {_shape(found)} at {len(times)} times, must give one at each'
            raise ModelError(self.where, what, "such as position(...)[2]")
        return found

    def _compile(self, node: ast.AST) -> Callable[[Answers], Any]:
        match node:
            case ast.Constant(value=bool() | str()):
                raise self._unknown(node)
            case ast.Constant(value=int() | float() as value):
                number = np.float64(value)
                return lambda case: number
            case ast.Name(id=name):
                return self._name(name)
            case ast.Subscript(value=inner, slice=place):
                return self._entry(inner, place)
            case ast.UnaryOp(op=op, operand=inner) if type(op) in OPERATORS:
                return _applied(OPERATORS[type(op)], [self._compile(inner)])
            case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATORS:
                return _applied(OPERATORS[type(op)], [self._compile(left), self._compile(right)])
            case ast.BoolOp(op=op, values=parts):
                return _applied(OPERATORS[type(op)], [self._compile(part) for part in parts])
            case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in OPERATORS:
                return _applied(OPERATORS[type(op)], [self._compile(left), self._compile(right)])
            case ast.Call(func=ast.Name(id=name), args=given, keywords=[]):
                return self._call(name, given)
        raise self._unknown(node)

    def _name(self, name: str) -> Callable[[Answers], Any]:
        if name in CONSTANTS:
            return lambda case: CONSTANTS[name]
        if name not in self.words.names:
            raise self._unknown_name(name)
        self.named.add(name)
        self.whole.add(name)
        return lambda case: case.value(name)

    def _entry(self, inner: ast.AST, place: ast.AST) -> Callable[[Answers], Any]:
        """A component of vectors, an entry of an array: of the last axis."""
        try:
            index = ast.literal_eval(place)
        except (ValueError, TypeError):
            index = None
        if not isinstance(index, int) or isinstance(index, bool):
            what = f'"{self.text}": "{ast.unparse(place)}" is no place in a list'
            raise ModelError(self.where, what, "a whole number, from 0")
        before = set(self.whole)
        whole, text = self._compile(inner), ast.unparse(inner)
        if isinstance(inner, ast.Name) and index >= 0:
            self.highest = max(self.highest, index)
            self.whole -= {inner.id} - before

        def entry(case: Answers) -> Any:
            values = np.asarray(whole(case))
            count = values.shape[-1] if values.ndim else 0
            if not -count <= index < count:
                what = f'"{text}" has {count} entries, [{index}] is none'
                raise ModelError(
                    self.where, what if count else f'"{text}" is one number, it has no [{index}]'
                )
            return values[..., index]

        return entry

    def _call(self, name: str, given: list[ast.expr]) -> Callable[[Answers], Any]:
        if name in self.words.quantities:
            return self._question(name, given)
        if name == LENGTH and len(given) == 1:
            return _applied(lambda x: np.linalg.norm(x, axis=-1), [self._compile(given[0])])
        reduction = REDUCTIONS.get(name)
        if reduction is not None and len(given) == 1 + reduction[1]:
            return self._reduced(name, [self._compile(part) for part in given])
        if name in FUNCTIONS:
            function, least, most = FUNCTIONS[name]
            if least <= len(given) <= most:
                return _applied(function, [self._compile(part) for part in given])
        if name in self.words.names:
            whole = len(given) == 1 and isinstance(given[0], ast.Constant) and isinstance(given[0].value, int)
            hint = f"write {name}[{ast.unparse(given[0])}], counted from 0" if whole else f"write {name}"
            raise ModelError(self.where, f'"{self.text}": {name} is no function', hint)
        if name not in FUNCTIONS and name not in REDUCTIONS and name != LENGTH:
            raise self._unknown_name(name)
        raise ModelError(self.where, f'"{self.text}": {name}() does not take {len(given)} arguments')

    def _reduced(self, name: str, parts: list[Callable[[Answers], Any]]) -> Callable[[Answers], Any]:
        function, _, timely = REDUCTIONS[name]

        def reduced(case: Answers) -> Any:
            values = [np.asarray(part(case)) for part in parts]
            if not values[0].ndim:
                raise ModelError(self.where, f'"{self.text}": {name}() is of a history, not of one number')
            return function(case.value("t"), *values) if timely else function(*values)

        if timely and "t" not in self.words.names:
            raise ModelError(self.where, f'"{self.text}": {name}() is of histories, there are none here')
        return reduced

    def _question(self, quantity: str, given: list[ast.expr]) -> Callable[[Answers], Any]:
        if len(given) != 1:
            raise ModelError(self.where, f'"{self.text}": {quantity}() is asked of one item')
        node = given[0]
        item = (
            node.value
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
            else ast.unparse(node)
        )
        self.asked.append((quantity, item))
        return lambda case: case.ask(quantity, item)

    def _unknown_name(self, name: str) -> ModelError:
        calls = [*self.words.quantities, *REDUCTIONS, LENGTH, *FUNCTIONS]
        known = [*self.words.names, *CONSTANTS, *(f"{call}()" for call in dict.fromkeys(calls))]
        hint = nearest(name, [*self.words.names, *calls])
        return ModelError(
            self.where, f'"{self.text}": unknown name "{name}", known are {", ".join(known)}', hint
        )

    def _unknown(self, node: ast.AST) -> ModelError:
        what = f'"{self.text}": "{ast.unparse(node)}" is not allowed'
        names = listed(self.words.quantities) if self.words.quantities else listed(self.words.names)
        return ModelError(self.where, what, meant_by(self.text) or f"there are: {names}")


def _applied(function: Callable[..., Any], parts: list[Callable[[Answers], Any]]) -> Callable[[Answers], Any]:
    return lambda case: function(*(part(case) for part in parts))


def _shape(found: Any) -> str:
    return f"numbers of shape {found.shape}" if found.size else "nothing"
