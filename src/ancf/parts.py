"""How functions that only kernels call are compiled: to what kernels take in, and no further.

Numba brings every function to machine code by itself, with all that it calls, before a kernel takes it in
and the same code is optimised and translated once more: a function three calls deep four times.  A part is
left as it comes from numba, and is optimised with the kernel that has it: a third less time for a line.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, update_wrapper
from typing import Any, NoReturn, TypeVar, cast

import llvmlite.binding as llvm
import numba
from numba import types
from numba.core import codegen, compiler
from numba.core.targetconfig import TargetConfig

F = TypeVar("F", bound=Callable[..., Any])

_Library: Any = codegen.JITCodeLibrary


class PartLibrary(_Library):  # type: ignore[misc]
    """A function as code for kernels, without a translation of its own."""

    @classmethod
    def read(cls, target: Any, name: str, code: bytes) -> PartLibrary:
        """The one whose code another process has written, see :mod:`ancf.kept`."""
        library = cls(target.codegen(), name)
        library._final_module = llvm.parse_bitcode(code)
        library._finalize_final_module()
        return library

    def _optimize_final_module(self) -> None:
        """With the kernel."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """There is no such function in machine code."""
        self._ensure_finalized()
        return 0

    @property
    def codegen(self) -> _Nowhere:
        """What numba tells the surroundings of a function that it can call."""
        return _Nowhere()


class _Nowhere:
    """Where the surroundings of a function would be kept."""

    def set_env(self, name: str, env: Any) -> None:
        """Parts raise nothing and need none."""


class PartCompiler(compiler.Compiler):
    """Numba's compiler with a :class:`PartLibrary`."""

    def define_pipelines(self) -> list[Any]:
        """Numba's own pipelines, which take the library that is there."""
        state: Any = self.state
        if state.library is None:
            state.library = PartLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        pipelines: list[Any] = super().define_pipelines()  # type: ignore[no-untyped-call]
        return pipelines


class Part:
    """A function that only kernels call; numba is asked for it when the first of them is compiled.

    A start from the cache needs few of the hundreds that there are, and numba takes a tenth of a millisecond
    to look at each.

    Parameters
    ----------
    function : function
    settings : mapping
        Of numba.
    finish : function, optional
        ``finish(dispatcher)``: what is to be done with numba's object for it.
    """

    def __init__(
        self, function: Callable[..., Any], settings: Any, finish: Callable[[Any], None] | None = None
    ) -> None:
        self.py_func, self._settings, self._finish = function, settings, finish
        update_wrapper(self, function)

    def __call__(self, *arguments: Any, **keywords: Any) -> NoReturn:
        """Refuse: there is no entry for Python."""
        name = self.py_func.__name__
        raise TypeError(f"{name} is a part of kernels: call one of them, or its py_func")

    @property
    def _numba_type_(self) -> Any:
        return types.Dispatcher(self.dispatcher)

    @cached_property
    def dispatcher(self) -> Any:
        """Numba's object for it."""
        dispatcher: Any = numba.njit(**self._settings)(self.py_func)

        def keep(compiled: Any) -> None:  # numba would jump to the entry for Python, which is not there
            dispatcher.overloads[tuple(compiled.signature.args)] = compiled

        dispatcher.add_overload = keep
        if self._finish is not None:
            self._finish(dispatcher)
        return dispatcher

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.dispatcher, name)


def part(function: F, settings: Any, finish: Callable[[Any], None] | None = None) -> F:
    """Compile ``function`` with these settings of numba where kernels call it; see :class:`Part`."""
    made: Any = function if getattr(numba.config, "DISABLE_JIT", 0) else Part(function, settings, finish)
    return cast(F, made)


def _values(self: Any) -> dict[str, Any]:
    """All options of a target: those that are set, over the defaults.

    Numba looks up every call that it compiles by its options, and asks for each of them in turn: a tenth of
    all the time to compile.
    """
    kind = type(self)
    if kind not in _defaults:
        _defaults[kind] = {name: option.default for name, option in kind.options.items()}
    return {**_defaults[kind], **self._values}


_defaults: dict[type, dict[str, Any]] = {}
TargetConfig.values = _values  # type: ignore[method-assign]
