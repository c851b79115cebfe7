"""The cache of compiled kernels when several processes fill it at once, and when it is of another version.

Numba picks a name that its index does not have, enters it there, and then writes the file. Two processes that
do so at the same time may take one name for two kernels; one that is killed in between leaves an entry whose
file is missing or old. Here one process writes at a time, the file first and its entry afterwards.

A kernel that another process compiles just now is waited for and taken from the cache, not compiled twice.

An index names the classes that kernels take. After an update one of them may have gone, and numba would fail
while it reads; here what cannot be read is compiled anew.

Without a folder to write to, or with one that is full, kernels are compiled at each start: a warning says so.
The folder may be shared: the lock is opened such that no link of somebody else makes this process write, or
wait for ever, elsewhere.
"""

from __future__ import annotations

import hashlib
import itertools
import os
import pickle
import stat
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, cast

from numba.core import event
from numba.core.caching import Cache, IndexDataCacheFile

if sys.platform != "win32":
    import fcntl


#: What reading classes that have gone or changed, or a file that was cut off, ends in.
UNREADABLE = (
    ImportError,
    AttributeError,
    LookupError,
    TypeError,
    ValueError,
    EOFError,
    OSError,
    pickle.UnpicklingError,
)
#: How long to wait for another process that writes, s; writing takes milliseconds.
PATIENCE = 60.0
#: How long to wait for another process that compiles the same kernel, s; then it is compiled here as well.
COMPILING = 300.0
_said: set[str] = set()
#: Files of claims by folder, open until this process ends, and the claims that it holds by dispatcher.
_files: dict[str, int] = {}
_held: dict[int, list[tuple[int, int]]] = {}
_ended: list[int] = []


def share() -> None:
    """Let this process wait while another one writes; the system frees the lock of a killed process."""
    numbas = cast(Any, IndexDataCacheFile)
    numbas.save = _save
    numbas._load_index = _or(numbas._load_index, dict)
    numbas.load = _or(numbas.load, lambda: None)
    cache = cast(Any, Cache)
    cache._save_overload = _if_possible(cache._save_overload)
    if sys.platform != "win32":
        cache.load_overload = _waiting(cache.load_overload)
        cache.save_overload = _releasing(cache.save_overload)
        cast(Any, event).register("numba:compile", _Ended())


def use(dispatcher: Any, stamp: str) -> None:
    """Cache what a dispatcher compiles; ``stamp`` changes with the sources of the kernels that it calls."""
    try:
        dispatcher.enable_caching()
    except (RuntimeError, OSError):  # numba found no place
        _say("no folder for compiled kernels can be written")
        return
    # numba's own stamp covers the kernel's file alone, not the kernels that it calls
    cache_file = getattr(dispatcher._cache, "_cache_file", None)
    if cache_file is not None and hasattr(cache_file, "_source_stamp"):
        cache_file._source_stamp = stamp


def _say(what: str) -> None:
    """Warn once that kernels are not kept."""
    if what not in _said:
        _said.add(what)
        hint = "each start compiles them anew; NUMBA_CACHE_DIR in the environment names another folder"
        warnings.warn(f"{what}: {hint}", RuntimeWarning, stacklevel=3)


def _if_possible(save: Callable[..., Any]) -> Callable[..., Any]:
    def saved(self: Any, *arguments: Any) -> None:
        try:
            save(self, *arguments)
        except OSError as error:
            _say(f"compiled kernels cannot be kept in {self.cache_path}: {error.strerror or error}")

    return saved


def _waiting(load: Callable[..., Any]) -> Callable[..., Any]:
    """Load a kernel; one that is missing is claimed, and one that somebody else has claimed is waited for."""

    def loaded(self: Any, signature: Any, context: Any) -> Any:
        found = load(self, signature, context)
        if found is not None or getattr(self, "_cache_file", None) is None:
            return found
        name = f"{os.path.basename(self._cache_file._index_path)} {signature}"
        place = 1 + int.from_bytes(hashlib.sha256(name.encode()).digest()[:7], "big")
        file, waited = claim(self.cache_path, place, COMPILING)
        if waited and (found := load(self, signature, context)) is not None:
            give_back(file, place)
            return found
        if file >= 0:
            _held.setdefault(id(self), []).append((file, place))
        return None

    return loaded


def _releasing(save: Callable[..., Any]) -> Callable[..., Any]:
    """Save a kernel, and then give its claim back."""

    def saved(self: Any, *arguments: Any) -> None:
        try:
            save(self, *arguments)
        finally:
            _release(id(self))

    return saved


class _Ended(event.Listener):
    """Remembers what has been compiled: what is never saved, for it failed, does not keep its claim."""

    def on_start(self, event: Any) -> None:
        for cache in _ended:
            _release(cache)
        _ended.clear()

    def on_end(self, event: Any) -> None:
        if (cache := id(getattr(event.data["dispatcher"], "_cache", None))) in _held:
            _ended.append(cache)


def _release(cache: int) -> None:
    for file, place in _held.pop(cache, []):
        give_back(file, place)


def claim(folder: str, place: int, patience: float) -> tuple[int, bool]:
    """Lock a number in a folder of compiled kernels, and whether that had to be waited for.

    The system frees it when this process ends. The file is -1 where there are no locks, or patience is over.
    """
    waited = False
    try:
        if folder not in _files:
            path = os.path.join(folder, "ancf.claims")
            flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
            _files[folder] = os.open(path, flags, 0o666)
            if not stat.S_ISREG(os.fstat(_files[folder]).st_mode):
                raise OSError(f"{path} is no plain file")
        end = time.monotonic() + patience
        while True:
            try:
                fcntl.lockf(_files[folder], fcntl.LOCK_EX | fcntl.LOCK_NB, 1, place)
                return _files[folder], waited
            except (BlockingIOError, PermissionError):
                if time.monotonic() > end:
                    return -1, waited
            waited = True
            time.sleep(0.02)
    except OSError:  # a file system without locks, or no place to write
        return -1, waited


def give_back(file: int, place: int) -> None:
    """Unlock what was claimed."""
    if file >= 0:
        fcntl.lockf(file, fcntl.LOCK_UN, 1, place)


def _or(read: Callable[..., Any], nothing: Callable[[], Any]) -> Callable[..., Any]:
    def readable(self: Any, *key: Any) -> Any:
        try:
            return read(self, *key)
        except UNREADABLE:
            return nothing()

    return readable


def _save(self: Any, key: Any, data: Any) -> None:
    with _alone(self._cache_path):
        index = self._load_index()
        used = set(index.values())
        names = (self._data_name(number) for number in itertools.count(1))
        name = index.get(key) or next(name for name in names if name not in used)
        self._save_data(name, data)
        index[key] = name
        self._save_index(index)


@contextmanager
def _alone(folder: str) -> Iterator[None]:
    if sys.platform == "win32":
        yield
        return
    path = os.path.join(folder, "ancf.lock")
    # no link is followed, no pipe waited for, and nothing is written
    file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC, 0o666)
    try:
        if not stat.S_ISREG(os.fstat(file).st_mode):
            raise OSError(f"{path} is no plain file")
        _lock(file)
        yield
    finally:
        os.close(file)


def _lock(file: int) -> None:
    """Wait for the lock, but not for ever: another user may hold it."""
    end = time.monotonic() + PATIENCE
    while True:
        try:
            return fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > end:
                raise TimeoutError(f"another process holds the lock for {PATIENCE:g} s") from None
        time.sleep(0.01)
