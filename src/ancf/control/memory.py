"""What a controller remembers between its calls, so that a run which is resumed goes on with it.

A controller that has the methods ``state()`` and ``restore(state)`` is kept with every checkpoint.  Of any
other one is found out whether it changes numbers, texts, dicts or arrays that it holds, as attributes or as
variables around it; a run that is resumed then says that it cannot know them.  No code of a file is run, so
nothing is pickled.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable
from typing import Any

from ..errors import ModelError
from ..model import checks

#: Kinds of values of which a change is memory; a list that only grows is a log.
PLAIN = (bool, int, float, complex, str, bytes, tuple, list, dict, set)
#: Names in a message.
MOST_NAMED = 4


def offers(controller: Any) -> bool:
    """Whether a controller can be asked for its state and take it back."""
    return all(callable(getattr(controller, name, None)) for name in ("state", "restore"))


def kept_state(controller: Any, where: str) -> str:
    """The state that a controller offers, as JSON.

    Raises
    ------
    ModelError
        It is nothing that JSON has.
    """
    state = controller.state()
    try:
        return json.dumps(state, default=lambda value: value.tolist())
    except (AttributeError, TypeError, ValueError) as error:
        what = f"state() gave {checks.shown(state)}, which no file can keep: {error}"
        raise ModelError(f"{where}.controller", what, "return numbers, texts, lists and dicts") from None


class Memory:
    """The memory of a controller during a run.

    Parameters
    ----------
    controller : callable
    where : str
        Stands in messages.
    """

    def __init__(self, controller: Any, where: str) -> None:
        self._controller, self._where = controller, where
        self._offers, self._first = offers(controller), held(controller)
        self._before: tuple[int, str] = (-1, "")

    def note(self, done: int) -> None:
        """Keep what it remembers before it is called after so many steps; then it may be stopped."""
        if self._offers:
            self._before = done, kept_state(self._controller, self._where)

    def values(self, done: int) -> dict[str, Any]:
        """What a checkpoint after so many steps has of it, before it is asked then."""
        kept: dict[str, Any] = {"changed": changed(self._first, held(self._controller))}
        if self._offers:
            asked, before = self._before
            kept["state"] = before if asked == done else kept_state(self._controller, self._where)
        return kept


def restored(controller: Any, name: str, kept: dict[str, Any]) -> str:
    """Give a controller what it remembered at a checkpoint; what to say of memory that nothing kept."""
    if offers(controller) and "state" in kept:
        controller.restore(json.loads(kept["state"]))
    now = {key: value for key, (_, value) in held(controller).items()}
    lost = [key for key, value in kept.get("changed", {}).items() if now.get(key) != value]
    if not lost:
        return ""
    named = checks.listed(lost[:MOST_NAMED])
    what = f'the controller "{name}" had changed {named}, which the file does not keep'
    return f"{what}: the run goes on with what it holds now (give it the methods state() and restore(state))"


def changed(first: dict[str, tuple[Any, int]], now: dict[str, tuple[Any, int]]) -> dict[str, int]:
    """Names of what is another value now, with its mark; a list to which something was added is left out."""
    found = {}
    for name, (value, mark) in now.items():
        before, old = first.get(name, (None, 0))
        grown = isinstance(value, list) and isinstance(before, list) and value[: len(before)] == before
        if mark != old and not grown:
            found[name] = mark
    return found


def held(controller: Any) -> dict[str, tuple[Any, int]]:
    """Values that a controller holds and does not offer, by name, with a mark of each."""
    while offers(controller):
        if not hasattr(controller, "controller"):  # what others wrap stays one of its own
            return {}
        controller = controller.controller
    holder = getattr(controller, "__self__", controller)
    found = dict(getattr(holder, "__dict__", {}))
    code, cells = getattr(controller, "__code__", None), getattr(controller, "__closure__", None)
    if code is not None and cells:
        found |= dict(zip(code.co_freevars, map(_content, cells), strict=True))
    plain = {
        name: value for name, value in found.items() if isinstance(value, PLAIN) or hasattr(value, "tobytes")
    }
    return {name: (list(x) if isinstance(x, list) else x, _mark(x)) for name, x in plain.items()}


def _content(cell: Any) -> Any:
    try:
        return cell.cell_contents
    except ValueError:  # not set yet
        return None


def _mark(value: Any) -> int:
    as_bytes: Callable[[], bytes] | None = getattr(value, "tobytes", None)
    return zlib.crc32(as_bytes() if as_bytes is not None else repr(value).encode())
