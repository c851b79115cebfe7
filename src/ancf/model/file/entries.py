"""The tables of a model file as pydantic models: keys, types, units; ranges that need no other key."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias, Union

from pydantic import Discriminator, Field, Tag

from ..kind import Kind
from ..kinds import CONNECTIONS, LOADS, SUPPORTS
from .fields import (
    Coefficients,
    ElementCount,
    ElementName,
    Entry,
    Inertia,
    Integrator,
    Matrix,
    NonNegative,
    Parameters,
    Positive,
    StrainName,
    Vector,
)
from .surfaces import TAGGED as SURFACE_SHAPES
from .surfaces import AnySurface
from .surroundings import FluidEntry, GroundEntry


class SectionEntry(Entry):
    """Stiffnesses and mass given directly."""

    EA: Positive = Field(description="Axial stiffness [N].")
    EI: NonNegative = Field(description="Bending stiffness [N m^2].")
    rhoA: Positive = Field(description="Mass per length [kg/m].")
    damping: NonNegative = Field(0.0, description="External viscous force per length and velocity [N s/m^2].")
    axial_damping: NonNegative = Field(0.0, description="Axial Kelvin-Voigt damping [N s].")
    bending_damping: NonNegative = Field(0.0, description="Bending Kelvin-Voigt damping [N m^2 s].")
    slope_damping: NonNegative = Field(0.0, description="Damping of the slopes' rates, of cables only [N s].")
    diameter: Positive | None = Field(None, description="Outer diameter in a fluid and on the ground [m].")
    drag: Coefficients | None = Field(None, description="Drag coefficients, normal and tangential [-].")
    added_mass: Coefficients | None = Field(
        None, description="Added mass coefficients, normal and tangential [-]."
    )
    rotary_inertia: Positive | Coefficients | None = Field(
        None, description="Moment of inertia of a section per length, or those about local y and z [kg m]."
    )


class MaterialEntry(Entry):
    """Material of a section with a shape or with moments."""

    E: Positive = Field(description="Young's modulus [N/m^2].")
    rho: Positive = Field(description="Density [kg/m^3].")
    nu: float = Field(0.0, gt=-1, lt=0.5, description="Poisson's ratio [-].")
    shear_factors: Annotated[list[Positive], Field(min_length=2, max_length=2)] = Field(
        [1.0, 1.0], description="Factors of the shear stiffnesses along local y and z of a beam [-]."
    )
    damping: NonNegative = Field(0.0, description="External viscous force per length and velocity [N s/m^2].")
    axial_damping: NonNegative = Field(0.0, description="Axial Kelvin-Voigt damping [N s].")
    bending_damping: NonNegative = Field(0.0, description="Bending Kelvin-Voigt damping [N m^2 s].")
    slope_damping: NonNegative = Field(0.0, description="Damping of the slopes' rates, of cables only [N s].")
    drag: Coefficients | None = Field(None, description="Drag coefficients, normal and tangential [-].")
    added_mass: Coefficients | None = Field(
        None, description="Added mass coefficients, normal and tangential [-]."
    )
    rotary_inertia: Positive | Coefficients | None = Field(
        None, description="Moment of inertia of a section per length, or those about local y and z [kg m]."
    )


class RectangleEntry(MaterialEntry):
    """A rectangle of a material."""

    shape: Literal["rectangle"] = Field(description="Shape of the section.")
    width: Positive = Field(description="Width, along local y [m].")
    height: Positive = Field(description="Height, along local z [m].")
    J: Positive | None = Field(None, description="Torsion constant, default Saint-Venant's [m^4].")
    diameter: Positive | None = Field(None, description="Outer diameter in a fluid and on the ground [m].")


class CircleEntry(MaterialEntry):
    """A full circle of a material."""

    shape: Literal["circle"] = Field(description="Shape of the section.")
    diameter: Positive = Field(description="Diameter [m].")
    J: Positive | None = Field(None, description="Torsion constant, default Saint-Venant's [m^4].")


class MomentsEntry(MaterialEntry):
    """A section with two axes of symmetry, by the integrals over its area."""

    shape: Literal["moments"] = Field(description="Shape of the section.")
    A: Positive = Field(description="Area [m^2].")
    I_y: Positive = Field(description="Integral of z^2 over the area [m^4].")
    I_z: Positive = Field(description="Integral of y^2 over the area [m^4].")
    J: Positive = Field(description="Torsion constant [m^4].")
    I_yyyy: Positive | None = Field(
        None, description="Integral of y^4, default that of a rectangle with the same A, I_y, I_z [m^6]."
    )
    I_zzzz: Positive | None = Field(None, description="Integral of z^4, default as for I_yyyy [m^6].")
    I_yyzz: Positive | None = Field(None, description="Integral of y^2 z^2, default as for I_yyyy [m^6].")
    diameter: Positive | None = Field(None, description="Outer diameter in a fluid and on the ground [m].")


class MotionEntry(Entry):
    """Initial rigid motion of a body."""

    velocity: Vector = Field([0.0, 0.0, 0.0], description="Velocity of the point about [m/s].")
    angular_velocity: Vector = Field([0.0, 0.0, 0.0], description="Angular velocity [rad/s].")
    about: Vector | None = Field(
        None,
        description="Point of the rotation, default the start of a beam, a rigid body's centre of mass [m].",
    )


class BeamMotionEntry(MotionEntry):
    """Initial motion of a beam."""

    along: list[float] | None = Field(None, description="Arc lengths of velocities, increasing [m].")
    velocities: list[Vector] | None = Field(
        None,
        description="Added to the rigid motion: velocities at these places, a spline between them [m/s].",
    )


class MassMotionEntry(Entry):
    """Initial motion of a point mass."""

    velocity: Vector = Field([0.0, 0.0, 0.0], description="Velocity [m/s].")


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
    sensors: list[str] = Field(
        [], description="Points, springs and joints, by name, that are recorded at every step."
    )


class EquilibriumEntry(Entry):
    """Settings of an equilibrium."""

    load_steps: int = Field(1, ge=1, description="Number of steps in which the loads grow.")


SHAPES = ("rectangle", "circle", "moments")
TAGGED: dict[str, type[Entry]] = {
    "<section>": SectionEntry,
    "<rectangle>": RectangleEntry,
    "<circle>": CircleEntry,
    "<moments>": MomentsEntry,
}


def _by_type(*types: str, default: str | None = None) -> Discriminator:
    def tag(value: Any) -> str | None:
        kind = value.get("type", default) if isinstance(value, dict) else None
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
MomentsTag = Annotated[MomentsEntry, Tag("<moments>")]
AnySection = Annotated[DirectTag | RectangleTag | CircleTag | MomentsTag, _by_shape(named=False)]
BodySection = Annotated[
    Annotated[str, Tag("<name>")] | DirectTag | RectangleTag | CircleTag | MomentsTag, _by_shape(named=True)
]


def _any_of(kinds: list[Kind]) -> Any:
    """A table of one of these kinds, by its `type`."""
    entries = {f"<{kind.word}>": kind.entry() for kind in kinds}
    TAGGED.update(entries)
    tagged = tuple(Annotated[entry, Tag(tag)] for tag, entry in entries.items())
    return Annotated[Union[tagged], _by_type(*(kind.word for kind in kinds))]  # noqa: UP007


if TYPE_CHECKING:  # the kinds are known at run time alone
    AnySupport: TypeAlias = Entry
    AnyLoad: TypeAlias = Entry
    AnyConnection: TypeAlias = Entry
else:
    AnySupport, AnyLoad, AnyConnection = map(_any_of, (SUPPORTS, LOADS, CONNECTIONS))


class WheelEntry(Entry):
    """A wheel that a rope or belt goes around."""

    at: Vector = Field(description="Centre [m].")
    radius: Positive = Field(description="Radius of the axis of the rope on it [m].")
    turn: Literal["left", "right"] = Field("left", description="Which way the path turns, seen against axis.")


class ReevingEntry(Entry):
    """Path over wheels in one plane: arcs and straight lines in between."""

    wheels: list[WheelEntry] = Field(min_length=1, description="Wheels, one after the other.")
    axis: Vector = Field(description="Normal of the plane of all wheels, of any length [-].")
    start: Vector | None = Field(None, description="Start, if the path has ends [m].")
    end: Vector | None = Field(None, description="End, if the path has ends [m].")


class BeamEntry(Entry):
    """A beam or cable: start and end, path, or reeving; elements or nodes."""

    type: Literal["beam"] = Field("beam", description="Kind of body.")
    name: str = Field(description="Unique name; letters, digits, _, - and spaces inside.")
    section: BodySection = Field(description="Name of a section of this file, or a section.")
    start: Vector | None = Field(None, description="Start of a straight beam [m].")
    end: Vector | None = Field(None, description="End of a straight beam [m].")
    path: list[Vector] | None = Field(None, description="Points of a spline, instead of start and end [m].")
    reeving: ReevingEntry | None = Field(None, description="Path over wheels, instead of path.")
    closed: bool = Field(False, description="The end is joined to the start, as in a belt.")
    elements: ElementCount | None = Field(
        None, description='Number of elements of equal length, or "auto": by an estimate of the error.'
    )
    nodes: list[float] | None = Field(
        None, description="Reference arc lengths of the nodes, 0 to length [m]."
    )
    element: ElementName = Field(
        "cable", description="Kind of element: the cable, or a beam with shear, torsion and a cross-section."
    )
    strain: StrainName | None = Field(
        None, description='Strain measures of a cable, default "material"; the beams have "green".'
    )
    poisson: Literal["centreline", "full"] = Field(
        "centreline", description="Poisson effect of the beams: on the centreline only, or in the volume."
    )
    length: Positive | None = Field(
        None, description="Natural length, default that of the initial shape [m]."
    )
    natural_shape: Literal["path", "straight"] | list[Vector] = Field(
        "path",
        description="The initial shape is free of bending, or a straight beam was bent into it, or one with "
        "the bends of a spline through points [m].",
    )
    gauss: Annotated[list[int], Field(min_length=2, max_length=2)] = Field(
        [5, 3],
        description="Numbers of Gauss points of a cable's axial and bending integrals, "
        "or along a beam and across its section.",
    )
    y_axis: Vector | None = Field(
        None, description="Direction near the local y axis at the start, default horizontal [-]."
    )
    motion: BeamMotionEntry | None = Field(None, description="Initial motion.")


class PointMassEntry(Entry):
    """A mass at a point."""

    type: Literal["point_mass"] = Field(description="Kind of body.")
    name: str = Field(description="Unique name; letters, digits, _, - and spaces inside.")
    at: Vector = Field(description="Initial position [m].")
    mass: Positive = Field(description="Mass [kg].")
    volume: NonNegative = Field(0.0, description="Volume that it displaces in a fluid [m^3].")
    drag_area: NonNegative = Field(0.0, description="Drag coefficient times area [m^2].")
    added_mass: NonNegative = Field(0.0, description="Added mass in units of the displaced mass [-].")
    motion: MassMotionEntry | None = Field(None, description="Initial motion.")


class RigidBodyEntry(Entry):
    """A rigid body."""

    type: Literal["rigid_body"] = Field(description="Kind of body.")
    name: str = Field(description="Unique name; letters, digits, _, - and spaces inside.")
    at: Vector = Field(description="Initial position of the centre of mass [m].")
    mass: Positive = Field(description="Mass [kg].")
    inertia: Inertia = Field(
        description="About the centre of mass in body axes: three principal moments or a matrix [kg m^2]."
    )
    axes: Matrix | None = Field(
        None, description="Rotation matrix, its columns are the initial body axes; default global [-]."
    )
    volume: NonNegative = Field(0.0, description="Volume that it displaces in a fluid [m^3].")
    drag_area: NonNegative = Field(0.0, description="Drag coefficient times area [m^2].")
    added_mass: NonNegative = Field(0.0, description="Added mass in units of the displaced mass [-].")
    motion: MotionEntry | None = Field(None, description="Initial rigid motion.")


AnyBody = Annotated[
    Annotated[BeamEntry, Tag("<beam>")]
    | Annotated[PointMassEntry, Tag("<point_mass>")]
    | Annotated[RigidBodyEntry, Tag("<rigid_body>")],
    _by_type("beam", "point_mass", "rigid_body", default="beam"),
]
TAGGED |= SURFACE_SHAPES
TAGGED |= {"<beam>": BeamEntry, "<point_mass>": PointMassEntry, "<rigid_body>": RigidBodyEntry}


class InputEntry(Entry):
    """A number that is given while a simulation runs; formulas of loads may name it."""

    name: str = Field(
        description="Unique among inputs; letters, digits and _, no name of formulas such as t."
    )
    value: float = Field(
        0.0,
        description="What it is until something else is given [of what it is multiplied with, such as N].",
    )
    unit: str = Field("", description="Its unit, for tables of results.")
    description: str = Field("", description="What it is, for tables of results.")


class FileEntry(Entry):
    """A model file of ancf; SI units."""

    title: str = Field("", description="Title of the study.")
    parameters: Parameters = Field(default_factory=dict)
    gravity: Vector = Field([0.0, 0.0, 0.0], description="Gravity, [x, y, z] [m/s^2].")
    sections: dict[str, AnySection] = Field({}, description="Cross-sections by name.")
    bodies: list[AnyBody] = Field(min_length=1, description="Beams, cables, point masses, rigid bodies.")
    inputs: list[InputEntry] = Field([], description="Numbers that are given while a simulation runs.")
    supports: list[AnySupport] = Field([], description="What holds the bodies.")
    loads: list[AnyLoad] = Field([], description="Forces, moments and distributed loads.")
    connections: list[AnyConnection] = Field([], description="Joints and springs between points.")
    fluids: list[FluidEntry] = Field([], description="Water, air: what the bodies move in.")
    grounds: list[GroundEntry] = Field([], description="What beams and cables lie on.")
    surfaces: list[AnySurface] = Field([], description="Drums, sheaves: what beams and cables touch.")
    simulation: SimulationEntry | None = Field(None, description="Settings of a simulation.")
    equilibrium: EquilibriumEntry | None = Field(None, description="Settings of an equilibrium.")


NESTED: dict[str, type[Entry]] = {
    "wheels": WheelEntry,
    "reeving": ReevingEntry,
    "inputs": InputEntry,
    "fluids": FluidEntry,
    "grounds": GroundEntry,
    "motion": BeamMotionEntry,
    "simulation": SimulationEntry,
    "equilibrium": EquilibriumEntry,
}
