"""The command line: run, check, schema, info, reproduce, validate."""

from __future__ import annotations

import gc
import sys

__all__ = ["main"]

#: Objects between two looks for garbage: what modules are made of stays, and to look through it again and
#: again takes a tenth of a start.
MANY = 100_000


def main() -> None:
    """Entry point of the command ``ancf``; Ctrl-C while it still imports ends it as later on."""
    gc.set_threshold(MANY)
    try:
        from .app import start

        start()
    except KeyboardInterrupt:
        if sys.stderr is not None:
            sys.stderr.write("stopped by Ctrl-C\n")
        sys.exit(130)
