"""What prints as a sheet that is made elsewhere: by a module that knows of more than the item itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from ..model.tables import Readable, Sheet

Said = TypeVar("Said")
#: By the name of a class its sheet and its line, put here by :mod:`ancf.catenary.sheets`.
SHEETS: dict[str, Callable[[Any], Sheet]] = {}
LINES: dict[str, Callable[[Any], str]] = {}


class Told(Readable):
    """A form, a run or statistics: prints as a sheet, shows as HTML in a notebook, in one line by `repr`."""

    __slots__ = ()

    def _sheet(self) -> Sheet:
        return _of(self, SHEETS)(self)

    def in_a_line(self) -> str:
        """What `repr` shows."""
        return _of(self, LINES)(self)


def _of(item: Told, known: dict[str, Callable[[Any], Said]]) -> Callable[[Any], Said]:
    """What is known of the class of an item, or of one that it comes from."""
    return next(known[kind.__name__] for kind in type(item).__mro__ if kind.__name__ in known)
