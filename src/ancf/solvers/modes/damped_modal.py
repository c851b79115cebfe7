"""Damped modes about an equilibrium, or about a steady rotation: complex eigenvalues.

In axes that turn with the rate W the equations of motion of all vectors of unknowns are, W being the skew
matrix of the rate on each of them,

    M x'' + (D + 2 M W) x' + (K + M W W) x = 0,    C x = 0,

because the mass matrix is the same in all axes and the elements' forces turn with the body.  What stands
still acts on the velocities that there are, see :mod:`ancf.solvers.statics.standing`.  The steady rotation
itself, q with M W W q + forces + C^T lambda = 0, is found by Newton's method from the given state.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray, IntArray
from ...batches import Batches
from ...elements.cable import CableBatch
from ...elements.solid import SolidBatch
from ...errors import SolveError
from ...later import coo_array, csc_array
from ...linalg.sparse import to_sparse
from ...model.supports.winch import Winch
from ...system.at_rest import assemble_at_rest
from ...system.contacts import Touching, touching
from ...system.core import Core, apply_load, follow_supports, residual
from ...system.reactions import AT_REST
from ...system.system import System
from ..derivatives.differences_of_forces import Differences, axes_of, contacts_of, without_noise
from ..statics.standing import Standing, vectors_and_arms
from .modal import motions, unscaled
from .quadratic import ComplexArray, lowest

MANY = 1500  # unknowns, as all of it is dense
STEADY = 0.05  # velocities that are no rotation, of the largest
SYMMETRIC = 1e-6  # forces that change when the model is turned, of the largest
BALANCED = 1e-7  # forces that are left, of the largest
ALIKE = 1e-4  # derivatives of forces that change when the model is turned, of the largest
ROUNDED = 32.0 * np.finfo(float).eps  # of stiffness times place: what round-off leaves of elastic forces
ROUNDS = 30  # of Newton's method
TURN = 0.3  # rad, by which a model is turned to see whether it turns freely


class Damped:
    """Matrices of a system about a state, in the components that are free."""

    def __init__(self, system: System, q: FloatArray, v: FloatArray, time: float) -> None:
        self.system, self.time = system, time
        self.lam = np.intersect1d(system.free, system.multipliers)
        self.free = np.setdiff1d(system.free, self.lam)
        if len(self.free) > MANY:
            raise SolveError(
                "damped_modes", f"{len(self.free)} unknowns, the most are {MANY}", "take fewer elements"
            )
        self.q = q.copy()
        self.v, self.a = np.zeros_like(q), np.zeros_like(q)
        system.place(time, self.q, self.v, self.a)
        self.spin, self.centre = rotation_of(system, q, v)
        self.axes = axes_of(system)
        self.W = _on_vectors(system, _skew(self.spin))
        self.standing = Standing(system, self.spin, self.centre)
        self.rough = Differences(system, contacts_of(system))
        system.level[:] = 1.0, 0.0, 0.0
        self.M = self._whole(1.0, 0.0, 0.0)
        self.braked = self._braked() if np.any(self.spin) else None
        if np.any(self.spin):
            self._check_surroundings()
            self._check_symmetry()
            self._settle()

    def _braked(self) -> csc_array | None:
        """The damping of beams by what stands still, alike from all sides, which brakes rotation too."""
        if not any(beam.section.damping for beam in self.system.model.beams.values()):
            return None
        own = [b for b in self.system.parts.values() if isinstance(b, CableBatch | SolidBatch)]
        free = [b._replace(lane_data=_unbraked(b.lane_data)) for b in own]
        whole, rest = (self._whole(0.0, 1.0, 0.0, Batches(some)) for some in (own, free))
        return csc_array(whole - rest)

    def _whole(
        self, mass: float, damping: float, stiffness: float, batches: Batches | None = None
    ) -> csc_array:
        core = self.system.core
        parts = core.batches if batches is None else batches
        with unscaled(self.system):
            assemble_at_rest(parts, core.ws, self.q, core.A, mass, damping, stiffness)
        return csc_array(to_sparse(core.A, self.system.places))

    def _part(self, A: csc_array, rows: IntArray, columns: IntArray) -> FloatArray:
        """Rows and columns of a matrix in the components of the unknowns."""
        found: FloatArray = csc_array(self.axes.T @ A @ self.axes)[rows][:, columns].toarray()
        return found

    def whole(self) -> tuple[csc_array, csc_array, csc_array]:
        """Mass, damping and stiffness as they act along global axes, held unknowns included, each (n, n).

        Damping is without the gyroscopic part, stiffness without the centrifugal one; joints are rows and
        columns of it.
        """
        stiffness, damping = self.standing.beyond(self.q)
        system = self.system
        touches, rubs = self._touching(system.core), self._rubbing()
        K = self._whole(0.0, 0.0, 1.0) + csc_array(stiffness) + touches.matrix() + rubs[0]
        resisting = self._whole(0.0, 1.0, 0.0) + csc_array(damping) + touches.brakes() + rubs[1]
        return self.M, csc_array(resisting), csc_array(K)

    def _touching(self, core: Core) -> Touching:
        return touching(core, self.q, self.system.n, lambda row: physical(self.system, row)[: self.system.n])

    def _rubbing(self) -> tuple[csc_array, csc_array]:
        """What matrices of a time step lack of stiffness and damping of contacts: normals that turn."""
        core, own = self.system.core, self.rough.batches
        if not len(own):
            return csc_array((self.system.n, self.system.n)), csc_array((self.system.n, self.system.n))
        touches = self._touching(core._replace(batches=own))
        K, D = (csc_array(x) for x in self.rough.at(self.q, np.zeros_like))
        return (
            without_noise(K, self._whole(0.0, 0.0, 1.0, own) + touches.matrix()),
            without_noise(D, self._whole(0.0, 1.0, 0.0, own) + touches.brakes()),
        )

    def matrices(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Mass, damping with the gyroscopic part, stiffness with the centrifugal one, constraints.

        Leaves the sizes of what cancels in the stiffness in ``terms``.
        """
        f = self.free
        _, resisting, K = self.whole()
        if self.braked is not None:
            K = csc_array(K + self.braked @ self.W)
        M = self._part(self.M, f, f)
        D = self._part(csc_array(resisting + 2.0 * (self.M @ self.W)), f, f)
        centrifugal = self.M @ self.W @ self.W
        turned = self._part(csc_array(K + centrifugal), f, f)
        across = abs(self.axes)
        self.terms = csc_array(across.T @ (abs(K) + abs(centrifugal)) @ across)[f][:, f].toarray()
        return M, D, turned, self._part(K, self.lam, f)

    def _forces(self) -> tuple[FloatArray, float, FloatArray]:
        """What the rotation leaves in the free unknowns and constraints, the largest force, round-off."""
        system = self.system
        arm = physical(system, self.q)
        for slots in system.numbering.slots.values():
            for c in range(3):
                arm[np.unique(slots[:, 0]) + c] -= self.centre[c]
        inertia = self.M @ (self.W @ (self.W @ arm))
        r = self.axes.T @ (self._residual(self.q) + inertia)
        rounded = abs(self.axes.T) @ self._rounded()
        both = np.concatenate([self.free, self.lam])
        return r[both], float(np.max(np.abs(inertia), initial=0.0)), rounded[both]

    def _rounded(self) -> FloatArray:
        """Round-off of elastic forces, (n,): of sums of stiffness times place that cancel, the largest."""
        sums = abs(self._whole(0.0, 0.0, 1.0)) @ np.abs(physical(self.system, self.q))
        weight = np.where(self.system.core.weight > 0.0, self.system.core.weight, 1.0)
        found: FloatArray = ROUNDED * weight * np.max(sums / weight)
        return found

    def _residual(self, q: FloatArray) -> FloatArray:
        """Forces and constraints less loads as the model turns, in global components, (n,)."""
        core, f, r = self.system.core, np.zeros(self.system.size), np.zeros(self.system.size)
        apply_load(core.loads, core.loads.value, f)
        residual(core.batches, core.ws, q, self.standing.velocity(q), np.zeros_like(q), f, r)
        return physical(self.system, r)

    def _check_surroundings(self) -> None:
        """Nothing whose resistance depends on more than the velocity stands still around what turns."""
        model = self.system.model
        outside = [item.name for item in model.fluids] + [item.name for item in model.grounds]
        wound = {item.beam.name for item in model.supports if isinstance(item, Winch)}
        sections = {name: beam.section for name, beam in model.beams.items()}
        braked = [name for name, s in sections.items() if s.slope_damping or (s.damping and name in wound)]
        if outside or braked:
            what = f'"{(braked or outside)[0]}" has or is a resistance that stands still'
            hint = "leave it out of a model that turns; damping= of a section stands for air that is at rest"
            raise SolveError("damped_modes", what, hint)

    def _check_symmetry(self) -> None:
        """Forces turn with the model: what stands still and acts on it does so the same from all sides."""
        from scipy.spatial.transform import Rotation  # few runs turn: see ancf.later

        R = Rotation.from_rotvec(TURN * self.spin / np.linalg.norm(self.spin)).as_matrix()
        turned = self.q.copy()
        places, arms = vectors_and_arms(self.system, self.q, self.centre)
        turned[places] += arms @ R.T - arms
        T = _on_vectors(self.system, R, 1.0)
        before, after = self._residual(self.q), self._residual(turned)
        arm = self.M @ (self.W @ (self.W @ physical(self.system, self.q)))
        largest = max(float(np.max(np.abs(x))) for x in (after, before, arm))
        off = np.abs(after - T @ before) > SYMMETRIC * largest + 2.0 * self._rounded()
        if np.any(off) or not self._softens_alike(turned, T):
            what = "forces or joints that stand still do not act alike from all sides of the axis of rotation"
            raise SolveError(
                "damped_modes",
                what,
                "loads and gravity along the axis, joints that turn about it, bearings alike across it",
            )

    def _softens_alike(self, turned: FloatArray, T: csc_array) -> bool:
        """Whether derivatives of what may stand still, of bearings say, turn with the model."""
        standing = self.standing
        pairs = zip(*(standing.derivatives(q, standing.velocity) for q in (self.q, turned)), strict=True)
        return all(
            np.max(np.abs(after - T @ before @ T.T), initial=0.0)
            <= ALIKE * np.max(np.abs(before), initial=0.0)
            for before, after in pairs
        )

    def _settle(self) -> None:
        """Newton's method for the state that turns steadily, as far as round-off lets it."""
        f, lam, before = self.free, self.lam, np.inf
        for _ in range(ROUNDS):
            left, largest, rounded = self._forces()
            size = float(np.max(np.abs(left)))
            if size <= BALANCED * largest or (size > 0.5 * before and np.all(np.abs(left) <= rounded)):
                return
            before = size
            _, _, K, C = self.matrices()
            scale = np.ones(len(left))
            scale[len(f) :] = np.max(np.abs(K))  # rows of joints as large as stiffnesses
            both = np.block([[K, C.T], [C, np.zeros((len(lam), len(lam)))]]) * np.outer(scale, scale)
            step = scale * np.linalg.lstsq(both, -scale * left, rcond=1e-13)[0]
            self.q[np.concatenate([f, lam])] += step
            follow_supports(self.system.core.supports, self.q, self.v, self.a)
        what = f"{size:.3g} are left of {largest:.3g} N: the state does not turn steadily"
        hint = "let loads, supports and dampers turn with it, or leave them out"
        raise SolveError("damped_modes", what, hint)


def _unbraked(lane_data: FloatArray) -> FloatArray:
    """Constants of elements without their external damping, the last of them."""
    found = lane_data.copy()
    found[:, -1] = 0.0
    return found


def damped_modes_about(
    system: System, q: FloatArray, v: FloatArray, time: float, count: int
) -> tuple[ComplexArray, ComplexArray, FloatArray, FloatArray, FloatArray]:
    """Lowest damped modes about a state.

    Returns
    -------
    values : ndarray of complex, shape (count,)
        Eigenvalues, 1/s, of a pair that with the positive imaginary part.
    shapes : ndarray of complex, shape (count, size)
    whirl : ndarray, shape (count,)
        Along the axis of the spin, 1 and -1 for circles with and against it.
    spin : ndarray, shape (3,)
        rad/s.
    q : ndarray, shape (size,)
        State vector about which they are.
    """
    made = Damped(system, q, v, time)
    M, D, K, C = made.matrices()
    Z = motions(C, np.diag(M).copy()) if len(C) else np.eye(len(M))
    values, vectors = lowest(M, D, K, Z, made.terms, count)
    shapes = np.zeros((len(values), system.size), dtype=complex)
    shapes[:, made.free] = vectors.T
    for shape in shapes:
        for part in (shape.real, shape.imag):
            whole, zero = np.ascontiguousarray(part), np.zeros(system.size)
            follow_supports(system.core.supports, whole, zero, zero.copy())
            part[:] = whole
    return values, shapes, _whirl(made, shapes), made.spin, made.q


def _whirl(made: Damped, shapes: ComplexArray) -> FloatArray:
    """How much of each shape turns about the axis of the spin: of positions, and of what lies along the axis.

    Vectors across the axis turn with their body and tell of a tilt by moving along it.
    """
    rate, system = float(np.linalg.norm(made.spin)), made.system
    if rate == 0.0:
        return np.zeros(len(shapes))
    first = np.concatenate([slots[:, 0] for slots in system.slots.values()])
    places = _vectors(system.slots)
    is_place = np.isin(places[:, 0], first)
    here = made.q[places]
    length = np.linalg.norm(here, axis=1)  # 1 of a direction, 0 of how it changes along an element
    along = (np.abs(here @ made.spin) > 0.7 * rate * length) & (length > 0.5)
    weight = np.where(is_place, 1.0 / system.model.size**2, np.where(along, 1.0, 0.0))
    found = np.zeros(len(shapes))
    for k, shape in enumerate(shapes):
        x = shape[places]
        turned = np.cross(made.spin / rate, x)
        whole = float(weight @ np.sum(np.abs(x) ** 2, axis=1))
        if whole > 0.0:
            found[k] = float(weight @ np.sum(x.conj() * turned, axis=1).imag) / whole
    return found


def rotation_of(system: System, q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rate of the steady rotation that velocities are, rad/s, and a place on its axis, m.

    Raises
    ------
    SolveError
        They are no rotation.
    """
    places = _vectors(system.slots)
    rates = v[places]
    largest = float(np.max(np.abs(rates), initial=0.0))
    if np.max(np.abs(rates) * system.weights()[places], initial=0.0) <= AT_REST:  # round-off of given motions
        return np.zeros(3), np.zeros(3)
    first = np.concatenate([slots[:, 0] for slots in system.slots.values()])
    moved = np.isin(places[:, 0], first)
    blocks = np.zeros((len(places), 3, 6))
    blocks[:, :, :3] = np.array([_skew(-r) for r in q[places]])  # omega x r = -r x omega
    blocks[moved, :, 3:] = np.eye(3)
    found = np.linalg.lstsq(blocks.reshape(-1, 6), rates.ravel(), rcond=None)[0]
    spin: FloatArray = np.array(found[:3], dtype=np.float64)
    shift = found[3:]
    left = np.abs(blocks.reshape(-1, 6) @ found - rates.ravel())
    rate = float(np.linalg.norm(spin))
    along = abs(float(shift @ spin)) / rate if rate > 0.0 else float(np.linalg.norm(shift))
    if np.max(left) > STEADY * largest or along > STEADY * largest:
        what = "the state moves, and not in a steady rotation of all bodies about one axis"
        hint = (
            "give an equilibrium, or velocities of all bodies by set_motion(angular_velocity=), also of those"
        )
        raise SolveError("damped_modes", what, f"{hint} on clamps that turn")
    centre: FloatArray = np.cross(spin, shift) / rate**2
    return spin, centre


def _skew(w: FloatArray) -> FloatArray:
    return np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])


def _vectors(tables: dict[str, IntArray]) -> IntArray:
    """Places of all vectors of nodes, shape (count, 3)."""
    slots = np.unique(np.concatenate([table.ravel() for table in tables.values()]))
    found: IntArray = slots[:, None] + np.arange(3)
    return found


def _on_vectors(system: System, matrix: FloatArray, elsewhere: float = 0.0) -> csc_array:
    """A (3, 3) matrix on all vectors of unknowns, in global components, a number on all others, (n, n)."""
    places = _vectors(system.numbering.slots)
    others = np.setdiff1d(np.arange(system.n), places)
    values = np.concatenate([np.tile(matrix.ravel(), len(places)), np.full(len(others), elsewhere)])
    rows = np.concatenate([np.repeat(places, 3, axis=1).ravel(), others])
    columns = np.concatenate([np.tile(places, (1, 3)).ravel(), others])
    return csc_array(coo_array((values, (rows, columns)), shape=(system.n, system.n)))


def physical(system: System, x: FloatArray) -> FloatArray:
    """Global components (n,) of a state vector or of forces, whose shadows have them."""
    found = x[: system.n].copy()
    supports = system.core.supports
    for slot, shadow in zip(supports.rot_slot.tolist(), supports.rot_shadow.tolist(), strict=True):
        found[slot : slot + 3] = x[shadow : shadow + 3]
    return found
