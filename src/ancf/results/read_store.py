"""A results file opened for reading, finished or not."""

from __future__ import annotations

import json
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import ModelError
from ..files import results_at
from ..model import checks
from ..model.bodies.rigid import Body
from ..model.model import Model
from ..solvers.record import Stats
from ..system.sensors import Listing
from . import checkpoints, derivatives, given, hdf5, remembered, sound
from .checkpoints import Checkpoint
from .layout import read_joints, read_slots
from .layout_sensors import DATA, read_listing
from .remembered import Remembered
from .store import FORMAT, STATUS, VERSION


class ReadStore:
    """A results file opened for reading; also one whose run was killed.

    Parameters
    ----------
    path : path
        Of the file, or of a folder that holds ``results.h5``.
    status : str, optional
        How the run ended, where its file could not take it any more.

    Raises
    ------
    ModelError
        It is not there, not a results file, or damaged.
    """

    def __init__(self, path: str | Path, status: str | None = None) -> None:
        if not isinstance(path, str | Path):
            raise ModelError("load", f"must be given a path, is given {checks.shown(path)}")
        self.path, self._status = results_at(Path(path)), status
        self._file = hdf5.opened(self.path)
        with sound.inside(self.path):
            self._begin()

    def __reduce__(self) -> Any:
        """A result of a file is that file: another process opens it again."""
        return ReadStore, (self.path.resolve(), self._status)

    def _begin(self) -> None:
        if self._file.attrs.get("format") != FORMAT:
            raise ModelError(str(self.path), "is not a results file of ancf")
        if (version := self._file.attrs.get("format_version")) != VERSION:
            what = f"is a results file of version {version}, this ancf reads version {VERSION}"
            raise ModelError(str(self.path), what)
        self.header: dict[str, Any] = json.loads(self._file.attrs["header"])
        sound.check_header(self.header)
        # an earlier load of a run that goes on has seen less of it
        self._rows = self._refreshed(self._file, ("time", "q", "v", "work", "energy"))
        self._sensors = self._file.get("sensors")
        self._samples = self._refreshed(self._sensors, DATA[::-1]) if self._sensors else 0
        widths = [self._file[name].shape[1] for name in ("q", "v", "work", "energy")]
        if (
            widths[0] != widths[1]
            or widths[2:] != [2, 3]
            or not 0 <= int(self._file["status"][()]) < len(STATUS)
        ):
            raise ValueError("its data sets do not belong together")
        sound.check_times(self._file["time"][: self._rows], "time")
        self.given = given.read(self._file)
        self.derived = derivatives.read(self._file, widths[0], self._rows)
        checks.array(list(self.stats.as_dict().values()), "stats", (None,))

    @staticmethod
    def _refreshed(group: Any, names: tuple[str, ...]) -> int:
        """Rows that all data sets of a group have; the time, which is written last, comes first."""
        rows = 0
        for k, name in enumerate(names):
            data = group[name]
            data.refresh()
            rows = rows if k else data.shape[0]
            if data.dtype != np.float64 or data.ndim != (2 if k else 1) or data.shape[0] < rows:
                raise ValueError(f'the data set "{name}" is not as it should be')
        return rows

    @property
    def arrays(self) -> dict[str, Any]:
        """See :class:`Store`; time is written last, so that every row of it is complete.

        Of a file that grows HDF5 reads right what it has just opened alone.
        """
        whole = {name: self._file[name] for name in ("q", "v", "work", "energy")}
        return {"time": self._times, **{k: Rows(d, self._rows) for k, d in whole.items()}}

    @cached_property
    def _times(self) -> FloatArray:
        return Rows(self._file["time"], self._rows)[:]

    @property
    def samples(self) -> dict[str, Any]:
        """See :class:`Store`."""
        rows = self._samples
        whole = {name: Rows(self._sensors[name], rows) for name in DATA[:-1]}
        return {"time": Rows(self._sensors["time"], rows)[:], **whole}

    def listing(self, bodies: dict[str, Body]) -> Listing:
        """See :class:`Store`."""
        if not self._sensors:
            return Listing()
        with sound.inside(self.path):
            found = read_listing(self._sensors, bodies)
            widths = {name: int(self._sensors[name].shape[1]) for name in DATA[:-1]}
            sound.check_listing(found, self.width, widths)
            sound.check_times(self._sensors["time"][: self._samples], "sensors/time")
            return found

    def model(self) -> Model:
        """The model that was computed; Python functions are missing.

        Raises
        ------
        ModelError
            The file describes none.
        """
        try:
            return Model.from_dict(self.header["model"])
        except ModelError as error:
            what = f"describes no model: {error.where}: {error.what}"
            raise ModelError(str(self.path), what, error.hint) from None
        except hdf5.DAMAGED as error:
            raise hdf5.damaged(self.path, error) from None

    def layout(self, model: Model) -> tuple[dict[str, IntArray], dict[str, IntArray], Remembered]:
        """Slots by body, unknowns by joint, and what goes with the last state.

        Raises
        ------
        ModelError
            They do not belong to the states.
        """
        with sound.inside(self.path):
            slots, joints = read_slots(self._file, model.bodies), read_joints(self._file)
            sound.check_unknowns(model, slots, joints, self.width)
            return slots, joints, remembered.read(self._file, model)

    def checkpoint(self) -> Checkpoint | None:
        """What a run can go on from to the last bit; None where there is none.

        Raises
        ------
        ModelError
            It is damaged in a way that its checksum does not show.
        """
        with sound.inside(self.path):
            return checkpoints.latest(self._file, self._rows, self._samples)

    @property
    def width(self) -> int:
        """Size of the state vectors."""
        return int(self._file["q"].shape[1])

    @property
    def stats(self) -> Stats:
        """Counters."""
        *counts, seconds = self._file["stats"][:].tolist()
        return Stats.of(counts, seconds)

    @property
    def status(self) -> str:
        """One of STATUS; "running" also for a run that was killed."""
        return self._status or STATUS[int(self._file["status"][()])]


class Rows:
    """The first rows of a data set, which are read when they are asked for; NumPy takes them as an array."""

    def __init__(self, data: Any, rows: int) -> None:
        self._data, self.shape = data, (rows, *data.shape[1:])

    def __len__(self) -> int:
        return int(self.shape[0])

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> FloatArray:
        return np.asarray(self[:], dtype=dtype)

    def __getitem__(self, key: Any) -> FloatArray:
        first, *rest = key if isinstance(key, tuple) else (key,)
        if first is Ellipsis:
            first = slice(None)
        if isinstance(first, slice):
            start, stop, stride = first.indices(self.shape[0])
            first = slice(start, stop, stride)
        elif not -len(self) <= first < len(self):
            raise IndexError(f"state {first} is asked for, and there are {len(self)}")
        elif first < 0:
            first += len(self)
        try:
            if rest and isinstance(rest[-1], np.ndarray):  # HDF5 reads columns in ascending order alone
                columns, order = np.unique(rest[-1], return_inverse=True)
                return np.asarray(self._data[(first, *rest[:-1], columns)])[..., order]
            return np.asarray(self._data[(first, *rest)])
        except (OSError, RuntimeError) as error:
            raise hdf5.damaged(self._data.file.filename, error) from None
