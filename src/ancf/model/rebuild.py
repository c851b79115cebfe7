"""A model from plain data: the items of a model file, and all of what ``Model.to_dict`` gave."""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any, Protocol

from ..errors import ModelError
from . import checks
from .bodies.beam import Beam
from .bodies.layout import placed_beam
from .bodies.rigid import IN_FLUID, Body, make_point_mass, make_rigid_body
from .describe import VELOCITIES, fields_of, other, section_of
from .functions.function import Missing, TimeFunction
from .functions.inputs import Input, named
from .kinds import GROUPS, SURROUNDINGS, by_word, kind_of
from .surroundings.velocity_field import VelocityField

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

BODIES = ("beam", "point_mass", "rigid_body")


class Located(Protocol):
    """A Model, as far as items are added to it."""

    inputs: dict[str, Input]

    def located(self, place: str) -> AbstractContextManager[None]:
        """Within this context errors speak of ``place``."""
        ...


class Table:
    """A table of a description; what it lacks is an error with its place."""

    def __init__(self, given: object, where: str) -> None:
        if not isinstance(given, Mapping):
            raise ModelError(where, f"must be a table, is {checks.shown(given)}")
        self.given, self.where = given, where

    def take(self, key: str) -> Any:
        """The value of a key that must be there."""
        if key not in self.given:
            raise ModelError(f"{self.where}.{key}", "is missing in the description")
        return self.given[key]

    def tables(self, key: str) -> Iterator[Table]:
        """The tables of a list, none where there is no such list."""
        given = self.given.get(key, [])
        if not isinstance(given, list | tuple):
            raise ModelError(key, f"must be a list of tables, is {checks.shown(given)}")
        return (Table(item, f"{key}[{k}]") for k, item in enumerate(given))


def bodies(plain: Table) -> Iterator[tuple[Body, str]]:
    """Bodies of a description, one after the other, with their places."""
    for table in plain.tables("bodies"):
        yield _body(table), table.where


def _body(table: Table) -> Body:
    kind, where = checks.choice(table.take("type"), f"{table.where}.type", BODIES), table.where
    name, motion = checks.text(table.take("name"), f"{where}.name"), Table(table.take("motion"), where)
    body: Body
    in_fluid = [table.given.get(key, 0.0) for key in IN_FLUID]
    if kind == "beam":
        body = _beam(table, name)
    elif kind == "point_mass":
        body = make_point_mass(where, name, table.take("at"), table.take("mass"), *in_fluid)
    else:
        given = (table.take(key) for key in ("at", "mass", "inertia", "axes"))
        body = make_rigid_body(where, name, *given, *in_fluid)
    keys = ("velocity",) if kind == "point_mass" else ("velocity", "angular_velocity", "about")
    more = [key for key in VELOCITIES if key in motion.given]
    body.set_motion(**{key: motion.take(key) for key in (*keys, *more)})
    return body


def _beam(table: Table, name: str) -> Beam:
    section = Table(table.take("section"), f"{table.where}.section")
    try:
        made = section_of(dict(section.given))
    except KeyError as error:
        raise ModelError(f"{section.where}.{error.args[0]}", "is missing in the description") from None
    except ModelError as error:
        raise ModelError(
            section.where + error.where.removeprefix("Section"), error.what, error.hint
        ) from None
    return placed_beam(table.where, name, made, table.take, table.given)


def items(model: Any, plain: Table) -> None:
    """Add surroundings, then supports, loads and connections of a description: some name a surface."""
    for group in SURROUNDINGS:
        for k, table in enumerate(plain.tables(group)):
            add_surrounding(model, group, k, _arguments(table))
    for group in GROUPS:
        for k, table in enumerate(plain.tables(group)):
            add_item(model, group, k, table.take("type"), _arguments(table))


def _arguments(table: Table) -> dict[str, Any]:
    """Arguments of the method; Python functions that a description could not keep are missing ones."""
    given = {key: value for key, value in table.given.items() if key != "type"}
    functions = {key: Missing.of(value) for key, value in given.items() if key != "name"}
    return given | {key: value for key, value in functions.items() if value is not None}


def missing(item: Any) -> list[tuple[str, str]]:
    """Its name and that of each Python function which a description could not keep."""
    given = (getattr(item, field.name) for field in fields(item))
    found = [value.missing for value in given if isinstance(value, TimeFunction | VelocityField)]
    return [(item.name, missing) for missing in found if missing]


def add_item(model: Located, group: str, number: int, word: str, given: Mapping[str, Any]) -> None:
    """Add a support, load or connection by its word in files and the arguments of its method.

    Raises
    ------
    ModelError
        There is no such kind, an argument is missing, unknown or wrong; ``where`` is ``loads[2].force``.
    """
    kinds, where = by_word(group), f"{group}[{number}]"
    if not isinstance(word, str) or word not in kinds:
        what = f"is {checks.shown(word)}, there are: {', '.join(kinds)}"
        hint = checks.nearest(word, kinds) or "a kind of your own is registered in ancf.model.kinds"
        raise ModelError(f"{where}.type", what, hint)
    _add(model, kinds[word].method, where, word, given)


def add_surrounding(model: Located, group: str, number: int, given: Mapping[str, Any]) -> None:
    """Add a fluid, a ground or a surface by the arguments of its method; errors as of :func:`add_item`."""
    kind = SURROUNDINGS[group]
    _add(model, kind.method, f"{group}[{number}]", kind.word, given)


def added_again(model: Any, old: Any, new: Any, where: str) -> None:
    """Raise ModelError, of ``where``, if the method of an item does not accept it beside all others.

    Parameters
    ----------
    model : Model
        With the item as it was. It stays as it is.
    old, new : object
        Item of the model, and the same with another number.
    """
    bare = model.snapshot()
    group = next(key for key in (*GROUPS, *SURROUNDINGS) if any(one is old for one in getattr(bare, key)))
    setattr(bare, group, [one for one in getattr(bare, group) if one is not old])
    plain = fields_of(new) if group in SURROUNDINGS else other(new, kind_of(new))
    try:
        if group in SURROUNDINGS:
            add_surrounding(bare, group, 0, _arguments(Table(plain, where)))
        else:
            add_item(bare, group, 0, plain["type"], _arguments(Table(plain, where)))
    except ModelError as error:
        raise ModelError(where, error.what, error.hint) from None


def _add(model: Located, method: str, where: str, word: str, given: Mapping[str, Any]) -> None:
    add = getattr(model, method)
    try:
        inspect.signature(add).bind(**given)
    except TypeError as error:
        raise ModelError(where, f"{word}: {error}") from None
    first = {item.name: item.value for item in model.inputs.values()}
    with model.located(where), named(first):
        add(**given)
