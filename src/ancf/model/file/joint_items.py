"""Joints that hold directions, and torsion springs, as tables of a model file."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from .fields import Entry, ItemName, NonNegative, PointLabel, PointOrPosition, Vector


class UniversalEntry(Entry):
    """Two coincident points whose bodies turn about the two arms of a cross."""

    type: Literal["universal"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointOrPosition = Field(description="The other point, or a position in space: the ground [m].")
    axis_a: Vector = Field(description="Initial direction of the arm that is fixed in the first body [-].")
    axis_b: Vector = Field(description="The same in the second body, normal to it [-].")
    name: ItemName = None


class WeldEntry(Entry):
    """A rigid connection of two nodes, of two bodies, or of one of each."""

    type: Literal["weld"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointLabel
    name: ItemName = None


class GuideEntry(Entry):
    """A guided end: it moves along a line in space and does not turn."""

    type: Literal["guide"] = Field(description="Kind of connection.")
    point: PointLabel
    axis: Vector = Field(description="Direction of the line [-].")
    name: ItemName = None


class TorsionSpringEntry(Entry):
    """A torsion spring and damper about an axis."""

    type: Literal["torsion_spring"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointOrPosition = Field(description="The other point, or a position in space: the ground [m].")
    axis: Vector = Field(description="Initial direction of the axis [-].")
    stiffness: NonNegative = Field(description="Moment per angle [N m/rad].")
    damping: NonNegative = Field(0.0, description="Moment per rate of the angle [N m s/rad].")
    angle: float = Field(0.0, description="Angle without moment, from the initial position [rad].")
    name: ItemName = None
