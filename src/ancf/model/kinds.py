"""The kinds of supports, loads, connections and surroundings; a new one is its file and a line here."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from typing import Any

from . import sheets
from .functions.function import TimeFunction
from .joints.basic import Fixation, Revolute, Slide, Spherical
from .joints.connections import Spring
from .joints.guides import Cylindrical, Planar, Prismatic
from .joints.rigid_joints import GUIDE, UNIVERSAL, WELD
from .joints.torsion import TORSION_SPRING
from .kind import CONTACT, JOINT, SLIDE, SPRING, SURFACE_CONTACT, Kind, Look, Push
from .loads.followers import FOLLOWER_FORCE, PRESSURE
from .loads.load import DistributedLoad, Force, Moment
from .loads.state_function import StateFunction
from .supports.support import Clamp, Hold, Pin
from .supports.winch import Winch
from .surfaces import body_contact, cable_contact, surface
from .surfaces.contact import Contact
from .surroundings.fluids import Fluid
from .surroundings.grounds import Ground


def _entry(name: str, module: str = "items") -> Callable[[], Any]:
    return lambda: getattr(import_module(f"ancf.model.file.{module}"), name)


@cache
def _clock(name: str) -> TimeFunction:
    """The time as the first number: one function for all items of a name, so that models share it."""
    return TimeFunction(["t", 0.0, 0.0], 3, name)


SUPPORTS: list[Kind] = [
    Kind(Pin, "pin", "pin", "pin", _entry("PinEntry"), sheets.pin, look=Look("up", "black", 5.5)),
    Kind(
        Clamp,
        "clamp",
        "clamp",
        "clamp",
        _entry("ClampEntry"),
        sheets.clamp,
        look=Look("square", "light", 5.5),
    ),
    Kind(Hold, "hold", "hold", "hold", _entry("HoldEntry"), sheets.hold, look=Look("down", "white", 4.0)),
    Kind(
        Winch,
        "winch",
        "winch",
        "winch",
        _entry("WinchEntry"),
        sheets.winch,
        look=Look("circle", "white", 8.0),
    ),
]
LOADS: list[Kind] = [
    Kind(
        Force,
        "force",
        "force",
        "add_force",
        _entry("ForceEntry"),
        sheets.force,
        push=Push("force", "N"),
        batch="state_force",
        on_state=lambda item: isinstance(item.force, StateFunction),
        inputs=lambda item: [_clock(item.name)],
    ),
    Kind(
        Moment,
        "moment",
        "moment",
        "add_moment",
        _entry("MomentEntry"),
        sheets.moment,
        push=Push("moment", "N m", turns=True),
    ),
    Kind(
        DistributedLoad,
        "distributed",
        "distributed load",
        "add_distributed_load",
        _entry("DistributedEntry"),
        sheets.distributed,
        ends=("body",),
        between=sheets.part,
        push=Push("load", "N/m"),
        batch="state_force",
        on_state=lambda item: isinstance(item.load, StateFunction),
        inputs=lambda item: [_clock(item.name)],
    ),
    FOLLOWER_FORCE,
    PRESSURE,
]
CONNECTIONS: list[Kind] = [
    Kind(
        Spherical,
        "spherical",
        "spherical joint",
        "connect",
        _entry("SphericalEntry"),
        sheets.nothing,
        ends=("a", "b"),
        asked=JOINT,
        rows="spherical",
        look=Look("circle", "white", 4.0),
    ),
    Kind(
        Revolute,
        "hinge",
        "hinge",
        "hinge",
        _entry("HingeEntry"),
        sheets.axis,
        ends=("a", "b"),
        asked=JOINT,
        rows="hinge",
        look=Look("circle", "light", 4.0),
    ),
    Kind(
        Cylindrical,
        "cylindrical",
        "cylindrical joint",
        "cylindrical",
        _entry("CylindricalEntry"),
        sheets.axis,
        ends=("a", "b"),
        asked=JOINT,
        rows="cylindrical",
        look=Look("circle", "light", 4.0),
    ),
    Kind(
        Prismatic,
        "prismatic",
        "prismatic joint",
        "prismatic",
        _entry("PrismaticEntry"),
        sheets.axis,
        ends=("a", "b"),
        asked=JOINT,
        rows="prismatic",
        look=Look("square", "light", 4.0),
    ),
    Kind(
        Planar,
        "planar",
        "planar joint",
        "planar",
        _entry("PlanarEntry"),
        sheets.axis,
        ends=("a", "b"),
        asked=JOINT,
        rows="planar",
        look=Look("square", "light", 4.0),
    ),
    UNIVERSAL,
    WELD,
    GUIDE,
    Kind(
        Fixation,
        "fixation",
        "clamp to a body",
        "clamp",
        _entry("FixationEntry"),
        sheets.nothing,
        ends=("point", "to"),
        asked=JOINT,
        rows="fixation",
        look=Look("square", "white", 4.0),
    ),
    Kind(
        Slide,
        "slide",
        "sliding joint",
        "slide",
        _entry("SlideEntry"),
        sheets.slide,
        ends=("point", "carrier"),
        keys=("point", "along"),
        between=sheets.along,
        asked=SLIDE,
        look=Look("slider", "orange", 5.0),
    ),
    Kind(
        Spring,
        "spring",
        "spring",
        "add_spring",
        _entry("SpringEntry"),
        sheets.spring,
        ends=("a", "b"),
        asked=SPRING,
    ),
    TORSION_SPRING,
    Kind(
        Contact,
        "contact",
        "contact",
        "add_contact",
        _entry("ContactEntry"),
        sheets.contact,
        ends=("point", "carrier"),
        keys=("point", "along"),
        between=sheets.along,
        asked=CONTACT,
    ),
    Kind(
        surface.SurfaceContact,
        "surface_contact",
        "contact with a surface",
        "add_surface_contact",
        _entry("SurfaceContactEntry"),
        surface.data,
        ends=("body", "surface"),
        between=surface.between,
        asked=SURFACE_CONTACT,
    ),
    Kind(
        cable_contact.CableContact,
        "cable_contact",
        "contact of cables",
        "add_cable_contact",
        _entry("CableContactEntry"),
        surface.data,
        ends=("body", "other"),
        between=cable_contact.between,
        asked=SURFACE_CONTACT,
    ),
    Kind(
        body_contact.BodyContact,
        "body_contact",
        "contact of bodies",
        "add_body_contact",
        _entry("BodyContactEntry"),
        body_contact.data,
        ends=("surface", "other"),
        between=body_contact.between,
        asked=SURFACE_CONTACT,
    ),
]
FLUID = Kind(
    Fluid,
    "fluid",
    "fluid",
    "add_fluid",
    _entry("FluidEntry", "surroundings"),
    sheets.fluid,
    ends=(),
    between=sheets.between_heights,
    batch="fluid",
    inputs=lambda item: item.functions(),
    push=Push("velocity", "m/s"),
)
GROUND = Kind(
    Ground,
    "ground",
    "ground",
    "add_ground",
    _entry("GroundEntry", "surroundings"),
    sheets.ground,
    ends=(),
    between=sheets.lie_of_ground,
    batch="ground",
)
SURFACE = Kind(
    surface.Surface,
    "surface",
    "surface",
    "add_surface",
    _entry("AnySurface", "surfaces"),
    surface.shape,
    ends=(),
    between=surface.lie,
)
#: What is around all bodies, one kind for each key of a model file and attribute of a Model.
SURROUNDINGS: dict[str, Kind] = {"fluids": FLUID, "grounds": GROUND, "surfaces": SURFACE}
#: By the key of a model file under which they stand, which is the attribute of a Model too.
GROUPS: dict[str, list[Kind]] = {"supports": SUPPORTS, "loads": LOADS, "connections": CONNECTIONS}


def all_kinds() -> Iterator[Kind]:
    """Every kind of support, load and connection, group by group."""
    for kinds in GROUPS.values():
        yield from kinds


def kind_of(item: Any) -> Kind:
    """The kind of a support, load, connection or surrounding."""
    return _by_item()[type(item)]


@cache
def _by_item() -> dict[type, Kind]:
    return {kind.item: kind for kind in (*all_kinds(), *SURROUNDINGS.values())}


def by_word(group: str) -> dict[str, Kind]:
    """The kinds of a group by their words in files."""
    return {kind.word: kind for kind in GROUPS[group]}


def marked() -> dict[str, Look]:
    """Kinds of which pictures have markers, by word: supports, then joints."""
    return {kind.word: kind.look for kind in all_kinds() if kind.look is not None}


def pushing() -> dict[str, Push]:
    """Kinds of loads and surroundings that pictures draw as arrows, by noun."""
    kinds = (*all_kinds(), *SURROUNDINGS.values())
    return {kind.noun: kind.push for kind in kinds if kind.push is not None}
