"""The tables of a model file as pydantic models: keys, types, units; ranges that need no other key."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ancf.model.file.fields import (
    Entry,
    Integrator,
    ItemName,
    NonNegative,
    PointLabel,
    PointOrPosition,
    Positive,
    ScalarFunction,
    Vector,
    VectorFunction,
)


class SectionEntry(Entry):
    """Stiffnesses and mass given directly."""

    EA: Positive = Field(description="Axial stiffness [N].")
    EI: NonNegative = Field(description="Bending stiffness [N m^2].")
    rhoA: Positive = Field(description="Mass per length [kg/m].")
    damping: NonNegative = Field(0.0, description="External viscous force per length and velocity [N s/m^2].")
    axial_damping: NonNegative = Field(0.0, description="Axial Kelvin-Voigt damping [N s].")
    bending_damping: NonNegative = Field(0.0, description="Bending Kelvin-Voigt damping [N m^2 s].")


class MaterialEntry(Entry):
    """Material of a section with a shape."""

    E: Positive = Field(description="Young's modulus [N/m^2].")
    rho: Positive = Field(description="Density [kg/m^3].")
    nu: float = Field(0.0, gt=-1, lt=0.5, description="Poisson's ratio [-].")
    damping: NonNegative = Field(0.0, description="External viscous force per length and velocity [N s/m^2].")
    axial_damping: NonNegative = Field(0.0, description="Axial Kelvin-Voigt damping [N s].")
    bending_damping: NonNegative = Field(0.0, description="Bending Kelvin-Voigt damping [N m^2 s].")


class RectangleEntry(MaterialEntry):
    """A rectangle of a material."""

    shape: Literal["rectangle"] = Field(description="Shape of the section.")
    width: Positive = Field(description="Width, along local y [m].")
    height: Positive = Field(description="Height, along local z [m].")


class CircleEntry(MaterialEntry):
    """A full circle of a material."""

    shape: Literal["circle"] = Field(description="Shape of the section.")
    diameter: Positive = Field(description="Diameter [m].")


class MotionEntry(Entry):
    """Initial rigid motion of a body."""

    velocity: Vector = Field([0.0, 0.0, 0.0], description="Velocity of the point about [m/s].")
    angular_velocity: Vector = Field([0.0, 0.0, 0.0], description="Angular velocity [rad/s].")
    about: Vector | None = Field(
        None, description="Point of the rotation, default the start of the body [m]."
    )


class PinEntry(Entry):
    """Holds a node's position."""

    type: Literal["pin"] = Field(description="Kind of support.")
    point: PointLabel
    displacement: VectorFunction = Field(None, description="Prescribed displacement, function of t [m].")
    name: ItemName = None


class ClampEntry(Entry):
    """Holds a node's position and slope."""

    type: Literal["clamp"] = Field(description="Kind of support.")
    point: PointLabel
    stretch: Literal["free", "fixed"] = Field("free", description="Hold the slope's direction, or all of it.")
    rotation: ScalarFunction = Field(
        None, description="Angle of the tangent about axis, function of t [rad]."
    )
    axis: Vector = Field([0.0, 0.0, 1.0], description="Axis of the rotation [-].")
    rotation_rate: ScalarFunction = Field(None, description="First time derivative of rotation [rad/s].")
    rotation_acceleration: ScalarFunction = Field(
        None, description="Second derivative of rotation [rad/s^2]."
    )
    displacement: VectorFunction = Field(None, description="Prescribed displacement, function of t [m].")
    name: ItemName = None


class HoldEntry(Entry):
    """Holds single components of a node."""

    type: Literal["hold"] = Field(description="Kind of support.")
    point: PointLabel
    position: str = Field("", description='Components of the position that are held, letters of "xyz".')
    slope: str = Field("", description='Components of the slope r_x that are held, letters of "xyz".')
    name: ItemName = None


class ForceEntry(Entry):
    """A force at a point."""

    type: Literal["force"] = Field(description="Kind of load.")
    point: PointLabel
    force: VectorFunction = Field(description="Force, function of t [N].")
    name: ItemName = None


class MomentEntry(Entry):
    """A moment at a point."""

    type: Literal["moment"] = Field(description="Kind of load.")
    point: PointLabel
    moment: VectorFunction = Field(description="Moment, function of t [N m].")
    name: ItemName = None


class DistributedEntry(Entry):
    """A load per length on a body."""

    type: Literal["distributed"] = Field(description="Kind of load.")
    body: str = Field(description="Name of the body.")
    load: VectorFunction = Field(description="Load per reference length, function of t [N/m].")
    between: Annotated[list[float], Field(min_length=2, max_length=2)] | None = Field(
        None, description="Reference arc lengths of its first and last point, default the whole body [m]."
    )
    name: ItemName = None


class SphericalEntry(Entry):
    """Two coincident nodes keep the same position."""

    type: Literal["spherical"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointLabel
    name: ItemName = None


class SpringEntry(Entry):
    """A spring and damper."""

    type: Literal["spring"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointOrPosition = Field(description="The other point, or a position in space [m].")
    stiffness: NonNegative = Field(description="Stiffness [N/m].")
    damping: NonNegative = Field(0.0, description="Damping [N s/m].")
    length: NonNegative | None = Field(None, description="Length without force, default the initial one [m].")
    slack: bool = Field(False, description="It carries tension only.")
    name: ItemName = None


class SimulationEntry(Entry):
    """Settings of a simulation."""

    t_end: Positive = Field(description="End time [s].")
    step: Positive = Field(description="Time step, at most t_end [s].")
    integrator: Integrator = Field("trapezoidal", description="Time integrator, a name or a table with type.")
    start: Literal["reference", "equilibrium"] = Field("reference", description="State at t = 0.")
    equilibrium_of: list[str] | None = Field(
        None, description="Bodies whose equilibrium is the start, default all."
    )
    output_step: Positive | None = Field(
        None, description="Time between stored states, a multiple of step [s]."
    )
    outputs: list[str] = Field([], description="Points that the summary prints.")


class EquilibriumEntry(Entry):
    """Settings of an equilibrium."""

    load_steps: int = Field(1, ge=1, description="Number of steps in which the loads grow.")


SHAPES = ("rectangle", "circle")
TAGGED: dict[str, type[Entry]] = {
    "<section>": SectionEntry,
    "<rectangle>": RectangleEntry,
    "<circle>": CircleEntry,
    "<pin>": PinEntry,
    "<clamp>": ClampEntry,
    "<hold>": HoldEntry,
    "<force>": ForceEntry,
    "<moment>": MomentEntry,
    "<distributed>": DistributedEntry,
    "<spherical>": SphericalEntry,
    "<spring>": SpringEntry,
}


def _by_type(*types: str) -> Discriminator:
    def tag(value: Any) -> str | None:
        kind = value.get("type") if isinstance(value, dict) else None
        return f"<{kind}>" if kind in types else None

    context: dict[str, str | int | float] = {"key": "type", "allowed": " ".join(types)}
    return Discriminator(tag, "wrong_kind", "wrong kind", context)


def _by_shape(named: bool) -> Discriminator:
    def tag(value: Any) -> str | None:
        if named and isinstance(value, str):
            return "<name>"
        shape = value.get("shape", "section") if isinstance(value, dict) else None
        return f"<{shape}>" if shape in (*SHAPES, "section") else None

    return Discriminator(tag, "wrong_kind", "wrong kind", {"key": "shape", "allowed": " ".join(SHAPES)})


DirectTag = Annotated[SectionEntry, Tag("<section>")]
RectangleTag = Annotated[RectangleEntry, Tag("<rectangle>")]
CircleTag = Annotated[CircleEntry, Tag("<circle>")]
AnySection = Annotated[DirectTag | RectangleTag | CircleTag, _by_shape(named=False)]
BodySection = Annotated[
    Annotated[str, Tag("<name>")] | DirectTag | RectangleTag | CircleTag, _by_shape(named=True)
]
AnySupport = Annotated[
    Annotated[PinEntry, Tag("<pin>")]
    | Annotated[ClampEntry, Tag("<clamp>")]
    | Annotated[HoldEntry, Tag("<hold>")],
    _by_type("pin", "clamp", "hold"),
]
AnyLoad = Annotated[
    Annotated[ForceEntry, Tag("<force>")]
    | Annotated[MomentEntry, Tag("<moment>")]
    | Annotated[DistributedEntry, Tag("<distributed>")],
    _by_type("force", "moment", "distributed"),
]
AnyConnection = Annotated[
    Annotated[SphericalEntry, Tag("<spherical>")] | Annotated[SpringEntry, Tag("<spring>")],
    _by_type("spherical", "spring"),
]


class BodyEntry(Entry):
    """A beam or cable: start and end, or path; elements or nodes."""

    type: Literal["beam"] = Field("beam", description="Kind of body.")
    name: str = Field(description="Unique name; letters, digits, _, - and spaces inside.")
    section: BodySection = Field(description="Name of a section of this file, or a section.")
    start: Vector | None = Field(None, description="Start of a straight beam [m].")
    end: Vector | None = Field(None, description="End of a straight beam [m].")
    path: list[Vector] | None = Field(None, description="Points of a spline, instead of start and end [m].")
    elements: int | None = Field(None, ge=1, description="Number of elements of equal length.")
    nodes: list[float] | None = Field(
        None, description="Reference arc lengths of the nodes, 0 to length [m]."
    )
    element: Literal["cable"] = Field("cable", description="Kind of element.")
    strain: Literal["material", "paper"] = Field("material", description="Strain measures of the cable.")
    poisson: Literal["centreline", "full"] = Field("centreline", description="Poisson effect of thick beams.")
    length: Positive | None = Field(
        None, description="Natural length, default that of the initial shape [m]."
    )
    natural_shape: Literal["path", "straight"] = Field(
        "path", description="The initial shape is free of bending, or a straight beam was bent into it."
    )
    gauss: Annotated[list[int], Field(min_length=2, max_length=2)] = Field(
        [5, 3], description="Numbers of Gauss points of the axial and the bending integrals."
    )
    motion: MotionEntry | None = Field(None, description="Initial rigid motion.")


class FileEntry(Entry):
    """A model file of ancf; SI units."""

    title: str = Field("", description="Title of the study.")
    gravity: Vector = Field([0.0, 0.0, 0.0], description="Gravity [m/s^2].")
    sections: dict[str, AnySection] = Field({}, description="Cross-sections by name.")
    bodies: list[BodyEntry] = Field(min_length=1, description="Beams and cables.")
    supports: list[AnySupport] = Field([], description="What holds the bodies.")
    loads: list[AnyLoad] = Field([], description="Forces, moments and distributed loads.")
    connections: list[AnyConnection] = Field([], description="Joints and springs between points.")
    simulation: SimulationEntry | None = Field(None, description="Settings of a simulation.")
    equilibrium: EquilibriumEntry | None = Field(None, description="Settings of an equilibrium.")


NESTED: dict[str, type[Entry]] = {
    "bodies": BodyEntry,
    "motion": MotionEntry,
    "simulation": SimulationEntry,
    "equilibrium": EquilibriumEntry,
}
