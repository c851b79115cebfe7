"""``ancf schema``: the JSON Schema of model files."""

from __future__ import annotations

import json
from pathlib import Path

import typer

from ancf.errors import ModelError

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def write_schema(path: Path | None) -> None:
    """Print the schema, or write it to a file."""
    from ancf.model.file import schema

    text = json.dumps({"$schema": DIALECT, **schema()}, indent=2)
    if path is None:
        typer.echo(text)
        return
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text + "\n", encoding="utf-8")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ModelError(str(path), f"cannot be written: {reason}") from None
