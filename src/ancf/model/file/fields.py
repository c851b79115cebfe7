"""Kinds of values in a model file, as pydantic sees them and as the JSON Schema shows them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

from ancf.errors import ModelError
from ancf.model import checks
from ancf.model.bodies import as_inertia
from ancf.model.elements import KINDS
from ancf.model.functions import TimeFunction
from ancf.model.settings import FORMULATIONS, INTEGRATORS, IntegratorSettings

if TYPE_CHECKING:  # the names are known at run time alone
    ElementName: TypeAlias = str
    StrainName: TypeAlias = str
else:
    ElementName = Literal[tuple(KINDS)]
    StrainName = Literal[tuple(dict.fromkeys(name for kind in KINDS.values() for name in kind.strains))]


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
        "formulation": {
            "enum": list(FORMULATIONS),
            "description": "How joints with multipliers are kept; trapezoidal has no index3.",
        },
        "stages": {"enum": [2, 3], "description": "Stages of radau: order 3 or 5 [-]."},
        "tolerance": {
            "type": "number",
            "minimum": 1e-12,
            "maximum": 0.1,
            "description": "Error of a step of radau, relative to the size of the model [-].",
        },
        "adaptive": {"type": "boolean", "description": "Whether radau chooses its steps [-]."},
        "min_step": {
            "type": "number",
            "exclusiveMinimum": 0,
            "description": "Smallest step of radau [s].",
        },
        "max_step": {
            "type": "number",
            "exclusiveMinimum": 0,
            "description": "Largest step of radau [s].",
        },
        "safety": {
            "type": "number",
            "exclusiveMinimum": 0,
            "maximum": 1,
            "description": "Part of the stable step that explicit may take [-].",
        },
        "check": {"type": "boolean", "description": "Whether explicit refuses unstable steps [-]."},
    },
    "required": ["type"],
    "additionalProperties": False,
}

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
Vector = Annotated[list[float], Field(min_length=3, max_length=3)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Matrix = Annotated[list[Vector], Field(min_length=3, max_length=3)]
Line = Annotated[list[Vector], Field(min_length=2, max_length=2)]
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
Inertia = Annotated[
    Any,
    _checked(lambda v: as_inertia(v, "")),
    WithJsonSchema({"anyOf": [_vector_schema(_NUMBER), _vector_schema(_vector_schema(_NUMBER))]}),
]
Integrator = Annotated[
    Any,
    _checked(IntegratorSettings.of),
    WithJsonSchema({"anyOf": [{"enum": list(INTEGRATORS)}, _INTEGRATOR_TABLE]}),
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
