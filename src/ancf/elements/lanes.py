"""Kernels of the cable for LANES elements at a time.

The workspace ``ws`` is a flat array of rows of LANES numbers: row k of lane l is ``ws[k * LANES + l]``.
With a constant row length and one array the compiler turns the inner loops into vector instructions.

Each element is described by d = (r_2 - r_1)/L, t1 = r_x(0), t2 = r_x(L); then

    r_x  =  cd d + c1 t1 + c2 t2,        r_xx = (ed d + e1 t1 + e2 t2)/L

with the coefficients of one Gauss point in a row of the table ``gp``: cd c1 c2 ed e1 e2 weight.
"""

from __future__ import annotations

import math

import numpy as np

from ..arrays import FloatArray
from ..compiled import formula, inline_kernel
from .shapes import gauss

LANES = 8

# rows of the workspace: three components each, then scalars, then the reference strains
D, T1, T2 = 0, 3, 6  # element shape
FD, F1, F2 = 9, 12, 15  # force on d, t1, t2
VD, V1, V2 = 18, 21, 24  # rates of d, t1, t2
LENGTH, INV_L, EA_L, EI_L, DA_L, DB_L = 27, 28, 29, 30, 31, 32
MASS, VISCOUS = 33, 34  # rhoA L/420, external damping / rhoA
CONSTANTS = 8  # rows from LENGTH to VISCOUS
A1, AS1, A2, AS2 = 35, 38, 41, 44  # accelerations of the four slots
NODAL = 47  # forces on the four slots: 12 rows
SLOPE = 59  # slope damping L/30, of damped elements
REFERENCE = 60  # reference axial strain or curvature at the Gauss point at hand
KPP, KPS, KSS = 61, 67, 76  # second derivatives at a Gauss point: 6, 9, 6 rows
KDD, KD1, KD2, K11, K12, K22 = 82, 91, 100, 109, 118, 127  # 3x3 blocks
ROWS = 738  # of the workspace, which all elements share: what the greediest needs

#: A curved reference needs kappa itself; it is rounded off below this fraction of kappa0.
SMOOTHING = 1e-4
#: Curvature times element length below which bending damping acts alike in all directions.
STRAIGHT = 1e-2


def gauss_table(axial: int, bending: int) -> FloatArray:
    """Coefficients of r_x and r_xx at the axial, then the bending Gauss points, shape (n, 7)."""
    rows = []
    for points in (axial, bending):
        x, weight = gauss(points)
        c = (6 * x * (1 - x), 1 - 4 * x + 3 * x * x, 3 * x * x - 2 * x)
        e = (6 - 12 * x, 6 * x - 4, 6 * x - 2)
        rows.append(np.stack([*c, *e, weight], axis=1))
    return np.ascontiguousarray(np.concatenate(rows))


def workspace() -> FloatArray:
    """Workspace for the kernels of all elements; its rows do not cross cache lines."""
    spare = np.zeros((ROWS + 1) * LANES)
    start = -(spare.ctypes.data // 8) % LANES
    return spare[start : start + ROWS * LANES]


@formula
def clear(ws, first, rows):
    """Set rows to zero."""
    for i in range(first * LANES, (first + rows) * LANES):
        ws[i] = 0.0


@inline_kernel
def axial_force(ws, gp, g, paper):
    """Add the axial force of Gauss point ``g`` to rows FD, F1, F2 (eqs. 25, 27, B-1)."""
    cd, c1, c2, w = gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 6]
    for m in range(LANES):
        px = cd * ws[0 * LANES + m] + c1 * ws[3 * LANES + m] + c2 * ws[6 * LANES + m]
        py = cd * ws[1 * LANES + m] + c1 * ws[4 * LANES + m] + c2 * ws[7 * LANES + m]
        pz = cd * ws[2 * LANES + m] + c1 * ws[5 * LANES + m] + c2 * ws[8 * LANES + m]
        a = px * px + py * py + pz * pz
        e0 = ws[REFERENCE * LANES + m]
        f = w * ws[EA_L * LANES + m] * (0.5 * (a - 1.0) - e0 if paper else 1.0 - (1.0 + e0) / math.sqrt(a))
        px *= f
        py *= f
        pz *= f
        ws[9 * LANES + m] += cd * px
        ws[10 * LANES + m] += cd * py
        ws[11 * LANES + m] += cd * pz
        ws[12 * LANES + m] += c1 * px
        ws[13 * LANES + m] += c1 * py
        ws[14 * LANES + m] += c1 * pz
        ws[15 * LANES + m] += c2 * px
        ws[16 * LANES + m] += c2 * py
        ws[17 * LANES + m] += c2 * pz


@inline_kernel
def bending_force(ws, gp, g, paper, curved):
    """Add the bending force of Gauss point ``g`` to rows FD, F1, F2 (eqs. 26, 27)."""
    cd, c1, c2, ed, e1, e2, w = gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 3], gp[g, 4], gp[g, 5], gp[g, 6]
    scale = math.sqrt(1.0 + SMOOTHING * SMOOTHING)
    for m in range(LANES):
        px = cd * ws[0 * LANES + m] + c1 * ws[3 * LANES + m] + c2 * ws[6 * LANES + m]
        py = cd * ws[1 * LANES + m] + c1 * ws[4 * LANES + m] + c2 * ws[7 * LANES + m]
        pz = cd * ws[2 * LANES + m] + c1 * ws[5 * LANES + m] + c2 * ws[8 * LANES + m]
        il = ws[INV_L * LANES + m]
        sx = (ed * ws[0 * LANES + m] + e1 * ws[3 * LANES + m] + e2 * ws[6 * LANES + m]) * il
        sy = (ed * ws[1 * LANES + m] + e1 * ws[4 * LANES + m] + e2 * ws[7 * LANES + m]) * il
        sz = (ed * ws[2 * LANES + m] + e1 * ws[5 * LANES + m] + e2 * ws[8 * LANES + m]) * il
        a = px * px + py * py + pz * pz
        b = px * sx + py * sy + pz * sz
        c = sx * sx + sy * sy + sz * sz
        ia = 1.0 / a
        im = ia * ia * (ia if paper else 1.0)
        k2 = (a * c - b * b) * im
        f = w * ws[EI_L * LANES + m]
        if curved:
            kappa0 = ws[REFERENCE * LANES + m]
            f *= 1.0 - kappa0 * scale / math.sqrt(abs(k2) + (SMOOTHING * kappa0) ** 2 + 1e-200)
        wa = f * (c * im - (3.0 if paper else 2.0) * k2 * ia)  # 2 dW/da
        wb = -f * b * im  # dW/db
        wc = f * a * im * il  # 2 dW/dc / L
        ax = wa * px + wb * sx
        ay = wa * py + wb * sy
        az = wa * pz + wb * sz
        wb *= il
        bx = wb * px + wc * sx
        by = wb * py + wc * sy
        bz = wb * pz + wc * sz
        ws[9 * LANES + m] += cd * ax + ed * bx
        ws[10 * LANES + m] += cd * ay + ed * by
        ws[11 * LANES + m] += cd * az + ed * bz
        ws[12 * LANES + m] += c1 * ax + e1 * bx
        ws[13 * LANES + m] += c1 * ay + e1 * by
        ws[14 * LANES + m] += c1 * az + e1 * bz
        ws[15 * LANES + m] += c2 * ax + e2 * bx
        ws[16 * LANES + m] += c2 * ay + e2 * by
        ws[17 * LANES + m] += c2 * az + e2 * bz


@inline_kernel
def inertia_force(ws):
    """Rows NODAL: consistent mass (eq. 23) times the rows A1 ... AS2, plus the rows FD, F1, F2."""
    for k in range(3):
        for m in range(LANES):
            h, mass, il = ws[LENGTH * LANES + m], ws[MASS * LANES + m], ws[INV_L * LANES + m]
            a1, a2 = ws[(A1 + k) * LANES + m], ws[(A2 + k) * LANES + m]
            s1, s2 = h * ws[(AS1 + k) * LANES + m], h * ws[(AS2 + k) * LANES + m]
            fd = ws[(FD + k) * LANES + m] * il
            ws[(NODAL + k) * LANES + m] = mass * (156 * a1 + 22 * s1 + 54 * a2 - 13 * s2) - fd
            ws[(NODAL + 3 + k) * LANES + m] = ws[(F1 + k) * LANES + m] + mass * h * (
                22 * a1 + 4 * s1 + 13 * a2 - 3 * s2
            )
            ws[(NODAL + 6 + k) * LANES + m] = mass * (54 * a1 + 13 * s1 + 156 * a2 - 22 * s2) + fd
            ws[(NODAL + 9 + k) * LANES + m] = ws[(F2 + k) * LANES + m] + mass * h * (
                -13 * a1 - 3 * s1 - 22 * a2 + 4 * s2
            )


@inline_kernel
def axial_tangent(ws, gp, g, paper, c_damping):
    """Rows KPP: second derivative of the axial energy by r_x, damping included."""
    cd, c1, c2, w = gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 6]
    for m in range(LANES):
        px = cd * ws[0 * LANES + m] + c1 * ws[3 * LANES + m] + c2 * ws[6 * LANES + m]
        py = cd * ws[1 * LANES + m] + c1 * ws[4 * LANES + m] + c2 * ws[7 * LANES + m]
        pz = cd * ws[2 * LANES + m] + c1 * ws[5 * LANES + m] + c2 * ws[8 * LANES + m]
        a = px * px + py * py + pz * pz
        e0 = ws[REFERENCE * LANES + m]
        ea = w * ws[EA_L * LANES + m]
        if paper:
            f = ea * (0.5 * (a - 1.0) - e0)
            h = ea + c_damping * w * ws[DA_L * LANES + m]
        else:
            f = ea * (1.0 - (1.0 + e0) / math.sqrt(a))
            h = (ea - f + c_damping * w * ws[DA_L * LANES + m]) / a
        ws[(KPP + 0) * LANES + m] = f + h * px * px
        ws[(KPP + 1) * LANES + m] = h * px * py
        ws[(KPP + 2) * LANES + m] = h * px * pz
        ws[(KPP + 3) * LANES + m] = f + h * py * py
        ws[(KPP + 4) * LANES + m] = h * py * pz
        ws[(KPP + 5) * LANES + m] = f + h * pz * pz


@inline_kernel
def bending_tangent(ws, gp, g, paper, curved):
    """Rows KPP, KPS, KSS: second derivatives of the bending energy by r_x = p and r_xx = s."""
    cd, c1, c2, ed, e1, e2, w = gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 3], gp[g, 4], gp[g, 5], gp[g, 6]
    scale = math.sqrt(1.0 + SMOOTHING * SMOOTHING)
    power = 3.0 if paper else 2.0
    for m in range(LANES):
        px = cd * ws[0 * LANES + m] + c1 * ws[3 * LANES + m] + c2 * ws[6 * LANES + m]
        py = cd * ws[1 * LANES + m] + c1 * ws[4 * LANES + m] + c2 * ws[7 * LANES + m]
        pz = cd * ws[2 * LANES + m] + c1 * ws[5 * LANES + m] + c2 * ws[8 * LANES + m]
        il = ws[INV_L * LANES + m]
        sx = (ed * ws[0 * LANES + m] + e1 * ws[3 * LANES + m] + e2 * ws[6 * LANES + m]) * il
        sy = (ed * ws[1 * LANES + m] + e1 * ws[4 * LANES + m] + e2 * ws[7 * LANES + m]) * il
        sz = (ed * ws[2 * LANES + m] + e1 * ws[5 * LANES + m] + e2 * ws[8 * LANES + m]) * il
        a = px * px + py * py + pz * pz
        b = px * sx + py * sy + pz * sz
        c = sx * sx + sy * sy + sz * sz
        ia = 1.0 / a
        im = ia * ia * (ia if paper else 1.0)
        k2 = (a * c - b * b) * im
        wu = 0.5 * w * ws[EI_L * LANES + m]  # dW/d(kappa^2)
        wuu = 0.0
        if curved:
            kappa0 = ws[REFERENCE * LANES + m]
            khat2 = abs(k2) + (SMOOTHING * kappa0) ** 2 + 1e-200
            ratio = kappa0 * scale / math.sqrt(khat2)
            wuu = 0.5 * wu * ratio / khat2
            wu *= 1.0 - ratio
        ua = c * im - power * k2 * ia
        ub = -2.0 * b * im
        uc = a * im
        haa = wu * (power * (power + 1.0) * k2 * ia - 2.0 * power * c * im) * ia + wuu * ua * ua
        hab = wu * 2.0 * power * b * im * ia + wuu * ua * ub
        hac = wu * (1.0 - power) * im + wuu * ua * uc
        hbb = -2.0 * wu * im + wuu * ub * ub
        hbc = wuu * ub * uc
        hcc = wuu * uc * uc
        # K = sum of coefficient x (p p^T, p s^T + s p^T or p s^T and s p^T, s s^T) + coefficient x I
        i0, p0, q0, s0 = 2.0 * wu * ua, 4.0 * haa, 2.0 * hab, hbb
        ws[(KPP + 0) * LANES + m] = i0 + p0 * px * px + 2.0 * q0 * px * sx + s0 * sx * sx
        ws[(KPP + 1) * LANES + m] = p0 * px * py + q0 * (px * sy + sx * py) + s0 * sx * sy
        ws[(KPP + 2) * LANES + m] = p0 * px * pz + q0 * (px * sz + sx * pz) + s0 * sx * sz
        ws[(KPP + 3) * LANES + m] = i0 + p0 * py * py + 2.0 * q0 * py * sy + s0 * sy * sy
        ws[(KPP + 4) * LANES + m] = p0 * py * pz + q0 * (py * sz + sy * pz) + s0 * sy * sz
        ws[(KPP + 5) * LANES + m] = i0 + p0 * pz * pz + 2.0 * q0 * pz * sz + s0 * sz * sz
        i1, p1, q1, o1, s1 = wu * ub, 2.0 * hab, 4.0 * hac, hbb, 2.0 * hbc
        ws[(KPS + 0) * LANES + m] = i1 + p1 * px * px + (q1 + o1) * px * sx + s1 * sx * sx
        ws[(KPS + 1) * LANES + m] = p1 * px * py + q1 * px * sy + o1 * sx * py + s1 * sx * sy
        ws[(KPS + 2) * LANES + m] = p1 * px * pz + q1 * px * sz + o1 * sx * pz + s1 * sx * sz
        ws[(KPS + 3) * LANES + m] = p1 * py * px + q1 * py * sx + o1 * sy * px + s1 * sy * sx
        ws[(KPS + 4) * LANES + m] = i1 + p1 * py * py + (q1 + o1) * py * sy + s1 * sy * sy
        ws[(KPS + 5) * LANES + m] = p1 * py * pz + q1 * py * sz + o1 * sy * pz + s1 * sy * sz
        ws[(KPS + 6) * LANES + m] = p1 * pz * px + q1 * pz * sx + o1 * sz * px + s1 * sz * sx
        ws[(KPS + 7) * LANES + m] = p1 * pz * py + q1 * pz * sy + o1 * sz * py + s1 * sz * sy
        ws[(KPS + 8) * LANES + m] = i1 + p1 * pz * pz + (q1 + o1) * pz * sz + s1 * sz * sz
        i2, p2, q2, s2 = 2.0 * wu * uc, hbb, 2.0 * hbc, 4.0 * hcc
        ws[(KSS + 0) * LANES + m] = i2 + p2 * px * px + 2.0 * q2 * px * sx + s2 * sx * sx
        ws[(KSS + 1) * LANES + m] = p2 * px * py + q2 * (px * sy + sx * py) + s2 * sx * sy
        ws[(KSS + 2) * LANES + m] = p2 * px * pz + q2 * (px * sz + sx * pz) + s2 * sx * sz
        ws[(KSS + 3) * LANES + m] = i2 + p2 * py * py + 2.0 * q2 * py * sy + s2 * sy * sy
        ws[(KSS + 4) * LANES + m] = p2 * py * pz + q2 * (py * sz + sy * pz) + s2 * sy * sz
        ws[(KSS + 5) * LANES + m] = i2 + p2 * pz * pz + 2.0 * q2 * pz * sz + s2 * sz * sz
