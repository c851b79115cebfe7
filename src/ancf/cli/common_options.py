"""Arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

ModelFile = Annotated[Path, typer.Argument(metavar="MODEL.toml", help="Model file.", show_default=False)]
AnyInput = Annotated[
    Path,
    typer.Argument(
        metavar="FILE", help="Model file, line file, results file or its folder.", show_default=False
    ),
]
Folder = Annotated[Path, typer.Option("--output", "-o", metavar="OUT", help="Folder for what is written.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")]
Verify = Annotated[
    bool,
    typer.Option("--verify", help="Compute again with half the step, with twice the elements, and compare."),
]
Resume = Annotated[bool, typer.Option("--resume", help="Go on where OUT/results.h5 ends.")]
Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help="Other value in the file: sections.rope.EA=2e4; may be repeated.",
    ),
]
Names = Annotated[
    list[str] | None,
    typer.Argument(metavar="NAMES", help="Figures and tables, such as fig2, or all.", show_default="all"),
]
Quick = Annotated[bool, typer.Option("--quick", help="Fewer and shorter runs, in a few minutes.")]
Jobs = Annotated[
    int | None,
    typer.Option("--jobs", "-j", metavar="N", help="Processes at once.", show_default="one for each core"),
]
OptionalFolder = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="OUT", help="Folder for a CSV file.")
]
States = Annotated[
    bool, typer.Option(help="Write OUT/results.h5 as well, some 10 to 100 MB for ancf view and ancf export.")
]
Report = Annotated[bool, typer.Option(help="Write OUT/report.html as well, which needs matplotlib.")]
To = Annotated[
    str | None,
    typer.Option(
        metavar="FORMATS",
        help='Of the report, such as "html,pdf,docx"; PDF and DOCX need the extra report.',
        show_default="all that are installed",
    ),
]
SchemaFile = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="FILE", help="File to write, instead of printing it.")
]
