"""How far a cable that is very stiff against stretch is from bending as it should: membrane locking.

The axial strain of a bent element of cubic shape cannot vanish along the whole of it.  Where EA L^2/EI of an
element is large it resists with a stress that no load causes, and bends too little; the error falls with
about the second power of its length.  Gauss' two points of an element see the strain that loads cause, and
not this one.  The estimate is the first correction of Newton's method when the strain counts at these two
points, and at the others with a small part of its stiffness, which keeps what two points leave free.
Reference: Prathap, The Finite Element Method in Structural Mechanics (1993), on membrane locking.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...batches import Batches
from ...elements.cable import CableBatch
from ...elements.cable_strain import gauss_table
from ...elements.shapes import gauss
from ...later import csc_array, eigh, splu
from ...linalg.sparse import to_sparse
from ...system.contacts import touching
from ...system.core import apply_supports, assemble, residual, restrict
from ...system.system import System

#: EA L^2/EI of an element up to which it bends freely, and that left at the other points.
FREE, LEFT = 1e3, 10.0
TWO = 2  # points that stay
ROOM = 10  # rows of axial points in the batch
#: Share of the largest frequency that is none, and of the square of the least by which matrices are shifted.
NEUTRAL, SHIFT = 1e-4, 1e-2


def stiffest(system: System) -> tuple[float, str]:
    """Largest EA L^2/EI of an element of a cable, and its name; 0 and "" where nothing resists bending."""
    found = [(0.0, "")]
    for name, beam in system.model.beams.items():
        if not beam.has_section and beam.section.EI > 0.0:
            ratio = beam.section.EA * float(np.max(np.diff(beam.node_x))) ** 2 / beam.section.EI
            found.append((ratio, name))
    return max(found, key=lambda one: one[0])


def freed(system: System, q: FloatArray, omega: FloatArray, shapes: FloatArray) -> FloatArray:
    """Angular frequencies of modes about the state (size,) without locking, rad/s, (m,) of the m above zero.

    Of the shapes (count, size) that one step of inverse iteration with the softened stiffness gives. They are
    those found where no element is stiff, and where the estimate does not exist.
    """
    vibrating = omega > NEUTRAL * float(np.max(omega, initial=0.0))
    found: FloatArray = omega[vibrating]
    (ratio, _), core, n = stiffest(system), system.core, system.n
    system.level[:] = 1.0, 0.0, 0.0
    if ratio <= FREE or not len(found):
        return found
    M = _matrix(system, core.batches, q, 1.0, 0.0)
    K = _matrix(system, _softer(system, ratio), q, 0.0, 1.0)
    K = csc_array(K + touching(core, q, n).matrix())
    x = shapes[vibrating, :n].T.copy()
    x[system.multipliers] = 0.0
    pushed = M @ x
    pushed[system.multipliers] = 0.0
    try:
        y = splu(csc_array(K + SHIFT * float(found[0]) ** 2 * M)).solve(pushed)
        y[system.multipliers] = 0.0
        lower = np.sqrt(np.maximum(eigh(y.T @ (K @ y), y.T @ (M @ y), eigvals_only=True), 0.0))
    except (RuntimeError, ValueError, np.linalg.LinAlgError):  # singular, or not a number
        return found
    return lower if np.all(lower > 0.0) else found


def _matrix(system: System, batches: Batches, q: FloatArray, mass: float, stiffness: float) -> csc_array:
    values = np.empty(system.places.size)
    assemble(batches, system.core.ws, q, np.zeros_like(q), values, mass, 0.0, stiffness)
    restrict(system.core.supports, values)
    return csc_array(to_sparse(values, system.places))


def _softer(system: System, ratio: float) -> Batches:
    """All batches, those of cables so that they do not lock."""
    parts = system.parts.items()
    return Batches(_softened(b, LEFT / ratio) if name == "cable" else b for name, b in parts)


def locked(system: System, q: FloatArray) -> FloatArray:
    """By how much the state (size,) would move without locking, in the entries of its unknowns, (n,).

    Zero where no element is stiff, and where the estimate does not exist: the softened shape is unstable.
    """
    (ratio, _), core = stiffest(system), system.core
    nothing = np.zeros(system.n)
    system.level[:] = 1.0, 0.0, 0.0
    if ratio <= FREE:
        return nothing
    batches = _softer(system, ratio)
    still, none, whole = np.zeros_like(q), np.zeros_like(q), np.empty_like(q)
    freed = np.empty_like(q)
    residual(core.batches, core.ws, q, still, still, none, whole)
    residual(batches, core.ws, q, still, still, none, freed)
    r = freed - whole  # loads cancel
    apply_supports(core.supports, r)
    matrix = _matrix(system, batches, q, 0.0, 1.0)
    try:
        lu = splu(csc_array(matrix + touching(core, q, system.n).matrix()))
    except RuntimeError:  # exactly singular
        return nothing
    moved: FloatArray = lu.solve(r[: system.n])
    return moved if np.all(np.isfinite(moved)) else nothing


def _softened(batch: CableBatch, left: float) -> CableBatch:
    """The batch with two axial points more, and a share of the stiffness ``left`` at the others."""
    groups, tables, first = batch.groups.copy(), [], 0
    reference = batch.lane_reference.copy()
    for k, (start, end, _, g0, axial, bending, *_) in enumerate(batch.groups.tolist()):
        own = batch.gp[g0 : g0 + axial + bending].copy()
        kept = min(axial, ROOM - TWO)
        own = np.concatenate([gauss_table(kept, bending)[:kept], own[axial:]])
        own[:kept, 6] *= left
        two = gauss_table(TWO, bending)[:TWO].copy()
        two[:, 6] *= 1.0 - left
        tables.append(np.concatenate([two, own]))
        groups[k, 3], groups[k, 4] = first, TWO + kept
        first += len(tables[-1])
        strains = batch.lane_reference[start:end, :axial]
        at = np.concatenate([gauss(TWO)[0], gauss(kept)[0]])
        reference[start:end, : len(at)] = np.einsum("gk,ckl->cgl", _lagrange(gauss(axial)[0], at), strains)
    return batch._replace(
        groups=groups, gp=np.ascontiguousarray(np.concatenate(tables)), lane_reference=reference
    )


def _lagrange(nodes: FloatArray, at: FloatArray) -> FloatArray:
    """Values at ``at`` of the polynomials that are 1 at one of the nodes, (points, nodes)."""
    return np.vander(at, len(nodes)) @ np.linalg.inv(np.vander(nodes, len(nodes)))
