"""The linear model about an equilibrium: x' = A x + B u, y = C x + D u, all of them changes."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import ModelError
from ..model import checks
from ..model.tables import Readable, Sheet, Table, number, plural
from ..preparation import adopted
from ..results.state import State
from ..system.system import System


@dataclass(frozen=True)
class Reading:
    """How states follow from state vectors of the same model.

    Parameters
    ----------
    system : System
    q : ndarray, shape (size,)
        Of the equilibrium.
    unknowns : ndarray, shape (k,)
    of_q, of_v : ndarray, shape (states, k)
        Factors of their changes and of their rates.
    """

    system: System
    q: FloatArray
    unknowns: IntArray
    of_q: FloatArray
    of_v: FloatArray

    def __call__(self, now: State) -> FloatArray:
        """States (states,); ModelError of another model."""
        q, v = adopted(now, self.system, "state")
        pairs = zip(_places(now.system), _places(self.system), strict=False)
        if all(np.array_equal(mine, own) for mine, own in pairs):
            q, v = now.q, now.v  # supports as in the run, also where those of this model do not move
        found: FloatArray = self.of_q @ (q - self.q)[self.unknowns] + self.of_v @ v[self.unknowns]
        return found


def _places(system: System) -> list[IntArray]:
    """What says what the entries of a state vector are."""
    each = [table[name] for table in (system.slots, system.joints) for name in sorted(table)]
    return [system.supports.rot_slot, np.array([len(each)]), *each]


@dataclass(frozen=True)
class LinearModel(Readable):
    """Linear equations about an equilibrium, x' = A x + B u and y = C x + D u, in SI units.

    x, u and y are changes from the equilibrium. The states are amplitudes of the undamped modes about it,
    lowest first, then the displacements of what inputs move, then the rates of all of these. Modes count from
    where all of it would stand at rest with these displacements; where a velocity is the input, the rate of a
    mode is its momentum over its mass.

    Parameters
    ----------
    A, B, C, D : ndarray, shape (states, states), (states, inputs), (outputs, states), (outputs, inputs)
    inputs, outputs, states : tuple of str
        Names.
    input_units, output_units, state_units : tuple of str
        "" where it is not known.
    inputs_at, outputs_at : ndarray, shape (inputs,) and (outputs,)
        What they are in the equilibrium.
    frequencies_hz : ndarray, shape (modes,)
        Undamped, of the modes among the states.
    about : State
        The equilibrium.
    left_out_hz : float
        Frequency of the lowest mode that was left out, infinite without any.
    notes : list of str
        What to know that nobody asked for: that the state is no equilibrium.
    """

    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: FloatArray
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    states: tuple[str, ...]
    input_units: tuple[str, ...]
    output_units: tuple[str, ...]
    state_units: tuple[str, ...]
    inputs_at: FloatArray
    outputs_at: FloatArray
    frequencies_hz: FloatArray
    about: State
    left_out_hz: float = np.inf
    notes: list[str] = field(default_factory=list, repr=False)
    reading: Reading | None = field(default=None, repr=False)

    def __repr__(self) -> str:
        sizes = ", ".join(plural(len(names), word) for names, word in self._named())
        return f"LinearModel({sizes})"

    def _named(self) -> list[tuple[tuple[str, ...], str]]:
        return [(self.inputs, "input"), (self.outputs, "output"), (self.states, "state")]

    def _sheet(self) -> Sheet:
        hz = self.frequencies_hz
        kept = f"{plural(len(hz), 'mode')}" + (f", {hz[0]:.4g} to {hz[-1]:.4g} Hz" if len(hz) else "")
        left = f"from {self.left_out_hz:.4g} Hz, at rest" if np.isfinite(self.left_out_hz) else ""
        facts = [("states", f"{len(self.states)}, {kept}"), ("modes left out", left)]
        rows = [
            (word, name, unit, number(value))
            for word, names, units, values in (
                ("input", self.inputs, self.input_units, self.inputs_at),
                ("output", self.outputs, self.output_units, self.outputs_at),
            )
            for name, unit, value in zip(names, units, values, strict=True)
        ]
        facts += [("note", text) for text in self.notes]
        title = self.about.model.title
        columns = ("", "name", "unit", "in the equilibrium")
        return Sheet(f"LinearModel{f' {title!r}' if title else ''}", facts, [Table(columns, rows)])

    @property
    def eigenvalues(self) -> Any:
        """Of A, 1/s, ascending by size; those of :func:`ancf.damped_modes`, pairs in full."""
        found = np.linalg.eigvals(self.A)
        return found[np.lexsort((found.imag, np.abs(found)))]

    def state(self, now: State) -> FloatArray:
        """States x, shape (states,), of a state or a run near the equilibrium: for a controller.

        Positions and velocities go through the inverse of what the states mean; modes that were left out, and
        multipliers of joints, do not count.

        Parameters
        ----------
        now : State
            Of the same model; what a controller or stepper is given is one.

        Raises
        ------
        ModelError
            It is no State, or one of another model.
        """
        if not isinstance(now, State):
            raise ModelError("state", f"must be a State or a run, is {checks.shown(now)}")
        assert self.reading is not None
        return self.reading(now)

    def frequency_response(self, f: Any) -> Any:
        """Transfer function C (i w - A)^-1 B + D at frequencies, complex, shape (n, outputs, inputs).

        Parameters
        ----------
        f : array_like, shape (n,)
            Hz; 0 for the static gain.

        Raises
        ------
        ModelError
            A frequency is negative, or an undamped mode has just this frequency.
        """
        rows = checks.array(np.atleast_1d(f), "frequency_response.f", (None,))
        found = np.empty((len(rows), len(self.outputs), len(self.inputs)), dtype=complex)
        for k, hz in enumerate(rows.tolist()):
            checks.non_negative(hz, f"frequency_response.f[{k}]")
            found[k] = self.D + self.C @ self._resolved(2j * np.pi * hz, hz)
        return found

    def _resolved(self, s: complex, hz: float) -> Any:
        try:
            return np.linalg.solve(s * np.eye(len(self.A)) - self.A, self.B)
        except np.linalg.LinAlgError:
            what = f"at {hz:g} Hz it is infinite: a motion there has neither stiffness nor damping"
            hint = "leave this frequency out, or hold or damp the motion"
            raise ModelError("frequency_response", what, hint) from None

    def to_scipy(self) -> Any:
        """The same as a ``scipy.signal.StateSpace``."""
        from scipy.signal import StateSpace  # few need it

        return StateSpace(self.A, self.B, self.C, self.D)

    def reduced(self, modes: int) -> LinearModel:
        """The same with the lowest modes alone; the others follow at once, as at rest.

        States of the other modes have the value at which they would stand still: the static gain stays as it
        is, exactly, and the outputs get a direct part of the inputs in D. It serves well below
        ``left_out_hz``. What inputs move keeps its states.

        Parameters
        ----------
        modes : int
            Number of modes that stay.

        Raises
        ------
        ModelError
            There are not so many, or what is left out has no stiffness.
        """
        count = len(self.frequencies_hz)
        checks.integer(modes, "linearise.modes", 1, count)
        if modes == count:
            return self
        if self.frequencies_hz[modes] == 0.0:
            free = int(np.sum(self.frequencies_hz == 0.0))
            what = f"is {modes}, but {free} motions have no stiffness, and would not stand still"
            raise ModelError("linearise.modes", what, f"give {free} or more")
        moved = self.states[count:].index("rate of mode 1")
        kept = np.ones(len(self.A), dtype=bool)
        kept[modes:count] = kept[count + moved + modes : 2 * count + moved] = False
        out = np.flatnonzero(~kept)
        try:
            rest = np.linalg.solve(
                self.A[np.ix_(out, out)], np.hstack([self.A[np.ix_(out, kept)], self.B[out]])
            )
        except np.linalg.LinAlgError:
            what = "what is left out has no stiffness and would not stand still"
            raise ModelError("linearise.modes", what, "keep more modes") from None
        to_states, to_inputs = rest[:, : kept.sum()], rest[:, kept.sum() :]
        A, C = self.A[np.ix_(kept, out)], self.C[:, out]
        read = self.reading
        if read is not None:
            read = replace(read, of_q=read.of_q[kept], of_v=read.of_v[kept])
        return replace(
            self,
            A=self.A[np.ix_(kept, kept)] - A @ to_states,
            B=self.B[kept] - A @ to_inputs,
            C=self.C[:, kept] - C @ to_states,
            D=self.D - C @ to_inputs,
            states=tuple(np.array(self.states)[kept].tolist()),
            state_units=tuple(np.array(self.state_units)[kept].tolist()),
            frequencies_hz=self.frequencies_hz[:modes],
            left_out_hz=float(self.frequencies_hz[modes]),
            reading=read,
        )
