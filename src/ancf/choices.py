"""Kernels that are chosen by the type of what they take: what a model has no use for is not compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba.extending import overload

from .compiled import FORMULA, PART


def optional(function: Callable[..., Any], default: Any = None) -> Any:
    """Kernel whose first argument is a tuple; of an empty one it returns `default` and compiles nothing."""

    def stub(items, *arguments):
        raise TypeError("only in compiled code")

    def nothing(items, *arguments):
        return default

    @overload(stub, jit_options=PART, strict=False)
    def _choose(items, *arguments):
        return function if len(items) else nothing

    return stub


def where_dimensions(number: int, function: Callable[..., Any], default: Any) -> Any:
    """Kernel whose first argument is an array; of one with fewer dimensions it returns `default`.

    So a batch that has no use for an array says so by its type, and nothing is compiled for it.
    """

    def stub(array, *arguments):
        return function(array, *arguments) if array.ndim == number else default

    def nothing(array, *arguments):
        return default

    @overload(stub, jit_options=FORMULA, strict=False)
    def _choose(array, *arguments):
        return function if array.ndim == number else nothing

    return stub
