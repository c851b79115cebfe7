"""Paths to the values of a file, written as messages write them: ``bodies[2].section.EA``."""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

from ...errors import ModelError
from ..checks import listed, nearest, shown

#: A key, in quotation marks if it holds other characters, or the place in a list.
STEP = re.compile(r'\.?(?:"(?P<quoted>[^"]*)"|(?P<bare>[^.\[\]"=]+))|\[(?P<index>\d+)\]')


class PathError(ModelError):
    """A path that a file does not have."""


def changed(tables: dict[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Tables of a file with other values at some paths.

    Parameters
    ----------
    tables : dict
        What TOML of a model or line file gives; it is left as it is.
    values : mapping
        By path: keys with dots between them, places in lists in brackets, from 0. A table in a list may be
        called by its name instead: ``bodies.wire.elements``. A name of ``[parameters]`` may stand alone.

    Raises
    ------
    ModelError
        There is no such place; the message lists what is there.
    """
    if not values:
        return tables
    made = copy.deepcopy(tables)
    for path, value in values.items():
        _set(made, path, value)
    return made


def found(tables: dict[str, Any], path: str) -> Any:
    """The value at a path; errors as of :func:`changed`."""
    holder, step, _ = _place(tables, path)
    if isinstance(holder, dict) and step not in holder:
        raise _unknown(path, path, step, holder)
    return holder[step]


def assignment(text: str) -> tuple[str, Any]:
    """Path and value out of ``PATH=VALUE``; what is no value of TOML is a text.

    Raises
    ------
    ModelError
        There is no "=", or nothing on one of its sides.
    """
    path, sign, given = text.partition("=")
    path, given = path.strip(), given.strip()
    if not (path and sign and given):
        raise ModelError("--set", f"is {shown(text)}, must be PATH=VALUE", "such as sections.rope.EA=2e4")
    try:
        return path, tomllib.loads(f"value = {given}")["value"]
    except tomllib.TOMLDecodeError:
        return path, given


def assignments(texts: list[str] | None) -> dict[str, Any]:
    """Values by path out of all that ``--set`` was given.

    Raises
    ------
    ModelError
        One is no assignment, or a path stands twice.
    """
    made: dict[str, Any] = {}
    for text in texts or []:
        path, value = assignment(text)
        if path in made:
            raise ModelError("--set", f"gives {path} twice")
        made[path] = value
    return made


def _set(tables: dict[str, Any], path: str, value: Any) -> None:
    holder, step, _ = _place(tables, path)
    if isinstance(holder, dict) and isinstance(holder.get(step), dict | list) and _is_number(value):
        raise PathError(path, "is no number but a table or a list", _inside(holder[step]))
    holder[step] = value


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _place(tables: dict[str, Any], path: str) -> tuple[Any, Any, str]:
    """What holds the last step of a path, and that step; the holder is a table or a list that has it."""
    return [*walk(tables, path)][-1]


def walk(tables: dict[str, Any], path: str) -> Iterator[tuple[Any, Any, str]]:
    """What holds each step of a path, that step and the path of the holder; errors as of :func:`changed`."""
    steps = _steps(path)
    if len(steps) == 1 and steps[0] not in tables and steps[0] in _names(tables.get("parameters")):
        yield tables["parameters"], steps[0], "parameters"
        return
    here: Any = tables
    where = ""
    for k, step in enumerate(steps):
        last = k == len(steps) - 1
        if isinstance(here, list):
            step = _item(here, step, where, path)
        elif not isinstance(here, dict) or isinstance(step, int):
            raise PathError(path, f'"{where}" is {shown(here)}, there is nothing inside')
        elif step not in here and not (last and _may_be_default(step, where, here)):
            raise _unknown(path, where, step, here)
        yield here, step, where
        if not last:
            here, where = here[step], _joined(where, step)


def _steps(path: str) -> list[str | int]:
    made: list[str | int] = []
    place = 0
    for step in STEP.finditer(path):
        if step.start() != place or (not made and path[:1] in ".["):
            break
        place = step.end()
        made.append(int(step["index"]) if step["index"] else step["quoted"] or step["bare"] or "")
    if not made or place != len(path) or "" in made:
        hint = 'write it like sections.rope.EA, spans[3].length, connections."dropper 1".stiffness'
        raise PathError(path or '""', "is no path to a value of a file", hint)
    return made


def _item(items: list[Any], step: str | int, where: str, path: str) -> int:
    """Place in a list, also of the table with this name."""
    if isinstance(step, str):
        names = [item.get("name") if isinstance(item, dict) else None for item in items]
        if step in names:
            return names.index(step)
        known = [name for name in names if isinstance(name, str)]
        have = f"there are: {listed(known)}" if known else f"its entries have no names: {_count(items)}"
        raise PathError(path, f'"{where}" has no entry "{step}", {have}', nearest(step, known))
    if step >= len(items):
        raise PathError(path, f'"{where}" has {_count(items)}')
    return step


def _may_be_default(step: str, where: str, here: Mapping[str, Any]) -> bool:
    """Whether a key that is not in a table may be one with a default: who reads the file tells if it is."""
    if where:
        return where != "parameters"
    return not nearest(step, _names(here.get("parameters")))


def _count(items: list[Any]) -> str:
    return "1 entry, [0]" if len(items) == 1 else f"{len(items)} entries, [0] to [{len(items) - 1}]"


def _unknown(path: str, where: str, step: Any, here: Mapping[str, Any]) -> PathError:
    names = [*here] if where else [*here, *_names(here.get("parameters"))]
    inside = f'"{where}" has' if where else "the file has"
    return PathError(path, f'{inside} no "{step}", there are: {listed(names, 30)}', nearest(step, names))


def _inside(value: Any) -> str:
    if isinstance(value, list):
        return f"its entries are [0] to [{len(value) - 1}]" if value else ""
    return f"in it are: {listed(value)}"


def _names(table: Any) -> list[str]:
    return [*table] if isinstance(table, dict) else []


def _joined(where: str, step: str | int) -> str:
    if isinstance(step, int):
        return f"{where}[{step}]"
    key = step if re.fullmatch(r"[\w-]+", step) else f'"{step}"'
    return f"{where}.{key}" if where else key
