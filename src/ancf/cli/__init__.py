"""The command line: run, check, schema, info, reproduce."""

from ancf.cli.app import app, main

__all__ = ["app", "main"]
