"""The tables of a model file as pydantic models: keys, types, units; ranges that need no other key."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ancf.model.file.fields import (
    ElementName,
    Entry,
    Inertia,
    Integrator,
    ItemName,
    Line,
    Matrix,
    NonNegative,
    Pair,
    PointLabel,
    PointOrPosition,
    Positive,
    ScalarFunction,
    StrainName,
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
    slope_damping: NonNegative = Field(0.0, description="Damping of the slopes' rates, of cables only [N s].")


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


class RectangleEntry(MaterialEntry):
    """A rectangle of a material."""

    shape: Literal["rectangle"] = Field(description="Shape of the section.")
    width: Positive = Field(description="Width, along local y [m].")
    height: Positive = Field(description="Height, along local z [m].")
    J: Positive | None = Field(None, description="Torsion constant, default Saint-Venant's [m^4].")


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


class MotionEntry(Entry):
    """Initial rigid motion of a body."""

    velocity: Vector = Field([0.0, 0.0, 0.0], description="Velocity of the point about [m/s].")
    angular_velocity: Vector = Field([0.0, 0.0, 0.0], description="Angular velocity [rad/s].")
    about: Vector | None = Field(
        None,
        description="Point of the rotation, default the start of a beam, a rigid body's centre of mass [m].",
    )


class MassMotionEntry(Entry):
    """Initial motion of a point mass."""

    velocity: Vector = Field([0.0, 0.0, 0.0], description="Velocity [m/s].")


class PinEntry(Entry):
    """Holds the position of a node, a point mass or a rigid body's centre of mass."""

    type: Literal["pin"] = Field(description="Kind of support.")
    point: PointLabel
    displacement: VectorFunction = Field(None, description="Prescribed displacement, function of t [m].")
    name: ItemName = None


class ClampEntry(Entry):
    """Holds a node's position and slope, on a beam all three slopes, or a rigid body altogether."""

    type: Literal["clamp"] = Field(description="Kind of support.")
    point: PointLabel
    stretch: Literal["free", "fixed"] = Field(
        "free", description="Hold the slopes' directions, or all of them."
    )
    rotation: ScalarFunction = Field(None, description="Angle of the slopes about axis, function of t [rad].")
    axis: Vector = Field([0.0, 0.0, 1.0], description="Axis of the rotation [-].")
    rotation_rate: ScalarFunction = Field(None, description="First time derivative of rotation [rad/s].")
    rotation_acceleration: ScalarFunction = Field(
        None, description="Second derivative of rotation [rad/s^2]."
    )
    displacement: VectorFunction = Field(None, description="Prescribed displacement, function of t [m].")
    name: ItemName = None


class HoldEntry(Entry):
    """Holds single components of a node, a point mass or a rigid body's centre of mass."""

    type: Literal["hold"] = Field(description="Kind of support.")
    point: PointLabel
    position: str = Field("", description='Components of the position that are held, letters of "xyz".')
    slope: str = Field("", description='Components of the slope r_x that are held, letters of "xyz".')
    slope_y: str = Field("", description='Components of a beam\'s r_y that are held, letters of "xyz".')
    slope_z: str = Field("", description='Components of a beam\'s r_z that are held, letters of "xyz".')
    twist: bool = Field(False, description="Hold a beam's section against turning about the tangent.")
    displacement: VectorFunction = Field(
        None, description="Prescribed displacement of the position's held components, function of t [m]."
    )
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
    between: Pair | None = Field(
        None, description="Reference arc lengths of its first and last point, default the whole body [m]."
    )
    name: ItemName = None


class SphericalEntry(Entry):
    """Two coincident points keep the same position."""

    type: Literal["spherical"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointOrPosition = Field(description="The other point, or a position in space [m].")
    name: ItemName = None


class HingeEntry(Entry):
    """Two coincident points keep the same position, their bodies turn about one axis only."""

    type: Literal["hinge"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointOrPosition = Field(description="The other point, or a position in space: the ground [m].")
    axis: Vector = Field(description="Initial direction of the axis [-].")
    name: ItemName = None


class FixationEntry(Entry):
    """A node of a beam or cable clamped to a rigid body."""

    type: Literal["fixation"] = Field(description="Kind of connection.")
    point: PointLabel
    to: str = Field(description="Name of the rigid body.")
    stretch: Literal["free", "fixed"] = Field(
        "free", description="Hold the slopes' directions, or all of them."
    )
    name: ItemName = None


class SlideEntry(Entry):
    """A point slides along a beam, a cable or a line of a rigid body."""

    type: Literal["slide"] = Field(description="Kind of connection.")
    point: PointOrPosition = Field(description="The sliding point, or the position of a fixed ring [m].")
    along: str = Field(description="Name of the carrier: a beam, a cable or a rigid body.")
    line: Line | None = Field(
        None, description="Of a rigid body: start and end of the line in body axes [m]."
    )
    offset: Pair = Field([0.0, 0.0], description="Of a beam: place (y, z) of the line in its section [m].")
    s: float | None = Field(None, description="Initial arc length, default the nearest place [m].")
    tolerance: NonNegative | None = Field(
        None, description="Largest initial distance from the line, default 1e-6 of the model's size [m]."
    )
    mass: NonNegative = Field(0.0, description="Mass that moves along the line [kg].")
    friction: NonNegative = Field(0.0, description="Coulomb's coefficient of friction [-].")
    friction_velocity: Positive = Field(1e-3, description="Speed at which friction is full [m/s].")
    viscous: NonNegative = Field(0.0, description="Viscous resistance to sliding [N s/m].")
    force: ScalarFunction = Field(None, description="Drive force towards larger s, function of t [N].")
    motion: ScalarFunction = Field(None, description="Prescribed arc length, function of t [m].")
    release: Vector | None = Field(None, description="Direction in which no force acts [-].")
    unilateral: Vector | None = Field(
        None, description="Direction of the only force that the carrier receives [-]."
    )
    at_end: Literal["stop", "clamp", "release"] = Field(
        "stop", description="At an end of the line: stop the computation, hold the point, let it go."
    )
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


class ContactEntry(Entry):
    """A wire rests on a straight strip through a point."""

    type: Literal["contact"] = Field(description="Kind of connection.")
    point: PointLabel
    along: str = Field(description="Name of the wire: a cable or a beam.")
    stiffness: Positive = Field(description="Force per overlap [N/m].")
    damping: NonNegative = Field(0.0, description="Force per rate of overlap [N s/m].")
    strip: Vector = Field([0.0, 1.0, 0.0], description="Direction of the strip [-].")
    normal: Vector = Field([0.0, 0.0, 1.0], description="Direction of the force on the wire [-].")
    s: NonNegative | None = Field(None, description="Arc length near which it starts [m].")
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
    "<pin>": PinEntry,
    "<clamp>": ClampEntry,
    "<hold>": HoldEntry,
    "<force>": ForceEntry,
    "<moment>": MomentEntry,
    "<distributed>": DistributedEntry,
    "<spherical>": SphericalEntry,
    "<hinge>": HingeEntry,
    "<fixation>": FixationEntry,
    "<slide>": SlideEntry,
    "<spring>": SpringEntry,
    "<contact>": ContactEntry,
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
    Annotated[SphericalEntry, Tag("<spherical>")]
    | Annotated[HingeEntry, Tag("<hinge>")]
    | Annotated[FixationEntry, Tag("<fixation>")]
    | Annotated[SlideEntry, Tag("<slide>")]
    | Annotated[SpringEntry, Tag("<spring>")]
    | Annotated[ContactEntry, Tag("<contact>")],
    _by_type("spherical", "hinge", "fixation", "slide", "spring", "contact"),
]


class BeamEntry(Entry):
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
    natural_shape: Literal["path", "straight"] = Field(
        "path", description="The initial shape is free of bending, or a straight beam was bent into it."
    )
    gauss: Annotated[list[int], Field(min_length=2, max_length=2)] = Field(
        [5, 3],
        description="Numbers of Gauss points of a cable's axial and bending integrals, "
        "or along a beam and across its section.",
    )
    y_axis: Vector | None = Field(
        None, description="Direction near the local y axis at the start, default horizontal [-]."
    )
    motion: MotionEntry | None = Field(None, description="Initial rigid motion.")


class PointMassEntry(Entry):
    """A mass at a point."""

    type: Literal["point_mass"] = Field(description="Kind of body.")
    name: str = Field(description="Unique name; letters, digits, _, - and spaces inside.")
    at: Vector = Field(description="Initial position [m].")
    mass: Positive = Field(description="Mass [kg].")
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
    motion: MotionEntry | None = Field(None, description="Initial rigid motion.")


AnyBody = Annotated[
    Annotated[BeamEntry, Tag("<beam>")]
    | Annotated[PointMassEntry, Tag("<point_mass>")]
    | Annotated[RigidBodyEntry, Tag("<rigid_body>")],
    _by_type("beam", "point_mass", "rigid_body", default="beam"),
]
TAGGED |= {"<beam>": BeamEntry, "<point_mass>": PointMassEntry, "<rigid_body>": RigidBodyEntry}


class FileEntry(Entry):
    """A model file of ancf; SI units."""

    title: str = Field("", description="Title of the study.")
    gravity: Vector = Field([0.0, 0.0, 0.0], description="Gravity [m/s^2].")
    sections: dict[str, AnySection] = Field({}, description="Cross-sections by name.")
    bodies: list[AnyBody] = Field(min_length=1, description="Beams, cables, point masses, rigid bodies.")
    supports: list[AnySupport] = Field([], description="What holds the bodies.")
    loads: list[AnyLoad] = Field([], description="Forces, moments and distributed loads.")
    connections: list[AnyConnection] = Field([], description="Joints and springs between points.")
    simulation: SimulationEntry | None = Field(None, description="Settings of a simulation.")
    equilibrium: EquilibriumEntry | None = Field(None, description="Settings of an equilibrium.")


NESTED: dict[str, type[Entry]] = {
    "motion": MotionEntry,
    "simulation": SimulationEntry,
    "equilibrium": EquilibriumEntry,
}
