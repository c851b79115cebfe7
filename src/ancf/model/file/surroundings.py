"""Fluids and grounds as tables of a model file."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, WithJsonSchema

from ..surroundings.grounds import height_of
from ..surroundings.gusts import Gusts
from ..surroundings.velocity_field import VelocityField
from ..surroundings.waves import SPECTRA, STRETCHINGS, Waves
from .fields import Entry, NonNegative, Positive, Vector, checked, of_schemas, vector_schema

_NUMBER = {"type": "number"}
_TERM = {"anyOf": [_NUMBER, {"type": "string"}]}
_PROFILE = {
    "type": "object",
    "properties": {
        "z": {"type": "array", "items": _NUMBER, "minItems": 2, "description": "Increasing heights [m]."},
        "velocity": {
            "type": "array",
            "items": vector_schema(_NUMBER),
            "minItems": 2,
            "description": "Velocities there [m/s].",
        },
    },
    "required": ["z", "velocity"],
    "additionalProperties": False,
}
Velocity = Annotated[
    Any,
    checked(lambda v: VelocityField(v, "")),
    WithJsonSchema({"anyOf": [of_schemas(vector_schema(_TERM), vector_schema(_NUMBER)), _PROFILE]}),
]


_WAVES = {
    "type": "object",
    "properties": {
        "spectrum": {"enum": list(SPECTRA), "description": "Kind of waves."},
        "height": {**_NUMBER, "exclusiveMinimum": 0, "description": "Height, of a sea significant [m]."},
        "period": {**_NUMBER, "exclusiveMinimum": 0, "description": "Period, of a sea of its peak [s]."},
        "gamma": {**_NUMBER, "minimum": 1, "description": "Peak enhancement of jonswap, default 3.3 [-]."},
        "seed": {"type": "integer", "minimum": 0, "description": "Of the random phases, default 1."},
        "components": {"type": "integer", "minimum": 1, "description": "Number of waves, default 100."},
        "phase": {**_NUMBER, "description": "Of a regular wave at x = y = 0, t = 0, default 0 [rad]."},
        "direction": {**_NUMBER, "description": "Of travel, from x towards y, default 0 [rad]."},
        "depth": {**_NUMBER, "exclusiveMinimum": 0, "description": "Of the water, default deep [m]."},
        "ramp": {**_NUMBER, "minimum": 0, "description": "Time in which they grow, default the period [s]."},
        "stretching": {"enum": list(STRETCHINGS), "description": "How the profile follows the surface."},
    },
    "required": ["spectrum", "height", "period"],
    "additionalProperties": False,
}
Sea = Annotated[Any, checked(lambda v: Waves(v, "")), WithJsonSchema(_WAVES)]
_GUSTS = {
    "type": "object",
    "properties": {
        "speed": {**_NUMBER, "exclusiveMinimum": 0, "description": "Mean speed of the wind [m/s]."},
        "deviation": {**_NUMBER, "minimum": 0, "description": "Standard deviation of the speed [m/s]."},
        "length": {**_NUMBER, "exclusiveMinimum": 0, "description": "Of the turbulence [m]."},
        "extent": {
            "type": "array",
            "items": _NUMBER,
            "minItems": 2,
            "maxItems": 2,
            "description": "From where to where along the line [m].",
        },
        "direction": {**_NUMBER, "description": "Of the wind, from x towards y, default 0 [rad]."},
        "line": {**vector_schema(_NUMBER), "description": "Direction of the line, default y [-]."},
        "spacing": {**_NUMBER, "exclusiveMinimum": 0, "description": "Of stations, default 5 [m]."},
        "decay": {**_NUMBER, "minimum": 0, "description": "Of the coherence, default 10 [-]."},
        "duration": {**_NUMBER, "exclusiveMinimum": 0, "description": "Until they repeat, default 600 [s]."},
        "step": {**_NUMBER, "exclusiveMinimum": 0, "description": "Of the table, default 0.1 [s]."},
        "ramp": {**_NUMBER, "minimum": 0, "description": "Time in which they grow, default 0 [s]."},
        "seed": {"type": "integer", "minimum": 0, "description": "Of the random numbers, default 1."},
    },
    "required": ["speed", "deviation", "length", "extent"],
    "additionalProperties": False,
}
Squalls = Annotated[Any, checked(lambda v: Gusts(v, "")), WithJsonSchema(_GUSTS)]


class FluidEntry(Entry):
    """A fluid everywhere, or between two heights."""

    name: str = Field(description="Unique name.")
    density: Positive = Field(description="Density [kg/m^3].")
    velocity: Velocity = Field(
        [0.0, 0.0, 0.0],
        description="Velocity: numbers or formulas of t, x, y, z, a table over t, or a profile over z [m/s].",
    )
    above: float | None = Field(None, description="Lowest height z, default none [m].")
    below: float | None = Field(None, description="Highest height z, default none [m].")
    on: list[str] | None = Field(None, description="Bodies on which it acts, default all.")
    gusts: Squalls | None = Field(
        None, description="Turbulence that is added to its velocity [m, m/s, s, rad]."
    )
    waves: Sea | None = Field(None, description="Waves on its surface at `below` [m, s, rad].")


_LINE = {"type": "array", "items": _NUMBER, "minItems": 2, "description": "Increasing places [m]."}
_ROWS = {"type": "array", "items": {"type": "array", "items": _NUMBER}, "description": "Heights [m]."}
_RELIEF = {
    "type": "object",
    "properties": {"x": _LINE, "y": _LINE, "z": _ROWS},
    "required": ["x", "y", "z"],
    "additionalProperties": False,
}
Height = Annotated[Any, checked(lambda v: height_of(v, "")), WithJsonSchema({"anyOf": [_NUMBER, _RELIEF]})]


class GroundEntry(Entry):
    """A ground on which beams and cables lie."""

    name: str = Field(description="Unique name.")
    height: Height = Field(description="Height z of the plane at x = y = 0, or a table of heights [m].")
    stiffness: Positive = Field(description="Force per length, diameter and depth [Pa/m].")
    damping: NonNegative = Field(0.0, description="Force per length, diameter and rate of depth [Pa s/m].")
    friction: NonNegative = Field(0.0, description="Coulomb's coefficient of friction [-].")
    stick: Positive | None = Field(
        None, description="Stiffness against sliding before it slips, default stiffness [Pa/m]."
    )
    normal: Vector | None = Field(None, description="Normal of a plane that slopes, default up [-].")
    on: list[str] | None = Field(None, description="Beams and cables that lie on it, default all.")
