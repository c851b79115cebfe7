"""Surfaces as tables of a model file, one class for each shape, made from its parameters."""

from __future__ import annotations

from dataclasses import MISSING
from dataclasses import fields as fields_of
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias, Union

from pydantic import Discriminator, Field, Tag, create_model

from ..surfaces.shape import Shape
from ..surfaces.shapes import SHAPES
from . import fields

_TYPES: dict[str, Any] = {
    "positive": fields.Positive,
    "vector": fields.Vector,
    "direction": fields.Vector,
    "path": str,
    "points": list[fields.Vector],
    "triangles": list[Annotated[list[int], Field(min_length=3, max_length=3)]],
}


def _entry(word: str, shape: type[Shape]) -> type[fields.Entry]:
    rows: dict[str, Any] = {
        "name": (str, Field(description="Unique name.")),
        "shape": (Literal[word], Field(description="Shape of the surface.")),
    }
    for p, own in zip(shape.parameters, fields_of(shape), strict=True):
        kind, about = _TYPES[p.kind], f"{p.description} [{p.unit}]."
        if own.default is MISSING:
            rows[p.name] = (kind, Field(description=about))
        elif own.default is None:
            rows[p.name] = (kind | None, Field(None, description=about))
        else:
            default = list(own.default) if isinstance(own.default, tuple) else own.default
            rows[p.name] = (kind, Field(default, description=about))
    rows["on"] = (str | None, Field(None, description="Rigid body that carries it, default the ground."))
    says = (shape.__doc__ or "").partition("\n")[0]
    return create_model(f"{shape.__name__}Entry", __base__=fields.Entry, __doc__=says, **rows)


#: By the word of the shape.
ENTRIES = {word: _entry(word, shape) for word, shape in SHAPES.items()}


def _by_shape(value: Any) -> str | None:
    shape = value.get("shape") if isinstance(value, dict) else None
    return f"<surface {shape}>" if shape in ENTRIES else None


_KEY: dict[str, str | int | float] = {"key": "shape", "allowed": " ".join(ENTRIES)}
TAGGED: dict[str, type[fields.Entry]] = {f"<surface {word}>": entry for word, entry in ENTRIES.items()}
if TYPE_CHECKING:  # the shapes are known at run time alone
    AnySurface: TypeAlias = fields.Entry
else:
    AnySurface = Annotated[
        Union[tuple(Annotated[entry, Tag(tag)] for tag, entry in TAGGED.items())],  # noqa: UP007
        Discriminator(_by_shape, "wrong_kind", "wrong kind", _KEY),
    ]
