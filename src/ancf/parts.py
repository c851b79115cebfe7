"""How functions that only kernels call are compiled: to what kernels take in, and no further.

Numba brings every function to machine code by itself, with all that it calls, before a kernel takes it in
and the same code is optimised and translated once more: a function three calls deep four times.  A part is
left as it comes from numba, and is optimised with the kernel that has it: a third less time for a line.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
from numba.core import codegen, compiler
from numba.core.targetconfig import TargetConfig

F = TypeVar("F", bound=Callable[..., Any])

_Library: Any = codegen.JITCodeLibrary


class PartLibrary(_Library):  # type: ignore[misc]
    """A function as code for kernels, without a translation of its own."""

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


def part(function: F, settings: Any) -> F:
    """Compile ``function`` with these settings of numba where kernels call it; Python cannot call it."""
    dispatcher: Any = numba.njit(**settings)(function)

    def refuse(*arguments: Any, **keywords: Any) -> None:
        raise TypeError(f"{function.__name__} is a part of kernels: call one of them, or its py_func")

    def keep(compiled: Any) -> None:
        dispatcher.overloads[tuple(compiled.signature.args)] = compiled

    # numba would jump to the entry that is not there
    dispatcher._compile_for_args, dispatcher.add_overload = refuse, keep
    return cast(F, dispatcher)


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
