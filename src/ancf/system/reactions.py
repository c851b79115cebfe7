"""Forces that supports exert on nodes."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model.joints.connections import Spring
from ..model.supports.held import support_asked
from .core import apply_load, residual
from .system import System

AT_REST = 1e-9  # largest velocity, of a position in sizes of the model per s
BALANCED = 1e-3  # out-of-balance force of a body's nodes, of the largest force
ROUND_OFF = 1e-8  # the same, of the largest stiffness, N


def at_rest(
    system: System, q: FloatArray, v: FloatArray, time: float, name: str, balanced: bool | None
) -> FloatArray | None:
    """What an equilibrium leaves out of balance, shape (size,), for the body of a support; None in motion.

    It is what the rows of the held unknowns, which the solver drops, are out of balance.  What is at rest
    but out of balance is in motion too: it has just been let go.  ``balanced`` None: it is beside an
    equilibrium, and need not be one.

    Raises
    ------
    ModelError
        The state is one of ``ancf.equilibrium``, which ``balanced`` says, but not of the support's body.
    """
    moving = np.abs(v[: system.n]) * system.core.weight
    moving[list(system.numbering.lengths.values())] = 0.0  # an equilibrium has them at a time
    if np.max(moving) > AT_REST:
        return None
    r, load = _out_of_balance(system, q.copy(), time)
    loose = 0.0 if balanced is None else _loose(system, name, r, load)
    if loose > 0.0 and balanced:
        body = next(s for s in system.model.supports if s.name == name).point.body.name
        what = f'"{body}" is not in equilibrium: {loose:.3g} N are out of balance'
        raise ModelError("State.reaction", what, "ask the state of ancf.equilibrium(model)")
    return None if loose > 0.0 else r


def held_part(system: System, name: str, r: FloatArray) -> FloatArray:
    """Of forces out of balance, shape (size,), those in the directions that a support holds, shape (3,)."""
    force = np.zeros(3)
    for i in system.constraints.positions[name]:
        force[i % 3] = r[i]
    return force


def support_name(system: System, support: Any) -> str:
    """Name of a support, or of the one at a point; ModelError if there is no such one."""
    return support_asked(system.model, support, system.constraints.positions, "reaction")


def _out_of_balance(system: System, q: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
    """Internal forces less loads, and the loads, in physical components."""
    zero, f, r = np.zeros(system.size), np.zeros(system.size), np.zeros(system.size)
    system.place(time, q, zero.copy(), zero.copy())
    tables = system.inputs.moment(time, (q, zero))
    apply_load(system.core.loads, tables.value[0], f)
    residual(system.core.batches, system.core.ws, q, zero, zero, f, r)
    return r, f


def _loose(system: System, name: str, r: FloatArray, load: FloatArray) -> float:
    """What is out of balance on the free nodes of the support's body, N, zero in equilibrium.

    Nodes shared with other bodies do not count: those may have been left out of the equilibrium.
    """
    body = next(s for s in system.model.supports if s.name == name).point.body.name
    slots = {key: table[:, 0] for key, table in system.numbering.slots.items()}
    others = np.concatenate([[-1], *(table for key, table in slots.items() if key != body)])
    mine = (np.setdiff1d(slots[body], others)[:, None] + np.arange(3)).ravel()
    mine = np.setdiff1d(mine, system.core.supports.held)
    held = [i for unknowns in system.constraints.positions.values() for i in unknowns]
    largest = max(float(np.max(np.abs(r[held]))), float(np.max(np.abs(load))))
    loose = float(np.max(np.abs(r[mine]), initial=0.0))
    return loose if loose > BALANCED * largest + ROUND_OFF * largest_stiffness(system) else 0.0


def largest_stiffness(system: System) -> float:
    """Largest EA of a body and stiffness times length of a spring, N."""
    springs = [c.stiffness for c in system.model.connections if isinstance(c, Spring)]
    of_springs = max(springs) * system.model.size if springs else 0.0
    return max([0.0, of_springs, *(beam.section.EA for beam in system.model.beams.values())])
