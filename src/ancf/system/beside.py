"""The system of a model with another number, in which little changes: all else is shared."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..connections.contact_build import renumbered as stripped
from ..connections.spring_build import renumbered, springs
from ..contact.build import renumbered as touching
from ..contact.bump_build import renumbered as bumping
from ..contact.strand_build import renumbered as crossing
from ..elements.registry import ELEMENTS as ELEMENTS_OF
from ..elements.registry import offered
from ..loads.fluid import renumbered as in_fluids
from ..loads.ground import renumbered as on_ground
from ..loads.pressure import renumbered as again_pressed
from ..model.bodies.beam import Beam
from ..model.model import Model
from ..model.points import Point
from ..model.surfaces.body_contact import BodyContact
from ..model.surfaces.cable_contact import CableContact
from ..model.surfaces.contact import Contact
from ..model.surfaces.surface import SurfaceContact
from .compile import Parts, beams_by_kind, bind_parts, build_bodies, build_slides, has_mass_of_its_own
from .core import Loads
from .inputs import Inputs
from .probe import Probe, locate
from .supports import collect
from .system import System

#: Parts that can be made alone: elements, as one.
ELEMENTS, SPRINGS, BODIES, SLIDES = "elements", "springs", "bodies", "slides"
FLUIDS, PRESSING, RUBBING, GROUND = "fluid", "pressing", "rubbing", "ground"
CROSSING, BUMPING, PRESSURE, STRIPS = "crossing", "bumping", "pressure", "contacts"
#: Parts of contacts and what numbers them again.
CONTACTS: dict[str, tuple[type, Any]] = {
    PRESSING: (SurfaceContact, touching),
    RUBBING: (SurfaceContact, touching),
    CROSSING: (CableContact, crossing),
    BUMPING: (BodyContact, bumping),
    STRIPS: (Contact, stripped),
}


class Acts(NamedTuple):
    """What of a system a number of a model acts on, besides the initial shape and motion."""

    parts: frozenset[str] = frozenset()  # of ELEMENTS, SPRINGS, BODIES and so on, see above
    weighs: bool = False  # dead loads
    moves: bool = False  # places and axes of supports
    shapes: bool = False  # shape functions, and where points are on their bodies


def beside(system: System, model: Model, acts: Acts) -> System:
    """A system that differs in the numbers of some of its parts alone.

    Parameters
    ----------
    system : System
    model : Model
        With the same bodies, supports, loads and connections but for these numbers.
    acts : Acts
    """
    made, own = System.__new__(System), {"core", "double"}
    dead = _weighed(system, model) if acts.weighs else None
    own |= {"dead", "patterns"} if acts.weighs and dead is None else set()
    own |= {"supports"} if acts.moves else set()
    made.__dict__.update((key, value) for key, value in system.__dict__.items() if key not in own)
    made.model = model
    if dead is not None:
        made.dead = dead
    if acts.moves:
        made.constraints = collect(model, system.numbering)
        made.constraints.held |= set(system.spare.tolist())
        made.inputs = Inputs(system.inputs.loads, made.constraints, system.inputs.given)
        made._like = system
    bound, parts = _renumbered(system, model, acts), _built(system, model, acts)
    if bound or parts:
        rank = np.arange(system.numbering.blocks, dtype=np.int64)
        made.parts = system.parts | bound | bind_parts(parts, rank, system.constraints, system.places)
    return made


def _weighed(system: System, model: Model) -> Loads | None:
    """Dead loads where nothing but masses that stand at one place are others, or None."""
    mine = system.model.bodies
    changed = [(mine[name], body) for name, body in model.bodies.items() if body is not mine[name]]
    if not np.array_equal(model.gravity, system.model.gravity):
        return None
    still = system.dead.still.copy()
    for old, new in changed:
        if isinstance(old, Beam) or isinstance(new, Beam):
            return None
        at = system.numbering.slots[old.name][0, 0]
        still[at : at + 3] += (new.mass - old.mass) * np.asarray(model.gravity)
    return system.dead._replace(still=still, gravity=still.copy())


def _renumbered(system: System, model: Model, acts: Acts) -> Parts:
    """Parts in which nothing but numbers is another one."""
    found, find = Parts(), _finder(system) if acts.shapes else None
    if ELEMENTS in acts.parts:
        found |= {kind: _elements(system, kind, beams) for kind, beams in _others(system, model).items()}
    if SPRINGS in acts.parts and SPRINGS in system.parts and not acts.shapes:
        found[SPRINGS] = renumbered(system.parts[SPRINGS], system.model, model)
    for name in CONTACTS.keys() & acts.parts & system.parts.keys():
        kind, again = CONTACTS[name]
        items = [one for one in model.connections if isinstance(one, kind)]
        found[name] = again(system.parts[name], items, *([find] if kind is SurfaceContact else []))
    surroundings: tuple[tuple[str, Any], ...] = (GROUND, on_ground), (FLUIDS, in_fluids)
    for name, around in surroundings:
        if name in acts.parts & system.parts.keys():
            found[name] = around(system.parts[name], model, find)
    if PRESSURE in acts.parts & system.parts.keys() and acts.shapes:
        found[PRESSURE] = again_pressed(system.parts[PRESSURE], model, find)
    return found


def _others(system: System, model: Model) -> dict[str, list[Beam]]:
    """Beams of kinds some of which are others."""
    mine = system.model.bodies
    kinds = beams_by_kind(model).items()
    return {kind: beams for kind, beams in kinds if any(beam is not mine[beam.name] for beam in beams)}


def _elements(system: System, kind: str, beams: list[Beam]) -> Any:
    """The batch of elements of a kind."""
    batch, slots = system.parts[kind], system.numbering.slots
    own = offered(batch, "renumbered")
    for beam in beams:
        if own is not None and batch is not None and beam is not system.model.bodies[beam.name]:
            batch = own(batch, beam, slots[beam.name])
    if own is not None and batch is not None:
        return batch
    parts = {kind: ELEMENTS_OF[kind].build(beams, [slots[beam.name] for beam in beams])}
    rank = np.arange(system.numbering.blocks, dtype=np.int64)
    return bind_parts(parts, rank, system.constraints, system.places)[kind]


def _finder(system: System) -> Callable[[Point], Probe]:
    """What locates points of bodies."""
    slots = system.numbering.slots

    def find(point: Point) -> Probe:
        return locate(point, slots[point.body.name], system.lengths.get(point.body.name, (-1, 0.0)))

    return find


def _built(system: System, model: Model, acts: Acts) -> Parts:
    """Parts that have to be made again, in the slots of the nodes."""
    slots, mine, parts = system.numbering.slots, system.model.bodies, Parts()
    find = _finder(system)
    if SPRINGS in acts.parts and acts.shapes and SPRINGS in system.parts:
        parts[SPRINGS] = springs(model, find)
    if SLIDES in acts.parts:
        parts |= build_slides(model, system.numbering, system.level, find)
    changed = [body for name, body in model.bodies.items() if body is not mine[name]]
    changed += [mine[body.name] for body in changed]
    if BODIES in acts.parts and any(has_mass_of_its_own(body) for body in changed):
        parts |= build_bodies(model, slots)
    return parts
