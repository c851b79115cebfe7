"""The tables of a line file as pydantic models: keys, types, units; ranges that need no other key."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ..model.file.fields import Entry, NonNegative, Parameters, Positive
from .wire import EXPANSION


class WireEntry(Entry):
    """Contact wire or messenger, of the catalogue or with its own numbers."""

    type: str | None = Field(None, description="Name of the catalogue, instead of EA, EI and mass.")
    EA: Positive | None = Field(None, description="Axial stiffness [N].")
    EI: NonNegative | None = Field(None, description="Bending stiffness [N m^2].")
    mass: Positive | None = Field(None, description="Mass per length of the wire as it hangs [kg/m].")
    tension: Positive = Field(description="Force at the anchors along the track [N].")
    damping: NonNegative = Field(0.0, description="Viscous force per length and velocity [N s/m^2].")
    diameter: Positive | None = Field(None, description="Outer diameter, which wind needs [m].")
    drag: NonNegative = Field(1.0, description="Drag coefficient across the wire.")
    expansion: NonNegative = Field(EXPANSION, description="Thermal expansion [1/K].")


class PantographEntry(Entry):
    """A pantograph file."""

    name: str = Field("", description="Name in tables and figures, default that of the file.")
    title: str = Field("", description="What it is.")
    parameters: Parameters = Field(default_factory=dict)
    masses: list[float] = Field(min_length=1, description="From the lowest to the head with the strip [kg].")
    stiffness: list[float] = Field(description="Of the springs below each mass [N/m].")
    damping: list[float] = Field(description="Of the dampers below each mass [N s/m].")
    static_force: float = Field(description="Contact force at standstill [N].")
    aerodynamic: float = Field(0.0, description="k of the force k v^2 [N s^2/m^2].")
    strip_length: float = Field(1.45, description="Length of the strip across the track [m].")
    relaxed_at: Literal["start", "nominal", "mean"] = Field(
        "start", description="Height at which the lowest spring carries nothing."
    )
    source: str = Field("", description="Where the data come from.")
    tags: dict[str, str] = Field(default_factory=dict, description="How sure a value is, by its key.")


class RayleighEntry(Entry):
    """Damping of both wires."""

    alpha: NonNegative = Field(0.0, description="Part proportional to mass [1/s].")
    beta: NonNegative = Field(0.0, description="Part proportional to stiffness and tension [s].")


class StitchEntry(WireEntry):
    """Stitch wires."""

    reach: Positive = Field(description="Distance of their ends from the support [m].")


class DroppersEntry(Entry):
    """All droppers: stiffness or EA."""

    stiffness: Positive | None = Field(None, description="Stiffness of each dropper [N/m].")
    EA: Positive | None = Field(None, description="Axial stiffness, instead of stiffness [N].")
    mass: NonNegative = Field(0.0, description="Mass per length, half at each end [kg/m].")
    damping: NonNegative = Field(0.0, description="Damping [N s/m].")
    slack: bool = Field(True, description="They carry tension only.")
    clamp_contact: NonNegative = Field(0.0, description="Clamp on the contact wire [kg].")
    clamp_messenger: NonNegative = Field(0.0, description="Clamp on the messenger [kg].")


class SteadyArmEntry(Entry):
    """Springs at the supports (vertical), or a hinged arm (length)."""

    vertical: NonNegative | None = Field(None, description="Vertical stiffness about rest [N/m].")
    lateral: Positive | None = Field(None, description="Sideways stiffness, default held [N/m].")
    length: Positive | None = Field(None, description="Length of a hinged arm, instead of vertical [m].")
    mass: NonNegative = Field(0.0, description="Mass of the arm, half of it at the wire [kg].")
    stiffness: Positive = Field(1e6, description="Stiffness of a hinged arm along itself [N/m].")


class SpanEntry(Entry):
    """A span, or several alike."""

    repeat: int = Field(1, ge=1, le=1000, description="How many spans alike follow each other.")
    length: Positive = Field(description="Distance of the two supports [m].")
    droppers: list[float] = Field(description="Places from the start of the span, increasing [m].")
    pre_sag: NonNegative | list[float] = Field(
        0.0, description="Depth of a parabola between first and last dropper, or one sag per dropper [m]."
    )


class LineEntry(Entry):
    """A line file."""

    title: str = Field("", description="Name of the line.")
    parameters: Parameters = Field(default_factory=dict)
    source: str = Field("", description="Where the data come from.")
    tags: dict[str, str] = Field(default_factory=dict, description="How sure a value is, by its key.")
    spans: list[SpanEntry] = Field(min_length=1, description="The spans along the track.")
    contact_wire: WireEntry = Field(description="The contact wire.")
    messenger_wire: WireEntry = Field(description="The messenger.")
    droppers: DroppersEntry = Field(description="The droppers.")
    steady_arm: SteadyArmEntry = Field(description="The steady arms.")
    system_height: Positive | list[float] = Field(
        description="Height of the messenger over the contact wire at the supports, one or one each [m]."
    )
    damping: RayleighEntry = Field(
        default_factory=lambda: RayleighEntry(alpha=0.0, beta=0.0),
        description="Rayleigh damping of both wires.",
    )
    stitch: StitchEntry | None = Field(None, description="Stitch wires at the supports, default none.")
    messenger_support: Positive | None = Field(None, description="Vertical stiffness, default rigid [N/m].")
    messenger_clamp: Literal["hinged", "continuous"] = Field(
        "hinged", description="Whether the messenger turns freely in its supports or bends over them."
    )
    stagger: float | list[float] = Field(
        0.0, description="Sideways place of the contact wire; one number alternates, or one per support [m]."
    )
    messenger_stagger: float | list[float] | None = Field(
        None, description="The same of the messenger, default that of the contact wire [m]."
    )
    contact_support: Literal["held", "free"] = Field(
        "held", description="Whether the contact wire is held at its height at the supports at rest."
    )
    anchors: Literal["fixed", "tension"] = Field(
        "fixed", description="Whether the wires' ends keep their places or their forces in motion."
    )
    gravity: Positive = Field(9.81, description="Gravity [m/s^2].")


#: Tables of a line file by their key.
TABLES: dict[str, type[Entry]] = {
    "contact_wire": WireEntry,
    "messenger_wire": WireEntry,
    "damping": RayleighEntry,
    "stitch": StitchEntry,
    "droppers": DroppersEntry,
    "steady_arm": SteadyArmEntry,
    "spans": SpanEntry,
}
