"""Options of ``ancf export`` and ``ancf export-fmu``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

ResultsFile = Annotated[
    Path, typer.Argument(metavar="RESULTS.h5", help="Results file, or its folder.", show_default=False)
]
Kind = Annotated[
    str | None,
    typer.Option(
        "--to",
        metavar="KIND",
        help="vtk, csv, parquet, xlsx, mp4 or gif; default as the file after -o ends.",
        show_default=False,
    ),
]
Target = Annotated[
    Path | None,
    typer.Option(
        "--output",
        "-o",
        metavar="PATH",
        help="File, or folder of the tables; default beside the results file.",
        show_default=False,
    ),
]
Points = Annotated[
    str | None,
    typer.Option(
        metavar="POINTS", help='For tables: points such as "beam.end,beam.at(0.5)".', show_default=False
    ),
]
Frames = Annotated[
    int | None,
    typer.Option(metavar="N", help="At most so many stored states, evenly spaced.", show_default=False),
]
FromTime = Annotated[
    float | None,
    typer.Option("--start", metavar="S", help="States from this time on, s.", show_default=False),
]
ToTime = Annotated[
    float | None, typer.Option("--end", metavar="S", help="States up to this time, s.", show_default=False)
]
Color = Annotated[
    str | None,
    typer.Option(metavar="WHAT", help="For movies: tension, curvature, speed or plain.", show_default=False),
]
Fps = Annotated[
    int | None, typer.Option(metavar="F", help="For movies: pictures per second.", show_default=False)
]
View = Annotated[
    str | None,
    typer.Option(metavar="PLANE", help='For movies: seen in the plane "xz", or "xyz".', show_default=False),
]
Unit = Annotated[
    Path | None,
    typer.Option("--output", "-o", metavar="FILE", help="FMU to write.", show_default="beside the model"),
]
Fmi = Annotated[str, typer.Option("--fmi", metavar="VERSION", help='"2.0" or "3.0".')]
