"""Derivatives of natural modes: frequencies, repeated ones too, and shapes of simple ones (Nelson 1976)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError, SolveError
from ..later import bmat, csc_array, splu
from ..linalg.sparse import to_sparse
from ..results.modes import Modes
from ..solvers.modes.modal import contacts_about
from ..system.at_rest import assemble_at_rest
from ..system.core import follow_supports, restrict
from ..system.fields import Fields
from ..system.system import System
from .answers import Face, text_of
from .base import check_differentiable
from .family import Family
from .parameters import Parameter

#: Difference of two eigenvalues, relative, up to which they are one.
SAME = 1e-7
#: Share of the largest eigenvalue below which one is zero: a neutral motion.
ZERO = 1e-12


@dataclass(frozen=True)
class ModalSensitivity:
    """Derivatives of modes by one parameter, per unit of it.

    Parameters
    ----------
    name : str
    frequencies : ndarray, shape (count,)
        Of the angular frequencies, rad/s; of equal ones in ascending order, as they part.
    repeated : ndarray of bool, shape (count,)
        Whether another mode has the same frequency.
    """

    name: str
    frequencies: FloatArray
    repeated: Any
    _shapes: FloatArray
    _modes: Modes
    _family: Family

    @property
    def frequencies_hz(self) -> FloatArray:
        """Of the frequencies, Hz."""
        return self.frequencies / (2 * np.pi)

    @property
    def shapes(self) -> FloatArray:
        """Of the shapes, (count, size).

        Raises
        ------
        ModelError
            A mode is repeated: its shape is one of many.
        """
        if np.any(self.repeated):
            k = int(np.argmax(self.repeated))
            what = f"mode {k + 1} has the frequency of another one, its shape is one of many"
            raise ModelError(f"sensitivity {self.name}", what, "ask for fewer modes, or let them differ")
        return self._shapes

    def position(self, point: Any) -> FloatArray:
        """Of the displacements of a point in each mode, (count, 3)."""
        item, modes = text_of(point), self._modes
        total = _displacements(modes.about.system, self.shapes, item)
        here = _displacements(modes.about.system, modes.shapes, item)
        for system, weight in zip(self._family.systems, self._family.weights, strict=True):
            near = Face(system, modes.shapes, modes.shapes, 0.0, True, modes.about.system).position(item)
            total = total + weight * (near - here)
        return total


def _displacements(system: System, shapes: FloatArray, item: Any) -> FloatArray:
    fields = Fields()
    fields._bodies, fields._slots = system.model.bodies, system.slots
    fields._q = fields._v = shapes
    return fields.position(item)


def of_modes(modes: Modes, parameters: list[Parameter]) -> dict[str, ModalSensitivity]:
    """Sensitivities of modes.

    Raises
    ------
    ModelError
        The state about which they are does not know its own, or a parameter has none.
    SolveError
        The equations have no solution.
    """
    where, about = "modes.sensitivities", modes.about
    system: System = about.system
    check_differentiable(system, where)
    problem = _Problem(modes)
    made = {}
    for parameter in parameters:
        family = Family(parameter, system, thorough=True)
        own = about.derivatives.get(family.name)
        if own is not None:
            dq = own.dq
        else:
            dq = np.zeros(system.size) if family.name in about.derivatives else family.of_states(about.t)[0]
        made[family.name] = problem.sensitivity(family, dq)
    return made


class _Problem:
    """A y = lambda M y with y the unknowns that are free, multipliers among them, and its solutions."""

    def __init__(self, modes: Modes) -> None:
        self.modes, self.system = modes, modes.about.system
        system = self.system
        self.q = np.array(modes.about.q)
        self.free = np.asarray(system.free)
        self.A, self.M = self._matrices(system, self.q)
        self.values = modes.frequencies**2
        self.Y = self._whole(modes.shapes)

    def _matrices(self, system: System, q: FloatArray) -> tuple[csc_array, csc_array]:
        core = system.core
        system.level[:] = 1.0, 0.0, 0.0
        found = []
        for mass, stiffness in ((0.0, 1.0), (1.0, 0.0)):
            assemble_at_rest(core.batches, core.ws, q, core.A, mass, 0.0, stiffness)
            restrict(core.supports, core.A)
            found.append(to_sparse(core.A, system.places))
        A = csc_array(found[0] + contacts_about(system, q))
        lam = np.isin(self.free, system.multipliers)
        keep = _diagonal(~lam)
        M = csc_array(keep @ found[1][self.free][:, self.free] @ keep)
        return csc_array(A[self.free][:, self.free]), M

    def _whole(self, shapes: FloatArray) -> FloatArray:
        """Shapes at the free unknowns, with the multipliers that go with them, (n, count)."""
        Y = shapes[:, self.free].T.copy()
        lam = np.flatnonzero(np.isin(self.free, self.system.multipliers))
        if len(lam):
            Y[lam] = 0.0
            rest = self.A @ Y - (self.M @ Y) * self.values
            C = self.A[lam].toarray()
            C[:, lam] = 0.0
            Y[lam] = -np.linalg.lstsq(C.T, rest, rcond=None)[0]
        return Y

    def sensitivity(self, family: Family, dq: FloatArray) -> ModalSensitivity:
        """Derivatives by the parameter of a family where the state changes by dq."""
        dAY, dMY = np.zeros_like(self.Y), np.zeros_like(self.Y)
        family.know(self.system)
        each = zip(family.systems, family.offsets, family.weights, strict=True)
        for system, offset, weight in each:
            q, v, a = self.q + offset * dq, np.zeros_like(dq), np.zeros_like(dq)
            system.place(self.modes.about.t, q, v, a)
            A, M = self._matrices(system, q)
            dAY += weight * (A @ self.Y)
            dMY += weight * (M @ self.Y)
        count = len(self.values)
        rates, repeated, Y = np.zeros(count), np.zeros(count, dtype=bool), self.Y
        derivative = np.zeros((count, self.system.size))
        for group in self._groups():
            own = np.mean(self.values[group])
            small = Y[:, group].T @ (dAY[:, group] - own * dMY[:, group])
            rates[group] = np.linalg.eigvalsh(0.5 * (small + small.T))
            repeated[group] = len(group) > 1
        for k in np.flatnonzero(~repeated).tolist():
            rest = dAY[:, k] - rates[k] * (self.M @ Y[:, k]) - self.values[k] * dMY[:, k]
            derivative[k, self.free] = self._shape(k, rest, -0.5 * float(Y[:, k] @ dMY[:, k]), family.name)
        for k in range(count):
            derivative[k, self.system.multipliers] = 0.0
            _follow(self.system, derivative[k])
            derivative[k] += _turned(family, self.modes.shapes[k], self.system)
        omega = self.modes.frequencies
        moving = self.values > ZERO * np.max(self.values)
        slopes = np.where(moving, rates / (2 * np.where(moving, omega, 1.0)), 0.0)
        return ModalSensitivity(family.name, slopes, repeated, derivative, self.modes, family)

    def _groups(self) -> list[Any]:
        """Places of equal eigenvalues."""
        groups: list[list[int]] = []
        for k, value in enumerate(self.values):
            if groups and abs(value - self.values[groups[-1][0]]) <= SAME * abs(value):
                groups[-1].append(k)
            else:
                groups.append([k])
        return [np.array(group) for group in groups]

    def _shape(self, k: int, rest: FloatArray, along: float, name: str) -> FloatArray:
        """The derivative y' of a simple mode: (A - lambda M) y' = -rest, y.M y' = along."""
        My = csc_array((self.M @ self.Y[:, k])[:, None])
        parts: Any = [[self.A - self.values[k] * self.M, My], [My.T, None]]
        whole = csc_array(bmat(parts))
        try:
            y = splu(whole).solve(np.append(-rest, along))
        except RuntimeError:
            raise SolveError(f"sensitivity {name}", f"mode {k + 1} has no derivative of its shape") from None
        found: FloatArray = y[:-1]
        return found


def _diagonal(mask: Any) -> csc_array:
    n = len(mask)
    return csc_array((mask.astype(np.float64), (np.arange(n), np.arange(n))), shape=(n, n))


def _follow(system: System, x: FloatArray) -> None:
    follow_supports(system.core.supports, x, np.zeros_like(x), np.zeros_like(x))


def _turned(family: Family, shape: FloatArray, system: System) -> FloatArray:
    """What the local axes of supports do to the shadows of a shape."""
    total = np.zeros_like(shape)
    for own, weight in zip(family.systems, family.weights, strict=True):
        x = shape.copy()
        _follow(own, x)
        total[system.n :] += weight * x[system.n :]
    return total
