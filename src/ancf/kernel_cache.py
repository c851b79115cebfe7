"""The cache of compiled kernels when several processes fill it at once, and when it is of another version.

Numba picks a name that its index does not have, enters it there, and then writes the file. Two processes that
do so at the same time may take one name for two kernels; one that is killed in between leaves an entry whose
file is missing or old. Here one process writes at a time, the file first and its entry afterwards.

Processes that start together on an empty cache would all compile the same kernels. Here the first one that
needs a kernel compiles it, and the others wait for it and read it. A kernel waits for those that it calls and
for no other, so that two processes never wait for each other.

An index names the classes that kernels take. One that is defined in another program, or has gone with an
update, cannot be read, and numba would fail, or begin an empty index. Here each entry is read by itself: what
this process cannot read stays for those that can.

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
from contextlib import contextmanager, suppress
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
#: How long to wait for another process that compiles a kernel, s; then this one compiles it as well.  Beside
#: fifteen busy processes on two cores the longest takes ten minutes.  An ended process holds none.
LONGEST = 1800.0
_said: set[str] = set()


def share() -> None:
    """Let this process wait while another one writes; the system frees the lock of a killed process."""
    numbas = cast(Any, IndexDataCacheFile)
    numbas.save = _save
    numbas._save_index = _each_by_itself(numbas._save_index)
    numbas._load_index = _or(_read_each(numbas._load_index), dict)
    numbas.load = _or(numbas.load, lambda: None)
    cache = cast(Any, Cache)
    cache._save_overload = _if_possible(cache._save_overload)


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
    if sys.platform != "win32":
        _compile_once(dispatcher)


def _compile_once(dispatcher: Any) -> None:
    """Let the dispatcher look into the cache again when no other process compiles the same kernel."""
    cache = dispatcher._cache
    compile_it, load = dispatcher.compile, cache.load_overload
    # numba's own first loads all that a compiler needs, for a third of the time
    load = getattr(cache, "_load_overload", load)
    held: dict[str, int] = {}

    def loaded(signature: Any, context: Any) -> Any:
        found = load(signature, context)
        if found is not None:
            return found
        text = hashlib.sha256(str(signature).encode()).hexdigest()[:16]
        path = os.path.join(cache.cache_path, f"{cache._impl.filename_base}.{text}.lock")
        file = None if path in held else _wait_for(path)
        if file is None:
            return None
        held[path] = file
        return load(signature, context)

    def compiled(signature: Any) -> Any:
        before = set(held)
        try:
            return compile_it(signature)
        finally:
            for path in set(held) - before:
                with suppress(OSError):
                    os.unlink(path)
                os.close(held.pop(path))

    cache.load_overload, dispatcher.compile = loaded, compiled


def _wait_for(path: str) -> int | None:
    """The locked file of a kernel; None without a place for it, or if another process keeps it too long."""
    if "impatient" in _said:
        return None
    try:
        file = opened(path)
    except OSError:
        return None
    try:
        _lock(file, LONGEST)
    except BaseException as error:
        os.close(file)
        if not isinstance(error, OSError):
            raise
        _said.add("impatient")
        return None
    return file


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


def _or(read: Callable[..., Any], nothing: Callable[[], Any]) -> Callable[..., Any]:
    def readable(self: Any, *key: Any) -> Any:
        try:
            return read(self, *key)
        except UNREADABLE:
            return nothing()

    return readable


def _each_by_itself(save: Callable[..., Any]) -> Callable[..., Any]:
    """Write the keys of an index as bytes; those that came as bytes are as they were."""

    def saved(self: Any, index: dict[Any, str]) -> None:
        save(self, {key if isinstance(key, bytes) else self._dump(key): name for key, name in index.items()})

    return saved


def _read_each(load: Callable[..., Any]) -> Callable[..., Any]:
    """Read the keys of an index; one that this process cannot read stays bytes."""

    def key_of(raw: bytes) -> Any:
        try:
            return pickle.loads(raw)
        except UNREADABLE:
            return raw

    def loaded(self: Any) -> dict[Any, str]:
        return {key_of(raw): name for raw, name in load(self).items()}

    return loaded


def _save(self: Any, key: Any, data: Any) -> None:
    with alone(self._cache_path):
        index = self._load_index()
        used = set(index.values())
        names = (self._data_name(number) for number in itertools.count(1))
        name = index.get(key) or next(name for name in names if name not in used)
        self._save_data(name, data)
        index[key] = name
        self._save_index(index)


@contextmanager
def alone(folder: str) -> Iterator[None]:
    """Here no other process writes to a folder of the cache."""
    if sys.platform == "win32":
        yield
        return
    file = opened(os.path.join(folder, "ancf.lock"))
    try:
        _lock(file, PATIENCE)
        yield
    finally:
        os.close(file)


def opened(path: str) -> int:
    """A file to be locked: no link is followed, no pipe waited for, and nothing is written."""
    file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC, 0o666)
    if stat.S_ISREG(os.fstat(file).st_mode):
        return file
    os.close(file)
    raise OSError(f"{path} is no plain file")


def _lock(file: int, patience: float) -> None:
    """Wait for the lock, but not for ever: another user may hold it."""
    end = time.monotonic() + patience
    while True:
        try:
            return fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > end:
                raise TimeoutError(f"another process holds the lock for {patience:g} s") from None
        time.sleep(0.01)


class _Announcer(event.Listener):
    def __init__(self, say: Callable[[], None]) -> None:
        self.say: Callable[[], None] | None = say

    def on_start(self, event: Any) -> None:
        if self.say is not None:
            self.say()
            self.say = None

    def on_end(self, event: Any) -> None:
        pass


def announce_compilation(say: Callable[[], None]) -> None:
    """Call ``say`` once, before the first kernel that is not in the cache gets compiled."""
    event.register("numba:compile", _Announcer(say))  # type: ignore[no-untyped-call]


class _Watcher(event.Listener):
    def __init__(self, tell: Callable[[int], None]) -> None:
        self.tell, self.depth = tell, 0

    def on_start(self, event: Any) -> None:
        self.depth += 1
        if self.depth == 1:
            self.tell(1)

    def on_end(self, event: Any) -> None:
        self.depth -= 1
        if self.depth == 0:
            self.tell(0)


def watch_compilation(tell: Callable[[int], None]) -> None:
    """Call ``tell(1)`` whenever a kernel begins to be compiled and ``tell(0)`` when none is any more."""
    event.register("numba:compile", _Watcher(tell))  # type: ignore[no-untyped-call]
