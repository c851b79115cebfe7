"""Where the stored states of a run are kept: in memory, or in an HDF5 file that is read while it grows.

The file is written in HDF5's single-writer-multiple-reader mode and flushed after every block of steps,
so that a run that is killed leaves a file which is readable up to its last block.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Protocol

import h5py
import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError, StorageError
from ..files import problem, writing
from ..model import checks
from ..model.bodies.rigid import Body
from ..solvers.checkpoint import Snapshot
from ..solvers.record import Stats
from ..solvers.status import COUNTS
from ..system.energy import energies
from ..system.sensors import Listing
from ..system.system import System
from . import checkpoints, derivatives, given, hdf5, remembered
from .checkpoints import Checkpoint
from .given import Given
from .layout import write_layout
from .layout_sensors import DATA, write_listing

#: Room that the head of a file needs besides what the model says, bytes; it is tried first, because HDF5 may
#: end the process where not even that can be written.
LEAST = 2**16
FORMAT = "ancf results"
VERSION = 1
STATUS = ("running", "complete", "failed", "interrupted")
CHUNK_BYTES = 256 * 1024


class Store(Protocol):
    """States and counters of a run; arrays have one row per stored time."""

    @property
    def arrays(self) -> dict[str, Any]:
        """The arrays ``time q v work energy`` (energy: kinetic, strain, potential)."""
        ...

    @property
    def samples(self) -> dict[str, Any]:
        """What sensors took: the arrays ``time q v measured``, one row per step."""
        ...

    def listing(self, bodies: dict[str, Body]) -> Listing:
        """What the sensors recorded."""
        ...

    @property
    def given(self) -> Given | None:
        """What the inputs were; None: nobody led the run."""
        ...

    @property
    def stats(self) -> Stats:
        """Counters."""
        ...

    @property
    def status(self) -> str:
        """One of STATUS."""
        ...


class MemoryStore:
    """States of a run in memory."""

    def __init__(self, system: System, given: Given | None = None) -> None:
        self._system, self.given = system, given
        self._parts: list[tuple[FloatArray, ...]] = []
        self._joined: dict[str, FloatArray] = {}
        self._samples: list[tuple[FloatArray, FloatArray]] = []
        self.stats, self.status = Stats(), "running"
        self.checkpoint: Checkpoint | None = None

    def append(self, t: FloatArray, q: FloatArray, v: FloatArray, work: FloatArray) -> None:
        """Add states; see :class:`ancf.solvers.record.Recorder`."""
        self._parts.append((t, q, v, work))
        self._joined = {}

    def due(self) -> bool:
        """Never: what is in memory is lost with the process."""
        return False

    def keep(self, snapshot: Snapshot) -> None:
        """Take a snapshot from which a run can go on when the result has been saved."""
        self.checkpoint = Checkpoint(snapshot, sum(len(part[0]) for part in self._parts), self.recorded)

    def forget(self) -> None:
        """Let go of the states; samples stay."""
        self._parts, self._joined = [], {}

    def record(self, t: FloatArray, samples: FloatArray) -> None:
        """Add samples."""
        self._samples.append((t, samples))

    @property
    def recorded(self) -> int:
        """How many rows of samples there are."""
        return sum(len(t) for t, _ in self._samples)

    def unrecord(self, rows: int) -> None:
        """Let go of the samples behind so many rows."""
        while self._samples and self.recorded > rows:
            t, samples = self._samples.pop()
            if (left := rows - self.recorded) > 0:
                self._samples.append((t[:left].copy(), samples[:left].copy()))

    @property
    def samples(self) -> dict[str, FloatArray]:
        """See :class:`Store`."""
        if len(self._samples) > 1:
            t, samples = (np.concatenate(column) for column in zip(*self._samples, strict=True))
            self._samples = [(t, samples)]
        [(t, samples)] = self._samples
        return {"time": t, **_split(samples, self._system.sensors)}

    def listing(self, bodies: dict[str, Body]) -> Listing:
        """See :class:`Store`."""
        return self._system.sensors

    def update(self, stats: Stats, status: str) -> None:
        """Counters and status so far."""
        self.stats, self.status = stats, status

    @property
    def arrays(self) -> dict[str, FloatArray]:
        """See :class:`Store`."""
        if not self._joined:
            columns = [np.concatenate(column) for column in zip(*self._parts, strict=True)]
            self._joined = dict(zip(("time", "q", "v", "work"), columns, strict=True))
            self._parts = [tuple(columns)]
        if "energy" not in self._joined:
            self._joined["energy"] = LazyEnergy(self._system, self._joined)  # type: ignore[assignment]
        return self._joined


class LazyEnergy:
    """Energies of states in memory, computed when they are asked for."""

    def __init__(self, system: System, arrays: dict[str, FloatArray]) -> None:
        self._system, self._arrays = system, arrays
        self._values: FloatArray | None = None

    def __getitem__(self, key: Any) -> FloatArray:
        if self._values is None:
            self._values = energies(self._system, self._arrays["q"], self._arrays["v"])
        part: FloatArray = self._values[key]
        return part


class FileStore:
    """States of a run in an HDF5 file, written block by block.

    Parameters
    ----------
    path : path
    system : System
    header : dict
        What made the result.
    inputs : Given, optional
        What they are, which grows with the run.

    Raises
    ------
    ModelError
        The file cannot be written.
    StorageError
        Later, from any method: it can no longer be written; what has been stored can be read.
    """

    def __init__(
        self, path: str | Path, system: System, header: dict[str, Any], inputs: Given | None = None
    ) -> None:
        self._system, self._given, self._noted = system, inputs, 0
        if not isinstance(path, str | Path):
            raise ModelError("file", f"must be a path, is {checks.shown(path)}")
        self.path = Path(path)
        with writing(path):
            self.path.unlink(missing_ok=True)  # a result that still reads the old file keeps it
            self.path.write_bytes(bytes(LEAST + 2 * len(json.dumps(header)) + 32 * system.size))
            self._file = h5py.File(self.path, "w", libver="latest")
            try:
                self._create(header)
                self._file.swmr_mode = True
            except (OSError, RuntimeError) as error:
                hdf5.abandon(self._file)
                raise OSError(problem(error) or str(error)) from None
        self._opened: dict[str, Any] = {}
        self._places = checkpoints.Places(self._file)
        self.stats, self.status = Stats(), "running"

    @classmethod
    def reopened(cls, path: Path, system: System, inputs: Given | None = None) -> FileStore:
        """A finished file of the same system, to add to it; it holds what its inputs were."""
        store = cls.__new__(cls)
        store.path, store._system, store._given = path, system, inputs
        store._noted = 0 if inputs is None else inputs.count
        store.stats, store.status, store._opened = Stats(), "running", {}
        with writing(path):
            store._file = h5py.File(path, "r+", libver="latest")
            store._file.swmr_mode = True
        store._places = checkpoints.Places(store._file)
        return store

    def _create(self, header: dict[str, Any]) -> None:
        file, size = self._file, self._system.size
        file.attrs["format"], file.attrs["format_version"] = FORMAT, VERSION
        file.attrs["header"] = json.dumps(header)
        for name, width in (("time", 0), ("q", size), ("v", size), ("work", 2), ("energy", 3)):
            tail = (width,) if width else ()
            rows = max(1, min(1024, CHUNK_BYTES // (8 * max(width, 1))))
            file.create_dataset(name, (0, *tail), "f8", maxshape=(None, *tail), chunks=(rows, *tail))
        file.create_dataset("stats", data=np.zeros(len(COUNTS) + 1))
        file.create_dataset("status", data=0)
        write_layout(file, self._system)
        remembered.create(file, remembered.of_system(self._system))
        write_listing(file, self._system.sensors)
        given.create(file, self._given)
        derivatives.create(file, header["settings"].get("sensitivities", []), size, self._system.sensors)
        checkpoints.Places.make(file)
        file.flush()

    def append(self, t: FloatArray, q: FloatArray, v: FloatArray, work: FloatArray) -> None:
        """Add states; see :class:`ancf.solvers.record.Recorder`."""
        if len(t) == 0:
            return
        self.copy(t, q, v, work, energies(self._system, q, v))

    def copy(self, t: FloatArray, q: FloatArray, v: FloatArray, work: FloatArray, energy: FloatArray) -> None:
        """Add states whose energies, shape (m, 3), are known."""
        columns = {"q": q, "v": v, "work": work, "energy": energy, "time": t}
        with self._storing():
            self._note()
            for name, values in columns.items():
                _extend(self._data(name), values)

    def record(self, t: FloatArray, samples: FloatArray) -> None:
        """Add samples."""
        columns = _split(samples, self._system.sensors) | {"time": t}
        with self._storing():
            self._note()
            for name in DATA:
                _extend(self._data(f"sensors/{name}"), columns[name])

    def _note(self) -> None:
        """Write what inputs were given since; before the times of what came about under them."""
        if self._given is not None and self._given.names and self._noted < self._given.count:
            _extend(self._data(given.DATA), self._given.since(self._noted))
            self._noted = self._given.count

    def derive(self, k: int, rows: Sequence[FloatArray]) -> None:
        """Add derivatives by parameter k of states, of their rates and of samples."""
        with self._storing():
            derivatives.add(self._file, k, rows)

    def update(self, stats: Stats, status: str) -> None:
        """Counters and status so far; everything until now reaches the disk."""
        self.stats, self.status = stats, status
        with self._storing():
            self._note()
            self._data("stats")[:] = [getattr(stats, name) for name in COUNTS] + [stats.cpu_seconds]
            self._data("status")[()] = STATUS.index(status)
            remembered.write(self._file, self._data, remembered.of_system(self._system))
            self._file.flush()

    def due(self) -> bool:
        """Whether it is time for another checkpoint."""
        return self._places.due()

    def keep(self, snapshot: Snapshot) -> None:
        """Write a checkpoint, see :mod:`ancf.results.checkpoints`."""
        samples = self._data("sensors/time").shape[0] if self._system.sensors else 0
        self.put(Checkpoint(snapshot, self._data("time").shape[0], samples))

    def put(self, checkpoint: Checkpoint) -> None:
        """Write a checkpoint of which is known what goes with it."""
        with self._storing():
            self._places.keep(checkpoint)

    def close(self) -> None:
        """Close the file; the states are read from it from now on."""
        with self._storing():
            self._file.close()

    def _data(self, name: str) -> Any:
        """A data set; HDF5 looks for one as long as it takes to write a block to it."""
        if name not in self._opened:
            self._opened[name] = self._file[name]
        return self._opened[name]

    @contextmanager
    def _storing(self) -> Iterator[None]:
        if not self._file:
            raise StorageError(str(self.path), "cannot be written any more")
        try:
            yield
        except (OSError, RuntimeError) as error:
            hdf5.abandon(self._file)
            said = problem(error) or str(error).split("\n", 1)[0]
            hint = "make room or store less often (output_step)"
            raise StorageError(str(self.path), f"cannot be written any more: {said}", hint) from error


def _extend(data: Any, values: FloatArray) -> None:
    """Add rows to a data set."""
    first = data.shape[0]
    data.resize(first + len(values), axis=0)
    data[first:] = values
    data.flush()


def _split(samples: FloatArray, listing: Listing) -> dict[str, FloatArray]:
    """Rows of samples as entries of q, of v, and what was measured."""
    k = len(listing.index)
    return {"q": samples[:, :k], "v": samples[:, k : 2 * k], "measured": samples[:, 2 * k :]}
