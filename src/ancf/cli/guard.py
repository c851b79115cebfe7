"""Every error as one block on stderr and an exit code; no traceback reaches the user."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import typer

from ancf.cli.output import StorageError
from ancf.errors import ModelError, SolveError

FAILED, WRONG_INPUT, STOPPED = 1, 2, 130
TRACEBACK = "ANCF_TRACEBACK"


@contextmanager
def reported() -> Iterator[None]:
    """Turn what goes wrong inside into a message and ``typer.Exit``; warnings become one line each."""
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        try:
            yield
        except (typer.Exit, BrokenPipeError):
            raise
        except (Exception, KeyboardInterrupt) as error:
            if os.environ.get(TRACEBACK):
                raise
            show(error)
            if isinstance(error, StorageError):
                _leave()
            raise typer.Exit(exit_code(error)) from None


def _leave() -> None:
    """End now: HDF5 crashes when it closes a file that it cannot write."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(FAILED)


def exit_code(error: BaseException) -> int:
    """2 for wrong input, 130 for Ctrl-C, otherwise 1."""
    if isinstance(error, KeyboardInterrupt):
        return STOPPED
    return WRONG_INPUT if isinstance(error, ModelError) else FAILED


def show(error: BaseException) -> None:
    """Print an error to stderr: where, what, what to do, and its notes."""
    from rich.text import Text

    from ancf.cli.screen import console

    kind, what, hint = described(error)
    text = Text.assemble((kind, "bold red"), f" {what}")
    for line in ([hint] if hint else []) + list(getattr(error, "__notes__", [])):
        text.append(f"\n  {line}")
    console(stderr=True).print(text, soft_wrap=True)


def described(error: BaseException) -> tuple[str, str, str]:
    """Kind, message and hint of an error."""
    if isinstance(error, ModelError | SolveError):
        return "error:", f"{error.where}: {error.what}", error.hint
    if isinstance(error, KeyboardInterrupt):
        return "stopped", "by Ctrl-C", ""
    if isinstance(error, MemoryError):
        return "error:", "not enough memory", "fewer elements, or a longer output_step"
    if isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename else ""
        return "error:", f"{place}{error.strerror or error}", ""
    hint = f"this is a fault of ancf: please report it; {TRACEBACK}=1 in the environment shows where"
    return "internal error:", f"{type(error).__name__}: {error}", hint


def _show_warning(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
    from rich.text import Text

    from ancf.cli.screen import console

    console(stderr=True).print(Text.assemble(("warning:", "yellow"), f" {message}"), soft_wrap=True)
