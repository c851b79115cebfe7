"""Garbage is collected later: what makes a model allocates much that stays, and leaves no cycles behind."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


@contextmanager
def later() -> Iterator[None]:
    """No garbage is collected meanwhile.

    Python looks through all objects when many new ones have been made, and there are two hundred thousand
    of them with the compiler loaded: that takes as long as it takes to find the form of a line.
    """
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def without(function: Callable[P, R]) -> Callable[P, R]:
    """The function, during which no garbage is collected."""

    @wraps(function)
    def calm(*args: P.args, **kwargs: P.kwargs) -> R:
        with later():
            return function(*args, **kwargs)

    return calm
