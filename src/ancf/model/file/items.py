"""Supports, loads and connections as tables of a model file, one class for each kind."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from .fields import (
    Curve,
    Entry,
    ForceFunction,
    ItemName,
    Line,
    NonNegative,
    Pair,
    PointLabel,
    PointOrPosition,
    Positive,
    ScalarFunction,
    Vector,
    VectorFunction,
)


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
    rotation_vector: VectorFunction = Field(
        None, description="Instead: axis times angle from the initial direction, function of t [rad]."
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


class WinchEntry(Entry):
    """Pays out or hauls in a cable at one of its ends, whose place it does not hold."""

    type: Literal["winch"] = Field(description="Kind of support.")
    point: PointLabel
    length: ScalarFunction = Field(
        description="Natural length of what is paid out, function of t, or of inputs with speed [m]."
    )
    speed: ScalarFunction | None = Field(
        None, description="Speed that is followed, or the largest one towards a length of inputs [m/s]."
    )
    acceleration: Positive | None = Field(None, description="Largest change of the speed in time [m/s^2].")
    name: ItemName = None


class ForceEntry(Entry):
    """A force at a point."""

    type: Literal["force"] = Field(description="Kind of load.")
    point: PointLabel
    force: ForceFunction = Field(
        description="Force, function of t, or of t and the point's x, y, z, vx, vy, vz [N]."
    )
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
    load: ForceFunction = Field(
        description="Load per reference length, function of t, or of t and each point's x ... vz [N/m]."
    )
    between: Pair | None = Field(
        None, description="Reference arc lengths of its first and last point, default the whole body [m]."
    )
    name: ItemName = None


class PressureEntry(Entry):
    """A load normal to a beam and to an axis, which turns with the beam."""

    type: Literal["pressure"] = Field(description="Kind of load.")
    body: str = Field(description="Name of the body.")
    pressure: ScalarFunction = Field(
        description="Per present length, along tangent x axis, function of t [N/m]."
    )
    axis: Vector = Field(description="Normal of the plane in which it turns [-].")
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


class CylindricalEntry(Entry):
    """Two bodies, one of which slides along an axis of the other and turns about it."""

    type: Literal["cylindrical"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointOrPosition = Field(description="The other point, or a position in space: the ground [m].")
    axis: Vector = Field(description="Initial direction of the axis through a [-].")
    name: ItemName = None


class PrismaticEntry(Entry):
    """Two bodies, one of which slides along an axis of the other."""

    type: Literal["prismatic"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointOrPosition = Field(description="The other point, or a position in space: the ground [m].")
    axis: Vector = Field(description="Initial direction of the axis through a [-].")
    name: ItemName = None


class PlanarEntry(Entry):
    """Two bodies, one of which slides in a plane of the other, whose normal is axis."""

    type: Literal["planar"] = Field(description="Kind of connection.")
    a: PointLabel
    b: PointOrPosition = Field(description="The other point, or a position in space: the ground [m].")
    axis: Vector = Field(description="Initial normal of the plane through a [-].")
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
    stiffness: NonNegative = Field(0.0, description="Stiffness [N/m].")
    damping: NonNegative = Field(0.0, description="Damping [N s/m].")
    length: NonNegative | None = Field(None, description="Length without force, default the initial one [m].")
    slack: bool = Field(False, description="It carries tension only.")
    law: Curve | None = Field(None, description="Rows of elongation and force of a spring beside it [m, N].")
    damper: Curve | None = Field(None, description="Rows of rate and force of a damper beside it [m/s, N].")
    friction: NonNegative = Field(0.0, description="Coulomb's force [N].")
    friction_velocity: Positive = Field(0.01, description="Rate at which friction is 0.76 of its size [m/s].")
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
    profile: Curve | None = Field(
        None, description="Rows of arc length [m] and how far the wire's surface stands out there [m]."
    )
    name: ItemName = None


class SurfaceContactEntry(Entry):
    """A beam or cable may touch a surface, all along it."""

    type: Literal["surface_contact"] = Field(description="Kind of connection.")
    body: str = Field(description="Name of the beam or cable.")
    surface: str = Field(description="Name of the surface.")
    stiffness: Positive = Field(description="Normal force per length and depth [Pa].")
    damping: NonNegative = Field(0.0, description="Normal force per length and rate of depth [Pa s].")
    friction: NonNegative = Field(0.0, description="Coulomb's coefficient of friction [-].")
    stick: Positive | None = Field(
        None, description="Force per length and way before it slips, default stiffness [Pa]."
    )
    radius: Positive | None = Field(
        None, description="Radius of the beam, default half the diameter of its section [m]."
    )
    name: ItemName = None


class CableContactEntry(Entry):
    """Two cables or beams may touch, or one may touch itself."""

    type: Literal["cable_contact"] = Field(description="Kind of connection.")
    body: str = Field(description="Name of a beam or cable.")
    other: str = Field(description="Name of another one, or of the same: it touches itself.")
    stiffness: Positive = Field(description="Normal force per length and depth, side by side [Pa].")
    damping: NonNegative = Field(0.0, description="Normal force per length and rate of depth [Pa s].")
    friction: NonNegative = Field(0.0, description="Coulomb's coefficient of friction [-].")
    stick: Positive | None = Field(
        None, description="Force per length and way before it slips, default stiffness [Pa]."
    )
    radius: Positive | None = Field(
        None, description="Radius of both, default half the diameters of their sections [m]."
    )
    name: ItemName = None


class BodyContactEntry(Entry):
    """Two rigid bodies, or one and the ground, may touch with their surfaces."""

    type: Literal["body_contact"] = Field(description="Kind of connection.")
    surface: str = Field(description="Name of a surface.")
    other: str = Field(description="Name of another surface, on another body or on the ground.")
    stiffness: Positive = Field(description="Normal force per depth [N/m].")
    damping: NonNegative = Field(0.0, description="Normal force per rate of depth [N s/m].")
    friction: NonNegative = Field(0.0, description="Coulomb's coefficient of friction [-].")
    stick: Positive | None = Field(
        None, description="Force per way before it slips, default stiffness [N/m]."
    )
    name: ItemName = None
