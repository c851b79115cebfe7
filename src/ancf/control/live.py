"""A run between two steps: what controllers, and programs that take steps, see of it and may change."""

from __future__ import annotations

import math
from collections.abc import Iterator, MutableMapping

import numpy as np

from ..arrays import FloatArray
from ..contact.rubbed import RUBBED
from ..errors import ModelError
from ..model import checks
from ..model.joints.torsion import TorsionSpring
from ..model.names import unknown
from ..preparation import Prepared
from ..results import motions, remembered
from ..results.given import Given
from ..results.overview import line_of_state
from ..results.remembered import Remembered
from ..results.state import Energy, State
from ..solvers.record import Stats
from ..solvers.runs import AnyRun
from ..solvers.stepping import Run
from ..system.contact_fields import TOUCHING
from ..system.energy import energies
from ..system.inputs import Inputs
from ..system.spring_fields import springs_of
from ..system.system import System


class InputValues(MutableMapping[str, float]):
    """The inputs of a model by name, as they are now; a value that is given holds from the next step on.

    Parameters
    ----------
    inputs : Inputs
    run : AnyRun
        Knows the time.
    history : Given, optional
        Takes what is given.
    """

    def __init__(self, inputs: Inputs, run: AnyRun, history: Given | None = None) -> None:
        self._inputs, self._run, self._history = inputs, run, history

    def __setattr__(self, name: str, value: object) -> None:
        if not name.startswith("_"):  # it would be accepted, and do nothing
            raise AttributeError(f'no attribute of inputs can be set: write run.inputs["{name}"] = {value!r}')
        super().__setattr__(name, value)

    def __getitem__(self, name: str) -> float:
        if name not in self._inputs.given:
            raise unknown("inputs", "input", name, self._inputs.given)
        return self._inputs.given[name]

    def __setitem__(self, name: str, value: float) -> None:
        if name not in self._inputs.given:
            raise unknown("inputs", "input", name, self._inputs.given)
        if type(value) is not float or not math.isfinite(value):
            value = checks.number(value, f'inputs["{name}"]')
        if self._inputs.given[name] == value:
            return
        self._inputs.give(name, value)
        if self._history is not None:
            run = self._run
            self._history.note(run.t_start + run.done * run.h, self._inputs.given)

    def __delitem__(self, name: str) -> None:
        raise ModelError(f'inputs["{name}"]', "cannot be deleted: the model has it")

    def __iter__(self) -> Iterator[str]:
        return iter(self._inputs.given)

    def __len__(self) -> int:
        return len(self._inputs.given)

    def __repr__(self) -> str:
        return f"InputValues({self._inputs.given})"


class Live(State):
    """The present state of a run; it answers as a :class:`ancf.State`, always of now.

    Attributes
    ----------
    t : float
        Time, s.
    inputs : mapping of str to float
        Inputs by name, to be read and given.
    """

    def __init__(self, made: Prepared) -> None:
        self.system, self.model, self._run = made.system, made.system.model, made.run
        self.inputs = InputValues(made.system.inputs, made.run, made.given)
        self._bodies, self._slots = self.model.bodies, self.system.slots
        self._joints, self._arcs = self.system.joints, self.system.numbering.arcs
        self._lengths = self.system.lengths
        self._springs = springs_of(self.model.connections)
        self._partly = isinstance(self._run, Run) and self._run.far is not None
        self.look()

    def look(self) -> None:
        """See the run as it is now."""
        self._now, self._seen = self._run.now(), self._run.done
        self.t = self._run.t_start + self._run.done * self._run.h

    def _vectors(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Those of now; of a line of which parts sleep they are made when they are asked for."""
        if self._partly and self._seen != self._run.done:
            self._now, self._seen = self._run.now(), self._run.done
        return self._now

    @property
    def _q(self) -> FloatArray:  # type: ignore[override]
        return self._vectors()[0]

    @property
    def _v(self) -> FloatArray:  # type: ignore[override]
        return self._vectors()[1]

    @property
    def _work(self) -> FloatArray:
        return self._vectors()[2]

    def __repr__(self) -> str:
        return line_of_state(self)

    def _in_motion(self) -> tuple[FloatArray, FloatArray]:
        """As the step had them; a Radau method has none."""
        if isinstance(self._run, Run):
            return self._run.felt()
        return motions.of_state(self.system, self._q, self._v, self.t, self.known)

    def _turned_to(self, spring: TorsionSpring) -> float | None:
        return self._remembered_turn(spring, self.system.memory)

    def _memory_of(self, part: str) -> dict[str, FloatArray] | None:
        """As it is now; before the first step nothing has acted yet, and what the run begins with counts."""
        memory = self.system.memory
        known = {key.partition(".")[2]: x for key, x in memory.items() if key.startswith(f"{part}.")}
        frictions = {rough: rubbed for _, rough, _, rubbed in TOUCHING.values()}
        if known and part in frictions and self._run.done == 0:
            sums = np.zeros_like(known["found"])
            sums[:, RUBBED:] = frictions[part](self.system.parts[part], self._q, self._v)
            known["found"] = sums
            if "limit" in known:
                known["acted"] = known["limit"]
        return known or None

    def _at_rest(self, name: str) -> FloatArray | None:
        return None

    @property
    def rests(self) -> bool:
        """No run is an equilibrium."""
        return False

    @property
    def q(self) -> FloatArray:
        """State vector, shape (size,), a copy."""
        return self._q.copy()

    @property
    def v(self) -> FloatArray:
        """Rates of the state vector, shape (size,), a copy."""
        return self._v.copy()

    @property
    def stats(self) -> Stats:  # type: ignore[override]
        """Counters of the run."""
        return self._run.stats

    @property
    def known(self) -> Remembered:  # type: ignore[override]
        """What the run knows beside the state vectors."""
        return remembered.of_system(self.system)

    @property
    def energy(self) -> Energy:
        """Energies now, J; dissipated and supplied since the start."""
        kinetic, strain, potential = energies(self._whole, self._q[None], self._v[None])[0]
        dissipated, supplied = (np.float64(x) for x in self._work)
        return Energy(kinetic, strain, potential, dissipated, supplied)  # type: ignore[arg-type]

    def state(self) -> State:
        """The state now, which stays as it is while the run goes on."""
        return State(self._whole, self.t, self.q, self.v, self.stats, self.known)

    @property
    def _whole(self) -> System:
        """The system of the run, or one like it: cables of parts that sleep have no stiffness in that."""
        return self.system.double if self._partly else self.system
