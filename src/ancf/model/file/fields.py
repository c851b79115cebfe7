"""Kinds of values in a model file, as pydantic sees them and as the JSON Schema shows them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

from ancf.errors import ModelError
from ancf.model import checks
from ancf.model.functions import TimeFunction
from ancf.model.settings import INTEGRATORS, IntegratorSettings


class Entry(BaseModel):
    """A table: strict types, no unknown keys, finite numbers."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False, frozen=True)

    def given(self, *without: str) -> dict[str, Any]:
        """Fields that the file gives, but `type` and those named."""
        keys = self.model_fields_set - {"type", *without}
        return {key: getattr(self, key) for key in type(self).model_fields if key in keys}


def _checked(check: Callable[[Any], Any]) -> AfterValidator:
    def validate(value: Any) -> Any:
        try:
            check(value)
        except ModelError as error:
            place = error.where.removeprefix("integrator")
            context = {"place": place, "what": error.what, "hint": error.hint}
            raise PydanticCustomError("model", "{what}", context) from None
        return value

    return AfterValidator(validate)


def _function_schema(plain: dict[str, Any], row: dict[str, Any]) -> WithJsonSchema:
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
        "properties": {"t": times, "value": values},
        "required": ["t", "value"],
        "additionalProperties": False,
    }
    return WithJsonSchema({"anyOf": [plain, table]})


def _vector_schema(items: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": items, "minItems": 3, "maxItems": 3}


_NUMBER = {"type": "number"}
_TERM = {"anyOf": [_NUMBER, {"type": "string"}]}
_INTEGRATOR_TABLE = {
    "type": "object",
    "properties": {
        "type": {"enum": list(INTEGRATORS), "description": "Kind of integrator."},
        "rho_inf": {
            "type": "number",
            "minimum": 0,
            "maximum": 1,
            "description": "Spectral radius at infinite frequency, of generalized_alpha [-].",
        },
    },
    "required": ["type"],
    "additionalProperties": False,
}

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
Vector = Annotated[list[float], Field(min_length=3, max_length=3)]
ScalarFunction = Annotated[Any, _checked(lambda v: TimeFunction(v, 1, "")), _function_schema(_TERM, _NUMBER)]
VectorFunction = Annotated[
    Any,
    _checked(lambda v: TimeFunction(v, 3, "")),
    _function_schema(_vector_schema(_TERM), _vector_schema(_NUMBER)),
]
PointOrPosition = Annotated[
    Any,
    _checked(lambda v: None if isinstance(v, str) else checks.vector(v, "")),
    WithJsonSchema({"anyOf": [{"type": "string"}, _vector_schema(_NUMBER)]}),
]
Integrator = Annotated[
    Any,
    _checked(IntegratorSettings.of),
    WithJsonSchema({"anyOf": [{"enum": list(INTEGRATORS)}, _INTEGRATOR_TABLE]}),
]
PointLabel = Annotated[str, Field(description='A point: "beam.start", "beam.end" or "beam.at(0.5)", x in m.')]
ItemName = Annotated[
    str | None, Field(description="Unique name of this item; made from the point if not given.")
]
