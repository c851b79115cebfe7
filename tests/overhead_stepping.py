"""The pantograph's run along the line of overhead_oracle: unilateral contact, slack droppers, implicit steps.

The matrix of the taut line, the pantograph and the step is factorised once. Slack droppers and the contact
are a correction in their few unknowns, found in each step by an active set.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lapack


@dataclass(frozen=True)
class Pantograph:
    """Masses [kg] from base to head, stiffness [N/m] and damping [N s/m] below each, static force [N]."""

    mass: tuple[float, ...]
    stiffness: tuple[float, ...]
    damping: tuple[float, ...]
    force: float
    penalty: float = 5e4
    at_start: bool = False  # force: True where it starts, False with the head at height zero


class Factor:
    """Banded Cholesky factor of a sparse symmetric positive definite matrix."""

    def __init__(self, A):
        A = sp.coo_array(A)
        band = int(np.abs(A.row - A.col).max())
        self.ab = np.zeros((band + 1, A.shape[0]))
        upper = A.row <= A.col
        np.add.at(self.ab, (band + A.row[upper] - A.col[upper], A.col[upper]), A.data[upper])
        self.ab, info = lapack.dpbtrf(self.ab)
        assert info == 0

    def solve(self, b):
        return lapack.dpbtrs(self.ab, b)[0]


def correction(tension, gap, G, g, c, slack, penalty):
    """Corrections s of the dropper forces and contact force f of the two unilateral laws, by an active set.

    A taut line's tensions are `tension` + G s - g[0] f, a dropper that would push gets s = that tension; the
    penetration is `gap` + g[1] s - c f, and f = penalty max(0, penetration). Returns s, f and the tensions.
    """
    s, touching = np.zeros(len(tension)), gap > 0
    loose = (tension < 0) & slack
    for _ in range(50):
        k = np.flatnonzero(loose)
        A = np.eye(len(k) + 1)
        A[:-1, :-1] -= G[np.ix_(k, k)]
        A[:-1, -1] = g[0][k]
        A[-1, :-1] = -g[1][k] * touching
        A[-1, -1] = 1 / penalty + c if touching else 1.0
        x = np.linalg.solve(A, np.append(tension[k], gap * touching))
        s[:], f = 0.0, x[-1]
        s[k] = x[:-1]
        pull, depth = tension + G[:, k] @ s[k] - g[0] * f, gap + g[1] @ s - c * f
        before, loose, touched = loose, (pull < 0) & slack, touching
        touching = depth > 0
        if touching == touched and np.array_equal(before, loose):
            return s, f, pull - s
    raise RuntimeError("droppers and contact do not settle")


class Run:
    """A pantograph along the line at constant speed, from equilibrium; `rho` None: trapezoidal rule."""

    def __init__(self, line, pantograph, speed, step, rho=None, ramp=0.0):
        self.line, self.pan, self.speed, self.step, self.ramp = line, pantograph, speed, step, ramp
        n, m = line.M.shape[0], len(pantograph.mass)
        self.head = n + m - 1
        self.force = np.zeros(n + m)
        self.force[self.head] = pantograph.force
        chain = np.eye(m) - np.eye(m, k=-1)  # elongations of the chain's springs
        of = [chain.T @ np.diag(p) @ chain for p in (pantograph.damping, pantograph.stiffness)]
        self.M = sp.block_diag([line.M, np.diag(pantograph.mass)], format="csr")
        self.C, self.K = (sp.block_diag(p, format="csr") for p in ((line.C, of[0]), (line.K, of[1])))
        self.alpha = rho is not None
        self.am, self.af = ((2 * rho - 1) / (rho + 1), rho / (rho + 1)) if self.alpha else (0.0, 0.0)
        self.gamma = 0.5 - self.am + self.af
        self.beta = (0.5 + self.gamma) ** 2 / 4

    def place(self, t):
        """Distance covered after t; the speed grows smoothly over `ramp` seconds."""
        if t >= self.ramp:
            return self.speed * (t - self.ramp / 2)
        return self.speed * (t / 2 - self.ramp * np.sin(np.pi * t / self.ramp) / (2 * np.pi))

    def stretch(self, u):
        """Elongations of the droppers."""
        return u[self.line.upper] - u[self.line.lower]

    def across(self, x):
        """Vector that takes the height of the head minus the wire's (without sag) at x from the unknowns."""
        k, N = self.line.contact.at(x)
        h, number = np.zeros(len(self.force)), self.line.number[k : k + 4]
        h[number[number >= 0]] = -N[number >= 0]
        h[self.head] = 1.0
        return h

    def equilibrium(self, x):
        """Unknowns at rest with the pantograph at x; sets the force where it is meant for this place."""
        factor, h, line = Factor(self.K), self.across(x), self.line
        Y, y = factor.solve(self.padded()), factor.solve(h)
        k, B = line.stiffness, self.stretch
        for _ in range(30):
            u = factor.solve(self.force)
            s, f, _ = correction(
                line.load + k * B(u), h @ u - line.sag(x), k[:, None] * B(Y), (k * B(y), B(y)), h @ y,
                line.line.slack, self.pan.penalty,
            )  # fmt: skip
            if not self.pan.at_start or abs(f - self.pan.force) < 1e-9:
                break
            self.force[self.head] += self.pan.force - f
        return u + Y @ s - y * f

    def padded(self):
        """The droppers' columns in all unknowns, dense."""
        return np.vstack([self.line.B.toarray(), np.zeros((len(self.pan.mass), len(self.line.at)))])

    def run(self, start, end):
        """Time history from `start` to `end` [m]: dict of arrays over time."""
        line, dt, w = self.line, self.step, 1 - self.af
        u = self.equilibrium(start)
        v, a, p = np.zeros_like(u), np.zeros_like(u), np.zeros_like(u)
        cu, cv = self.beta * dt**2, self.gamma * dt
        factor = Factor((1 - self.am) * self.M + w * (cv * self.C + cu * self.K))
        Y = factor.solve(self.padded())
        kappa = w * (line.stiffness * cu + line.rate * cv)
        G, steps = kappa[:, None] * self.stretch(Y), int((end - start) / self.speed / dt + self.ramp / 2 / dt)
        masts = line.number[line.contact.node(line.masts[1:-1])]
        keep = {"x": [], "force": [], "height": [], "uplift": [], "droppers": []}
        for i in range(1, steps + 1):
            x = start + self.place(i * dt)
            h = self.across(x)
            u, v = u + dt * v + (0.5 * dt**2 - cu) * a, v + (dt - cv) * a
            b = w * (self.force - self.C @ v - self.K @ u)
            if self.alpha:
                b += self.af * p - self.am * (self.M @ a)
            a, y = factor.solve(np.column_stack([b, h])).T
            z, rate = u + cu * a, v + cv * a
            by = self.stretch(y)
            tension = line.load + line.stiffness * self.stretch(z) + line.rate * self.stretch(rate)
            s, f, pull = correction(
                tension, h @ z - line.sag(x), G, (kappa * by, w * cu * by), w * cu * (h @ y),
                line.line.slack, self.pan.penalty,
            )  # fmt: skip
            d = np.flatnonzero(s)
            a = a + w * (Y[:, d] @ s[d] - f * y)
            u, v = u + cu * a, v + cv * a
            if self.alpha:
                p = self.force - f * h - self.C @ v - self.K @ u
                p[line.upper] += s
                p[line.lower] -= s
            now = (x, f, u[self.head] - h @ u + line.sag(x), u[masts], pull)
            for values, value in zip(keep.values(), now, strict=True):
                values.append(value)
        return {k: np.array(values) for k, values in keep.items()} | {"end": u, "rate": v}
