"""The tables of a line file as pydantic models: keys, types, units; ranges that need no other key."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag

from ...model.file.fields import Curve, Entry, NonNegative, Parameters, Positive
from .wire import EXPANSION


def _whole(given: Any) -> Any:
    return int(given) if isinstance(given, float) and given.is_integer() else given


#: A study has it from a table, where all numbers are floats.
Seed = Annotated[int, BeforeValidator(_whole), Field(ge=0)]


def _of_file(given: Any) -> str:
    return "<file>" if isinstance(given, str) else "<rows>"


FileOrCurve = Annotated[
    Annotated[str, Tag("<file>")] | Annotated[Curve, Tag("<rows>")], Discriminator(_of_file)
]
FileOrNumbers = Annotated[
    Annotated[str, Tag("<file>")] | Annotated[list[float], Tag("<rows>")], Discriminator(_of_file)
]


class SectionEntry(Entry):
    """A wire of the catalogue or with its own numbers."""

    count: int = Field(1, ge=1, le=4, description="Wires side by side that act as one.")
    type: str | None = Field(None, description="Name of the catalogue, instead of EA, EI and mass.")
    EA: Positive | None = Field(None, description="Axial stiffness [N].")
    EI: NonNegative | None = Field(None, description="Bending stiffness [N m^2].")
    mass: Positive | None = Field(None, description="Mass per length of the wire as it hangs [kg/m].")
    damping: NonNegative = Field(0.0, description="Viscous force per length and velocity [N s/m^2].")
    diameter: Positive | None = Field(None, description="Outer diameter, which wind needs [m].")
    drag: NonNegative = Field(1.0, description="Drag coefficient across the wire.")
    expansion: NonNegative = Field(EXPANSION, description="Thermal expansion [1/K].")
    lift: FileOrCurve | None = Field(
        None,
        description="Rows of angle of attack [rad] and lift coefficient; or a CSV file, angle_deg and lift.",
    )


class WireEntry(SectionEntry):
    """Messenger, stitch wire or auxiliary."""

    tension: Positive = Field(description="Force at the anchors along the track [N].")


class ContactWireEntry(SectionEntry):
    """Contact wire, or a conductor rail."""

    tension: Positive | None = Field(None, description="Force at the anchors along the track [N].")
    rail: bool = Field(False, description="A conductor rail, which needs no tension.")
    spacing: Positive | None = Field(
        None, description="Between two wires (count = 2) that are each computed, across the track [m]."
    )


def _of_number(given: Any) -> str:
    return "<curve>" if isinstance(given, list) else "<number>"


NumberOrCurve = Annotated[
    Annotated[float, Tag("<number>")] | Annotated[Curve, Tag("<curve>")], Discriminator(_of_number)
]


#: One number, or one for each support or dropper.
Numbers = Annotated[list[float], Tag("<curve>")]
FloatOrList = Annotated[Annotated[float, Tag("<number>")] | Numbers, Discriminator(_of_number)]
PositiveOrList = Annotated[Annotated[Positive, Tag("<number>")] | Numbers, Discriminator(_of_number)]
NotNegativeOrList = Annotated[Annotated[NonNegative, Tag("<number>")] | Numbers, Discriminator(_of_number)]


class PantographEntry(Entry):
    """A pantograph file."""

    name: str = Field("", description="Name in tables and figures, default that of the file.")
    title: str = Field("", description="What it is.")
    parameters: Parameters = Field(default_factory=dict)
    masses: list[float] = Field(min_length=1, description="From the lowest to the head with the strip [kg].")
    stiffness: list[NumberOrCurve] = Field(
        description="Of the springs below each mass [N/m]; or rows of elongation [m] and force [N]."
    )
    damping: list[NumberOrCurve] = Field(
        description="Of the dampers below each mass [N s/m]; or rows of rate [m/s] and force [N]."
    )
    static_force: float = Field(description="Contact force at standstill [N].")
    aerodynamic: FloatOrList = Field(
        0.0, description="k of the force k v^2 on the lowest mass, or on each [N s^2/m^2]."
    )
    friction: list[float] = Field([], description="Coulomb's, below each mass [N].")
    stops: list[list[float]] = Field(
        [], description="Elongations at which the springs meet a stop, [] for none [m]."
    )
    stop_stiffness: Positive = Field(1e5, description="Of all stops [N/m].")
    strip_length: float = Field(1.45, description="Length of the strip across the track [m].")
    strip_distance: NonNegative = Field(0.0, description="Of two strips behind each other, 0 for one [m].")
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


class RuleEntry(Entry):
    """Droppers at equal distances."""

    first: Positive = Field(description="Distance of first and last dropper from the supports [m].")
    pitch_max: Positive = Field(description="Largest distance of two droppers [m].")


class AuxiliaryEntry(WireEntry):
    """Auxiliary messenger of a compound catenary."""

    height: Positive = Field(description="Over the contact wire, at its own droppers and its ends [m].")
    places: RuleEntry | None = Field(
        None, description="Where its droppers are in spans without long_droppers: first and pitch_max."
    )


class DroppersEntry(Entry):
    """All droppers: stiffness or EA."""

    stiffness: Positive | None = Field(None, description="Stiffness of each dropper [N/m].")
    EA: Positive | None = Field(None, description="Axial stiffness, instead of stiffness [N].")
    mass: NonNegative = Field(0.0, description="Mass per length, half at each end [kg/m].")
    damping: NonNegative = Field(0.0, description="Damping [N s/m].")
    slack: bool = Field(True, description="They carry tension only.")
    clamp_contact: NonNegative = Field(0.0, description="Clamp on the contact wire [kg].")
    clamp_messenger: NonNegative = Field(0.0, description="Clamp on the messenger [kg].")


Side = Literal["left", "right"]


class SteadyArmEntry(Entry):
    """Springs at the supports (vertical), or a hinged arm (length)."""

    vertical: NonNegative | None = Field(None, description="Vertical stiffness about rest [N/m].")
    lateral: Positive | None = Field(None, description="Sideways stiffness, default held [N/m].")
    length: Positive | None = Field(None, description="Length of a hinged arm, instead of vertical [m].")
    mass: NonNegative = Field(0.0, description="Mass of the arm, half of it at the wire [kg].")
    stiffness: Positive = Field(1e6, description="Stiffness of a hinged arm along itself [N/m].")
    angle: float | None = Field(None, description="Of a hinged arm at rest, up from the wire [rad].")
    uplift_stop: Positive | None = Field(None, description="Uplift at which a stop meets the wire [m].")
    side: Side | None = Field(None, description="Of the wire on which its hinge is; it only pulls there.")
    push: bool = Field(False, description="It can push too, as a strut.")


def _of_droppers(given: Any) -> str:
    return "<rule>" if isinstance(given, dict | RuleEntry) else "<places>"


DropperPlaces = Annotated[
    Annotated[list[float], Tag("<places>")] | Annotated[RuleEntry, Tag("<rule>")], Discriminator(_of_droppers)
]


class TensionerEntry(Entry):
    """Springs that pull the ends of the wires, or friction of the weights."""

    stiffness: Positive | None = Field(None, description="Of the spring at each end [N/m].")
    friction: NonNegative = Field(0.0, description="Share of the tension that wheels keep.")


class DropperErrorsEntry(Entry):
    """Random errors of the droppers' lengths."""

    deviation: NonNegative = Field(description="Standard deviation of each length [m].")
    seed: Seed = Field(1, description="The same seed gives the same errors.")


class LoadEntry(Entry):
    """A mass on a wire."""

    position: float = Field(description="Along the track from the first support [m].")
    mass: Positive = Field(description="Mass [kg].")
    wire: Literal["contact", "messenger", "auxiliary"] = Field("contact", description="On which wire.")


class ConditionsEntry(Entry):
    """State in which the line is looked at."""

    temperature: float | None = Field(None, description="Temperature [degrees Celsius].")
    contact_tension: Positive | None = Field(
        None, description="Other tension of the contact wire, of each [N]."
    )
    messenger_tension: Positive | None = Field(
        None, description="Other tension of the messenger, of each [N]."
    )
    ice: NonNegative = Field(0.0, description="On each of the wires [kg/m].")
    wind: float = Field(0.0, description="Steady, across the track, to the left [m/s].")
    air_density: Positive = Field(1.225, description="Density of the air [kg/m^3].")
    turbulence: NonNegative = Field(0.0, description="Standard deviation of gusts over the wind.")
    gust_length: Positive = Field(100.0, description="Length of the turbulence [m].")
    seed: Seed = Field(1, description="Of the gusts.")
    wear: NonNegative = Field(0.0, description="Share of the contact wire that is worn off.")


class SupportEntry(Entry):
    """A support, and the span that begins there."""

    position: float = Field(description="Along the track [m].")
    height: float | None = Field(None, description="Height of the contact wire [m].")
    system_height: Positive | None = Field(None, description="Messenger over contact wire [m].")
    stagger: float | None = Field(None, description="Sideways place of the contact wire, left [m].")
    messenger_stagger: float | None = Field(None, description="Sideways place of the messenger [m].")
    cant: float | None = Field(None, description="Right rail above the left one, at 1.5 m [m].")
    radius: float | None = Field(None, description="Of the track in the span, positive to the left [m].")
    droppers: list[float] | None = Field(None, description="Places in the span, default by the rule [m].")
    long_droppers: list[float] | None = Field(
        None, description="The same between messenger and auxiliary, default by its rule [m]."
    )
    pre_sag: NonNegative | None = Field(None, description="Depth of the parabola in the span [m].")
    arm_vertical: NonNegative | None = Field(None, description="Vertical stiffness of its arm [N/m].")
    arm_lateral: Positive | None = Field(None, description="Sideways stiffness of its arm [N/m].")
    arm_length: Positive | None = Field(None, description="Length of its hinged arm [m].")
    arm_angle: float | None = Field(None, description="Angle of its hinged arm [rad].")
    arm_mass: NonNegative | None = Field(None, description="Mass of its arm [kg].")
    arm_side: Side | None = Field(None, description="Side of the wire on which its hinge is.")
    arm_push: bool | None = Field(None, description="Its arm can push too.")
    uplift_stop: Positive | None = Field(None, description="Uplift at which a stop meets the wire [m].")


FileOrSupports = Annotated[
    Annotated[str, Tag("<file>")] | Annotated[list[SupportEntry], Tag("<rows>")], Discriminator(_of_file)
]


class SpanEntry(Entry):
    """A span, or several alike."""

    repeat: int = Field(1, ge=1, le=1000, description="How many spans alike follow each other.")
    length: Positive = Field(description="Distance of the two supports [m].")
    droppers: DropperPlaces | None = Field(
        None, description="Places from the start of the span, increasing [m]; or first and pitch_max."
    )
    pre_sag: NotNegativeOrList = Field(
        0.0, description="Depth of a parabola between first and last dropper, or one sag per dropper [m]."
    )
    radius: float | None = Field(
        None, description="Of the track, positive to the left, default straight [m]."
    )
    long_droppers: DropperPlaces | None = Field(
        None, description="Places of those between messenger and auxiliary, as droppers [m]."
    )


class ReportEntry(Entry):
    """What stands at the beginning of reports."""

    project: str = Field("", description="What the report belongs to.")
    author: str = Field("", description="Who wrote it.")
    customer: str = Field("", description="For whom.")


class LineEntry(Entry):
    """A line file."""

    title: str = Field("", description="Name of the line.")
    parameters: Parameters = Field(default_factory=dict)
    source: str = Field("", description="Where the data come from.")
    tags: dict[str, str] = Field(default_factory=dict, description="How sure a value is, by its key.")
    spans: list[SpanEntry] | None = Field(None, min_length=1, description="The spans along the track.")
    supports: FileOrSupports | None = Field(
        None, description="Instead of spans: a CSV file with a row for each support, or the rows."
    )
    dropper_rule: RuleEntry | None = Field(None, description="Where spans without a list have droppers.")
    contact_wire: ContactWireEntry = Field(description="The contact wire.")
    messenger_wire: WireEntry | None = Field(None, description="The messenger, default none.")
    droppers: DroppersEntry | None = Field(None, description="The droppers, needed with a messenger.")
    steady_arm: SteadyArmEntry = Field(description="The steady arms.")
    system_height: PositiveOrList | None = Field(
        None,
        description="Height of the messenger over the contact wire at the supports, one or one each [m].",
    )
    height: FloatOrList = Field(
        0.0, description="Height of the contact wire at the supports, one or one each [m]."
    )
    damping: RayleighEntry = Field(
        default_factory=lambda: RayleighEntry(alpha=0.0, beta=0.0),
        description="Rayleigh damping of both wires.",
    )
    stitch: StitchEntry | None = Field(None, description="Stitch wires at the supports, default none.")
    auxiliary_wire: AuxiliaryEntry | None = Field(
        None, description="Of a compound catenary, between messenger and contact wire; default none."
    )
    long_droppers: DroppersEntry | None = Field(
        None, description="Those between messenger and auxiliary, needed with one."
    )
    messenger_support: Positive | None = Field(None, description="Vertical stiffness, default rigid [N/m].")
    messenger_clamp: Literal["hinged", "continuous"] = Field(
        "hinged", description="Whether the messenger turns freely in its supports or bends over them."
    )
    stagger: FloatOrList = Field(
        0.0, description="Sideways place of the contact wire; one number alternates, or one per support [m]."
    )
    messenger_stagger: FloatOrList | None = Field(
        None, description="The same of the messenger, default that of the contact wire [m]."
    )
    cant: FloatOrList = Field(
        0.0, description="Right rail above the left one at the supports, at 1.5 m, one or one each [m]."
    )
    contact_support: Literal["held", "free"] = Field(
        "held", description="Whether the contact wire is held at its height at the supports at rest."
    )
    anchors: Literal["fixed", "tension", "spring"] = Field(
        "fixed",
        description="Whether the wires' ends keep their places or their forces, or springs pull them.",
    )
    tensioner: TensionerEntry | None = Field(None, description="Springs or friction at the ends.")
    messenger_support_mass: NonNegative = Field(
        0.0, description="What moves with the messenger at a support [kg]."
    )
    loads: list[LoadEntry] = Field(default_factory=list, description="Masses on the wires.")
    temperature: float = Field(10.0, description="At which heights and lengths hold [degrees Celsius].")
    conditions: ConditionsEntry | None = Field(None, description="State in which the line is looked at.")
    dropper_lengths: FileOrNumbers | None = Field(
        None, description="Unstretched lengths as built, a CSV file like the schedule, or a list [m]."
    )
    dropper_errors: DropperErrorsEntry | None = Field(None, description="By which the lengths are off.")
    gravity: Positive = Field(9.81, description="Gravity [m/s^2].")
    report: ReportEntry | None = Field(None, description="What stands at the beginning of reports.")


#: Tables of a line file by their key.
TABLES: dict[str, type[Entry]] = {
    "contact_wire": ContactWireEntry,
    "messenger_wire": WireEntry,
    "damping": RayleighEntry,
    "stitch": StitchEntry,
    "auxiliary_wire": AuxiliaryEntry,
    "long_droppers": DroppersEntry,
    "droppers": DroppersEntry,
    "steady_arm": SteadyArmEntry,
    "spans": SpanEntry,
    "supports": SupportEntry,
    "dropper_rule": RuleEntry,
    "tensioner": TensionerEntry,
    "loads": LoadEntry,
    "dropper_errors": DropperErrorsEntry,
    "conditions": ConditionsEntry,
    "report": ReportEntry,
}
