"""Parameters of a file: names for numbers, and formulas of them wherever a number may stand."""

from __future__ import annotations

import re
import types
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from types import MappingProxyType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from ...errors import ModelError
from .. import checks
from ..functions.expression import Expression
from ..functions.inputs import NAME, TAKEN

#: Parameters that formulas may name where a file is read, None where a text is no formula of parameters.
_known: ContextVar[Mapping[str, float] | None] = ContextVar("parameters", default=None)
#: A name in a formula; the letter in ``1e5`` is none.
WORD = re.compile(r"(?<![\w.])[A-Za-z_]\w*")


class Naming:
    """Marks a field whose text is a name, not a formula; formulas may stand in its lists and tables."""


@contextmanager
def given(tables: Any, inputs: Mapping[str, float]) -> Iterator[None]:
    """Here formulas may name the parameters of these tables of a file.

    Parameters
    ----------
    tables : dict
        A whole file, not checked yet.
    inputs : mapping
        Inputs of the model, whose names parameters must not have.

    Raises
    ------
    ModelError
        A parameter is no number and no formula of those before it, or has a name that formulas cannot.
    """
    table = tables.get("parameters") if isinstance(tables, dict) else None
    token = _known.set(None if table is None else MappingProxyType(values(table, inputs)))
    try:
        yield
    finally:
        _known.reset(token)


def refuse_keys(tables: Any, keys: Iterable[str]) -> None:
    """Raise ModelError if a key of a file stands below its table of parameters: no formula names it."""
    table = tables.get("parameters") if isinstance(tables, dict) else None
    taken = [name for name in table if name in keys] if isinstance(table, dict) else []
    used = set(WORD.findall(" ".join(_texts(tables)))) if taken else set()
    for name in taken:
        if name not in used:
            hint = "it belongs at the top, above the first table; else give the parameter another name"
            raise ModelError(f"parameters.{name}", "is a key of the file, and no formula names it", hint)


def _texts(tables: Any) -> Iterator[str]:
    """All texts of a file but its keys."""
    if isinstance(tables, str):
        yield tables
    elif isinstance(tables, dict | list):
        for part in tables.values() if isinstance(tables, dict) else tables:
            yield from _texts(part)


def values(table: Any, inputs: Mapping[str, float] = MappingProxyType({})) -> dict[str, float]:
    """Numbers of a table ``[parameters]``; a formula may name those above it."""
    if not isinstance(table, dict):
        raise ModelError("parameters", f"must be a table, is {checks.shown(table)} ({type(table).__name__})")
    found: dict[str, float] = {}
    for name, item in table.items():
        where = f"parameters.{name}"
        if not NAME.fullmatch(name) or name in TAKEN:
            hint = "letters, digits and _, no letter of t, x, y, z, vx, vy, vz alone and no function"
            raise ModelError(where, "has a name that cannot stand in a formula", hint)
        if name in inputs:
            raise ModelError(where, "is the name of an input too", "give one of them another name")
        found[name] = value(item, where, found) if isinstance(item, str) else checks.number(item, where)
    return found


def value(text: str, where: str, known: Mapping[str, float]) -> float:
    """Number that a formula of parameters gives.

    Raises
    ------
    ModelError
        It is none, names something else, or its value is not finite.
    """
    number = Expression(text, where, tuple(known)).at(known)
    return checks.number(number, where)


def kind_of(annotation: Any, metadata: list[Any]) -> str:
    """What a field takes: "number", "whole" numbers, "formula", "named", both of which have formulas of time,
    or "other", where no parameter can stand.
    """
    tables = "model_fields"  # their fields have kinds of their own
    found = [leaf for leaf in leaves(annotation) if not hasattr(leaf, tables)]
    if any(leaf is Any for leaf in found):
        return "named" if any(isinstance(mark, Naming) for mark in metadata) else "formula"
    numbers = [leaf for leaf in found if leaf is not type(None) and get_origin(leaf) is not Literal]
    if not numbers or any(leaf is not int and leaf is not float for leaf in numbers):
        return "other"
    return "number" if any(leaf is float for leaf in numbers) else "whole"


def words_of(annotation: Any) -> tuple[Any, ...]:
    """Words that may stand in a field instead of a number, such as "auto"."""
    return tuple(x for leaf in leaves(annotation) if get_origin(leaf) is Literal for x in get_args(leaf))


def resolved(given: Any, kind: str) -> Any:
    """What a field of this kind is given, with numbers in place of parameters.

    A text in a field of numbers is a formula of parameters. In a field that takes formulas of time, names of
    parameters become their values. Files without parameters are left as they are.

    Raises
    ------
    ModelError
        A formula names what is no parameter, or its value is not finite; ``where`` is inside the field.
    """
    known = _known.get()
    if known is None or kind == "other" or (kind == "named" and isinstance(given, str)):
        return given
    if kind in ("formula", "named"):
        return _mixed(given, "", known)
    return _numbers(given, "", known, whole=kind == "whole")


def leaves(annotation: Any) -> Iterator[Any]:
    """Types of which an annotation is made; what it may hold in lists counts as well."""
    origin = get_origin(annotation)
    if origin is Annotated:
        yield from leaves(get_args(annotation)[0])
    elif origin in (list, tuple, Union, types.UnionType):
        for part in get_args(annotation):
            yield from leaves(part)
    else:
        yield annotation


def _numbers(given: Any, where: str, known: Mapping[str, float], whole: bool) -> Any:
    if isinstance(given, list):
        return [_numbers(part, f"{where}[{k}]", known, whole) for k, part in enumerate(given)]
    if not isinstance(given, str):
        return given
    number = value(given, where, known)
    return int(number) if whole and number.is_integer() else number


def _mixed(given: Any, where: str, known: Mapping[str, float]) -> Any:
    """Numbers for formulas of parameters alone, and formulas of the rest with their values."""
    if isinstance(given, list):
        return [_mixed(part, f"{where}[{k}]", known) for k, part in enumerate(given)]
    if isinstance(given, dict):
        return {key: _mixed(part, f"{where}.{key}", known) for key, part in given.items()}
    if not isinstance(given, str) or not known.keys() & set(WORD.findall(given)):
        return given
    text = WORD.sub(lambda word: f"({known[word[0]]!r})" if word[0] in known else word[0], given)
    try:
        return value(given, where, known)
    except ModelError:  # it depends on time, or is wrong: who reads it tells
        return text
