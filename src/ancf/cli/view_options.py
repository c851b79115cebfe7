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
Several = Annotated[
    list[Path],
    typer.Argument(metavar="RESULTS.h5...", help="Results files, or their folders.", show_default=False),
]
Color = Annotated[
    str | None,
    typer.Option(
        metavar="WHAT",
        help='"tension", "curvature", "speed" or "plain" when it opens.',
        show_default="tension, of several runs a colour for each",
    ),
]
Live = Annotated[bool, typer.Option("--live", help="Follow a run that goes on, on a page of this machine.")]
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
