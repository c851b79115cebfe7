"""The command line: run, check, schema, info, reproduce, validate."""

from __future__ import annotations

import sys

__all__ = ["main"]


def main() -> None:
    """Entry point of the command ``ancf``; Ctrl-C while it still imports ends it as later on."""
    try:
        from .app import start

        start()
    except KeyboardInterrupt:
        if sys.stderr is not None:
            sys.stderr.write("stopped by Ctrl-C\n")
        sys.exit(130)
