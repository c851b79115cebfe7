"""Loads that depend on position, velocity and time: their kinds from a declaration of the parameters.

The kernels of a law are one file of ``ancf.loads``; method, table in files, description, checks and row in
printed tables follow from its parameters.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, make_dataclass
from inspect import Parameter as Argument
from inspect import Signature
from typing import Any, Literal

import numpy as np

from ...errors import ModelError
from .. import checks
from ..functions.function import TimeFunction
from ..kind import Kind, Look, Push
from ..points import Point
from ..sheets import value
from ..tables import number, numbers

#: Kinds of parameters: the check of what is given, and the type of files in ``ancf.model.file.fields``.
_TYPES: dict[str, tuple[Callable[[Any, str], Any], str]] = {
    "positive": (checks.positive, "Positive"),
    "non-negative": (checks.non_negative, "NonNegative"),
    "vector": (checks.vector, "Vector"),
    "direction": (checks.direction, "Vector"),
    "function": (lambda given, where: TimeFunction(given, 1, where), "ScalarFunction"),
    "vector function": (lambda given, where: TimeFunction(given, 3, where), "VectorFunction"),
}


@dataclass(frozen=True)
class Parameter:
    """A parameter of a law.

    Parameters
    ----------
    name : str
        Key in the method and in files.
    kind : str
        "positive", "non-negative", "vector", "direction" (of length 1 after the check), or "function" and
        "vector function" of time: the latter two become inputs of the kernels.
    unit : str
        Such as "N s^2/m^2", or "-".
    description : str
    default : optional
        What a user may leave out; None: it must be given.
    """

    name: str
    kind: str
    unit: str
    description: str
    default: Any = None

    @property
    def is_function(self) -> bool:
        """Whether it is a function of time."""
        return self.kind.endswith("function")

    def check(self, given: Any, where: str) -> Any:
        """The clean value; ModelError if it is wrong."""
        if given is None:
            raise ModelError(f"{where}.{self.name}", f"must be given: {self.description} [{self.unit}]")
        made = _TYPES[self.kind][0](given, f"{where}.{self.name}")
        if self.is_function:
            made.check_unit(self.unit)
        return made

    def shown(self, given: Any) -> str:
        """What a table says of its value."""
        unit = "" if self.unit == "-" else self.unit
        if isinstance(given, TimeFunction):
            text = value(given, unit).strip()
        else:
            text = f"{numbers(given) if isinstance(given, np.ndarray) else number(given)} {unit}".strip()
        return f"{self.name} = {text}"


#: Classes of the items by the word of their kind: no module has them by name, where pickle would look.
_items: dict[str, Any] = {}


def _again(word: str, values: list[Any]) -> Any:
    """An item that was pickled."""
    return _items[word](*values)


def law(
    word: str,
    noun: str,
    *parameters: Parameter,
    says: str,
    look: Look | None = None,
    push: Push | None = None,
    check: Callable[[str, Any], None] | None = None,
) -> Kind:
    """Record of a load at a point whose force depends on position, velocity and time.

    Parameters
    ----------
    word : str
        Its ``type`` in files, the method ``add_<word>`` and the module with its kernels,
        ``ancf.loads.<word>``.
    noun : str
        In tables and messages.
    *parameters : Parameter
    says : str
        What it is, one sentence: the docstring of the method and of the table.
    look : Look, optional
        Marker in pictures.
    push : Push, optional
        Arrow in pictures.
    check : function, optional
        ``check(where, item)`` raises ModelError if the parameters do not fit the point.
    """
    title = "".join(part.capitalize() for part in word.split("_"))
    names = [("name", str), ("point", Point), *((p.name, Any) for p in parameters)]
    item: Any = make_dataclass(title, names, frozen=True, slots=True, eq=False)
    item.__module__, item.__doc__ = __name__, says
    item.__reduce__ = lambda made: (_again, (word, [getattr(made, key) for key, _ in names]))
    _items[word] = item

    def add(model: Any, point: Any, *given: Any, name: str | None = None, **named: Any) -> Any:
        bound = signature.bind(point, *given, name=name, **named)
        where, label, clean = model.named_point(f"add_{word}", noun, point, name)
        bound.apply_defaults()
        values = [p.check(bound.arguments[p.name], where) for p in parameters]
        made = item(label, clean, *values)
        if check is not None:
            check(where, made)
        return model.add_load(made)

    arguments = [Argument(p.name, Argument.POSITIONAL_OR_KEYWORD, default=p.default) for p in parameters]
    signature = Signature(
        [
            Argument("point", Argument.POSITIONAL_OR_KEYWORD),
            *arguments,
            Argument("name", Argument.KEYWORD_ONLY, default=None),
        ]
    )
    add.__name__, add.__doc__ = f"add_{word}", says
    whole: Any = add
    first = Argument("model", Argument.POSITIONAL_OR_KEYWORD)
    whole.__signature__ = Signature([first, *signature.parameters.values()])
    return Kind(
        item,
        word,
        noun,
        f"add_{word}",
        lambda: _entry(title, word, parameters, says),
        lambda made: ", ".join(p.shown(getattr(made, p.name)) for p in parameters),
        look=look,
        push=push,
        add=add,
        batch=word,
        inputs=lambda made: [getattr(made, p.name) for p in parameters if p.is_function],
    )


def _entry(title: str, word: str, parameters: tuple[Parameter, ...], says: str) -> Any:
    """Its table in a model file."""
    from pydantic import Field, create_model

    from ..file import fields

    rows: dict[str, Any] = {
        "type": (Literal[word], Field(description="Kind of load.")),
        "point": (fields.PointLabel, ...),
    }
    for p in parameters:
        about = f"{p.description}{', function of t' if p.is_function else ''} [{p.unit}]."
        kind = getattr(fields, _TYPES[p.kind][1])
        rows[p.name] = (
            kind,
            Field(description=about) if p.default is None else Field(p.default, description=about),
        )
    rows["name"] = (fields.ItemName, None)
    return create_model(f"{title}Entry", __base__=fields.Entry, __doc__=says, **rows)
