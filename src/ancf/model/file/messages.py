"""One message per problem of a model file: its path in the file, what is wrong, what to do."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import Any, get_args, get_origin

from pydantic import ValidationError

from ...errors import ModelError
from ..checks import ALL, listed, nearest, shown
from ..functions.expression import QUANTITY
from ..kinds import GROUPS
from ..other_words import argument_of
from .entries import NESTED, TAGGED, FileEntry
from .fields import Entry
from .parameters import leaves

MOST_LINES = 10
#: Tables that a message names in which a key is known.
MOST_HOMES = 3
WANTED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "string_type": "text",
    "bool_type": "true or false",
    "list_type": "a list",
    "dict_type": "a table",
    "model_type": "a table",
    "finite_number": "a finite number",
}
#: Kinds of bodies, by what they may be called; "" is the default.
BODIES_CALLED = {
    **dict.fromkeys(("beam", "cable", "rope", "line"), ""),
    **dict.fromkeys(("point_mass", "mass"), "point_mass"),
    "rigid_body": "rigid_body",
}
#: What pydantic names the kinds of one value by, behind its place.
KINDS = ("float", "int", "str", "bool")
Tables = Callable[[tuple[int | str, ...]], type[Entry]]
BOUNDS = {"greater_than": ("gt", ">"), "greater_than_equal": ("ge", ">="), "less_than": ("lt", "<")}


def combined(problems: list[ModelError], source: str) -> ModelError:
    """One error out of all: itself when alone, otherwise a list with one line each."""
    if len(problems) == 1:
        return problems[0]
    lines = [f"\n  {problem}" for problem in problems[:MOST_LINES]]
    if len(problems) > MOST_LINES:
        lines.append(f"\n  and {len(problems) - MOST_LINES} more")
    return ModelError(source, f"{len(problems)} problems:" + "".join(lines))


def beside(problem: ModelError, source: str) -> ModelError:
    """The error with its file before its place: that of a file which stands beside another one."""
    if problem.where == source:
        return problem
    return ModelError(f"{source}: {problem.where}", problem.what, problem.hint)


def of_validation(error: ValidationError, tables: Tables | None = None) -> list[ModelError]:
    """ModelErrors out of what pydantic found; `tables` gives the table at a place, default a model file's."""
    entry_at = _entry if tables is None else tables
    found: dict[Any, list[dict[str, Any]]] = {}
    for k, detail in enumerate(error.errors(include_url=False)):
        *above, last = detail["loc"] or ("",)
        found.setdefault(tuple(above) if last in KINDS else k, []).append(dict(detail))
    return [_of_details(one, entry_at) for one in found.values()]


def _of_details(details: list[dict[str, Any]], entry_at: Tables) -> ModelError:
    """One message of what pydantic says of one value."""
    several = len(details) > 1 and {detail["type"] for detail in details} <= WANTED.keys()
    return _of_kinds(details) if several else _of_detail(details[0], entry_at)


def _of_kinds(details: list[dict[str, Any]]) -> ModelError:
    """One message of a value that is of none of the kinds which may stand there."""
    given, where = details[0]["input"], place(details[0]["loc"][:-1])
    kinds = [WANTED[detail["type"]] for detail in details]
    words = [WANTED["finite_number"]] if WANTED["finite_number"] in kinds else [*dict.fromkeys(kinds)]
    return ModelError(where, f"must be {' or '.join(words)}, is {shown(given)} ({type(given).__name__})")


def place(parts: tuple[int | str, ...]) -> str:
    """Path in the notation of the file: ``bodies[2].section.EA``."""
    text = ""
    for part in parts:
        if isinstance(part, int):
            text += f"[{part}]"
        elif not re.fullmatch(r"<\w+>", part):
            text += "." + (part if re.fullmatch(r"[\w-]+", part) else f'"{part}"')
    return text.removeprefix(".")


def _of_detail(detail: dict[str, Any], entry_at: Tables) -> ModelError:
    kind, where, given = detail["type"], place(detail["loc"]) or "the file", detail["input"]
    context = detail.get("ctx", {})
    if unit := _unit_beside(detail, entry_at):
        return ModelError(where, f"is {shown(given)}, must be a number in {unit}", "give the number alone")
    if kind == "list_type" and _of_tables(_field(detail, entry_at)) and isinstance(given, dict):
        what = f"must be a list of tables, is {shown(given)}"
        return ModelError(where, what, f"a table of the list begins with [[{where}]], in double brackets")
    if kind == "model":
        return ModelError(where + context["place"], context["what"], context["hint"])
    if kind == "wrong_kind":
        return _wrong_kind(where, given, context["key"], context["allowed"].split())
    if kind == "extra_forbidden":
        key, allowed = str(detail["loc"][-1]), list(entry_at(detail["loc"][:-1]).model_fields)
        at_top = entry_at(()) is FileEntry and len(detail["loc"]) == 1
        hint = elsewhere(key, entry_at(()), given) or (_kind_called(key) if at_top else "")
        hint = hint or nearest(key, allowed) or argument_of("", key, allowed)
        return ModelError(where, f"unknown key, allowed: {listed(allowed, 30)}", hint)
    if kind == "list_type" and (field := _field(detail, entry_at)) is not None:
        what, _ = _of_value(kind, given, context, detail["msg"])
        return ModelError(where, what, (field.description or "").rstrip("."))
    if kind == "missing":
        field = _field(detail, entry_at)
        said = "" if field is None else (field.description or "").rstrip(".") + _as_table(field, where)
        return ModelError(where, "is missing", said)
    return ModelError(where, *_of_value(kind, given, context, detail["msg"]))


def elsewhere(key: str, top: type[Entry], given: Any = None) -> str:
    """Where a key that a table does not have is known in such a file; "" if nowhere, or all over it."""
    homes = _homes(top).get(key, [])
    if "" in homes or (isinstance(given, dict) and key in top.model_fields):  # a table in a line
        return f'"{key}" belongs at the top of the file, above the first table'
    return f'"{key}" is a key of {" and ".join(homes)}' if 0 < len(homes) <= MOST_HOMES else ""


def _kind_called(key: str) -> str:
    """How a table is written that was called by its kind, ``hinges`` or ``pin``; "" if it is of none."""
    body = next(
        (kind for word, kind in BODIES_CALLED.items() if key.lower() in (word, *_plurals(word))), None
    )
    if body is not None:
        return f'[[bodies]] with type = "{body}"' if body else "[[bodies]]"
    for group, kinds in GROUPS.items():
        if any(key.lower() in (kind.word, f"{kind.word}s") for kind in kinds):
            return f'[[{group}]] with type = "{key.lower().removesuffix("s")}"'
    return ""


def _plurals(word: str) -> tuple[str, ...]:
    return f"{word}s", f"{word}es", f"{word.removesuffix('y')}ies"


@cache
def _homes(top: type[Entry]) -> dict[str, list[str]]:
    """Tables of a kind of file that have a key, as they begin, by the key; "" is the file itself."""
    found: dict[str, list[str]] = {}
    for name, field in top.model_fields.items():
        named = get_origin(field.annotation) is dict
        inside = get_args(field.annotation)[1] if named else field.annotation
        title = f"[{name}.NAME]" if named else f"[[{name}]]" if _has_list(inside) else f"[{name}]"
        own = {key for entry in leaves(inside) for key in getattr(entry, "model_fields", {})}
        # the name of a file may stand for tables
        plain = not own or str in leaves(inside)
        found.setdefault(name, []).extend([""] if plain else [])
        for key in own:
            found.setdefault(key, []).append(title)
    return found


def _has_list(annotation: Any) -> bool:
    return get_origin(annotation) is list or any(map(_has_list, get_args(annotation)))


def _field(detail: dict[str, Any], entry_at: Tables) -> Any:
    """The field at the place of a problem; None if it is inside of one."""
    *above, last = detail["loc"] or ("",)
    return entry_at(tuple(above)).model_fields.get(str(last))


def _as_table(field: Any, where: str) -> str:
    """Of a field that is a table with keys of its own how it is written, and what it needs."""
    table = field.annotation
    if not (isinstance(table, type) and issubclass(table, Entry)):
        return ""
    needed = [name for name, one in table.model_fields.items() if one.is_required()]
    return f": a table [{where}]" + (f" with {listed(needed)}" if needed else "")


def _unit_beside(detail: dict[str, Any], entry_at: Tables) -> str:
    """Unit of the number that a field takes and was given with a unit, "" if that is not what is wrong."""
    given, field = detail["input"], _field(detail, entry_at)
    if field is None or detail["type"] not in ("float_type", "model") or not isinstance(given, str):
        return ""
    if "product" in detail.get("ctx", {}).get("hint", ""):  # of a parameter
        return ""
    unit = re.search(r"\[([^\[\]]+)\]\.?$", field.description or "")
    return unit[1] if unit and QUANTITY.fullmatch(given.strip()) else ""


def _of_tables(field: Any) -> bool:
    """Whether a field is a list of tables."""
    return field is not None and any(hasattr(leaf, "model_fields") for leaf in leaves(field.annotation))


def _of_value(kind: str, given: Any, context: dict[str, Any], message: str) -> tuple[str, str]:
    if kind in WANTED:
        return f"must be {WANTED[kind]}, is {shown(given)} ({type(given).__name__})", ""
    if kind in BOUNDS:
        key, sign = BOUNDS[kind]
        return f"must be {sign} {context[key]:g}, is {given:g}", ""
    if kind == "literal_error":
        allowed = re.findall(r"'([^']*)'", context["expected"])
        return f"is {shown(given)}, must be one of {listed(allowed, ALL)}", nearest(given, allowed)
    if kind in ("too_short", "too_long"):
        wanted = context.get("min_length", context.get("max_length"))
        least = "at least " if wanted == 1 else ""
        return f"has {len(given)} entries, wanted {least}{wanted}", ""
    return f"{message}, is {shown(given)}", ""


def _wrong_kind(where: str, given: Any, key: str, allowed: list[str]) -> ModelError:
    if not isinstance(given, dict):
        also = "the name of a section or " if key == "shape" and "sections" not in where else ""
        return ModelError(where, f"must be {also}a table, is {shown(given)} ({type(given).__name__})")
    if key not in given:
        return ModelError(f"{where}.{key}", f"is missing, must be one of {listed(allowed, ALL)}")
    what = f"is {shown(given[key])}, must be one of {listed(allowed, ALL)}"
    return ModelError(f"{where}.{key}", what, nearest(given[key], allowed))


def _entry(parts: tuple[int | str, ...]) -> type[Entry]:
    entry: type[Entry] = FileEntry
    for part in parts:
        entry = TAGGED.get(str(part), NESTED.get(str(part), entry))
    return entry
