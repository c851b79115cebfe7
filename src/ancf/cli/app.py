"""The commands and their options; everything heavy is imported by the command that needs it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from ancf.cli.guard import reported

app = typer.Typer(
    name="ancf",
    help="Thin beams and cables that move a lot: absolute nodal coordinate formulation.",
    epilog="Exit codes: 0 done, 1 the solve failed, 2 the input is wrong, 130 stopped by Ctrl-C.",
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

ModelFile = Annotated[Path, typer.Argument(metavar="MODEL.toml", help="Model file.", show_default=False)]
AnyFile = Annotated[
    Path, typer.Argument(metavar="FILE", help="Model file or results file.", show_default=False)
]
Folder = Annotated[Path, typer.Option("--output", "-o", metavar="OUT", help="Folder for what is written.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")]
Names = Annotated[
    list[str] | None,
    typer.Argument(metavar="NAMES", help="Figures, such as fig2, or all.", show_default="all"),
]
Short = Annotated[bool, typer.Option("--short", help="Fewer and shorter runs, to try it out.")]
SchemaFile = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="FILE", help="File to write, instead of printing it.")
]


def _show_version(wanted: bool) -> None:
    if wanted:
        from ancf import __version__

        typer.echo(f"ancf {__version__}")
        raise typer.Exit


@app.callback()
def _common(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


@app.command()
def run(model: ModelFile, output: Folder = Path("out"), quiet: Quiet = False) -> None:
    """Compute what a model file asks for.

    Writes OUT/results.h5 while it runs, and OUT/summary.json at the end.
    """
    with reported():
        from ancf.cli.run import run_file

        run_file(model, output, quiet)


@app.command()
def check(model: ModelFile) -> None:
    """Say whether a model file is right."""
    with reported():
        from ancf.cli.info_model import check_file

        check_file(model)


@app.command()
def schema(output: SchemaFile = None) -> None:
    """Print the JSON Schema of model files."""
    with reported():
        from ancf.cli.schema import write_schema

        write_schema(output)


@app.command()
def info(file: AnyFile) -> None:
    """Say what is in a results or model file.

    A results file may belong to a run that is not finished, or was killed.
    """
    with reported():
        from ancf.cli.info import show_info

        show_info(file)


@app.command()
def reproduce(
    names: Names = None, output: Folder = Path("out"), short: Short = False, quiet: Quiet = False
) -> None:
    """Compute figures of the paper.

    Writes OUT/NAME.png, OUT/NAME.csv and OUT/NAME.json for each.
    """
    with reported():
        from ancf.cli.reproduce import reproduce_figures

        reproduce_figures(names or ["all"], output, short, quiet)


def main() -> None:
    """Entry point of the command ``ancf``."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a title in Greek must not stop a run in a terminal without it
            stream.reconfigure(errors="backslashreplace")
    app()
