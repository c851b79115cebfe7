"""Kinds of values in a model file, as pydantic sees them and as the JSON Schema shows them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationInfo,
    WithJsonSchema,
    field_validator,
)
from pydantic_core import PydanticCustomError

from ...errors import ModelError
from .. import checks
from ..bodies.rigid import as_inertia
from ..elements import KINDS
from ..functions.function import TimeFunction
from ..integrators import INTEGRATORS, integrator_of, table_schema
from ..loads.state_function import check_force
from .parameters import Naming, kind_of, resolved, words_of

if TYPE_CHECKING:  # the names are known at run time alone
    ElementName: TypeAlias = str
    StrainName: TypeAlias = str
else:
    ElementName = Literal[tuple(KINDS)]
    StrainName = Literal[tuple(dict.fromkeys(name for kind in KINDS.values() for name in kind.strains))]


class Entry(BaseModel):
    """A table: strict types, no unknown keys, finite numbers or formulas of parameters."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False, frozen=True, defer_build=True)

    @field_validator("*", mode="before")
    @classmethod
    def _without_parameters(cls, value: Any, info: ValidationInfo) -> Any:
        """Numbers in place of the parameters of the file."""
        kind, words = _kind(cls, info.field_name or "")
        if isinstance(value, str) and value in words:
            return value
        try:
            return resolved(value, kind)
        except ModelError as error:
            raise refused(error, error.where) from None

    def given(self, *without: str) -> dict[str, Any]:
        """Fields that the file gives, but `type` and those named."""
        keys = self.model_fields_set - {"type", *without}
        return {key: getattr(self, key) for key in type(self).model_fields if key in keys}


@cache
def _kind(entry: type[Entry], name: str) -> tuple[str, tuple[Any, ...]]:
    field = entry.model_fields[name]
    return kind_of(field.annotation, field.metadata), words_of(field.annotation)


def refused(error: ModelError, place: str) -> PydanticCustomError:
    """A ModelError as pydantic hands it on; `place` is inside the field."""
    context = {"place": place, "what": error.what, "hint": error.hint}
    return PydanticCustomError("model", "{what}", context)


def checked(check: Callable[[Any], Any]) -> AfterValidator:
    """Validator whose errors are those of a check that raises ModelError."""

    def validate(value: Any) -> Any:
        try:
            check(value)
        except ModelError as error:
            raise refused(error, error.where.removeprefix("integrator")) from None
        return value

    return AfterValidator(validate)


def of_schemas(plain: dict[str, Any], row: dict[str, Any]) -> dict[str, Any]:
    """JSON Schema of a function of time: constant or formulas, or a table with such rows."""
    times = {
        "type": "array",
        "items": {"type": "number"},
        "minItems": 2,
        "description": "Increasing times [s].",
    }
    values = {
        "type": "array",
        "items": row,
        "minItems": 2,
        "description": "Values at the times [as the key].",
    }
    table = {
        "type": "object",
        "properties": {"t": times, "value": values, "unit": _UNIT, **_HOW},
        "required": ["t", "value"],
        "additionalProperties": False,
    }
    single = row.get("type") == "number"
    file = _of_file(single)
    if single:
        return {"anyOf": [plain, table, file]}
    lone = {**table, "properties": {**table["properties"], "value": {**values, "items": _NUMBER}}}  # type: ignore[dict-item]
    parts = vector_schema({"anyOf": [*plain["items"]["anyOf"], lone, _of_file(True)]})
    return {"anyOf": [parts, table, file]}


_UNIT: dict[str, Any] = {
    "type": "string",
    "description": "Unit of the values, such as mm or kN; default as the key.",
}
#: How a series is followed.
_HOW: dict[str, Any] = {
    "interpolation": {
        "enum": ["linear", "spline"],
        "description": "Straight lines or a cubic spline [-]; default of a table linear, of a file spline.",
    },
    "cutoff": {
        "type": "number",
        "exclusiveMinimum": 0,
        "description": "Frequency of which a smoothing spline keeps the 0.71th part [Hz].",
    },
    "relative": {"type": "boolean", "description": "Count from the value at the first time [-]."},
    "integrate": {"type": "boolean", "description": "Values are speeds, the series is their way [-]."},
    "ramp": {
        "type": "number",
        "exclusiveMinimum": 0,
        "description": "Time in which it sets in smoothly, from t = 0 or the first time on [s].",
    },
}


def _of_file(single: bool) -> dict[str, Any]:
    """JSON Schema of a column of a CSV file, or of three."""
    name = {"type": "string"}
    column = name if single else {"type": "array", "items": name, "minItems": 3, "maxItems": 3}
    return {
        "type": "object",
        "properties": {
            "csv": {"type": "string", "description": "CSV file with a head, beside the model file."},
            "column": {**column, "description": "Name of the column, or three of them."},
            "unit": {**_UNIT, "description": "Its unit, such as mm or kN; default the head's."},
            "time": {"type": "string", "description": "Column of the times; default t, time or the first."},
            "time_unit": {"type": "string", "description": "Unit of the times, such as ms; default s."},
            **_HOW,
        },
        "required": ["csv", "column"],
        "additionalProperties": False,
    }


def _function_schema(plain: dict[str, Any], row: dict[str, Any]) -> WithJsonSchema:
    return WithJsonSchema(of_schemas(plain, row))


def vector_schema(items: dict[str, Any]) -> dict[str, Any]:
    """JSON Schema of three of them."""
    return {"type": "array", "items": items, "minItems": 3, "maxItems": 3}


_NUMBER = {"type": "number"}
_TERM = {"anyOf": [_NUMBER, {"type": "string"}]}

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
#: Number of elements; tags like these are no part of a place.
ElementCount = Annotated[
    Annotated[int, Field(ge=1), Tag("<number>")] | Annotated[Literal["auto"], Tag("<auto>")],
    Discriminator(lambda given: "<auto>" if given == "auto" else "<number>"),
]
Vector = Annotated[list[float], Field(min_length=3, max_length=3)]
Coefficients = Annotated[list[NonNegative], Field(min_length=2, max_length=2)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Curve = Annotated[list[Pair], Field(min_length=2)]
Matrix = Annotated[list[Vector], Field(min_length=3, max_length=3)]
Line = Annotated[list[Vector], Field(min_length=2, max_length=2)]
ScalarFunction = Annotated[Any, checked(lambda v: TimeFunction(v, 1, "")), _function_schema(_TERM, _NUMBER)]
VectorFunction = Annotated[
    Any,
    checked(lambda v: TimeFunction(v, 3, "")),
    _function_schema(vector_schema(_TERM), vector_schema(_NUMBER)),
]
ForceFunction = Annotated[
    Any,
    checked(lambda v: check_force(v, "")),
    _function_schema(vector_schema(_TERM), vector_schema(_NUMBER)),
]
PointOrPosition = Annotated[
    Any,
    Naming(),
    checked(lambda v: None if isinstance(v, str) else checks.vector(v, "")),
    WithJsonSchema({"anyOf": [{"type": "string"}, vector_schema(_NUMBER)]}),
]
Inertia = Annotated[
    Any,
    checked(lambda v: as_inertia(v, "")),
    WithJsonSchema({"anyOf": [vector_schema(_NUMBER), vector_schema(vector_schema(_NUMBER))]}),
]
Integrator = Annotated[
    Any,
    Naming(),
    checked(integrator_of),
    WithJsonSchema({"anyOf": [{"enum": list(INTEGRATORS)}, table_schema()]}),
]
Parameters = Annotated[
    dict[str, float | str],
    Field(
        description="Numbers, or formulas of those above, by names that may stand for numbers in the file "
        "[of what they stand for]."
    ),
]
PointLabel = Annotated[
    str,
    Field(
        description='A point: "beam.start", "beam.end", "beam.at(0.5)", or in the cross-section of a beam '
        '"beam.at(0.5, 0.01, 0)"; a point mass by its name; a rigid body "hub.centre", "hub.at(0.1, 0, 0)"; '
        "x, y, z in m."
    ),
]
ItemName = Annotated[
    str | None, Field(description="Unique name of this item; made from the point if not given.")
]
