"""The command line: run, check, schema, info, reproduce, validate."""

from ancf.cli.app import app, main

__all__ = ["app", "main"]
