"""Ctrl-C and SIGTERM, kept until they are heeded.

Python drops what the handler of a signal raises while an object is deleted ("Exception ignored in"): a run
whose only signal comes at such a moment would go on to its end.  So each signal is raised and kept, and a
run asks between two blocks of steps whether one was dropped, and nothing is printed of it.
"""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


class Terminated(KeyboardInterrupt):
    """The system asks the program to end (SIGTERM); it ends as after Ctrl-C."""


_FREE: dict[signal.Signals, Any] = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}
_RAISED = {signal.SIGINT: KeyboardInterrupt, signal.SIGTERM: Terminated}
_kept: list[type[KeyboardInterrupt]] = []


@contextmanager
def kept(*signals: signal.Signals) -> Iterator[None]:
    """Here signals raise and are kept; those that are ignored or handled already are left so."""
    main = threading.current_thread() is threading.main_thread()
    ours = [number for number in signals if main and signal.getsignal(number) is _FREE[number]]

    def stop(number: int, frame: Any) -> None:
        _kept.append(_RAISED[signal.Signals(number)])
        raise _kept[-1]

    show = sys.unraisablehook

    def dropped(what: Any) -> None:
        if not (_kept and issubclass(what.exc_type, KeyboardInterrupt)):
            show(what)

    try:
        if ours:
            sys.unraisablehook = dropped
        for number in ours:
            signal.signal(number, stop)
        yield
    finally:
        for number in ours:
            signal.signal(number, _FREE[number])
        if ours:
            sys.unraisablehook = show
            _kept.clear()


def heed() -> None:
    """Raise a signal that was kept.

    Raises
    ------
    KeyboardInterrupt, Terminated
    """
    if _kept and threading.current_thread() is threading.main_thread():
        raise _kept.pop()
