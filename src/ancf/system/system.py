"""System: a Model compiled once to flat arrays that the kernels work on."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..bodies.build import inertia
from ..connections import joint_build
from ..connections.contact import ContactBatch
from ..connections.contact_build import contacts
from ..connections.joint import JointBatch
from ..connections.sliding import SlidingBatch
from ..connections.sliding_build import sliding
from ..connections.spring_build import springs
from ..connections.spring_damper import SpringBatch
from ..elements.lanes import workspace
from ..elements.registry import ELEMENTS
from ..errors import ModelError
from ..linalg.block_ldl import allocate
from ..linalg.ordering import behind, fill_pattern, order
from ..loads.moment import MomentBatch
from ..loads.section_moment import SectionMomentBatch
from ..model.beam import Beam
from ..model.bodies import PointMass, RigidBody
from ..model.contact import Contact
from ..model.joints import Slide
from ..model.loads import Moment
from ..model.model import Model
from ..model.points import Point
from ..model.touching import bodies_of
from . import loads
from .core import Core, Loads, Supports, place_supports
from .inputs import Inputs
from .joints import bind_joints, bind_sliding, core_joints, joint_pairs, set_scales, sliding_pairs
from .matrix import Places, block_pairs
from .nodes import start_vectors
from .numbering import Numbering
from .probe import Probe, locate
from .sensors import Listing
from .supports import Constraints, collect

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class System:
    """All arrays of a model, in the order in which the solver eliminates the nodes.

    Parameters
    ----------
    model : Model

    Attributes
    ----------
    core : Core
        What the kernels work on.
    inputs : Inputs
        Functions of time.
    n : int
        Unknowns, held ones included; a state vector is longer by the shadows, see ``size``.
    ordering : str
        How the nodes were ordered: "as given", "band" or "minimum degree".
    half_bandwidth : int
        Of the matrix, in unknowns.
    sensors : Listing
        What a run records at every step.
    measuring : tuple
        Batches with an operation ``measure``.
    measured : ndarray, shape (m,)
        What these leave beside the state, for sensors; shared with them.
    measures : dict of str to ndarray
        Entries of ``measured`` by connection.
    """

    def __init__(self, model: Model) -> None:
        if not model.bodies:
            raise ModelError("bodies", "the model has no body", "add one with model.add_beam(...)")
        self.model = model
        self.numbering = Numbering(model)
        self.level = np.array([1.0, 0.0, 0.0])
        self.contacts = [c for c in model.connections if isinstance(c, Contact)]
        self.measured = np.zeros(4 * len(self.contacts))
        self.measures = {c.name: 4 * k + np.arange(4) for k, c in enumerate(self.contacts)}
        self.moment = np.zeros((sum(isinstance(load, Moment) for load in model.loads), 3))
        self._order(self._batches(self.numbering.slots))
        self.constraints = collect(model, self.numbering)
        self.places = Places(*fill_pattern(self.pairs, self.numbering.blocks))
        self.n = 6 * self.numbering.blocks
        self.size = self.n + 3 * len(self.constraints.rotations)
        self.slots = {name: self._shadowed(s) for name, s in self.numbering.slots.items()}
        self.multipliers = self.numbering.all_multipliers()
        self.joints = _joint_unknowns(self.numbering)
        self.patterns, load_functions = loads.patterns(model, self.probe, self.slots, self.numbering.arcs)
        batches = self._batches(self.numbering.slots)
        moment_functions = loads.moments(model, self.probe, self.moment)[1]
        self.inputs = Inputs(load_functions, moment_functions, self.constraints)
        self.core = self._core(batches)
        set_scales(self)
        self.measuring = tuple(b for b in self.core.batches if isinstance(b, ContactBatch))
        self.sensors = Listing()

    def skip_energies(self) -> None:
        """Do not account for what is dissipated and supplied in a run."""
        self.core = self.core._replace(accounted=False)

    def probe(self, point: Point) -> Probe:
        """Where the state of a point of the model is found."""
        return locate(point, self.slots[point.body.name])

    def _batches(self, slots: dict[str, IntArray]) -> list[Any]:
        def find(point: Point) -> Probe:
            return locate(point, slots[point.body.name])

        model = self.model
        kinds: dict[str, list[Beam]] = {}
        for beam in model.beams.values():
            kinds.setdefault(beam.element, []).append(beam)
        elements = [
            ELEMENTS[kind].build(beams, [slots[b.name] for b in beams]) for kind, beams in kinds.items()
        ]
        batches = [*elements, springs(model, find), *loads.moments(model, find, self.moment)[0]]
        undeformed = [b for b in model.bodies.values() if not isinstance(b, Beam)]
        if undeformed:
            batches.append(inertia(undeformed, slots))
        if self.contacts:
            batches.append(contacts(self.contacts, find, slots, self.measured.reshape(-1, 4)))
        return [*batches, *self._joint_batches(slots, find)]

    def _joint_batches(self, slots: dict[str, IntArray], find: Callable[[Point], Probe]) -> list[Any]:
        rows, unknowns, slides = [], [], []
        for body in self.model.rigid_bodies.values():
            rows += joint_build.rigid(body, slots)
            unknowns += self.numbering.multipliers[body.name].tolist()
        for joint in self.model.connections:
            if isinstance(joint, Slide):
                slides.append(joint)
            elif joint.name in self.numbering.multipliers:
                rows += joint_build.rows_of(joint, find, slots)
                unknowns += self.numbering.multipliers[joint.name].tolist()
        batches: list[Any] = [joint_build.batch(rows, unknowns, self.level)] if rows else []
        if slides:
            first = [int(self.numbering.multipliers[joint.name][0]) for joint in slides]
            batches.append(sliding(slides, first, self.level, find, slots))
        return batches

    def _order(self, batches: list[Any]) -> None:
        """Number the blocks so that L stays thin."""
        fixed = [joint_pairs(b) for b in batches if isinstance(b, JointBatch)]
        moving = [sliding_pairs(b) for b in batches if isinstance(b, SlidingBatch)]
        special = JointBatch | SlidingBatch | ContactBatch
        plain = block_pairs([b for b in batches if not isinstance(b, special)])
        pairs = np.concatenate([plain, *fixed])
        rank, self.ordering = order(pairs, self.numbering.blocks)
        joints = np.unique(self.numbering.all_multipliers() // 6)
        rank = behind(rank, pairs, np.setdiff1d(joints, self.numbering.sliding), self.numbering.sliding)
        self.numbering.renumber(rank)
        self.pairs = rank[np.concatenate([pairs, *moving])]
        spread = int(np.max(np.abs(np.diff(rank[pairs], axis=1)), initial=0))
        self.half_bandwidth = 6 * (spread + 1) - 1

    def _shadowed(self, slots: IntArray) -> IntArray:
        """Slots as elements and results see them: the shadow where there are local axes."""
        seen = slots.copy()
        for k, rotation in enumerate(self.constraints.rotations):
            seen[slots == rotation.slot] = self.n + 3 * k
        return seen

    def _core(self, batches: list[Any]) -> Core:
        # elements read and write the shadows; the matrix knows the unknowns alone
        seen = self._batches(self.slots)
        batches = [self._bound(plain, shadowed) for plain, shadowed in zip(batches, seen, strict=True)]
        followers = tuple(b for b in batches if isinstance(b, MomentBatch | SectionMomentBatch))
        springs_batch = next(b for b in batches if isinstance(b, SpringBatch))
        damped = any(beam.section.damped for beam in self.model.beams.values())
        slides = [joint for joint in self.model.connections if isinstance(joint, Slide)]
        rubbed = any(joint.viscous or joint.friction for joint in slides)
        rubbed |= any(contact.damping for contact in self.contacts)
        driven = np.array(sorted(self.constraints.driven), dtype=np.int64)
        supports = Supports(
            **_held_arrays(self._held(), self.places),
            **_rotation_arrays(self.constraints, self.places, self.n),
            prescribed=self.inputs.prescribed,
            driven=self._shadowed(driven),
        )
        return Core(
            batches=tuple(batches),
            followers=followers,
            ws=workspace(),
            A=np.zeros(self.places.size),
            factor=allocate(self.places.row_start, self.places.column),
            weight=self._weight(),
            supports=supports,
            joints=core_joints(batches, self, supports),
            loads=Loads(
                gravity=loads.gravity(self.model, self.slots, self.size),
                start=np.cumsum([0] + [len(p[0]) for p in self.patterns]).astype(np.int64),
                slot=_joined([p[0] for p in self.patterns], np.int64),
                factor=_joined([p[1] for p in self.patterns], np.float64),
                moment=self.moment,
            ),
            damped=damped or rubbed or bool(np.any(springs_batch.data[:, 1])),
            loaded=bool(self.patterns or len(self.moment) or len(driven)),
            accounted=True,
        )

    def _bound(self, plain: Any, seen: Any) -> Any:
        """A batch with its places in the matrix."""
        if isinstance(plain, JointBatch):
            return bind_joints(plain, seen, self.places)
        if isinstance(plain, SlidingBatch):
            return bind_sliding(plain, seen, self.places)
        if isinstance(plain, ContactBatch):  # it does not enter the matrix
            return seen
        return seen._replace(dest=self.places.dest(plain.base))

    def _held(self) -> IntArray:
        unused = np.flatnonzero(~self.numbering.used())
        return np.unique(np.concatenate([unused, sorted(self.constraints.held)])).astype(np.int64)

    def _weight(self) -> FloatArray:
        weight, size = np.ones(self.n), self.model.size
        for slots in self.numbering.slots.values():
            for c in range(3):
                weight[slots[:, 0] + c] = 1.0 / size
        for name, beam in self.model.beams.items():
            internal = self.numbering.slots[name][:-1, self.numbering.shared[name] :]
            for c in range(3):
                weight[internal + c] = np.diff(beam.node_x)[:, None]
        weight[self.numbering.all_multipliers()] = 0.0
        weight[list(self.numbering.arcs.values())] = 1.0 / size
        return weight

    def holding(self, bodies: list[str]) -> Core:
        """Core in which these bodies are held altogether; joints to others carry nothing."""
        extra = [self.numbering.slots[name].ravel()[:, None] + np.arange(3) for name in bodies]
        idle = [j.name for j in self.model.connections if set(bodies_of(j)) & set(bodies)]
        extra += [self.joints[name] for name in (*idle, *bodies) if name in self.joints]
        held = np.unique(np.concatenate([self.core.supports.held, *[e.ravel() for e in extra]]))
        supports = self.core.supports._replace(**_held_arrays(held, self.places))
        return self.core._replace(supports=supports)

    @cached_property
    def free(self) -> IntArray:
        """Unknowns that move freely."""
        return np.setdiff1d(np.arange(self.n), self.core.supports.held)

    def initial_state(self, time: float = 0.0) -> tuple[FloatArray, FloatArray]:
        """State vectors q and v of the initial shape and motion, supports as at ``time``."""
        q = self.initial_shape(time)
        return q, self.motion(q, time)

    def initial_shape(self, time: float = 0.0) -> FloatArray:
        """State vector q of the initial shape, supports as at ``time``."""
        q, v, a = np.zeros(self.size), np.zeros(self.size), np.zeros(self.size)
        for body in self.model.bodies.values():
            slots = self.numbering.slots[body.name]
            values = start_vectors(body)
            for c in range(3):
                q[slots + c] = values[:, :, c]
        for joint in self.model.connections:
            if isinstance(joint, Slide):
                q[self.numbering.arcs[joint.name]] = joint.s
        self._to_local(q)
        self.place(time, q, v, a)
        return q

    def element_of(self, slot: int) -> str:
        """Name of the element of a beam at whose first node r_y has this slot (as the batches see it)."""
        for name, slots in self.slots.items():
            if slots.shape[1] > 2 and slot in slots[:, 2]:
                return f"{name} element {int(np.flatnonzero(slots[:, 2] == slot)[0])}"
        return f"unknown {slot}"

    def adopt(
        self,
        slots: dict[str, IntArray],
        joints: dict[str, IntArray],
        q: FloatArray,
        v: FloatArray,
        time: float,
    ) -> tuple[FloatArray, FloatArray]:
        """State vectors from those of a system with the same bodies; supports as at ``time``."""
        new_q, new_v, a = np.zeros(self.size), np.zeros(self.size), np.zeros(self.size)
        for new, old in ((new_q, q), (new_v, v)):
            for name, target in self.slots.items():
                for c in range(3):
                    new[target + c] = old[slots[name] + c]
            for name, unknowns in self.joints.items():
                if name in joints and len(joints[name]) == len(unknowns):
                    new[unknowns] = old[joints[name]]
        before = new_q.copy(), new_v.copy()
        self.place(time, new_q, new_v, a)  # the rotations of this time
        for k, r in enumerate(self.constraints.rotations):
            R, dR = self.core.supports.rot_R[k, :2]
            own, shadow = slice(r.slot, r.slot + 3), slice(self.n + 3 * k, self.n + 3 * k + 3)
            new_q[own] = R.T @ before[0][shadow]
            new_v[own] = R.T @ (before[1][shadow] - dR @ new_q[own])
        held = self.core.supports.held
        still = np.setdiff1d(held, self.inputs.prescribed)
        new_v[still] = 0.0
        self.place(time, new_q, new_v, a)
        return new_q, new_v

    def motion(self, q: FloatArray, time: float) -> FloatArray:
        """Velocities of the bodies' initial rigid motions at the shape q, supports as at ``time``."""
        q, v, a = q.copy(), np.zeros(self.size), np.zeros(self.size)
        self.place(time, q, v, a)
        self._set_motion(q, v, a, time)
        return v

    def _to_local(self, q: FloatArray) -> None:
        for r in self.constraints.rotations:
            q[r.slot : r.slot + 3] = r.R0.T @ q[r.slot : r.slot + 3]

    def place(self, time: float, q: FloatArray, v: FloatArray, a: FloatArray) -> None:
        """Put supports where they are at ``time``, and moments; fills the shadows."""
        h = 1e-3
        tables = self.inputs.tables(time - h, h, 1, time, np.inf)
        place_supports(self.core.supports, self.core.loads.moment, tables, 0, q, v, a)

    def _set_motion(self, q: FloatArray, v: FloatArray, a: FloatArray, time: float) -> None:
        """Initial rigid motions of the bodies; what a support holds follows the support."""
        wanted = v.copy()
        moving = [b for b in self.model.bodies.values() if np.any(b.velocity) or np.any(_spin(b))]
        for body in moving:
            slots = self.slots[body.name]
            for k in range(slots.shape[1]):
                arm = np.stack([q[slots[:, k] + c] for c in range(3)], axis=1)
                if k == 0 and not isinstance(body, PointMass):
                    arm -= body.about
                rate = np.cross(_spin(body), arm) + (body.velocity if k == 0 else 0.0)
                for c in range(3):
                    wanted[slots[:, k] + c] = rate[:, c]
        if not moving:
            return
        for k, r in enumerate(self.constraints.rotations):
            shadow = slice(self.n + 3 * k, self.n + 3 * k + 3)
            R, dR = self.core.supports.rot_R[k, :2]
            wanted[r.slot : r.slot + 3] = R.T @ (wanted[shadow] - dR @ q[r.slot : r.slot + 3])
        given = v.copy()
        v[: self.n] = wanted[: self.n]
        held = self.core.supports.held
        v[held] = given[held]
        self._warn_of_jump(wanted, v)
        self.place(time, q, v, a)

    def _warn_of_jump(self, wanted: FloatArray, v: FloatArray) -> None:
        gap = np.abs(wanted[: self.n] - v[: self.n]) * self.core.weight
        worst = int(np.argmax(gap))
        if gap[worst] > 1e-9 * np.max(np.abs(wanted[: self.n]) * self.core.weight):
            name = self.numbering.describe(worst)
            text = f"{name}: set_motion asks for {wanted[worst]:.6g}, the support holds it at {v[worst]:.6g}"
            warnings.warn(text + "; the support wins", UserWarning, stacklevel=2)


def _spin(body: Beam | PointMass | RigidBody) -> FloatArray:
    return np.zeros(3) if isinstance(body, PointMass) else body.angular_velocity


def _joint_unknowns(numbering: Numbering) -> dict[str, IntArray]:
    """Multipliers by joint or rigid body, followed by s for a sliding joint."""
    found = {name: unknowns.copy() for name, unknowns in numbering.multipliers.items()}
    for name, arc in numbering.arcs.items():
        found[name] = np.append(found[name], arc)
    return found


def _joined(parts: list[NDArray], dtype: type) -> NDArray:  # type: ignore[type-arg]
    return np.concatenate([np.zeros(0), *parts]).astype(dtype)


def _held_arrays(held: IntArray, places: Places) -> dict[str, Any]:
    crosses = [places.cross(int(i)) for i in held]
    return {
        "held": np.ascontiguousarray(held, dtype=np.int64),
        "held_zero": _joined(crosses, np.int64),
        "held_one": np.ascontiguousarray(36 * (held // 6) + 7 * (held % 6), dtype=np.int64),
    }


def _rotation_arrays(constraints: Constraints, places: Places, n: int) -> dict[str, Any]:
    k = len(constraints.rotations)
    R = np.zeros((k, 3, 3, 3))
    moving = np.full(k, -1, dtype=np.int64)
    rows, rows_of, cols, cols_of = [], [], [], []
    for i, r in enumerate(constraints.rotations):
        R[i, 0] = r.R0
        if r.angle is not None:
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
        "rot_rows": _joined(rows, np.int64),
        "rot_rows_of": _joined(rows_of, np.int64),
        "rot_cols": _joined(cols, np.int64),
        "rot_cols_of": _joined(cols_of, np.int64),
    }
