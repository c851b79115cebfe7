"""Every error as one block on stderr and an exit code; no traceback reaches the user."""

from __future__ import annotations

import os
import signal
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer

from ..errors import ModelError, SolveError
from ..files import visible
from ..interrupts import Terminated, kept
from ..reading import inputs_spared

FAILED, WRONG_INPUT, STOPPED, TERMINATED = 1, 2, 130, 143
TRACEBACK = "ANCF_TRACEBACK"


@contextmanager
def reported() -> Iterator[None]:
    """Turn what goes wrong inside into a message and ``typer.Exit``; warnings become one line each."""
    with warnings.catch_warnings(), kept(signal.SIGINT, signal.SIGTERM), inputs_spared():
        warnings.showwarning = _show_warning
        try:
            yield
        except (typer.Exit, BrokenPipeError):
            raise
        except (Exception, KeyboardInterrupt) as error:
            if os.environ.get(TRACEBACK):
                raise
            found = _stop(error) or error
            show(found)
            raise typer.Exit(exit_code(found)) from None


def _stop(error: BaseException) -> KeyboardInterrupt | None:
    """Ctrl-C behind an error: an import that it cuts off ends in many ways."""
    while error.__context__ is not None and not isinstance(
        error, ModelError | SolveError | KeyboardInterrupt
    ):
        error = error.__context__
    return error if isinstance(error, KeyboardInterrupt) else None


def exit_code(error: BaseException) -> int:
    """2 for wrong input, 130 for Ctrl-C, 143 for SIGTERM, otherwise 1."""
    if isinstance(error, KeyboardInterrupt):
        return TERMINATED if _terminated(error) else STOPPED
    return WRONG_INPUT if isinstance(error, ModelError) else FAILED


def _terminated(error: BaseException) -> bool:
    return isinstance(error, Terminated) or isinstance(error.__cause__, Terminated)


def show(error: BaseException) -> None:
    """Print an error to stderr: where, what, what to do, and its notes."""
    from rich.text import Text

    from .screen import console

    kind, what, hint = described(error)
    text = Text.assemble((kind, "bold red"), f" {visible(what)}")
    for line in ([hint] if hint else []) + list(getattr(error, "__notes__", [])):
        text.append(f"\n  {visible(line)}")
    console(stderr=True).print(text, soft_wrap=True)


def described(error: BaseException) -> tuple[str, str, str]:
    """Kind, message and hint of an error."""
    if isinstance(error, ModelError | SolveError):
        return "error:", f"{error.where}: {error.what}", error.hint or _of_example(error)
    if isinstance(error, KeyboardInterrupt):
        return "stopped", "by SIGTERM" if _terminated(error) else "by Ctrl-C", ""
    if isinstance(error, MemoryError):
        return "error:", "not enough memory", "fewer elements, or a longer output_step"
    if isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename else ""
        return "error:", f"{place}{error.strerror or error}", ""
    hint = f"this is a fault of ancf: please report it; {TRACEBACK}=1 in the environment shows where"
    return "internal error:", f"{type(error).__name__}: {error}", hint


def _of_example(error: ModelError | SolveError) -> str:
    """Where a file that is not there comes from, if it is one of the examples."""
    from .examples import folder

    try:
        known = error.what == "no such file" and (folder() / Path(error.where).name).is_file()
    except (ModelError, OSError, ValueError):
        return ""
    return "it comes with the package: ancf examples --copy examples" if known else ""


def _show_warning(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
    from rich.text import Text

    from .screen import console

    text = Text.assemble(("warning:", "yellow"), f" {visible(str(message))}")
    console(stderr=True).print(text, soft_wrap=True)
