"""Units of the columns of a study: of what formulas give, and of what stands at paths of a file."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..model.file.paths import walk
from .formulas import LENGTH, REDUCTIONS

#: What has the unit of its first argument: of a history, or as functions of numbers.
ALIKE = {*REDUCTIONS, LENGTH, "abs"} - {"integral"}
#: The unit at the end of what a key of a file means.
LAST = re.compile(r"\[([^\[\]]+)\]\.?$")
#: What a description calls the unit of a plain number.
NONE = "-"
#: Of a number in a formula, such as the 2 of ``max(x) - 2``, whose unit is that of what stands beside it.
_NUMBER = "number"


def unit_of_formula(text: str, words: Mapping[str, str | None]) -> str | None:
    """Unit of what a formula gives, "" of a plain number, None where it does not tell.

    Parameters
    ----------
    text : str
        As :class:`Formula` takes it.
    words : mapping
        Units of its names and quantities, None where there is none in general.
    """
    found = _unit(ast.parse(" ".join(text.split()), mode="eval").body, words)
    return None if found is _NUMBER else found


def _unit(node: ast.AST, words: Mapping[str, str | None]) -> str | None:
    match node:
        case ast.Constant():
            return _NUMBER
        case ast.Name(id=name):
            return words.get(name)
        case ast.Subscript(value=inner) | ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=inner):
            return _unit(inner, words)
        case ast.BinOp(left=left, op=op, right=right):
            return _together(op, _unit(left, words), _unit(right, words))
        case ast.Call(func=ast.Name(id=name), args=given):
            return words[name] if name in words else _of_call(name, [_unit(one, words) for one in given])
    return None


def _together(op: ast.operator, one: str | None, other: str | None) -> str | None:
    """Unit of a sum of like things, and of their ratio; a factor may be one of units."""
    if isinstance(op, ast.Add | ast.Sub):
        return _same([one, other])
    if one == other == _NUMBER:
        return _NUMBER
    return "" if isinstance(op, ast.Div) and one == other and one is not None else None


def _of_call(name: str, units: list[str | None]) -> str | None:
    if name in ("min", "max") and len(units) > 1:
        return _same(units)
    if name == "where":
        return _same(units[1:])
    if name in ALIKE:
        return units[0]
    if name == "integral" and units[0]:
        return {"m/s": "m", "rad/s": "rad"}.get(units[0], f"{units[0]} s")
    return None


def _same(units: list[str | None]) -> str | None:
    """The unit that all of them have, plain numbers apart."""
    known = {*units} - {_NUMBER}
    return known.pop() if len(known) == 1 else None if known else _NUMBER


@dataclass(frozen=True)
class FileUnits:
    """Units of what the file of a study holds and of what its outputs give.

    Parameters
    ----------
    tables : dict
        The file.
    schema : mapping
        JSON Schema of such files; descriptions end with a unit in brackets.
    words : mapping
        Units of the names and quantities of formulas.
    beside : mapping
        Units of what stands in no schema, by its path.
    """

    tables: dict[str, Any]
    schema: Mapping[str, Any]
    words: Mapping[str, str | None]
    beside: Mapping[str, str | None] = field(default_factory=dict)

    def of(self, formula: str) -> str | None:
        """Unit of what a formula gives, see :func:`unit_of_formula`."""
        return unit_of_formula(formula, self.words)

    def at(self, path: str) -> str | None:
        """Unit of the value at a path, "" of a plain number, None where the schema does not tell."""
        if path in self.beside:
            return self.beside[path]
        here, unit = [self.schema], None
        for holder, step, _ in walk(self.tables, path):
            plain = [one for given in here for one in _choices(given, self.schema) if _fits(one, holder)]
            if isinstance(holder, dict):
                here = [one for given in plain for one in _of_key(given, step)]
                told = {match[1] for one in here if (match := LAST.search(one.get("description", "")))}
                unit = told.pop() if len(told) == 1 else None
            else:
                here = [given["items"] for given in plain if isinstance(given.get("items"), dict)]
        return "" if unit == NONE else unit


def _choices(given: Mapping[str, Any], schema: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """What a schema may stand for, without references."""
    if "$ref" in given:
        yield from _choices(schema["$defs"][given["$ref"].rpartition("/")[2]], schema)
        return
    yield given
    for key in ("anyOf", "oneOf", "allOf"):
        for one in given.get(key, ()):
            yield from _choices(one, schema)


def _fits(given: Mapping[str, Any], holder: Any) -> bool:
    """Whether a table of this schema may be that one, by its type."""
    wanted = given.get("properties", {}).get("type", {}).get("const")
    return wanted is None or not isinstance(holder, dict) or holder.get("type", wanted) == wanted


def _of_key(given: Mapping[str, Any], key: Any) -> Iterator[Mapping[str, Any]]:
    if key in given.get("properties", {}):
        yield given["properties"][key]
    elif isinstance(given.get("additionalProperties"), dict):
        yield given["additionalProperties"]
