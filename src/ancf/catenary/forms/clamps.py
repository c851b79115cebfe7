"""What a wire on a mesh gives too little at its clamps, as a compliance beside the dropper's own.

Where a dropper pulls with a force F the wire bends by F/T within some sqrt(EI/T), a decimetre. The slope is
one for the elements on both sides of a node, so that elements of metres spread this bend over themselves:
the node gives less than the clamp does on the wire, by the same share of F whatever the line does,

    c = G(x, x) - S(x)^T K^-1 S(x),

G the compliance of a beam under tension T, K its matrix on the mesh. What is missing is the part of the
displacement that the elements cannot take; it is orthogonal to them in energy, local, and follows from F
alone. So it stands in series with the dropper: the clamp is by c F from the node. It costs nothing in time,
and a bay between two droppers rings as it does on a mesh without this error: inertia of the missing part is
all that is left out.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray, IntArray
from ..lines.wire import Wire
from .mesh import Nodes

#: Elements on either side that are looked at: what happens at a node is forgotten after two or three.
BESIDE = 8


def missing_give(wire: Wire, nodes: Nodes, at: IntArray, hinges: tuple[int, ...] = ()) -> FloatArray:
    """Compliance (n,) in m/N that a wire lacks at some of its nodes under a transverse force.

    Parameters
    ----------
    wire : Wire
    nodes : Nodes
        Its mesh.
    at : (n,) array of int
        Inner nodes of the mesh.
    hinges : tuple of int
        Nodes at which the wire turns freely: there it can bend on any mesh.

    """
    ends = np.array([0, *hinges, nodes.x.size - 1])
    known: dict[tuple[float, ...], float] = {}
    give = np.zeros(at.size)
    for j, node in enumerate(at.tolist()):
        if node in ends:
            continue
        k = int(np.searchsorted(ends, node))
        first, last = max(int(ends[k - 1]), node - BESIDE), min(int(ends[k]), node + BESIDE)
        place = nodes.x[first : last + 1]
        key = (node - first, *np.round(np.diff(place), 6))
        if key not in known:
            known[key] = _missing(wire, place, node - first)
        give[j] = known[key]
    return give


def _missing(wire: Wire, x: FloatArray, node: int) -> float:
    """The same for one node of a wire between two hinges; an exact beam never gives less."""
    return max(_exact(wire, x[node] - x[0], x[-1] - x[node]) - _meshed(wire, x, node), 0.0)


def _exact(wire: Wire, left: float, right: float) -> float:
    """Compliance of a beam under tension between hinges, m/N: a string's less that of its bend."""
    layer, length = np.sqrt(wire.EI / wire.tension), left + right
    give = left * right / length
    if layer > 0.0:
        decay = -np.expm1(-2.0 * np.array([left, right, length]) / layer)
        give -= 0.5 * layer * decay[0] * decay[1] / decay[2]
    return float(give / wire.tension)


def _meshed(wire: Wire, x: FloatArray, node: int) -> float:
    """Compliance on a mesh of cubic elements, m/N."""
    size = x.size
    matrix = np.zeros((2 * size, 2 * size))
    for k, h in enumerate(np.diff(x)):
        matrix[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += wire.tension * _tension(h) + wire.EI * _bending(h)
    free = np.setdiff1d(np.arange(2 * size), [0, 2 * size - 2])
    force = (free == 2 * node).astype(float)
    return float(force @ np.linalg.solve(matrix[np.ix_(free, free)], force))


def _tension(h: float) -> FloatArray:
    """Integral of S'^T S' over an element, 1/m."""
    rows = [[36.0, 3 * h, -36.0, 3 * h], [3 * h, 4 * h * h, -3 * h, -h * h]]
    rows += [[-36.0, -3 * h, 36.0, -3 * h], [3 * h, -h * h, -3 * h, 4 * h * h]]
    return np.array(rows) / (30.0 * h)


def _bending(h: float) -> FloatArray:
    """Integral of S''^T S'' over an element, 1/m^3."""
    rows = [[12.0, 6 * h, -12.0, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
    rows += [[-12.0, -6 * h, 12.0, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
    return np.array(rows) / h**3
