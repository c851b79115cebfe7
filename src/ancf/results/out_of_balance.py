"""What a state lacks of an equilibrium that modes could be about: forces out of balance, motion of supports.

Modes about a state that is no equilibrium are those of nothing: what is out of balance sets off, and the
stiffness that a tension or a following load gives is not there yet.  Of the initial shape, which nobody may
have thought of, that is an error; of a state that was given it is a note.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError, SolveError
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import PointMass, RigidBody
from ..model.joints.connections import Spring
from ..model.joints.torsion import TorsionSpring
from ..model.model import Model
from ..solvers.derivatives.differences_of_forces import Differences
from ..solvers.modes.damped_modal import rotation_of
from ..system.core import apply_load, residual
from ..system.system import System
from . import remembered
from .remembered import Remembered

#: Share of all loads and reactions that may be out of balance, and of the largest stiffness for round-off.
BALANCED, ROUND_OFF = 1e-3, 1e-10
#: Share of the largest rate, above which a rate is that of a rotation.
ROTATES = 1e-6
#: Rate of a support, m/s or rad/s, below which it rests: differences leave some 1e-13 of an angle per second.
MOVES = 1e-8
#: Size of the rest beside omega^2, whose square is about the share of omega^2 that is wrong.
SMALL = 0.02
#: Unknowns on which such loads act, beyond which nothing is said: a load along all of a long cable.
MANY = 300
HALF = (
    "moments and loads that follow the motion have no potential: modes() takes the symmetric part of their "
    "stiffness, which is far from all of it here; ancf.damped_modes has all of it"
)
LEAVES_OUT = "modes() leaves that out, ancf.damped_modes(model) has it"


class Imbalance(NamedTuple):
    """Forces out of balance: their sum, its unit and where the largest one acts."""

    size: float
    unit: str
    place: str

    def __str__(self) -> str:
        return f"{self.size:.3g} {self.unit} are out of balance, most of it at {self.place}"


def notes_of_balance(
    system: System, q: FloatArray, time: float, known: Remembered | None, where: str
) -> list[str]:
    """A note on a state that was given and is no equilibrium.

    Parameters
    ----------
    system : System
    q : ndarray, shape (size,)
        State vector; velocities are left out.
    time : float
        At which loads are taken, s.
    known : Remembered or None
        What is known of the state that was given; None of the initial shape.
    where : str
        Stands in the message.

    Raises
    ------
    ModelError
        The initial shape is no equilibrium.
    """
    found = imbalance(system, q, time, known)
    if found is None:
        return []
    if known is None:
        hint = (
            "give about=ancf.equilibrium(model); for those of the shape as drawn leave out loads and gravity"
        )
        raise ModelError(where, f"the initial shape is no equilibrium, {found}", hint)
    return [f"the state is no equilibrium, {found}: its modes do not describe how it moves on"]


def imbalance(system: System, q: FloatArray, time: float, known: Remembered | None) -> Imbalance | None:
    """What is out of balance at rest; None in equilibrium."""
    if system.memory:
        system = system.double  # friction remembers: not in the system that goes on
        remembered.begin(system, q, np.zeros_like(q), known)
    r, load = _forces(system, q.copy(), time)
    weight = system.core.weight
    force = _in_newtons(system, r, weight)
    free = np.setdiff1d(system.free, system.multipliers)
    held = np.setdiff1d(system.held, system.multipliers)
    loads = float(np.sum(np.abs(_in_newtons(system, load, weight))))
    carried = loads + float(np.sum(np.abs(force[held])))
    loose = np.zeros_like(force)
    loose[free] = force[free]
    if float(np.sum(np.abs(loose))) <= BALANCED * carried + ROUND_OFF * _stiffness(system):
        return None
    return _described(system, q, loose, r)


def of_motion(system: System, q: FloatArray, v: FloatArray) -> list[str]:
    """A note on a state of which modes without gyroscopic and centrifugal forces are not the whole truth."""
    supports, rates = system.core.supports, np.abs(v[: system.n]) * system.core.weight
    try:
        rate = float(np.linalg.norm(rotation_of(system, q, v)[0]))
    except SolveError:  # otherwise than in a steady rotation
        rate = 0.0
    solid = any(not isinstance(body, PointMass) for body in system.model.bodies.values())
    if solid and rate > ROTATES * np.max(rates, initial=0.0):
        return [f"the model rotates with {rate:.4g} rad/s: {LEAVES_OUT}"]
    given = np.setdiff1d(system.inputs.prescribed, list(system.numbering.lengths.values())).astype(int)
    turning = supports.rot_R[supports.rot_moving >= 0, 1]
    if max(np.max(rates[given], initial=0.0), np.max(abs(turning), initial=0.0)) > MOVES:
        return ["a support moves in this state: modes() holds it where it is"]
    return []


def of_bends(model: Model, omega: FloatArray) -> list[str]:
    """A note on modes some of which have no frequency because bends of cables turn."""
    names = [name for name, beam in model.beams.items() if beam.turns_its_bend]
    if not names or omega[0] > 0.0:
        return []
    what = f'"{names[0]}" is bent by nature, and nothing resists that this bend turns'
    hint = 'hold its plane at each node (position and slope), or take element="nonlocking"'
    return [f"{what}: frequencies of zero may be that; {hint}"]


def of_loads(system: System, q: FloatArray, omega: FloatArray, shapes: FloatArray) -> list[str]:
    """A note on modes that change by what the stiffness of loads has besides its symmetric part.

    Parameters
    ----------
    system : System
    q : ndarray, shape (size,)
        State about which the modes are.
    omega : ndarray, shape (count,), rad/s
    shapes : ndarray, shape (count, size)
        Normed to a modal mass of 1 kg.
    """
    loads = Differences(system, system.core.external)
    if not 0 < len(loads.moved) <= MANY:
        return []
    J, at = loads.among(q), loads.place[loads.moved]
    rest, moved = 0.5 * (J - J.T), shapes[:, at]
    sizes = np.linalg.norm(moved @ rest, axis=1) * np.linalg.norm(moved, axis=1)
    return [HALF] if np.any(sizes > SMALL * np.maximum(omega, 0.0) ** 2) else []


def explain_unstable(error: SolveError) -> None:
    """Say of modes about a state that is an equilibrium, though none that is stable, what to do."""
    if "give about=" not in error.hint:
        return
    error.hint = ""
    error.advise(
        "it is an equilibrium that a push leaves: look for another one, from a path near it or with a small "
        "side load; moments and loads that follow the motion have no potential, and modes() takes the "
        "symmetric part of their stiffness: with them ask ancf.damped_modes, which has all of it"
    )


def _forces(system: System, q: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
    """Internal forces less loads, and the loads, shape (size,), along local axes where there are any."""
    core, zero = system.core, np.zeros(system.size)
    f, r = np.zeros(system.size), np.zeros(system.size)
    system.place(time, q, zero.copy(), zero.copy())
    apply_load(core.loads, core.loads.value, f)
    residual(core.batches, core.ws, q, zero, zero, f, r)
    for k, slot in enumerate(core.supports.rot_slot.tolist()):
        seen = slice(system.n + 3 * k, system.n + 3 * k + 3)
        r[slot : slot + 3] = core.supports.rot_R[k, 0].T @ r[seen]
    return r, f


def _in_newtons(system: System, r: FloatArray, weight: FloatArray) -> FloatArray:
    """Forces in the unknowns as forces of the same work: those of slopes, N m, by the size of the model."""
    own = r[: system.n] * (weight > 0.0)
    found: FloatArray = own / np.where(weight > 0.0, weight * system.model.size, 1.0)
    return found


def _described(system: System, q: FloatArray, loose: FloatArray, r: FloatArray) -> Imbalance:
    """Sum and place of what is out of balance: forces, or where there are hardly any, moments."""
    first = np.unique(np.concatenate([slots[:, 0] for slots in system.numbering.slots.values()]))
    forces = np.array([np.linalg.norm(loose[i : i + 3]) for i in first])
    worst = int(np.argmax(np.abs(loose)))
    if np.sum(forces) >= np.abs(loose[worst]):
        return Imbalance(float(np.sum(forces)), "N", _place(system, int(first[np.argmax(forces)])))
    if worst in system.numbering.arcs.values():
        return Imbalance(float(abs(r[worst])), "N", system.numbering.describe(worst))
    return Imbalance(_moment(system, q, r, worst), "N m", _place(system, worst))


def _moment(system: System, q: FloatArray, r: FloatArray, unknown: int) -> float:
    """Moment of a rigid body, which its axes share, or the force in an unknown of a slope, N m."""
    for name, slots in system.numbering.slots.items():
        if isinstance(system.model.bodies[name], RigidBody) and np.any(abs(slots + 1 - unknown) < 2):
            return float(np.linalg.norm(sum(np.cross(q[i : i + 3], r[i : i + 3]) for i in slots[0, 1:])))
    return float(abs(r[unknown]))


def _place(system: System, unknown: int) -> str:
    """Point of a body to which an unknown belongs, as one writes it."""
    for name, slots in system.numbering.slots.items():
        nodes = np.nonzero((slots <= unknown) & (unknown < slots + 3))[0]
        if not len(nodes):
            continue
        body = system.model.bodies[name]
        if not isinstance(body, Beam):
            return name
        node = int(nodes[0])
        ends = {0: f"{name}.start", len(body.node_x) - 1: f"{name}.end"}
        return ends.get(node, f"{name}.at({body.node_x[node]:g})")
    return system.numbering.describe(unknown)


def _stiffness(system: System) -> float:
    """Largest EA of a body, stiffness times length of a spring and moment of one per length, N."""
    size, connections = system.model.size, system.model.connections
    springs = [c.stiffness * size for c in connections if isinstance(c, Spring)]
    springs += [c.stiffness / size for c in connections if isinstance(c, TorsionSpring)]
    return max([0.0, *springs, *(beam.section.EA for beam in system.model.beams.values())])
