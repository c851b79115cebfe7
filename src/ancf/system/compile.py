"""From a Model to flat arrays: each batch is built once, in the slots of the nodes as they come in the model.

The order of elimination is known only when all batches are there, and the shadows only behind it.  Both
change integers alone: the fields of a batch that hold unknowns (``Traits.slots``) are mapped.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray, IntArray
from ..batches import Batches
from ..bodies.build import inertia, rotary_inertia
from ..compiled import Role, traits, with_role
from ..connections import joint_build
from ..connections.contact_build import contacts
from ..connections.sliding_build import sliding
from ..connections.spring_build import springs
from ..connections.torsion_build import torsion_springs
from ..contact.build import batches as surface_contacts
from ..contact.bump_build import bumps
from ..contact.bump_build import share as share_bumps
from ..contact.grip import GripBatch
from ..contact.strand import StrandBatch
from ..contact.strand_build import share, strands
from ..elements import winched_build
from ..elements.registry import ELEMENTS
from ..elements.workspace import workspace
from ..linalg.block_ldl import allocate
from ..linalg.ordering import MINIMUM_DEGREE, behind, from_both_ends, order
from ..model.bodies.beam import Beam
from ..model.joints.basic import Slide
from ..model.joints.connections import Spring
from ..model.joints.torsion import TorsionSpring
from ..model.model import Model
from ..model.points import Point
from ..model.sections.inertia import of_cable
from ..model.supports.winches import by_body
from ..model.surfaces.body_contact import BodyContact
from ..model.surfaces.cable_contact import CableContact
from ..model.surfaces.contact import Contact
from ..model.surfaces.surface import SurfaceContact
from . import loads
from .core import Core, Joints, Loads, Supports
from .far import no_far
from .matrix import Places, block_pairs
from .near import near_of
from .numbering import Numbering
from .probe import Probe, lengths_of, locate
from .supports import Constraints

Parts = dict[str, Any]


def build_parts(
    model: Model, numbering: Numbering, level: FloatArray, value: FloatArray, measured: FloatArray
) -> Parts:
    """All batches by name, in the slots of the numbering.

    They share ``level``, the weights of the constraints, slices of ``value``, the inputs of loads, and of
    ``measured``, (contacts, 4), what they leave for sensors.
    """
    slots = numbering.slots
    winches = by_body(model)
    lengths = lengths_of(model, {name: np.array([x]) for name, x in numbering.lengths.items()})

    def find(point: Point) -> Probe:
        return locate(point, slots[point.body.name], lengths.get(point.body.name, (-1, 0.0)))

    parts = build_elements(model, slots)
    if winches:
        parts["winched"] = winched_build.build(
            [w.beam for w in winches.values()],
            [slots[name] for name in winches],
            [w.at_start for w in winches.values()],
            [numbering.lengths[w.name] for w in winches.values()],
            model.gravity,
        )
    if any(isinstance(c, Spring) for c in model.connections):
        parts["springs"] = springs(model, find)
    twisted = [c for c in model.connections if isinstance(c, TorsionSpring)]
    if twisted:
        parts["torsion springs"] = torsion_springs(twisted, slots)
    parts |= loads.batches(model, find, value)
    parts |= build_bodies(model, slots)
    touching = [c for c in model.connections if isinstance(c, Contact)]
    if touching:
        parts["contacts"] = contacts(touching, find, slots, measured[: len(touching)])
    pressed = [c for c in model.connections if isinstance(c, SurfaceContact)]
    if pressed:
        rows = slice(len(touching), len(touching) + len(pressed))
        parts |= surface_contacts(pressed, find, slots, measured[rows])
    entwined = [c for c in model.connections if isinstance(c, CableContact)]
    if entwined:
        first = len(touching) + len(pressed)
        left = measured[first : first + len(entwined)]
        room = 6 * numbering.blocks + 12 * len(model.supports) + 12
        parts |= strands(entwined, find, left, room)
    bumping = [c for c in model.connections if isinstance(c, BodyContact)]
    if bumping:
        parts |= bumps(bumping, slots, measured[len(measured) - len(bumping) :])
    return parts | _joints(model, numbering, level, find)


def build_elements(model: Model, slots: dict[str, IntArray]) -> Parts:
    """Batches of elements by their kind, those of cables with a winch apart."""
    return {
        kind: ELEMENTS[kind].build(beams, [slots[b.name] for b in beams])
        for kind, beams in beams_by_kind(model).items()
    }


def beams_by_kind(model: Model) -> dict[str, list[Beam]]:
    """Those without a winch by the kind of their elements."""
    kinds: dict[str, list[Beam]] = {}
    winches = by_body(model)
    for name, beam in model.beams.items():
        if name not in winches:
            kinds.setdefault(beam.element, []).append(beam)
    return kinds


def has_mass_of_its_own(body: Any) -> bool:
    """Whether it is in the batch of masses, see :func:`build_bodies`."""
    return not isinstance(body, Beam) or (not body.has_section and bool(of_cable(body.section)))


def build_bodies(model: Model, slots: dict[str, IntArray]) -> Parts:
    """Batch of masses, if there are any."""
    undeformed = [b for b in model.bodies.values() if not isinstance(b, Beam)]
    rotary = rotary_inertia(model.beams.values(), slots)
    return {"bodies": inertia(undeformed, slots, rotary)} if undeformed or rotary else {}


def _joints(model: Model, numbering: Numbering, level: FloatArray, find: Callable[[Point], Probe]) -> Parts:
    """Rows of the rigid bodies, then of the joints; the sliding joints."""
    parts: Parts = {}
    if numbering.rows:
        rows = [row for rows in numbering.rows.values() for row in rows]
        unknowns = np.concatenate([numbering.multipliers[name] for name in numbering.rows])
        parts["joints"] = joint_build.batch(rows, unknowns.tolist(), level)
    return parts | build_slides(model, numbering, level, find)


def build_slides(
    model: Model, numbering: Numbering, level: FloatArray, find: Callable[[Point], Probe]
) -> Parts:
    """Batch of sliding joints, if there are any."""
    slides = [joint for joint in model.connections if isinstance(joint, Slide)]
    first = [int(numbering.multipliers[joint.name][0]) for joint in slides]
    return {"slides": sliding(slides, first, level, find, numbering.slots)} if slides else {}


def order_blocks(parts: Parts, numbering: Numbering) -> tuple[IntArray, IntArray, str, int]:
    """Number the blocks so that L stays thin.

    Returns
    -------
    rank : ndarray, shape (blocks,)
        New place of each block; the numbering has them already.
    pairs : ndarray, shape (m, 2)
        Pairs of blocks that some batch couples, in the new places.
    ordering : str
        How they were ordered.
    half_bandwidth : int
        In unknowns, without the rows that come last.
    """
    last = with_role(parts.values(), Role.SLIDES)
    couples = [(traits(b).couples, b) for b in parts.values() if Role.SLIDES not in traits(b).role]
    plain = block_pairs([b for own, b in couples if own is None])
    pairs = np.concatenate([plain, *(own(b) for own, b in couples if own is not None)])
    rank, ordering = order(pairs, numbering.blocks)
    joints = set((numbering.all_multipliers() // 6).tolist())
    behind_bodies = sorted(joints - set(numbering.sliding))
    spread = _spread(behind(rank, pairs, behind_bodies, numbering.sliding), pairs)
    if ordering != MINIMUM_DEGREE and not _is_line(parts):
        rank = from_both_ends(rank, _spread(rank, pairs))
    rank = behind(rank, pairs, behind_bodies, numbering.sliding)
    numbering.renumber(rank)
    moving = [own(b) for b in last if (own := traits(b).couples) is not None]
    return rank, rank[np.concatenate([pairs, *moving])], ordering, 6 * (spread + 1) - 1


def _spread(rank: IntArray, pairs: IntArray) -> int:
    """Largest difference of the places of two blocks that are coupled."""
    return int(np.max(np.abs(rank[pairs[:, 0]] - rank[pairs[:, 1]]), initial=0))


def bind_parts(parts: Parts, rank: IntArray, constraints: Constraints, places: Places) -> Parts:
    """Batches that read and write the shadows, with the places of the unknowns in the matrix."""
    unknown = np.arange(6 * len(rank), dtype=np.int64)
    to_unknown = 6 * rank[unknown // 6] + unknown % 6
    to_seen = to_unknown
    if constraints.rotations:
        shadow = unknown.copy()
        for k, rotation in enumerate(constraints.rotations):
            shadow[rotation.slot] = len(shadow) + 3 * k
        to_seen = shadow[to_unknown]
    bound: Parts = {}
    for name, batch in parts.items():
        plain = _mapped(batch, to_unknown)
        seen = _mapped(batch, to_seen) if constraints.rotations else plain
        own = traits(batch).bind
        bound[name] = own(plain, seen, places) if own else seen._replace(dest=places.dest(plain.base))
    share(bound)
    share_bumps(bound)
    return bound


def _mapped(batch: Any, table: IntArray) -> Any:
    """A batch whose unknowns are replaced by those of a table."""
    changes = {}
    for name in traits(batch).slots:
        unknowns = getattr(batch, name)
        changes[name] = np.where(unknowns >= 0, table[unknowns], -1)
    return batch._replace(**changes)


def make_core(
    parts: Parts,
    places: Places,
    weight: FloatArray,
    supports: Supports,
    joints: Joints,
    dead: Loads,
) -> Core:
    """What the kernels work on."""
    batches = tuple(parts.values())
    factor = allocate(places.row_start, places.column)
    external, rubbing = with_role(batches, Role.EXTERNAL), with_role(batches, Role.RUBS)
    losing = [b for b in batches if _damped(b) and Role.RUBS not in traits(b).role]
    near = near_of(batches, factor, supports.rot_slot, len(weight)) if _is_line(parts) else ()
    return Core(
        batches=Batches(batches),
        external=Batches(external),
        rubbing=Batches(rubbing),
        losing=Batches(losing),
        inertial=Batches(alone(b) for b in losing if (alone := traits(b).inertial)),
        remembering=Batches(b for b in batches if traits(b).memory),
        entwined=Batches(b for b in batches if isinstance(b, StrandBatch) and not isinstance(b, GripBatch)),
        near=near,
        far=(no_far(),) if near else (),
        ws=workspace(),
        A=np.zeros(places.size),
        factor=factor,
        weight=weight,
        supports=supports,
        joints=joints,
        loads=dead,
        sticks=any(_sticks(b) for b in batches if len(b[0])),
        damped=bool(rubbing) or bool(losing),
        loses=bool(losing),
        loaded=bool(len(dead.value) or any(len(b.base) for b in external) or len(supports.driven)),
        accounted=True,
    )


def _is_line(parts: Parts) -> bool:
    """Whether strips run along wires, without joints: blocks then ascend along these, see near."""
    others = ("joints", "slides", "crossing", "gripping")
    return "contacts" in parts and not any(name in parts for name in others)


def _sticks(batch: Any) -> bool:
    late = traits(batch).late
    return late is not None and late(batch) is not None


def _damped(batch: Any) -> bool:
    damped = traits(batch).damped
    return damped is not None and damped(batch)


def joined(parts: list[NDArray[Any]], dtype: type) -> NDArray[Any]:
    """One array of all."""
    return np.concatenate([np.zeros(0), *parts]).astype(dtype)


def held_arrays(held: IntArray, places: Places, used: NDArray[np.bool_]) -> dict[str, Any]:
    """What of Supports belongs to held unknowns; those that nothing has ``used`` have zeros already."""
    return {
        "held": np.ascontiguousarray(held, dtype=np.int64),
        "held_zero": places.crosses(held[used[held]]),
        "held_one": np.ascontiguousarray(36 * (held // 6) + 7 * (held % 6), dtype=np.int64),
    }


def rotation_arrays(constraints: Constraints, places: Places, n: int) -> dict[str, Any]:
    """What of Supports belongs to local axes; n: unknowns."""
    k = len(constraints.rotations)
    R = np.zeros((k, 3, 3, 3))
    moving = np.full(k, -1, dtype=np.int64)
    rows, rows_of, cols, cols_of = [], [], [], []
    for i, r in enumerate(constraints.rotations):
        R[i, 0] = r.R0
        if r.moves:
            moving[i] = int(np.max(moving[:i], initial=-1)) + 1
        row, col = places.pieces(r.slot)
        rows.append(row)
        cols.append(col)
        rows_of.append(np.full(len(row), i))
        cols_of.append(np.full(len(col), i))
    return {
        "rot_slot": np.array([r.slot for r in constraints.rotations], dtype=np.int64),
        "rot_shadow": n + 3 * np.arange(k, dtype=np.int64),
        "rot_R": R,
        "rot_moving": moving,
        "rot_rows": joined(rows, np.int64),
        "rot_rows_of": joined(rows_of, np.int64),
        "rot_cols": joined(cols, np.int64),
        "rot_cols_of": joined(cols_of, np.int64),
    }
