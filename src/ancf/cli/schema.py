"""``ancf schema``: the JSON Schema of model files."""

from __future__ import annotations

import json
from pathlib import Path

import typer

from ..files import write_text

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def write_schema(path: Path | None) -> None:
    """Print the schema, or write it to a file."""
    from ..model.file import schema

    text = json.dumps({"$schema": DIALECT, **schema()}, indent=2)
    if path is None:
        typer.echo(text)
        return
    write_text(path, text + "\n")
