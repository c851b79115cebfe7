"""The lines that come with the package, and how a line is called by name or path."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...errors import ModelError
from ...files import exists
from ...model.checks import listed, nearest, shown
from .file import read_file
from .line import Line
from .route import Route

FOLDER = Path(__file__).parents[1] / "data"
#: Files there that are no lines.
OTHER = ("pantographs", "wires")


def line_names() -> list[str]:
    """Names of the lines of the catalogue."""
    return sorted(path.stem for path in FOLDER.glob("*.toml") if path.stem not in OTHER)


def line_file(name: str) -> Path:
    """File of a line of the catalogue, to copy and change; ModelError for an unknown name."""
    if name not in line_names():
        what = f'unknown line "{name}", known: {listed(line_names())}'
        raise ModelError("line", what, nearest(name, line_names()))
    return FOLDER / f"{name}.toml"


def read_line(name_or_path: str | Path, values: Mapping[str, Any] | None = None) -> Line | Route:
    """Line of the catalogue by its name, or from a line file by its path; a Route if it has sections.

    Parameters
    ----------
    name_or_path : str or path
    values : mapping, optional
        Other values than those of its file, by path: ``{"spans[3].length": 60.0}``.

    Raises
    ------
    ModelError
        There is no such line, file or path, or the file is wrong.

    """
    return read_file(path_of(name_or_path), values)


def path_of(name_or_path: str | Path) -> Path:
    """File of a line of the catalogue by its name, or the path itself.

    Raises
    ------
    ModelError
        It is no name of the catalogue and cannot be a file.

    """
    given: object = name_or_path
    if not isinstance(given, str | Path):
        what = f"must be a name of the catalogue or a path, is {shown(given)}"
        raise ModelError("line", what, f"such as {line_names()[0]} or line.toml")
    text = str(name_or_path)
    if text in line_names():
        return line_file(text)
    path = Path(name_or_path)
    if not exists(path) and path.suffix != ".toml" and len(path.parts) == 1:
        what = f"no line of the catalogue and no file, the catalogue has: {listed(line_names())}"
        raise ModelError(text, what, nearest(text, line_names()))
    return path
