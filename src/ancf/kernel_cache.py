"""The cache of compiled kernels when several processes fill it at once, and when it is of another version.

Numba picks a name that its index does not have, enters it there, and then writes the file. Two processes that
do so at the same time may take one name for two kernels; one that is killed in between leaves an entry whose
file is missing or old. Here one process writes at a time, the file first and its entry afterwards.

An index names the classes that kernels take. After an update one of them may have gone, and numba would fail
while it reads; here what cannot be read is compiled anew.
"""

from __future__ import annotations

import itertools
import os
import pickle
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, cast

from numba.core.caching import IndexDataCacheFile

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
    pickle.UnpicklingError,
)


def share() -> None:
    """Let this process wait while another one writes; the system frees the lock of a killed process."""
    numbas = cast(Any, IndexDataCacheFile)
    numbas.save = _save
    numbas._load_index = _or(numbas._load_index, dict)
    numbas.load = _or(numbas.load, lambda: None)


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
    with open(os.path.join(folder, "ancf.lock"), "w", encoding="ascii") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield
