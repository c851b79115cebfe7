"""Parts of kernels that are kept, for processes beside this one and for the kernels of the next model.

A part (:mod:`ancf.parts`) has no machine code, so there is nothing of it that numba would keep: two processes
that compile side by side would both translate what their kernels share, and a model with other kinds all that
it shares with those before.  Here each folder of the cache has a file for them, to which processes append.

Only parts of the package are kept, as far as its sources and the types that they take tell what they are: of
one that takes in a function of a user they do not.
"""

from __future__ import annotations

import copy
import hashlib
import io
import itertools
import os
import pickle
import random
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, cast

import llvmlite
import numba
from numba import types
from numba.core import bytecode, compiler
from numba.core.caching import FunctionCache as _FunctionCache
from numba.core.caching import NullCache
from numba.core.environment import Environment as _Environment
from numba.core.typing.templates import Signature as _Signature

from .kernel_cache import UNREADABLE, alone, opened
from .parts import PartLibrary

Environment: Any = _Environment
FunctionCache: Any = _FunctionCache
Signature: Any = _Signature

#: Numba tells functions of one name apart by counting them.  Where code of other processes is linked, no two
#: processes may count alike.
bytecode.FunctionIdentity._unique_ids = itertools.count(random.SystemRandom().getrandbits(48))

#: Among other versions of these code does not travel.
_MADE_BY = f"{sys.version} {numba.__version__} {llvmlite.__version__}"
_ROOT = str(Path(__file__).parent) + os.sep


class UntoldError(Exception):
    """Nothing tells what this is in another process."""


#: Bytes by which a file begins that no other one begins with.
MARK = 16
#: What it ends in when a part cannot be kept or read; numba without a folder, and LLVM, raise RuntimeError.
NOT_KEPT = (UntoldError, RuntimeError, pickle.PicklingError, *UNREADABLE)


class Shelf:
    """The parts of a folder of the cache, of one version of the sources.

    Parameters
    ----------
    folder : str
    stamp : str
        Of the sources.
    """

    def __init__(self, folder: str, stamp: str) -> None:
        self._folder, self._name = folder, f"ancf.{stamp[:16]}.parts"
        self._parts: dict[bytes, bytes] = {}
        self._mark, self._read = b"", MARK
        self._shut = False

    def find(self, key: bytes) -> bytes | None:
        """The part of a key, if some process has compiled it."""
        if key not in self._parts and not self._shut and os.path.lexists(self._path):
            with self._opened() as file:
                self._look(file)
        return self._parts.get(key)

    def add(self, key: bytes, part: bytes) -> None:
        """Keep a part; where that was not possible once, it is not tried again."""
        self._parts[key] = part
        if not self._shut:
            self._shut = True
            with alone(self._folder), self._opened() as file:
                self._look(file)
                self._append(file, pickle.dumps((key, part)))
            self._shut = False

    @property
    def _path(self) -> str:
        return os.path.join(self._folder, self._name)

    @contextmanager
    def _opened(self) -> Iterator[int]:
        file = opened(self._path)
        try:
            yield file
        finally:
            os.close(file)

    def _look(self, file: int) -> None:
        """Read what has been added."""
        mark = os.pread(file, MARK, 0)
        if mark != self._mark:  # somebody has cleared it
            self._mark, self._read = mark, MARK
        begin = self._read
        new = io.BytesIO(os.pread(file, max(os.fstat(file).st_size - begin, 0), begin))
        with suppress(*UNREADABLE):  # the end, or what is being written
            while True:
                key, part = pickle.load(new)
                self._parts.setdefault(key, part)
                self._read = begin + new.tell()

    def _append(self, file: int, text: bytes) -> None:
        if len(self._mark) < MARK:
            self._clear()
            self._mark, self._read = os.urandom(MARK), MARK
            os.pwrite(file, self._mark, 0)
        os.ftruncate(file, self._read)  # what a process that was killed left half written
        if os.pwrite(file, text, self._read) == len(text):
            self._read += len(text)

    def _clear(self) -> None:
        """Remove the parts of other versions."""
        for old in Path(self._folder).glob("ancf.*.parts"):
            if old.name != self._name:
                with suppress(OSError):
                    old.unlink()


class PartCache(NullCache):
    """What numba asks for a part before it compiles it, and tells afterwards.

    Parameters
    ----------
    function : function
    stamp : str
        Of the sources.
    """

    def __init__(self, function: Any, stamp: str) -> None:
        self._function, self._stamp = function, stamp

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The part for arguments of these types, or None."""
        try:
            kept = self._shelf.find(self._key(sig, target_context))
            return kept and _read(kept, tuple(getattr(sig, "args", sig)), target_context)
        except NOT_KEPT:
            return None

    def save_overload(self, sig: Any, cres: Any) -> None:
        """Keep it, if all that it needs can be kept."""
        if cres.library.has_dynamic_globals or cres.reload_init or cres.objectmode:
            return
        about = copy.copy(cres.fndesc)
        about.typemap = about.calltypes = about.argtypes = None
        code = cres.library.serialize_using_bitcode()[2]
        with suppress(*NOT_KEPT):
            part = pickle.dumps((about, cres.signature.return_type, code))
            self._shelf.add(self._key(sig, cres.target_context), part)

    @property
    def _shelf(self) -> Shelf:
        folder = os.path.dirname(self._function.__code__.co_filename)
        if folder not in _shelves:
            _shelves[folder] = Shelf(FunctionCache(self._function).cache_path, self._stamp)
        return _shelves[folder]

    def _key(self, sig: Any, target_context: Any) -> bytes:
        args = tuple(getattr(sig, "args", sig))
        machine = target_context.codegen().magic_tuple()
        told = _MADE_BY, machine, _of_function(self._function), [_of_type(kind) for kind in args]
        return hashlib.sha256(repr(told).encode()).digest()


def _read(kept: bytes, args: tuple[Any, ...], target: Any) -> Any:
    about, returned, code = pickle.loads(kept)
    about.argtypes = args
    library = PartLibrary.read(target, about.qualname, code)
    env = Environment.from_fndesc(about)
    found = {
        "typing_context": target.typing_context,
        "target_context": target,
        "entry_point": target.get_executable(library, about, env),
        "signature": Signature(returned, args, None),
        "objectmode": False,
        "lifted": (),
        "fndesc": about,
        "library": library,
        "environment": env,
        "reload_init": (),
        "referenced_envs": (),
    }
    return compiler.CompileResult(**{**dict.fromkeys(compiler.CR_FIELDS), **found})


_shelves: dict[str, Shelf] = {}


def use(dispatcher: Any, stamp: str) -> None:
    """Keep what a dispatcher of parts compiles, see :class:`PartCache`, if there is a place for it."""
    if sys.platform != "win32":  # there are no locks there
        dispatcher._cache = PartCache(dispatcher.py_func, stamp)


def _of_function(function: Any) -> Any:
    """What tells a function of the package in any process, with all that is closed in with it."""
    function = getattr(function, "py_func", function)
    code = getattr(function, "__code__", None)
    if code is None or not code.co_filename.startswith(_ROOT):
        raise UntoldError
    closed = [_of_value(cell.cell_contents) for cell in function.__closure__ or ()]
    return function.__module__, function.__qualname__, code.co_firstlineno, closed


def _of_value(value: Any) -> Any:
    return repr(value) if isinstance(value, bool | int | float | str) else _of_function(value)


def _of_type(kind: Any) -> Any:
    if isinstance(kind, types.Dispatcher):
        return _of_function(kind.dispatcher)
    if isinstance(kind, types.BaseTuple):
        made = getattr(kind, "instance_class", tuple)
        return made.__module__, made.__qualname__, [_of_type(item) for item in cast(Any, kind).types]
    text = str(kind)
    if "0x" in text:
        raise UntoldError
    return text
