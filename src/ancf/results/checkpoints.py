"""Snapshots of a run as bytes, and their two places in a results file.

The places are written in turn, so that one of them is whole when the process is killed while the other is
written; a checksum tells which.  A place is a row of bytes: a line of JSON with what it holds, then the
numbers of the arrays one after the other.
"""

from __future__ import annotations

import json
import time
import zlib
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..model import checks
from ..solvers.checkpoint import Snapshot

GROUP, PLACES = "checkpoints", 2
VERSION = 1
#: Bytes of a chunk, and of the head of a place: length and checksum of what follows.
CHUNK, HEAD = 2**16, 16
#: Kinds of numbers.
KINDS = {"float64": "<f8", "int64": "<i8", "int32": "<i4", "bool": "?"}
#: Time between two checkpoints, s, and at least so many times what the last one took.
APART, SHARE = 5.0, 100.0


@dataclass(frozen=True)
class Checkpoint:
    """A snapshot, and how much of a results file goes with it.

    Parameters
    ----------
    snapshot : Snapshot
    rows, samples : int
        Stored states and rows of samples until then.
    number : int
        How many there were before.
    """

    snapshot: Snapshot
    rows: int
    samples: int
    number: int = 0


def to_bytes(checkpoint: Checkpoint) -> bytes:
    """A checkpoint as bytes."""
    snapshot = checkpoint.snapshot
    listed = [(place, array.dtype.name, array.shape) for place, array in snapshot.arrays.items()]
    head = {
        "version": VERSION,
        "t": snapshot.t,
        "values": snapshot.values,
        "arrays": listed,
        "rows": checkpoint.rows,
        "samples": checkpoint.samples,
        "number": checkpoint.number,
    }
    parts = [json.dumps(head).encode() + b"\n"]
    parts += [np.ascontiguousarray(array).tobytes() for array in snapshot.arrays.values()]
    body = b"".join(parts)
    return len(body).to_bytes(8, "little") + zlib.crc32(body).to_bytes(8, "little") + body


def from_bytes(data: bytes) -> Checkpoint | None:
    """The checkpoint, or None where the bytes are not all of one."""
    length = int.from_bytes(data[:8], "little")
    body = data[HEAD : HEAD + length]
    if length == 0 or len(body) < length or zlib.crc32(body) != int.from_bytes(data[8:HEAD], "little"):
        return None
    line, _, numbers = body.partition(b"\n")
    head = json.loads(line)
    if head["version"] != VERSION:
        return None
    arrays, at = {}, 0
    for place, kind, shape in head["arrays"]:
        dtype = np.dtype(KINDS[kind])
        count = int(np.prod(shape, dtype=np.int64))
        arrays[place] = np.frombuffer(numbers, dtype, count, at).reshape(shape)
        at += count * dtype.itemsize
    snapshot = Snapshot(checks.number(head["t"], "t"), head["values"], arrays)
    return Checkpoint(snapshot, head["rows"], head["samples"], head["number"])


class Places:
    """The places for checkpoints in a file that is being written.

    Parameters
    ----------
    file : h5py.File
    """

    def __init__(self, file: Any) -> None:
        self._file, self._number = file, 0
        self._next = 0.0

    @staticmethod
    def make(file: Any) -> None:
        """Make them, empty; a file that is read while it grows takes no new data sets."""
        for k in range(PLACES):
            file.create_dataset(f"{GROUP}/{k}", (0,), "u1", maxshape=(None,), chunks=(CHUNK,))

    def due(self) -> bool:
        """Whether enough time has passed since the last one."""
        return time.perf_counter() >= self._next

    def keep(self, checkpoint: Checkpoint) -> None:
        """Write a checkpoint to the place of the older one."""
        before = time.perf_counter()
        self._number += 1
        data = to_bytes(replace(checkpoint, number=self._number))
        place = self._file[f"{GROUP}/{self._number % PLACES}"]
        if place.shape[0] < len(data):
            place.resize(len(data), axis=0)
        place[: len(data)] = np.frombuffer(data, np.uint8)
        place.flush()
        now = time.perf_counter()
        self._next = now + max(APART, SHARE * (now - before))


def latest(file: Any, rows: int, samples: int) -> Checkpoint | None:
    """The last whole checkpoint of a file whose rows are there; None for none."""
    found = []
    for k in range(PLACES):
        name = f"{GROUP}/{k}"
        if name in file:
            place = file[name]
            place.refresh()
            found.append(from_bytes(place[:].tobytes()))
    whole = [c for c in found if c is not None and c.rows <= rows and c.samples <= samples]
    return max(whole, key=lambda c: c.number, default=None)
