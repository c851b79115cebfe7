"""Options of the commands of overhead lines."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

LineName = Annotated[
    str, typer.Argument(metavar="LINE", help="Line of the catalogue, or a line file.", show_default=False)
]
Forces = Annotated[list[float] | None, typer.Option("--force", help="Upward force, N; may be repeated.")]
Case = Annotated[
    str,
    typer.Argument(
        metavar="CASE", help="Reference case, such as en50318-2002, mooring, or contact.", show_default=False
    ),
]
Speed = Annotated[float, typer.Option("--speed", metavar="KMH", help="Speed, km/h.", show_default=False)]
Speeds = Annotated[
    str,
    typer.Option(
        "--speed", metavar="KMH", help='Speeds, km/h: "160:320:20" or "200,250".', show_default=False
    ),
]
Spacings = Annotated[
    str | None,
    typer.Option(
        "--spacing", metavar="M", help='Distances of a second pantograph, m: "150:250:25" or "200".'
    ),
]
CaseSpeed = Annotated[
    float | None,
    typer.Option(
        "--speed",
        metavar="KMH",
        help="Speed of a line, km/h; default: each that has ranges.",
        show_default=False,
    ),
]
Pantographs = Annotated[
    list[str] | None,
    typer.Option(
        "--pantograph",
        metavar="NAME",
        help="Of the catalogue, or a file; once for all, or once for each, the first ahead.",
        show_default="benchmark-2015",
    ),
]
Spacing = Annotated[
    list[float] | None,
    typer.Option(metavar="M", help="Distance to another pantograph behind, m; may be repeated."),
]
Start = Annotated[
    float | None,
    typer.Option(metavar="M", help="Track position of the last pantograph at the start, m."),
]
Window = Annotated[
    tuple[float, float] | None, typer.Option(metavar="FROM TO", help="Track interval that is evaluated, m.")
]
ContactKind = Annotated[str, typer.Option("--contact", metavar="KIND", help='"penalty" or "joint".')]
Step = Annotated[float | None, typer.Option(metavar="S", help="Time step, s.", show_default="0.001")]
OutputStep = Annotated[
    float | None,
    typer.Option(metavar="S", help="Time between stored states of the line, s.", show_default="0.02"),
]
Until = Annotated[
    float | None,
    typer.Option(
        metavar="M",
        help="Track position at which the last pantograph stops, m.",
        show_default="40 beyond the window",
    ),
]
ContactStiffness = Annotated[
    float | None,
    typer.Option("--contact-stiffness", metavar="N/M", help="Of the contact, N/m.", show_default="50000"),
]
Elements = Annotated[
    tuple[float, float] | None,
    typer.Option(
        "--mesh",
        metavar="CONTACT MESSENGER",
        help="Longest elements of contact wire and messenger, m.",
        show_default="0.8 2",
    ),
]
Runs = Annotated[
    list[Path], typer.Argument(metavar="OUT OUT ...", help="Folders of runs.", show_default=False)
]
Roof = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="CSV with the motion of the roof: columns t, up and perhaps side."),
]
Underside = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="CSV with the underside of the wire: columns position and height_mm."),
]
Measure = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE", help="TOML with the sensors of a measuring pantograph, beside the true force."
    ),
]
Reduce = Annotated[
    bool,
    typer.Option("--reduce", help="Let spans that no pantograph is near move by their modes: long lines."),
]
BrokenDroppers = Annotated[
    list[str] | None,
    typer.Option(
        "--break-dropper",
        metavar="SPAN-NUMBER",
        help="Take a dropper away, both counted from 1: 8-3; may be repeated.",
    ),
]
ResponseFile = Annotated[
    Path, typer.Argument(metavar="RESPONSE.csv", help="Measured frequency response.", show_default=False)
]
PantographFile = Annotated[
    Path, typer.Option("--output", "-o", metavar="FILE", help="Pantograph file to write.")
]
ResponseKind = Annotated[
    str,
    typer.Option(
        "--kind",
        metavar="KIND",
        help='"apparent_mass", "impedance", "dynamic_stiffness", "accelerance", "mobility" or "receptance".',
    ),
]
Masses = Annotated[
    int | None, typer.Option(metavar="N", help="Masses of the chain.", show_default="as few as fit")
]
StaticForce = Annotated[float, typer.Option("--static-force", metavar="N", help="At standstill, N.")]
Aerodynamic = Annotated[
    float,
    typer.Option(
        "--aerodynamic", metavar="K", help="Of the force K v^2, N s^2/m^2: a response does not tell it."
    ),
]
