"""An independent model of an overhead line: two-dimensional, linear, only numpy and scipy.

Contact and messenger wire are tensioned Euler-Bernoulli beams that move vertically (cubic Hermite elements);
droppers pull and go slack, supports are springs. Unknowns are deviations from the form-found rest state, so
the line with all droppers taut is one linear system. Nothing of the package is used here, so that the two can
be held against each other. This file is the line; the run is in overhead_stepping, data in overhead_cases.

Units are SI, heights are positive upwards, zero is the contact wire's height at the supports.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

GRAVITY = 9.81
#: Gauss points and weights on [0, 1], exact up to degree 7.
GAUSS = [((1 + x) / 2, w / 2) for x, w in zip(*np.polynomial.legendre.leggauss(4), strict=True)]


@dataclass(frozen=True)
class Wire:
    """Mass [kg/m], tension [N], EI [N m²], stiffness of its supports [N/m] (inf: rigid), viscous [N s/m²]."""

    mass: float
    tension: float
    EI: float
    support: float
    viscous: float = 0.0


@dataclass(frozen=True)
class Line:
    """Two wires, droppers at the same places in all spans, supports: all that the oracle knows of a line."""

    span: float
    spans: int
    droppers: tuple[float, ...]
    contact: Wire
    messenger: Wire
    system_height: float
    sag: tuple[float, ...] = ()  # [m] below the height at the supports, per dropper; empty: none
    dropper_stiffness: float = 0.0  # [N/m]
    dropper_EA: float = 0.0  # [N], stiffness EA / length instead
    dropper_mass: float = 0.0  # [kg/m]
    dropper_damping: float = 0.0  # [N s/m]
    clamps: tuple[float, float] = (0.0, 0.0)  # [kg] on the contact and the messenger wire
    arm_mass: float = 0.0  # [kg] at the contact wire
    held: bool = True  # contact wire held at height zero at the supports when the form is found
    alpha: float = 0.0  # [1/s] Rayleigh: alpha M + beta K
    beta: float = 0.0  # [s]
    beta_tension: bool = True  # K of the damping with the tension's part
    beta_springs: bool = True  # ... with droppers and supports
    slack: bool = True  # False: droppers also push
    flat: bool = False  # True: the contact does not see the static sag


def hermite(xi, h, order=0):
    """Shape functions (4,) of an element of length h at xi in [0, 1], or their derivatives in x."""
    rows = (
        (1 - 3 * xi**2 + 2 * xi**3, h * (xi - 2 * xi**2 + xi**3), 3 * xi**2 - 2 * xi**3, h * (xi**3 - xi**2)),
        (6 * (xi**2 - xi) / h, 1 - 4 * xi + 3 * xi**2, 6 * (xi - xi**2) / h, 3 * xi**2 - 2 * xi),
        ((12 * xi - 6) / h**2, (6 * xi - 4) / h, (6 - 12 * xi) / h**2, (6 * xi - 2) / h),
    )
    return np.array(rows[order])


def element(h, order):
    """Integral of N^(order) N^(order)^T over an element of length h, (4, 4)."""
    return sum(w * h * np.outer(hermite(x, h, order), hermite(x, h, order)) for x, w in GAUSS)


def mesh(fixed, size, finest=None, growth=1.5):
    """Nodes through the points `fixed`: elements up to `size`, growing from `finest` there if given."""
    nodes = [fixed[0]]
    for a, b in pairwise(fixed):
        if finest is None:
            parts = np.ones(int(np.ceil((b - a) / size - 1e-9)))
        else:
            half, n = [], 1
            while 2 * sum(half) < b - a - 1e-9:
                half.append(min(size, finest * growth ** (n - 1)))
                n += 1
            parts = np.array(half + half[::-1])
        nodes.extend(a + (b - a) * np.cumsum(parts) / parts.sum())
    return np.array(nodes)


class Beam:
    """One wire on its mesh: matrices of its own, unknowns (w, w') per node, and the vector N(x)."""

    def __init__(self, wire, nodes):
        self.wire, self.nodes = wire, nodes
        h = np.diff(nodes)
        dof = 2 * np.arange(len(h))[:, None] + np.arange(4)
        rows, cols = np.repeat(dof, 4, axis=1).ravel(), np.tile(dof, 4).ravel()
        size = (2 * len(nodes), 2 * len(nodes))
        self.N, self.S, self.B = (
            sp.csr_array((np.concatenate([element(x, k).ravel() for x in h]), (rows, cols)), shape=size)
            for k in range(3)
        )
        self.K = wire.tension * self.S + wire.EI * self.B
        self.weight = -GRAVITY * wire.mass * (self.N @ self.constant())

    def constant(self):
        """Unknowns of the straight line w = 1."""
        return np.tile([1.0, 0.0], len(self.nodes))

    def at(self, x):
        """First unknown and the four shape functions at x."""
        k = int(np.clip(np.searchsorted(self.nodes, x, side="right") - 1, 0, len(self.nodes) - 2))
        h = self.nodes[k + 1] - self.nodes[k]
        return 2 * k, hermite((x - self.nodes[k]) / h, h)

    def node(self, x):
        """The unknowns w at the nodes at the places x."""
        k = np.searchsorted(self.nodes, np.asarray(x) - 1e-7)
        assert np.allclose(self.nodes[k], x)
        return 2 * k

    def hang(self, load, places, heights):
        """Unknowns under `load` with w prescribed at the places, and the upward forces needed there."""
        known = self.node(places)
        free = np.setdiff1d(np.arange(2 * len(self.nodes)), known)
        z = np.zeros(2 * len(self.nodes))
        z[known] = heights
        z[free] = splu(self.K[free][:, free].tocsc()).solve(load[free] - self.K[free][:, known] @ heights)
        return z, (self.K @ z - load)[known]


class OverheadLine:
    """The line on a mesh: rest state (heights, dropper lengths and loads) and the taut line's M, C, K."""

    def __init__(self, line, size=0.5, messenger=1.0, finest=None):
        """`size`: longest element [m]; the messenger's is `messenger` times that; `finest`: see `mesh`."""
        self.line = line
        self.masts = line.span * np.arange(line.spans + 1)
        self.at = (self.masts[:-1, None] + np.asarray(line.droppers)).ravel()
        fixed = np.sort(np.concatenate([self.masts, self.at]))
        self.contact = Beam(line.contact, mesh(fixed, size, finest))
        self.messenger = Beam(line.messenger, mesh(fixed, size * messenger, finest and finest * messenger))
        self.form()
        self.assemble()

    def form(self):
        """Contact wire with prescribed heights, messenger under the dropper loads, dropper lengths."""
        line, n = self.line, len(self.at)
        held = self.masts if line.held else self.masts[[0, -1]]
        heights = np.concatenate([-np.tile(line.sag or (0.0,) * len(line.droppers), line.spans), 0.0 * held])
        places = np.concatenate([self.at, held])
        self.rest, force = self.contact.hang(self.contact.weight, places, heights)
        self.load = force[:n] + GRAVITY * line.clamps[0]
        self.arm_load = force[n:]
        self.length, self.stiffness = np.ones(n), np.full(n, line.dropper_stiffness)
        for _ in range(6):  # the droppers' weight depends on their length
            down = self.load + GRAVITY * (line.dropper_mass * self.length + line.clamps[1])
            load = self.messenger.weight.copy()
            load[self.messenger.node(self.at)] -= down
            high = np.full(len(self.masts), line.system_height)
            self.rest_messenger, _ = self.messenger.hang(load, self.masts, high)
            distance = self.rest_messenger[self.messenger.node(self.at)] - heights[:n]
            if line.dropper_EA:
                self.length = distance / (1 + self.load / line.dropper_EA)
                self.stiffness = line.dropper_EA / self.length
            else:
                self.length = distance - self.load / self.stiffness

    def assemble(self):
        """M, C, K of both wires with all droppers taut; unknowns ordered along the track."""
        line, wires = self.line, (self.contact, self.messenger)
        shift = 2 * len(self.contact.nodes)
        places = np.concatenate([np.repeat(w.nodes, 2) for w in wires])
        pinned = [w.node(self.masts[[0, -1]]) + k * shift for k, w in enumerate(wires)]
        pinned += [w.node(self.masts) + k * shift for k, w in enumerate(wires) if np.isinf(w.wire.support)]
        free = np.setdiff1d(np.arange(len(places)), np.concatenate(pinned))
        free = free[np.argsort(places[free], kind="stable")]
        n = len(free)
        self.number = np.full(len(places), -1)  # of an unknown of the wires (contact first) in the system
        self.number[free] = np.arange(n)
        ends = [self.number[w.node(self.at) + k * shift] for k, w in enumerate(wires)]
        d = np.arange(len(self.at))
        self.lower, self.upper = ends
        self.B = sp.csc_array(
            (np.repeat([-1.0, 1.0], len(d)), (np.concatenate(ends), np.tile(d, 2))), shape=(n, len(d))
        )
        mass, spring = np.zeros(len(places)), np.zeros(len(places))
        hung = line.dropper_mass * self.length / 2
        for k, (w, clamp) in enumerate(zip(wires, line.clamps, strict=True)):
            mass[w.node(self.at) + k * shift] += clamp + hung
            spring[w.node(self.masts) + k * shift] = 0.0 if np.isinf(w.wire.support) else w.wire.support
        mass[self.contact.node(self.masts)] += line.arm_mass

        def both(parts):
            return sp.block_diag(parts, format="csr")[free][:, free]

        tension = both([w.wire.tension * w.S for w in wires])
        bending = both([w.wire.EI * w.B for w in wires])
        droppers = self.B @ sp.diags_array(self.stiffness) @ self.B.T
        springs = droppers + sp.diags_array(spring[free])
        self.M = both([w.wire.mass * w.N for w in wires]) + sp.diags_array(mass[free])
        self.K = tension + bending + springs
        damped = bending + line.beta_tension * tension + line.beta_springs * springs
        self.C = line.alpha * self.M + line.beta * damped + both([w.wire.viscous * w.N for w in wires])
        self.C = self.C + line.dropper_damping * (self.B @ self.B.T)
        #: dropper forces follow T_0 + stiffness e + rate e', e = B^T u
        self.rate = line.beta * line.beta_springs * self.stiffness + line.dropper_damping

    def sag(self, x):
        """Static height of the contact wire at x, or 0 where the model is to be flat."""
        k, N = self.contact.at(x)
        return 0.0 if self.line.flat else N @ self.rest[k : k + 4]
