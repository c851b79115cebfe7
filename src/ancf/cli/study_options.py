"""Options of studies and calibrations."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

StudyFile = Annotated[
    Path,
    typer.Argument(metavar="STUDY.toml", help="Study file, or with --status its folder.", show_default=False),
]
Workers = Annotated[
    int | None,
    typer.Option("--workers", "-j", metavar="N", help="Processes at once.", show_default="one for each core"),
]
Scheduler = Annotated[
    str | None, typer.Option(metavar="ADDRESS", help="Scheduler of a Dask cluster, such as tcp://host:8786.")
]
Retry = Annotated[bool, typer.Option("--retry", help="Compute once more what failed before.")]
Status = Annotated[bool, typer.Option("--status", help="Say how far the study in a folder is.")]
CalibrationFile = Annotated[
    Path, typer.Argument(metavar="CALIBRATE.toml", help="Calibration file.", show_default=False)
]
OptimisationFile = Annotated[
    Path, typer.Argument(metavar="OPTIMISE.toml", help="Optimisation file.", show_default=False)
]
