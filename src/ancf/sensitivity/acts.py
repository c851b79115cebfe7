"""On what the numbers of a model act, as far as that is known: systems around them are made of the rest."""

from __future__ import annotations

from typing import Any

from ..model.bodies.beam import Beam
from ..model.bodies.rigid import PointMass, RigidBody
from ..model.functions.function import TimeFunction
from ..model.joints.basic import Slide, Spherical
from ..model.joints.connections import Spring
from ..model.loads.followers import Pressure
from ..model.loads.load import DistributedLoad, Force, Moment
from ..model.model import Model
from ..model.sections.section import DAMPINGS
from ..model.supports.winches import by_body
from ..model.surfaces.body_contact import BodyContact
from ..model.surfaces.cable_contact import CableContact
from ..model.surfaces.contact import Contact
from ..model.surfaces.surface import SurfaceContact, touches_with_its_own
from ..system.beside import (
    BODIES,
    BUMPING,
    CROSSING,
    ELEMENTS,
    FLUIDS,
    GROUND,
    PRESSING,
    PRESSURE,
    RUBBING,
    SLIDES,
    SPRINGS,
    STRIPS,
    Acts,
)

#: Of sections, those on which the forces of elements alone depend, and those on which weights do, too.
FORCES, MASSES = {"EA", "EI", "E", *DAMPINGS}, {"rhoA", "rho"}
#: Numbers of all bodies on which nothing but the initial motion depends.
MOTION = {"velocity", "angular_velocity"}
#: Of sections, those on which forces of fluids alone depend.
WET = {"drag", "added_mass"}
#: Of supports, what moves them: else they stay where they are when a beam keeps its initial shape.
MOTIONS = "displacement", "rotation", "rotation_vector"


def acts_of(model: Model, name: str) -> Acts | None:
    """Of a number by its name; None where it may act on anything."""
    owner, _, key = name.rpartition(".")
    key = key.partition("[")[0]
    if not owner:
        weighs = key == "gravity" and not by_body(model)
        return Acts(_wet(model), weighs=True) if weighs else None
    if key == "density" and any(fluid.name == owner for fluid in model.fluids):
        return Acts(_wet(model))
    ground = next((one for one in model.grounds if one.name == owner), None)
    if ground is not None:
        rough = ("friction", "stick") if ground.friction > 0.0 else ()  # else friction begins
        return Acts(frozenset((GROUND,))) if key in ("stiffness", "damping", "height", *rough) else None
    body = model.bodies.get(owner)
    if body is None:
        return _of_connection(model, owner, key)
    if key in MOTION and not model.fluids:
        return Acts()
    if isinstance(body, PointMass | RigidBody):
        return Acts(frozenset((BODIES,)), weighs=True) if key == "mass" else None
    if not isinstance(body, Beam) or owner in by_body(model):
        return None
    if key in WET:
        return Acts(_wet(model))
    if key in FORCES or key in MASSES:
        return Acts(frozenset((ELEMENTS, BODIES)), weighs=key in MASSES)
    around = frozenset((GROUND,) if model.grounds else ()) | _wet(model)
    if key == "diameter":
        wide = any(_is_wide(one, body) for one in model.connections)
        return None if wide else Acts(around | {ELEMENTS, BODIES}, weighs=True)
    if not _is_bare(model):
        return None
    if key in ("start", "end"):
        loose = Spring | CableContact | BodyContact
        sprung = not body.has_section and all(isinstance(one, loose) for one in model.connections)
        return Acts(moves=True) if sprung else None
    slides = any(isinstance(one, Slide) for one in model.connections)
    touching = {CROSSING, PRESSING, RUBBING}
    everything = around | touching | {ELEMENTS, SPRINGS, BODIES, PRESSURE, *((SLIDES,) if slides else ())}
    moves = any(getattr(one, way, None) is not None for one in model.supports for way in MOTIONS)
    return Acts(everything, weighs=True, moves=moves, shapes=True) if key == "length" else None


def _is_wide(contact: object, beam: Beam) -> bool:
    """Whether a contact depends on the diameter of a beam: one of cables has to find others by it."""
    if isinstance(contact, SurfaceContact):
        return contact.body is beam and touches_with_its_own(contact, beam)
    return isinstance(contact, CableContact)


def _of_connection(model: Model, owner: str, key: str) -> Acts | None:
    """The same of a number of a connection, of contacts of cables and of bodies without friction."""
    found = next((one for one in model.connections if one.name == owner), None)
    if isinstance(found, Spring) and key in ("stiffness", "damping", "length"):
        return Acts(frozenset((SPRINGS,)))
    if isinstance(found, Contact):
        return Acts(frozenset((STRIPS,))) if key in ("stiffness", "damping") else None
    if isinstance(found, CableContact | BodyContact):
        part = CROSSING if isinstance(found, CableContact) else BUMPING
        plain = found.friction == 0.0 and key in ("stiffness", "damping")
        return Acts(frozenset((part,))) if plain else None
    if not isinstance(found, SurfaceContact):
        return None
    rough = ("friction", "stick") if found.friction > 0.0 else ()  # else friction begins
    return Acts(frozenset((PRESSING, RUBBING))) if key in ("stiffness", "damping", "radius", *rough) else None


def _wet(model: Model) -> frozenset[str]:
    """The part of the fluids, if there are any."""
    return frozenset((FLUIDS,) if model.fluids else ())


def _is_bare(model: Model) -> bool:
    """Whether all there is, is known to know of lengths what :func:`ancf.system.beside.beside` does.

    Dead forces, pressures, moments at ends, fluids, grounds, springs, shared nodes, slides, contacts with
    surfaces, and those of cables and of bodies without friction.
    """
    return (
        not by_body(model)
        and all(_is_bare_load(load) for load in model.loads)
        and all(_is_bare_connection(one) for one in model.connections)
    )


def _is_bare_load(load: Any) -> bool:
    return isinstance(load, Pressure) or _turns_end(load) or isinstance(_given(load), TimeFunction)


def _is_bare_connection(one: Any) -> bool:
    if isinstance(one, CableContact | BodyContact):
        return one.friction == 0.0
    return isinstance(one, Spring | Slide | SurfaceContact) or (isinstance(one, Spherical) and one.shared)


def _turns_end(load: Any) -> bool:
    """Whether a load is a moment that knows of no length: at an end of a beam or on a rigid body."""
    if not isinstance(load, Moment):
        return False
    body = load.point.body
    return not isinstance(body, Beam) or load.point in (body.start, body.end)


def _given(load: Any) -> Any:
    """What a dead force is a function of."""
    if isinstance(load, Force):
        return load.force
    return load.load if isinstance(load, DistributedLoad) else None
