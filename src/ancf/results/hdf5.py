"""HDF5 files that may be cut off, half written or not ours: opened without waiting for ever, or refused.

A file whose writer was killed is marked as being written, and HDF5 opens it as one that grows: it then reads
a piece of metadata whose checksum is wrong again and again, with pauses that double, which never ends when
the piece is damaged. So a marked file is first read whole as if it had no mark, where a wrong checksum is an
error at once. Reference: HDF5 File Format Specification, version 3.0, section II.A (superblock).
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py

from ..errors import ModelError
from ..files import no_results, problem

SIGNATURE = b"\x89HDF\r\n\x1a\n"
#: Bytes of the superblock: its version, the marks of a writer, the length of the file, all of it.
VERSION, MARKS, END, HEAD = 8, 11, slice(28, 36), 48
#: Groups in groups: bodies/NAME/slots.
DEEPEST = 2
#: Pauses before another look at a file that a run may be writing just now, s.
PAUSES = (0.05, 0.1, 0.2, 0.4)
#: How long a file that grows is looked at anew at once, s.
LIVELY = 20.0
#: More bytes than any file has.
EVERYTHING = 1 << 60
#: What HDF5 and h5py raise about a damaged file.
DAMAGED = (
    OSError,
    RuntimeError,
    LookupError,
    ValueError,
    TypeError,
    AttributeError,
    ArithmeticError,
    AssertionError,
)


def opened(path: Path) -> Any:
    """Open a file for reading; also one that a run is writing, or was when it was killed.

    Raises
    ------
    ModelError
        There is no such file, it is no HDF5, cut off, damaged, or keeps its data in another file.
    """
    head, size = _head(path)
    if head[:VERSION] != SIGNATURE or len(head) < HEAD or head[VERSION] not in (2, 3):
        raise ModelError(str(path), "is not a results file of ancf: no HDF5 that it writes")
    if head[VERSION] == 3 and head[MARKS]:
        return _growing(path)
    end = int.from_bytes(head[END], "little")
    if size < end:
        raise ModelError(str(path), f"is cut off: {size} of {end} bytes are there", "copy it again")
    try:
        file = h5py.File(path, "r", libver="latest")
        _look_over(path, file)
    except DAMAGED as error:
        raise damaged(path, error) from None
    return file


def damaged(path: Path | str, error: Exception) -> ModelError:
    """One message for what HDF5 says about a file."""
    if isinstance(error, ModelError):
        return error
    said = problem(error) or str(error).split("\n", 1)[0]
    return ModelError(str(path), f"is not a results file of ancf, or damaged: {said}")


def abandon(file: Any) -> None:
    """Close a file that can no longer be written; what has reached the disk stays.

    HDF5 would try to write what it still has, fail, and crash when the program ends; so it writes to nowhere.
    """
    nowhere = os.open(os.devnull, os.O_RDWR)
    try:
        os.dup2(nowhere, file.id.get_vfd_handle())
        file.close()
    except (*DAMAGED, AssertionError):
        pass
    finally:
        os.close(nowhere)


def _head(path: Path) -> tuple[bytes, int]:
    """First bytes and size of a file."""
    try:
        if path.is_dir():
            raise no_results(path)
        if not path.is_file():
            raise ModelError(str(path), "there is no such file")
        with path.open("rb") as file:
            return file.read(HEAD), os.fstat(file.fileno()).st_size
    except (OSError, ValueError) as error:
        if isinstance(error, ModelError):
            raise
        raise ModelError(str(path), f"cannot be read: {problem(error) or error}") from None


def _growing(path: Path) -> Any:
    """Open a file that is marked as being written, after all of it could be read once."""
    begun, pauses = time.monotonic(), iter(PAUSES)
    while True:
        size = _head(path)[1]
        try:
            with Unmarked(path) as plain, h5py.File(plain, "r") as file:
                _look_over(path, file, whole=True)
            return h5py.File(path, "r", libver="latest", swmr=True)
        except ModelError:
            raise
        except DAMAGED as error:
            if _head(path)[1] > size and time.monotonic() < begun + LIVELY:
                continue  # read while a run wrote it
            pause = next(pauses, None)
            if pause is None:
                raise damaged(path, error) from None
            time.sleep(pause)


def _look_over(path: Path, file: Any, whole: bool = False) -> None:
    """Refuse data that are kept elsewhere; of the whole file read all metadata, see that data are there."""
    for name, item in _items(path, h5py.h5g.open(file.id, b"/")):
        if isinstance(item, h5py.h5d.DatasetID):
            plan = item.get_create_plist()
            if plan.get_external_count() or plan.get_layout() == h5py.h5d.VIRTUAL:
                raise ModelError(str(path), f'is refused: "{name}" keeps its data in another file')
            if whole:
                _inside(item, plan.get_layout(), path)
        if whole:
            _read_attributes(item)


def _items(path: Path, group: Any, prefix: str = "", depth: int = 0) -> Iterator[tuple[str, Any]]:
    """All groups and data sets with their names; HDF5's own visit may crash when one is damaged.

    Raises
    ------
    ModelError
        There is a link to another place or file, or groups lie deeper than a results file has them.
    """
    yield prefix or "/", group
    if depth > DEEPEST:
        raise ModelError(str(path), f'is refused: "{prefix}" lies deeper than anything that ancf writes')
    for key in list(group):
        name = f"{prefix}/{key.decode(errors='replace')}".lstrip("/")
        if group.links.get_info(key).type != h5py.h5l.TYPE_HARD:
            raise ModelError(str(path), f'is refused: "{name}" is a link to another place or file')
        item = h5py.h5o.open(group, key)
        if isinstance(item, h5py.h5g.GroupID):
            yield from _items(path, item, name, depth + 1)
        else:
            yield name, item


def _read_attributes(item: Any) -> None:
    whole = h5py.Group(item) if isinstance(item, h5py.h5g.GroupID) else h5py.Dataset(item)
    for key in whole.attrs:
        whole.attrs[key]


def _inside(data: Any, layout: int, path: Path) -> None:
    """Raise OSError when a piece of a data set is beyond the end of its file."""
    pieces: list[int] = []
    if layout == h5py.h5d.CHUNKED:
        data.chunk_iter(lambda chunk: pieces.append(chunk.byte_offset + chunk.size))
    elif layout == h5py.h5d.CONTIGUOUS and data.get_offset() is not None:
        pieces.append(data.get_offset() + data.get_storage_size())
    size = path.stat().st_size  # now: a run may have written more since the file was opened
    if pieces and max(pieces) > size:
        raise OSError(f"it is cut off: {size} of at least {max(pieces)} bytes are there")


class Unmarked:
    """A file without the mark of its writer, as what h5py takes for a file.

    It says to be longer than any file: what its writer appends after it was opened is not beyond its end.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.open("rb", buffering=0)
        self._at = 0
        head = bytearray(self._file.read(HEAD))
        head[MARKS] = 0
        head[END] = EVERYTHING.to_bytes(8, "little")
        head[HEAD - 4 :] = checksum(bytes(head[: HEAD - 4])).to_bytes(4, "little")
        self._head = bytes(head)

    def __enter__(self) -> Unmarked:
        return self

    def __exit__(self, *error: object) -> None:
        self._file.close()

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Go to a place."""
        self._at = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._at, os.SEEK_END: EVERYTHING}[whence]
        return self._at

    def tell(self) -> int:
        """Place now."""
        return self._at

    def readinto(self, buffer: Any) -> int:
        """Read from the place on."""
        data = memoryview(buffer).cast("B")
        self._file.seek(self._at)
        count = self._file.readinto(data)
        if count < len(data):
            raise OSError(
                f"it is cut off: {self._at + count} of at least {self._at + len(data)} bytes are there"
            )
        own = self._head[self._at : self._at + count]
        data[: len(own)] = own
        self._at += count
        return count

    def read(self, count: int) -> bytes:
        """Read from the place on; h5py asks for this method of what it takes for a file."""
        data = bytearray(count)
        return bytes(data[: self.readinto(data)])

    def write(self, data: Any) -> int:
        """Refuse: the file is only read."""
        raise OSError("opened for reading")

    def truncate(self, size: int | None = None) -> int:
        """Leave the length as it is."""
        return EVERYTHING

    def flush(self) -> None:
        """Nothing is written."""


def checksum(data: bytes) -> int:
    """HDF5's checksum of metadata: lookup3 of Bob Jenkins, as the specification asks for."""
    words = [(FULL & 0xDEADBEEF + len(data))] * 3
    parts = [data[i : i + 12].ljust(12, b"\0") for i in range(0, len(data), 12)]
    for k, part in enumerate(parts):
        words = [(w + int.from_bytes(part[4 * i : 4 * i + 4], "little")) & FULL for i, w in enumerate(words)]
        if k < len(parts) - 1:
            words = _mixed(words)
    for target, source, turn in LAST:
        words[target] = ((words[target] ^ words[source]) - _turned(words[source], turn)) & FULL
    return words[2]


FULL = 0xFFFFFFFF
#: The last rounds of lookup3: which of three words changes, by which one, turned how far.
LAST = ((2, 1, 14), (0, 2, 11), (1, 0, 25), (2, 1, 16), (0, 2, 4), (1, 0, 14), (2, 1, 24))


def _turned(word: int, bits: int) -> int:
    return (word << bits | word >> 32 - bits) & FULL


def _mixed(words: list[int]) -> list[int]:
    """Mix three words of lookup3."""
    mixed = list(words)
    for k, turn in enumerate((4, 6, 8, 16, 19, 4)):
        target, source, third = k % 3, (k + 2) % 3, (k + 1) % 3
        mixed[target] = ((mixed[target] - mixed[source]) & FULL) ^ _turned(mixed[source], turn)
        mixed[source] = (mixed[source] + mixed[third]) & FULL
    return mixed
