"""From cables with a winch to the flat arrays of a WinchedBatch, and what results ask of one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.bodies.beam import Beam
from . import cable_build
from .cable_columns import INV_L, LENGTH, MASS
from .cable_slack import Slack
from .cable_tangent import mass_entry
from .chunks import in_lanes
from .winched import INV_L0, WHOLE, X1, X2, WinchedBatch

__all__ = ["BATCH", "build", "momenta", "slack"]

BATCH = WinchedBatch
#: Matrix of eq. 23 on (r, r_X, r, r_X) by powers of the length, of an element of unit mass.
_entry: Any = mass_entry
_MASS = np.array([[_entry.py_func(x, y, 1.0) for y in range(4)] for x in range(4)]) / WHOLE
_POWER = np.array([[x % 2 + y % 2 for y in range(4)] for x in range(4)])


def build(
    beams: Sequence[Beam],
    slots: Sequence[IntArray],
    at_start: Sequence[bool],
    unknowns: Sequence[int],
    gravity: FloatArray,
) -> WinchedBatch:
    """Batch of the elements of cables with a winch.

    Parameters
    ----------
    beams : sequence of Beam
    slots : sequence of ndarray, shape (nodes, 2)
    at_start : sequence of bool
        Whether the winch is at the start of the beam.
    unknowns : sequence of int
        Of their lengths.
    gravity : ndarray, shape (3,)
    """
    plain = cable_build.build(beams, slots)
    rows = {}
    for beam, slot, first, unknown in zip(beams, slots, at_start, unknowns, strict=True):
        x = beam.node_x - (beam.length if first else 0.0)
        run = np.zeros((beam.elements, 8))
        run[:, X1], run[:, X2], run[:, INV_L0] = x[:-1], x[1:], 1.0 / beam.length
        run[0 if first else -1, 3 if first else 4] = 0.5 * beam.section.rhoA
        run[:, 5:] = gravity
        for e in range(beam.elements):
            rows[tuple(slot[e]), tuple(slot[e + 1])] = run[e], unknown
    found = [rows[tuple(base[:2]), tuple(base[2:])] for base in plain.base.tolist()]
    runs, owners = np.array([run for run, _ in found]), np.array([[unknown] for _, unknown in found])
    return WinchedBatch(
        *plain,
        lane_winch=in_lanes(owners, plain.first).astype(np.int64),
        lane_run=in_lanes(runs, plain.first, empty=3),
    )


def slack(batch: WinchedBatch, q: FloatArray) -> Slack:
    """See :class:`ancf.elements.registry.Element`."""
    return Slack(batch, q, _by_element(batch, q)["lam"])


def _by_element(batch: WinchedBatch, q: FloatArray) -> dict[str, FloatArray]:
    """Numbers of the elements: h, mass without the stretch, X of both nodes, L and lam."""
    counts = np.diff(batch.first)
    chunk = np.repeat(np.arange(len(counts)), counts)
    lane = np.arange(len(batch.base)) - np.repeat(batch.first[:-1], counts)
    data, run = batch.lane_data[chunk, :, lane], batch.lane_run[chunk, :, lane]
    size = q[batch.lane_winch[chunk, 0, lane]]
    found = {"h": data[:, LENGTH], "inv": data[:, INV_L], "mass": WHOLE * data[:, MASS], "L": size}
    return found | {"x1": run[:, X1], "x2": run[:, X2], "lam": size * run[:, INV_L0]}


def momenta(batch: WinchedBatch, q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Shapes, velocities and momenta of the material of each element, (n, 4, 3) each.

    They belong to r, r_X, r, r_X; half the sum of products of the last two is the kinetic energy.
    """
    known, places = _by_element(batch, q), batch.base[:, :, None] + np.arange(3)
    winch = _by_element(batch, v)["L"] / known["L"]
    x1, x2, inv = (known[key][:, None] for key in ("x1", "x2", "inv"))
    r, w = q[places], v[places]
    chord = inv * (r[:, 2] - r[:, 0])
    bend = inv * (6 * chord - 4 * r[:, 1] - 2 * r[:, 3]), inv * (2 * r[:, 1] + 4 * r[:, 3] - 6 * chord)
    drawn = x1 * r[:, 1], r[:, 1] + x1 * bend[0], x2 * r[:, 3], r[:, 3] + x2 * bend[1]
    w = w - winch[:, None, None] * np.stack(drawn, axis=1)
    mass = known["h"][:, None, None] ** _POWER * _MASS * (known["mass"] * known["lam"])[:, None, None]
    return r, w, np.einsum("nij,njk->nik", mass, w)
