"""Result: the stored states of a simulation and what can be asked of them."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError, StorageError
from ..files import writing
from ..model import checks
from ..model.joints.basic import Slide
from ..model.tables import Readable, Sheet
from ..solvers.record import Stats
from ..system.contact_fields import ContactFields
from ..system.energy import energies
from ..system.probe import lengths_of
from ..system.redundancy import independent
from ..system.spring_fields import SpringFields, springs_of
from ..system.system import System
from . import motions, noticed, remembered
from .comparison import Comparison, compare
from .given import Given, Led, history_of
from .momenta import Momenta
from .motions import Motions
from .overview import line_of_result, of_result
from .pictures import Filmed
from .read_store import ReadStore
from .remembered import Remembered
from .sensitivities import sensitivity_of
from .sensors import Sensors
from .slackness import SlackInterval, slack_intervals
from .state import Energy, State
from .store import FileStore, MemoryStore


class Result(SpringFields, ContactFields, Momenta, Motions, Led, Filmed, Readable):
    """History of a simulation: what it was, at any point, joint or support, at all stored times.

    ``print(result)`` says how it went; ``model`` is the model that was computed.
    """

    def __init__(self, store: MemoryStore | ReadStore, header: dict[str, Any], system: System | None) -> None:
        self._store, self._header, self._made_by = store, header, system
        self._recorded: Sensors | None = None
        self._moving: tuple[FloatArray, FloatArray] | None = None
        self.derivatives: Mapping[str, Any] = {}  # by the name of a parameter
        if system is not None:
            self.model, self._slots, self._joints = system.model, system.slots, system.joints
            self._last = remembered.of_system(system)
        else:
            assert isinstance(store, ReadStore)
            self.model = store.model()
            self._slots, self._joints, self._last = store.layout(self.model)
        self._bodies, self._springs = self.model.bodies, springs_of(self.model.connections)
        self._lengths = lengths_of(self.model, self._joints)
        slides = (item.name for item in self.model.connections if isinstance(item, Slide))
        self._arcs = {name: int(self._joints[name][-1]) for name in slides}

    def __getstate__(self) -> dict[str, Any]:
        """All but what is made again when it is asked for; of a file its place, not its content."""
        return {**self.__dict__, "_recorded": None, "_moving": None, "_system": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        del state["_system"]
        self.__dict__.update(state)
        if self._made_by is not None:
            remembered.restore(self._made_by, self._last)

    @cached_property
    def _system(self) -> System:
        """The system that made the result, or the one of the model that was loaded.

        Raises
        ------
        ModelError
            This version numbers the unknowns otherwise than the one that wrote the file.
        """
        if self._made_by is not None:
            return self._made_by
        try:
            system = independent(self.model)
        except ModelError:  # functions of time that a file does not keep
            system = System(self.model)
        mine, theirs = {**system.slots, **system.joints}, {**self._slots, **self._joints}
        same = mine.keys() == theirs.keys() and all(np.array_equal(mine[k], theirs[k]) for k in mine)
        if not same or system.size != self.q.shape[1]:
            made = self._header.get("versions", {}).get("ancf", "another version")
            what = f"its unknowns stand in the order of ancf {made}, which this version does not know"
            raise ModelError("Result", what, "simulate it again")
        remembered.restore(system, self._last)
        return system

    def __repr__(self) -> str:
        return line_of_result(self)

    def _sheet(self) -> Sheet:
        return of_result(self)

    @property
    def system(self) -> System:
        """The compiled model.

        Raises
        ------
        ModelError
            This version numbers the unknowns otherwise than the one that wrote the file.
        """
        return self._system

    def _contact_system(self) -> System:
        return self._system

    @property
    def t(self) -> FloatArray:
        """Stored times, s, shape (n_t,)."""
        t: FloatArray = self._store.arrays["time"]
        return t

    @property
    def q(self) -> Any:
        """State vectors, shape (n_t, size)."""
        return self._store.arrays["q"]

    @property
    def v(self) -> Any:
        """Rates of the state vectors, shape (n_t, size)."""
        return self._store.arrays["v"]

    @property
    def sensors(self) -> Sensors:
        """What was recorded at every step.

        Raises
        ------
        ModelError
            The simulation was given no sensors.
        """
        if self._recorded is None:
            listing = self._store.listing(self._bodies)
            if not listing:
                hint = 'give simulate(..., sensors=["wire.at(3)", spring])'
                raise ModelError("Result.sensors", "the simulation had no sensors", hint)
            self._recorded = Sensors(listing, lambda: self._store.samples, self)
            if missing := self._recorded.missing():
                raise ModelError(
                    str(getattr(self._store, "path", "sensors")), f"is damaged: sensors lack {missing}"
                )
        return self._recorded

    def _in_motion(self) -> tuple[FloatArray, FloatArray]:
        """Accelerations and forces out of balance of all stored states, shapes (n_t, size), kept."""
        if self._moving is None or len(self._moving[0]) != len(self.t):
            known = [self._known(k) for k in range(len(self.t))]
            self._moving = motions.of_history(self._system, self.q, self.v, self.t, known)
        return self._moving

    def _each_state(self) -> Iterator[Any]:
        q, v = self.q[...], self.v[...]
        return ((q[k], v[k], float(t), self._known(k)) for k, t in enumerate(self.t))

    def _turned_to(self, spring: Any) -> float | None:
        return self._remembered_turn(spring, self._last.memory)

    def _known(self, index: int) -> Remembered:
        known = self._last.until(index, self.q, self.v, self._arcs)
        given = self._kept() if self.model.inputs and not known.inputs else None
        if given is None:
            return known
        acting = given.acting(self.t[[index]])[0]
        return (
            known
            if np.isnan(acting).any()
            else replace(known, inputs=dict(zip(given.names, acting.tolist(), strict=True)))
        )

    def _led(self) -> bool:
        return self._store.given is not None and bool(self.model.inputs)

    def _kept(self) -> Given | None:
        return history_of(self._store, self.model, self._last, "controller" in self._header["settings"])

    @property
    def energy(self) -> Energy:
        """Energies at the stored times, J.

        Raises
        ------
        ModelError
            The simulation did not account for them; a state has its own, ``result.state(k).energy``.
        """
        if not self._header["settings"].get("energy", True):
            raise ModelError(
                "Result.energy", "was not accounted for", "leave out simulate(..., energy=False)"
            )
        arrays = self._store.arrays
        energy, work = arrays["energy"][:], arrays["work"][:]
        return Energy(energy[:, 0], energy[:, 1], energy[:, 2], work[:, 0], work[:, 1])

    def _end_energies(self) -> tuple[FloatArray, FloatArray]:
        """Energies and work at the first and the last stored time, J, shapes (2, 3) and (2, 2).

        The columns are kinetic, strain, potential, and dissipated, supplied; a long history is not read.
        """
        arrays, ends = self._store.arrays, (0, -1)
        work = np.stack([np.asarray(arrays["work"][k]) for k in ends])
        if isinstance(self._store, ReadStore):
            return np.stack([np.asarray(arrays["energy"][k]) for k in ends]), work
        q, v = (np.stack([data[k] for k in ends]) for data in (arrays["q"], arrays["v"]))
        return energies(self._system, q, v), work

    @property
    def notes(self) -> list[str]:
        """What to know of the run that nobody asked for, one line each: motions that jump or are noisy,
        numbers that look like those of other units, cables that were pressed, and when, bodies that were
        stretched by more than a tenth, cables that bent too sharply for their elements, had forces that waver
        within these or bends that turned, bodies below a ground, beams that may have gone through what they
        touch, energy that came from nowhere, steps that are long for what vibrates, joints of which others
        hold a part.

        All stored states are looked at, when it is asked for.
        """
        return noticed.of_result(self, [str(text) for text in self._header.get("notes", [])])

    @property
    def stats(self) -> Stats:
        """Counters of the run."""
        return self._store.stats

    @property
    def status(self) -> str:
        """How it ended: "complete", "failed", "interrupted"; "running" if it goes on or was killed."""
        return self._store.status

    @property
    def provenance(self) -> dict[str, Any]:
        """Model, settings and versions that made the result."""
        return self._header

    def state(self, index: int = -1) -> State:
        """State at a stored time, from which a simulation can go on.

        Raises
        ------
        ModelError
            The index is no whole number, or none of ``result.t``.
        """
        index = checks.integer(index, "state.index", -len(self.t), len(self.t) - 1)
        q, v = np.array(self.q[index]), np.array(self.v[index])  # copies: a state outlives its history
        known = self._known(range(len(self.t))[index])
        made = State(self._system, float(self.t[index]), q, v, self.stats, known)
        made.derivatives = {name: item.state(index) for name, item in self.derivatives.items()}
        return made

    def compare(self, other: Result, points: Sequence[Any] | None = None) -> Comparison:
        """Largest differences of positions from another result, at the times that both have stored.

        Parameters
        ----------
        other : Result
            Of the same bodies, on another mesh, with another step, method or parameter.
        points : sequence of points or names, optional
            Default start, middle and end of beams and cables, masses and centres of bodies.

        Returns
        -------
        Comparison
            Prints as a table; ``.largest`` has ``point``, ``distance`` in m and ``t`` in s.

        Raises
        ------
        ModelError
            A body or point is missing in one of them, or they have no time in common.
        """
        return compare(self, other, points)

    def slack_intervals(self, of: Any = None, below: float = 0.0) -> list[SlackInterval]:
        """When and where cables are slack, and springs that only pull, ordered by their starts.

        A cable is slack while the smallest tension of its elements is not above a limit.

        Parameters
        ----------
        of : cable, spring, name or a sequence of them, optional
            Default all cables and all springs with ``slack=True``.
        below : float, N
            The limit, >= 0, such as a tenth of the tension at rest.

        Returns
        -------
        list of SlackInterval
            Each with ``name``, ``start`` and ``end`` in s, the smallest ``tension`` in N, its time ``t`` and
            ``point``. They are as fine as the stored times, see ``output_step``.

        Raises
        ------
        ModelError
            There is no such cable or spring, or the limit is negative.
        """
        return slack_intervals(self, of, below)

    def sensitivity(self, name: str) -> Any:
        """Derivatives by a parameter of everything that the result answers, per unit of it.

        Parameters
        ----------
        name : str
            One of ``simulate(..., sensitivities=[...])``.

        Returns
        -------
        Sensitivity
            ``result.sensitivity("beam.EI").position(beam.end)``, (n_t, 3) in m per N m^2, and so on.

        Raises
        ------
        ModelError
            It was not asked for.
        """
        return sensitivity_of(self.derivatives, name)

    def derived(self) -> dict[str, dict[str, Any]]:
        """Data sets of derivatives by parameter, of a result that was read from a file."""
        return self._store.derived if isinstance(self._store, ReadStore) else {}

    def save(self, path: str | Path) -> None:
        """Write the result to an HDF5 file; :func:`ancf.load` reads it.

        Raises
        ------
        ModelError
            It cannot be written.
        """
        if isinstance(self._store, ReadStore):
            _copy(self._store.path, path)
            return
        file = FileStore(path, self._system, self._header, self._store.given)
        try:
            self._fill(file)
        except StorageError as error:
            raise ModelError(error.where, error.what, "make room, or choose another place") from None

    def _fill(self, file: FileStore) -> None:
        arrays = self._store.arrays
        if self._system.sensors:
            samples = self._store.samples
            parts = [samples[name] for name in ("q", "v", "measured")]
            file.record(samples["time"], np.concatenate(parts, axis=1))
        file.append(arrays["time"], arrays["q"], arrays["v"], arrays["work"])
        assert isinstance(self._store, MemoryStore)
        for k, name in enumerate(self._header["settings"].get("sensitivities", [])):
            if (own := self.derivatives.get(name)) is None:
                continue  # the run failed
            rows = self.sensors.derivatives[name].rows if self._system.sensors else np.zeros((0, 0))
            file.derive(k, (own.dq, own.dv, rows))
        if self._store.checkpoint is not None:
            file.put(self._store.checkpoint)
        file.update(self.stats, self.status)
        file.close()


def load(path: str | Path, system: System | None = None) -> Result:
    """Result from a file that a simulation or :meth:`Result.save` wrote.

    Parameters
    ----------
    path : path
        Of the file, or of the folder of a run, which holds ``results.h5``.
    system : System, optional
        The system that made it, if it is still there; else the file's model makes one when it is needed.

    It answers what the result in memory answered and has its model; a question that needs the value of a
    Python function, which no file can keep, is a ModelError.

    Raises
    ------
    ModelError
        There is no such file, or it is not a results file.
    """
    return read(ReadStore(path), None if system is None else checks.kind(system, "load.system", System))


def read(store: ReadStore, system: System | None = None) -> Result:
    """Result from a file that has been opened."""
    return Result(store, store.header, system)


def _copy(source: Path, path: str | Path) -> None:
    if not isinstance(path, str | Path):
        raise ModelError("save", f"must be given a path, is given {checks.shown(path)}")
    with writing(path):
        if Path(path).resolve() != source.resolve():
            shutil.copyfile(source, path)
