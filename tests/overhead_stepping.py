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


def correction(tension, gap, G, g, C, slack, penalty):
    """Corrections s of the dropper forces and contact forces f of the unilateral laws, by an active set.

    A taut line's tensions are `tension` + G s - g[0] f, a dropper that would push gets s = that tension; the
    penetrations are `gap` + g[1] s - C f, and f = penalty max(0, penetration). For n droppers and m contacts
    g are (n, m) and (m, n), C is (m, m). Returns s, f and the tensions.
    """
    m = len(gap)
    s, touching = np.zeros(len(tension)), gap > 0
    loose = (tension < 0) & slack
    for _ in range(50):
        k = np.flatnonzero(loose)
        A = np.block([[np.eye(len(k)) - G[np.ix_(k, k)], g[0][k]], [-g[1][:, k], np.eye(m) / penalty + C]])
        A[len(k) :][~touching] = np.eye(len(k) + m)[len(k) :][~touching]
        x = np.linalg.solve(A, np.append(tension[k], gap * touching))
        s[:], f = 0.0, x[len(k) :]
        s[k] = x[: len(k)]
        pull, depth = tension + G[:, k] @ s[k] - g[0] @ f, gap + g[1] @ s - C @ f
        before, loose, touched = loose, (pull < 0) & slack, touching
        touching = depth > 0
        if np.array_equal(touching, touched) and np.array_equal(before, loose):
            return s, f, pull - s
    raise RuntimeError("droppers and contacts do not settle")


class Run:
    """Equal pantographs along the line at constant speed, from equilibrium; `rho` None: trapezoidal rule.

    `behind`: distances behind the first [m], (m,); with one pantograph histories have no axis for it.
    """

    def __init__(self, line, pantograph, speed, step, rho=None, ramp=0.0, behind=(0.0,)):
        self.line, self.pan, self.speed, self.step, self.ramp = line, pantograph, speed, step, ramp
        self.behind, n, m, count = np.array(behind), line.M.shape[0], len(pantograph.mass), len(behind)
        self.heads = n + m * np.arange(1, count + 1) - 1
        self.force = np.zeros(n + m * count)
        self.force[self.heads] = pantograph.force
        chain = np.eye(m) - np.eye(m, k=-1)  # elongations of the chain's springs
        of = [chain.T @ np.diag(p) @ chain for p in (pantograph.damping, pantograph.stiffness)]
        parts = zip((line.M, line.C, line.K), (np.diag(pantograph.mass), *of), strict=True)
        self.M, self.C, self.K = (sp.block_diag([p, *[q] * count], format="csr") for p, q in parts)
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
        """Vectors (., m) that take heights of heads minus wire (without sag) at x (m,) from the unknowns."""
        places = np.atleast_1d(x)
        H = np.zeros((len(self.force), len(places)))
        for j, (place, head) in enumerate(zip(places, self.heads, strict=True)):
            k, N = self.line.contact.at(place)
            number = self.line.number[k : k + 4]
            H[number[number >= 0], j] = -N[number >= 0]
            H[head, j] = 1.0
        return H

    def sag(self, x):
        """Static heights of the contact wire at x (m,)."""
        return np.array([self.line.sag(place) for place in np.atleast_1d(x)])

    def equilibrium(self, x):
        """Unknowns at rest with pantographs at x; sets the force where it is meant for this place."""
        factor, H, line = Factor(self.K), self.across(x), self.line
        Y, y = factor.solve(self.padded()), factor.solve(H)
        k, B, load = line.stiffness[:, None], self.stretch, line.load
        for _ in range(30):
            u = factor.solve(self.force)
            s, f, _ = correction(
                load + k[:, 0] * B(u), H.T @ u - self.sag(x), k * B(Y), (k * B(y), B(y).T), H.T @ y,
                line.line.slack, self.pan.penalty,
            )  # fmt: skip
            if not self.pan.at_start or np.abs(f - self.pan.force).max() < 1e-9:
                break
            self.force[self.heads] += self.pan.force - f
        return u + Y @ s - y @ f

    def padded(self):
        """The droppers' columns in all unknowns, dense."""
        B = self.line.B.toarray()
        return np.vstack([B, np.zeros((len(self.force) - len(B), B.shape[1]))])

    def run(self, start, end):
        """Time history of the last pantograph from `start` to `end` [m]: dict of arrays over time."""
        line, dt, w = self.line, self.step, 1 - self.af
        first = start + self.behind.max() - self.behind
        u = self.equilibrium(first)
        v, a, p = np.zeros_like(u), np.zeros_like(u), np.zeros_like(u)
        cu, cv = self.beta * dt**2, self.gamma * dt
        factor = Factor((1 - self.am) * self.M + w * (cv * self.C + cu * self.K))
        Y = factor.solve(self.padded())
        kappa = w * (line.stiffness * cu + line.rate * cv)
        G, steps = kappa[:, None] * self.stretch(Y), int((end - start) / self.speed / dt + self.ramp / 2 / dt)
        masts = line.number[line.contact.node(line.masts[1:-1])]
        keep = {"x": [], "force": [], "height": [], "uplift": [], "droppers": []}
        for i in range(1, steps + 1):
            x = first + self.place(i * dt)
            H = self.across(x)
            u, v = u + dt * v + (0.5 * dt**2 - cu) * a, v + (dt - cv) * a
            b = w * (self.force - self.C @ v - self.K @ u)
            if self.alpha:
                b += self.af * p - self.am * (self.M @ a)
            a, y = np.split(factor.solve(np.column_stack([b, H])), [1], axis=1)
            a = a[:, 0]
            z, rate = u + cu * a, v + cv * a
            by = self.stretch(y)
            tension = line.load + line.stiffness * self.stretch(z) + line.rate * self.stretch(rate)
            s, f, pull = correction(
                tension, H.T @ z - self.sag(x), G, (kappa[:, None] * by, w * cu * by.T), w * cu * (H.T @ y),
                line.line.slack, self.pan.penalty,
            )  # fmt: skip
            d = np.flatnonzero(s)
            a = a + w * (Y[:, d] @ s[d] - y @ f)
            u, v = u + cu * a, v + cv * a
            if self.alpha:
                p = self.force - H @ f - self.C @ v - self.K @ u
                p[line.upper] += s
                p[line.lower] -= s
            now = (x, f, u[self.heads] - H.T @ u + self.sag(x), u[masts], pull)
            for values, value in zip(keep.values(), now, strict=True):
                values.append(value)
        history = {k: np.array(values) for k, values in keep.items()} | {"end": u, "rate": v}
        alone = {k: history[k][:, 0] for k in ("x", "force", "height") if len(self.heads) == 1}
        return history | alone
