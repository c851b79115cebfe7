"""System: a Model compiled once to flat arrays that the kernels work on."""

from __future__ import annotations

import warnings
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import Role, traits, with_role
from ..connections.spring_damper import gauges
from ..errors import ModelError
from ..linalg.ordering import fill_pattern
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import PointMass
from ..model.joints.basic import Slide
from ..model.joints.connections import Spring
from ..model.joints.touching import bodies_of
from ..model.model import Model
from ..model.points import Point
from ..model.supports.winches import check_winches
from ..model.surfaces.body_contact import BodyContact
from ..model.surfaces.cable_contact import CableContact
from ..model.surfaces.contact import Contact
from ..model.surfaces.surface import SurfaceContact
from . import loads
from .compile import bind_parts, build_parts, held_arrays, order_blocks
from .core import Core, place_supports
from .derived import Derived
from .initial_motion import at_rest, shape_rates, spin_of, spun
from .inputs import Inputs
from .joints import set_scales, share_scales
from .matrix import Places
from .nodes import start_vectors
from .numbering import Numbering
from .probe import Probe, lengths_of, locate
from .sensors import Listing
from .supports import collect


class System(Derived):
    """All arrays of a model, in the order in which the solver eliminates the nodes.

    Parameters
    ----------
    model : Model
    spare : ndarray, optional
        Multipliers of rows that others hold already: they are zero.
    like : System, optional
        One of the same bodies and connections with other numbers: its order of the nodes is taken over.

    Attributes
    ----------
    value : ndarray, shape (loads, 3)
        Inputs of loads as they are now.
    parts : dict of str to batch
        The batches of the core by name: elements by their kind, "springs", "moments", "section moments",
        other loads that depend on the state by the word of their kind, "bodies", "contacts", "pressing" and
        "rubbing" (on surfaces), "crossing" and "gripping" (cables on cables), "bumping"
        and "rolling" (bodies on bodies), "joints" (their rows) and "slides".
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
    measured : ndarray, shape (m,)
        What contacts and springs leave beside the state, for sensors: shared with their batches.
    measures : dict of str to ndarray
        Entries of ``measured`` by connection: four of a contact, force and length of a spring.
    """

    def __init__(self, model: Model, spare: IntArray | None = None, like: System | None = None) -> None:
        if not model.bodies:
            raise ModelError("bodies", "the model has no body", "add one with model.add_beam(...)")
        check_winches(model)
        self.model = model.snapshot()
        self.numbering = Numbering(model)
        self.level = np.array([1.0, 0.0, 0.0])
        self.sensors = Listing()
        kinds = Contact, SurfaceContact, CableContact, BodyContact
        contacts = [c.name for kind in kinds for c in model.connections if isinstance(c, kind)]
        springs = [c.name for c in model.connections if isinstance(c, Spring)]
        touched = 4 * len(contacts)
        self.measured = np.zeros(touched + 2 * len(springs))
        self.measures = {name: 4 * k + np.arange(4) for k, name in enumerate(contacts)}
        self.measures |= {name: touched + 2 * k + np.arange(2) for k, name in enumerate(springs)}
        functions = loads.functions(model)
        value = np.zeros((len(functions), 3))
        parts = build_parts(model, self.numbering, self.level, value, self.measured[:touched].reshape(-1, 4))
        self._order(parts, like)
        self.constraints = collect(model, self.numbering)
        self.spare = np.zeros(0, dtype=np.int64) if spare is None else spare
        self.constraints.held |= set(self.spare.tolist())
        self.n = 6 * self.numbering.blocks
        self.size = self.n + 3 * len(self.constraints.rotations)
        self.slots = {name: self._shadowed(s) for name, s in self.numbering.slots.items()}
        self.multipliers = self.numbering.all_multipliers()
        self.joints = _joint_unknowns(self.numbering)
        first = {item.name: item.value for item in model.inputs.values()}
        self.inputs = Inputs(functions, self.constraints, first)
        self.value = value
        self.parts = bind_parts(parts, self.rank, self.constraints, self.places)
        self._like = like
        if like is None or not share_scales(self, like):
            set_scales(self)

    def _order(self, parts: Any, like: System | None) -> None:
        """Order of the nodes and pattern of the matrix."""
        self.rank: IntArray
        self.pairs: IntArray
        self.ordering: str
        self.half_bandwidth: int
        self.places: Places
        if like is not None and like.numbering.blocks == self.numbering.blocks:
            found = like.rank, like.pairs, like.ordering, like.half_bandwidth
            self.numbering.renumber(like.rank)
        else:
            found = order_blocks(parts, self.numbering)
            like = None
        self.rank, self.pairs, self.ordering, self.half_bandwidth = found
        self.places = like.places if like else Places(*fill_pattern(self.pairs, self.numbering.blocks))

    def __reduce__(self) -> Any:
        """Addresses of compiled operations hold in one process alone: another one makes the system again."""
        kept = self.model, self.spare, self.sensors, self.measured, self.kept_memory()
        return _again, (*kept, bool(self.core.accounted))

    @property
    def memory(self) -> dict[str, FloatArray]:
        """What batches remember of the motion so far, by "part.array"; no copies."""
        return {
            f"{name}.{key}": getattr(batch, key)
            for name, batch in self.parts.items()
            for key in traits(batch).memory
            if getattr(batch, key).size
        }

    def kept_memory(self) -> dict[str, FloatArray]:
        """Copies of what batches remember, see :meth:`bring_memory`."""
        return {name: x.copy() for name, x in self.memory.items()}

    def bring_memory(self, kept: dict[str, FloatArray]) -> None:
        """Let batches remember what was kept; what is not there stays."""
        for name, x in self.memory.items():
            if name in kept:
                x[...] = kept[name]

    def weights(self) -> FloatArray:
        """With which changes of unknowns are measured, 1 for their shadows, (size,)."""
        weights = np.ones(self.size)
        weights[: self.n] = self.core.weight
        return weights

    @property
    def measuring(self) -> tuple[Any, ...]:
        """Batches with an operation ``measure`` that renew what the sensors have listed.

        All contacts if there is one among it, and of the springs those alone.
        """
        listed, springs = self.sensors, self.springs
        batches = with_role(self.core.batches, Role.MEASURES) if listed.columns else ()
        found = tuple(batch for batch in batches if batch is not springs)
        if not listed.springs:
            return found
        gauged = self.measured[-2 * len(springs.base) :].reshape(-1, 2)
        entries = np.concatenate([self.measures[name][:1] for name in listed.springs])
        wanted = (entries - (len(self.measured) - gauged.size)) // 2
        return *found, gauges(springs, wanted, gauged)

    def skip_energies(self) -> None:
        """Do not account for what is dissipated and supplied in a run."""
        self.core = self.core._replace(accounted=False)

    def probe(self, point: Point) -> Probe:
        """Where the state of a point of the model is found."""
        return locate(point, self.slots[point.body.name], self.lengths.get(point.body.name, (-1, 0.0)))

    @cached_property
    def lengths(self) -> dict[str, tuple[int, float]]:
        """Of cables with a winch, see :func:`ancf.system.probe.lengths_of`."""
        return lengths_of(self.model, self.joints)

    def _shadowed(self, slots: IntArray) -> IntArray:
        """Slots as elements and results see them: the shadow where there are local axes."""
        seen = slots.copy()
        for k, rotation in enumerate(self.constraints.rotations):
            seen[slots == rotation.slot] = self.n + 3 * k
        return seen

    def holding(self, bodies: list[str]) -> Core:
        """Core in which these bodies are held altogether; joints to others carry nothing."""
        extra = [self.numbering.slots[name].ravel()[:, None] + np.arange(3) for name in bodies]
        idle = [j.name for j in self.model.connections if set(bodies_of(j)) & set(bodies)]
        extra += [self.joints[name] for name in (*idle, *bodies) if name in self.joints]
        held = np.unique(np.concatenate([self.held, *[e.ravel() for e in extra]]))
        supports = self.supports._replace(**held_arrays(held, self.places, self.numbering.used()))
        return self.core._replace(supports=supports)

    @cached_property
    def double(self) -> System:
        """Another one of the same model, to ask what would write into the arrays of a run."""
        return System(self.model, self.spare)

    @cached_property
    def free(self) -> IntArray:
        """Unknowns that move freely."""
        return np.setdiff1d(np.arange(self.n), self.held)

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

    def shortest_slope(self, q: FloatArray) -> tuple[str, float] | None:
        """Node of a cable with the shortest tangent r_x, and its length; None without cables."""
        found = []
        for name, slots in self.slots.items():
            if slots.shape[1] == 2:  # r and r_x
                sizes = np.linalg.norm(q[slots[:, 1][:, None] + np.arange(3)], axis=1)
                k = int(np.argmin(sizes))
                found.append((f"{name} at node {k}", float(sizes[k])))
        return min(found, key=lambda node: node[1], default=None)

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
            R, dR = self.supports.rot_R[k, :2]
            own, shadow = slice(r.slot, r.slot + 3), slice(self.n + 3 * k, self.n + 3 * k + 3)
            new_q[own] = R.T @ before[0][shadow]
            new_v[own] = R.T @ (before[1][shadow] - dR @ new_q[own])
        held = self.held
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
        """Put supports where they are at ``time``, and inputs of loads; fills the shadows."""
        if self.inputs.still and not len(self.value) and not self.constraints.rotations:
            return  # nothing moves, and nothing is seen along other axes
        place_supports(self.supports, self.value, self.inputs.moment(time, (q, v)), 0, q, v, a)

    def _set_motion(self, q: FloatArray, v: FloatArray, a: FloatArray, time: float) -> None:
        """Initial rigid motions of the bodies; what a support holds follows the support."""
        wanted = v.copy()
        moving = [b for b in self.model.bodies.values() if not at_rest(b)]
        for body in moving:
            slots = self.slots[body.name]
            shaped = shape_rates(body) if isinstance(body, Beam) and body.along.size else None
            for k in range(slots.shape[1]):
                arm = np.stack([q[slots[:, k] + c] for c in range(3)], axis=1)
                if k == 0 and not isinstance(body, PointMass):
                    arm -= body.about
                rate = spun(spin_of(body), arm) + (body.velocity if k == 0 else 0.0)
                if shaped is not None:
                    rate += shaped[:, k]
                for c in range(3):
                    wanted[slots[:, k] + c] = rate[:, c]
        if not moving:
            return
        for k, r in enumerate(self.constraints.rotations):
            shadow = slice(self.n + 3 * k, self.n + 3 * k + 3)
            R, dR = self.supports.rot_R[k, :2]
            wanted[r.slot : r.slot + 3] = R.T @ (wanted[shadow] - dR @ q[r.slot : r.slot + 3])
        given = v.copy()
        v[: self.n] = wanted[: self.n]
        held = self.held
        v[held] = given[held]
        self._warn_of_jump(wanted, v)
        self.place(time, q, v, a)

    def _warn_of_jump(self, wanted: FloatArray, v: FloatArray) -> None:
        gap = np.abs(wanted[: self.n] - v[: self.n]) * self.weight
        worst = int(np.argmax(gap))
        moved = np.maximum(np.abs(wanted[: self.n]), np.abs(v[: self.n]))
        spins = [float(np.linalg.norm(spin_of(body))) for body in self.model.bodies.values()]
        if gap[worst] > 1e-9 * max(float(np.max(moved * self.weight)), *spins):
            name = self.numbering.describe(worst)
            text = f"{name}: set_motion asks for {wanted[worst]:.6g}, the support holds it at {v[worst]:.6g}"
            hint = "; the support wins: let it move so too, or change set_motion"
            warnings.warn(text + hint, UserWarning, stacklevel=2)


def _again(
    model: Model,
    spare: IntArray,
    sensors: Listing,
    measured: FloatArray,
    memory: dict[str, FloatArray],
    accounted: bool,
) -> System:
    """A system that was pickled."""
    made = System(model, spare)
    made.model, made.sensors, made.measured[...] = model, sensors, measured
    made.bring_memory(memory)
    if not accounted:
        made.skip_energies()
    return made


def _joint_unknowns(numbering: Numbering) -> dict[str, IntArray]:
    """Multipliers by joint or rigid body, followed by s for a sliding joint; the length by winch."""
    found = {name: unknowns.copy() for name, unknowns in numbering.multipliers.items()}
    for name, arc in numbering.arcs.items():
        found[name] = np.append(found[name], arc)
    return found | {name: np.array([unknown]) for name, unknown in numbering.lengths.items()}
