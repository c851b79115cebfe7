"""``ancf import-moordyn``: a model file from an input file of MoorDyn."""

from __future__ import annotations

from pathlib import Path

from ..files import beside, write_text
from ..model.file import parse_study
from ..mooring.moordyn_model import import_moordyn
from .screen import console
from .summary import plural


def import_file(lines: Path, output: Path) -> None:
    """Write the model file; say what is in it, what was assumed and what was left out.

    Raises
    ------
    ModelError
        The file cannot be read or taken, describes no valid model, or the model file cannot be written.
    """
    beside(output, lines)
    made = import_moordyn(lines)
    study = parse_study(made.tables, str(lines))
    write_text(output, made.toml(lines.name))
    screen = console()
    for note in made.notes:
        screen.print(note)
    for item in made.left_out:
        screen.print(f"left out: {item}")
    counts = plural(len(study.model.beams), "line"), plural(len(study.model.supports), "support")
    screen.print(f"written: {output} ({', '.join(counts)})")
