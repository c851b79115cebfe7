"""Where the state of a material point is found in a state vector."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..arrays import FloatArray, IntArray
from ..elements.registry import ELEMENTS
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body
from ..model.elements import KINDS
from ..model.model import Model
from ..model.points import Point
from ..model.supports.winches import by_body

#: Rows of a probe's factors; a cable has the first three.
R, R_X, R_XX, R_Y, R_Z, R_YX, R_ZX = range(7)
_NAMES = ("r_x", "r_xx", "r_y", "r_z", "r_yx", "r_zx")


@dataclass(frozen=True)
class Probe:
    """One material point: r and its derivatives are sums of slots of the state vector.

    Parameters
    ----------
    body : Beam, PointMass or RigidBody
    x, y, z : float
        Reference arc length, m, and place in the section; of a rigid body: body coordinates.
    slots : ndarray, shape (k,)
        Of the element: 4 for a cable, 8 or 10 for a beam with r_y and r_z; 1 or 4 of a body without.
    S : ndarray, shape (3, k) or (7, k)
        Factors of r at the point, and of r_x, r_xx, r_y, r_z, r_yx, r_zx of the centreline; of a rigid body
        the directors stand for r_x, r_y, r_z.
    """

    body: Body
    x: float
    y: float
    z: float
    slots: IntArray
    S: FloatArray

    def field(self, states: FloatArray, row: int = R) -> FloatArray:
        """r or a derivative, shape (..., 3), from state vectors of shape (..., n)."""
        return self.combined(states, self.S[row])

    def combined(self, states: FloatArray, factors: FloatArray) -> FloatArray:
        """Sum of factors times slots, shape (..., 3)."""
        total = np.zeros((*states.shape[:-1], 3))
        for slot, factor in zip(self.slots.tolist(), factors.tolist(), strict=True):
            if factor != 0.0:
                total += factor * states[..., slot : slot + 3]
        return total


@dataclass(frozen=True)
class BeamProbe(Probe):
    """Probe on a beam.

    Parameters
    ----------
    beam : Beam
    element : int
        Element that holds the point (the later one at a node, but the last at the end).
    unknown : int
        The natural length, where a winch changes it; else -1.
    far : float
        Place of the other end of such a beam, m.
    """

    beam: Beam
    element: int
    unknown: int = -1
    far: float = 0.0

    def field(self, states: FloatArray, row: int = R) -> FloatArray:
        """See :meth:`Probe.field`; derivatives are those by the material where a winch changes the length."""
        total = super().field(states, row)
        if self.unknown >= 0 and row in (R_X, R_XX):
            total /= self._drawn(states) ** (1 if row == R_X else 2)
        return total

    def _drawn(self, states: FloatArray) -> FloatArray:
        """Length now as a multiple of that of the mesh, shape (..., 1)."""
        return states[..., self.unknown : self.unknown + 1] / self.beam.length

    def rate(self, q: FloatArray, v: FloatArray, row: int) -> FloatArray:
        """Rate of r_x or r_xx at the material that is at the point, shape (..., 3)."""
        rate = super().field(v, row)
        if self.unknown < 0:
            return rate
        if row == R_XX:  # r_x has a rate that is quadratic in the element
            x, h = self.xi, self.element_length * self._drawn(q)
            parts = [self.moved(xi).rate(q, v, R_X) for xi in (0.0, 0.5, 1.0)]
            weights = 4.0 * x - 3.0, 4.0 - 8.0 * x, 4.0 * x - 1.0
            quick: FloatArray = sum(w * part for w, part in zip(weights, parts, strict=True)) / h
            return quick
        lam, mu = self._drawn(q), self._drawn(v) / self._drawn(q)
        label = self.x - self.far
        drawn: FloatArray = rate / lam - mu * (self.field(q, R_X) + label * lam * self.field(q, R_XX))
        return drawn

    @property
    def solid(self) -> bool:
        """Whether the beam has cross-sections."""
        return self.beam.has_section

    @property
    def element_length(self) -> float:
        """Reference length of the element, m."""
        return float(self.beam.node_x[self.element + 1] - self.beam.node_x[self.element])

    @property
    def xi(self) -> float:
        """Position in the element, 0 to 1."""
        return float(self.x - self.beam.node_x[self.element]) / self.element_length

    def moved(self, xi: float) -> BeamProbe:
        """Probe at xi in [0, 1] of the same element."""
        h = self.element_length
        S = _factors(self.beam, xi, h, self.y, self.z)
        return replace(self, x=float(self.beam.node_x[self.element]) + xi * h, S=S)

    def slope(self, states: FloatArray) -> FloatArray:
        """Derivative of the point's r by x, shape (..., 3)."""
        if self.unknown >= 0:
            return self.field(states, R_X)
        S = self.S[R_X]
        if self.y != 0.0 or self.z != 0.0:
            S = S + self.y * self.S[R_YX] + self.z * self.S[R_ZX]
        return self.combined(states, S)


def lengths_of(model: Model, unknowns: dict[str, IntArray]) -> dict[str, tuple[int, float]]:
    """Of cables with a winch, the unknown of the length and the place of the far end on the mesh, m.

    ``unknowns``: of joints and winches, by name.
    """
    found = by_body(model).items()
    there = [(name, w) for name, w in found if w.name in unknowns]
    return {name: (int(unknowns[w.name][0]), w.beam.length if w.at_start else 0.0) for name, w in there}


def locate(
    point: Point, slots: IntArray, length: tuple[int, float] = (-1, 0.0), element: int | None = None
) -> Probe:
    """Probe at a point of a body whose nodes have these slots, shape (nodes, vectors + internal).

    ``length``: of a cable with a winch, see :func:`lengths_of`. ``element``: another one than that which
    holds the point, whose shape is continued up to there.
    """
    body, x, y, z = point.body, point.x, point.y, point.z
    if not isinstance(body, Beam):
        return Probe(body, x, y, z, slots[0], _rigid_factors(point, slots.shape[1]))
    e = body.element_at(x) if element is None else element
    h = float(body.node_x[e + 1] - body.node_x[e])
    S = _factors(body, (x - body.node_x[e]) / h, h, y, z)
    vectors = KINDS[body.element].vectors
    parts = (slots[e, :vectors], slots[e + 1, :vectors], slots[e, vectors:])
    return BeamProbe(body, x, y, z, np.concatenate(parts), S, body, e, *length)


def _rigid_factors(point: Point, vectors: int) -> FloatArray:
    """Factors of r and the directors; the directors stand for r_x, r_y and r_z."""
    S = np.zeros((7, vectors))
    S[R, 0] = 1.0
    if vectors > 1:
        S[R, 1:] = point.x, point.y, point.z
        S[[R_X, R_Y, R_Z], [1, 2, 3]] = 1.0
    return S


def _factors(beam: Beam, xi: float, h: float, y: float, z: float) -> FloatArray:
    return _shapes(beam.element, beam.has_section, float(xi), float(h), float(y), float(z))


@lru_cache(maxsize=4096)
def _shapes(element: str, section: bool, xi: float, h: float, y: float, z: float) -> FloatArray:
    """Many points are nodes: where the elements are alike, their factors are."""
    shape, names = ELEMENTS[element].shape, _NAMES if section else _NAMES[:2]
    rest = [shape(element, xi, h, derivative=name) for name in names]
    found = np.stack([shape(element, xi, h, y, z), *rest])
    found.flags.writeable = False
    return found
