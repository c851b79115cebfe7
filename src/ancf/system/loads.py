"""Loads of the model: dead ones as patterns of nodal forces, batches of those that depend on the state."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..elements.shapes import gauss, hermite
from ..loads.moment import MomentBatch
from ..loads.section_moment import SectionMomentBatch
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body
from ..model.functions.function import TimeFunction
from ..model.joints.basic import Slide
from ..model.kind import Kind
from ..model.kinds import LOADS, SURROUNDINGS, kind_of
from ..model.loads.load import DistributedLoad, Force, Moment
from ..model.model import Model
from ..model.supports.winches import by_body
from .probe import R_X, R_Y, R_Z, Probe, R

Pattern = tuple[IntArray, FloatArray]  # slots and factors
Locate = Callable[..., Probe]


def functions(model: Model) -> list[TimeFunction]:
    """Inputs of all loads but gravity: dead loads, then those that depend on the state, then lengths."""
    dead = [amplitude for _, amplitude in _dead(model)]
    moments = [load.moment for part in _moments(model) for load in part]
    laws = [function for kind, items in _laws(model) for item in items for function in kind.inputs_of(item)]
    return dead + moments + laws + [winch.length for winch in by_body(model).values()]


def _dead(model: Model) -> list[tuple[Any, TimeFunction]]:
    """Loads that do not depend on the state, drives of sliding joints included, and their amplitudes."""
    found: list[tuple[Any, TimeFunction]] = []
    for load in model.loads:
        if isinstance(load, Force) and isinstance(load.force, TimeFunction):
            found.append((load, load.force))
        elif isinstance(load, DistributedLoad) and isinstance(load.load, TimeFunction):
            found.append((load, load.load))
    drives = (c for c in model.connections if isinstance(c, Slide))
    return found + [(joint, joint.force) for joint in drives if joint.force is not None]


def _moments(model: Model) -> tuple[list[Moment], list[Moment]]:
    """Moments on cables, and on cross-sections and rigid bodies."""
    items = [load for load in model.loads if isinstance(load, Moment)]
    cables = [load for load in items if _is_cable(load.point.body)]
    return cables, [load for load in items if not _is_cable(load.point.body)]


def _laws(model: Model) -> list[tuple[Kind, list[Any]]]:
    """Other loads that depend on the state, by kind, surroundings last."""
    found: dict[str, tuple[Kind, list[Any]]] = {kind.word: (kind, []) for kind in LOADS if kind.batch}
    for load in model.loads:
        kind = kind_of(load)
        if kind.has_batch(load):
            found[kind.word][1].append(load)
    around = [(kind, getattr(model, key)) for key, kind in SURROUNDINGS.items() if kind.batch]
    return [(kind, items) for kind, items in (*found.values(), *around) if items]


def patterns(model: Model, locate: Locate, slots: dict[str, IntArray], arcs: dict[str, int]) -> list[Pattern]:
    """Patterns of the dead loads; ``arcs``: s of the sliding joints."""
    found: list[Pattern] = []
    winches = by_body(model)
    for load, _ in _dead(model):
        if isinstance(load, Force):
            probe = locate(load.point)
            found.append((probe.slots, probe.S[R]))
        elif isinstance(load, DistributedLoad):
            at, factor = distributed(load.body, slots[load.body.name], *load.between)
            found.append((at, factor / load.body.length if load.body.name in winches else factor))
        else:  # a scalar on a slot of three: the two unknowns behind s are held
            found.append((np.array([arcs[load.name]]), np.ones(1)))
    return found


def growing(model: Model, rows: int) -> IntArray:
    """Rows of the inputs, of which there are so many, with lengths on which dead loads depend, or -1."""
    winches = by_body(model)
    last = {name: rows - len(winches) + k for k, name in enumerate(winches)}
    bodies = (load.body.name if isinstance(load, DistributedLoad) else "" for load, _ in _dead(model))
    return np.array([last.get(name, -1) for name in bodies], dtype=np.int64)


def batches(model: Model, locate: Locate, value: FloatArray) -> dict[str, Any]:
    """Batches of the loads that depend on the state, by name; each has a slice of ``value``, the inputs."""
    found: dict[str, Any] = {}
    first = len(_dead(model))
    cables, sections = _moments(model)
    if cables:
        own = value[first : first + len(cables)]
        found["moments"] = _on_slopes([locate(m.point) for m in cables], own)
    first += len(cables)
    if sections:
        shares = [_shares(m.point.body) for m in sections]
        own = value[first : first + len(sections)]
        found["section moments"] = _on_sections([locate(m.point) for m in sections], shares, own)
    first += len(sections)
    for kind, items in _laws(model):
        inputs = len(kind.inputs_of(items[0]))
        own = value[first : first + inputs * len(items)].reshape(len(items), inputs, 3)
        all_of_it = (model,) if kind in SURROUNDINGS.values() else ()
        found[kind.word] = import_module(f"ancf.loads.{kind.batch}").build(items, locate, own, *all_of_it)
        first += inputs * len(items)
    return found


def _is_cable(body: Body) -> bool:
    return isinstance(body, Beam) and not body.has_section


def _on_slopes(probes: list[Probe], value: FloatArray) -> MomentBatch:
    n = len(probes)
    return MomentBatch(
        base=np.array([p.slots for p in probes], dtype=np.int64).reshape(n, 4),
        dest=np.full((n, 16), -1, dtype=np.int64),
        factor=np.array([p.S[R_X] for p in probes], dtype=np.float64).reshape(n, 4),
        value=value,
    )


def _shares(body: Body) -> tuple[float, float]:
    """Of r_y and r_z in a torque: those of the stress in pure torsion."""
    if not isinstance(body, Beam):
        return 0.5, 0.5  # nothing shears a rigid body: any will do
    y, z = body.section.EI_z, body.section.EI_y
    return y / (y + z), z / (y + z)


def _on_sections(
    probes: list[Probe], shares: list[tuple[float, float]], value: FloatArray
) -> SectionMomentBatch:
    n = len(probes)
    base, factor = np.full((n, 6), -1, dtype=np.int64), np.zeros((n, 6))
    for e, probe in enumerate(probes):
        for first, row in ((0, R_Y), (3, R_Z)):
            used = np.flatnonzero(probe.S[row])
            columns = slice(first, first + len(used))
            base[e, columns], factor[e, columns] = probe.slots[used], probe.S[row][used]
    dest, share = np.full((n, 36), -1, dtype=np.int64), np.array(shares, dtype=np.float64).reshape(n, 2)
    return SectionMomentBatch(base, dest, factor, share, value)


def distributed(beam: Beam, slots: IntArray, x0: float, x1: float) -> Pattern:
    """Consistent nodal factors of a unit load per reference length from x0 to x1."""
    xi, weight = gauss(2)  # exact: the integrand is cubic
    a, b = beam.node_x[:-1], beam.node_x[1:]
    low = np.clip(a, x0, x1)
    loaded = np.clip(b, x0, x1) - low
    h = b - a
    S = hermite((low + xi[:, None] * loaded - a) / h, h)  # (2, elements, 4)
    share = np.einsum("g,e,gek->ek", weight, loaded, S)
    factors = np.zeros((beam.elements + 1, 2))
    factors[:-1] += share[:, :2]
    factors[1:] += share[:, 2:]
    return slots[:, :2].ravel(), factors.ravel()


def gravity(model: Model, slots: dict[str, IntArray], size: int) -> FloatArray:
    """Weight of all bodies on a state vector of this size, N, but of cables with a winch."""
    f, winches = np.zeros(size), by_body(model)
    for name, body in model.bodies.items():
        if name in winches:
            continue
        if isinstance(body, Beam):
            at, factor = distributed(body, slots[body.name], 0.0, body.length)
            weight = factor * body.section.rhoA
        else:
            at, weight = slots[body.name][0, :1], np.array([body.mass])
        np.add.at(f, at[:, None] + np.arange(3), weight[:, None] * model.gravity)
    return f


def hung(
    model: Model, slots: dict[str, IntArray], lengths: dict[str, int], rows: int
) -> tuple[FloatArray, IntArray, IntArray, IntArray]:
    """What cables with a winch weigh per metre of their length, N/m.

    Shape (m, 3), with the slots (m,), the rows of the inputs, of which there are so many, and the unknowns
    ``lengths``, by winch, with these lengths.
    """
    weight = [np.zeros((0, 3))]
    at: list[int] = []
    row: list[int] = []
    unknown: list[int] = []
    winches = by_body(model)
    for k, (name, winch) in enumerate(winches.items()):
        places, factor = distributed(winch.beam, slots[name], 0.0, winch.beam.length)
        share = factor * winch.beam.section.rhoA / winch.beam.length
        weight.append(share[:, None] * model.gravity)
        at += places.tolist()
        row += [rows - len(winches) + k] * len(places)
        unknown += [lengths[winch.name]] * len(places)
    slot, rows_of, place = (np.array(x, dtype=np.int64) for x in (at, row, unknown))
    return np.concatenate(weight), slot, rows_of, place
