"""Options of the viewer."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Page = Annotated[
    Path | None,
    typer.Option("--output", "-o", metavar="FILE", help="HTML file.", show_default="view.html beside it"),
]
Frames = Annotated[int, typer.Option(metavar="N", help="States that are shown, at most.")]
Color = Annotated[
    str, typer.Option(metavar="WHAT", help='"tension", "curvature", "speed" or "plain" when it opens.')
]
Traced = Annotated[
    list[str] | None,
    typer.Option(
        "--trace",
        metavar="POINT",
        help="Point whose path is drawn; may be repeated.",
        show_default="up to three that move most",
    ),
]
Open = Annotated[bool, typer.Option("--open/--no-open", help="Open it in a browser.")]
