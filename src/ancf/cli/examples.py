"""``ancf examples``: what they are, and a copy to run and to change."""

from __future__ import annotations

import shutil
from pathlib import Path

from ..errors import ModelError
from ..files import exists, writing
from .screen import console

#: Beside the package where it is installed, beside the sources in a clone.
PLACES = (Path(__file__).parent.parent / "examples", Path(__file__).parents[3] / "examples")
SUFFIXES = (".toml", ".py", ".txt", ".csv", ".md")


def folder() -> Path:
    """Where the examples are.

    Raises
    ------
    ModelError
        They were not installed with the package.
    """
    for place in PLACES:
        if exists(place, "is_dir"):
            return place
    raise ModelError("examples", "were not installed with the package", "install it again from its wheel")


def show_examples(copy: Path | None) -> None:
    """Print names and first lines, or copy all files to a folder.

    Raises
    ------
    ModelError
        A file of that name is there with another content, or it cannot be written; nothing is overwritten.
    """
    source = folder()
    files = sorted(f for f in source.rglob("*") if f.suffix in SUFFIXES and "__pycache__" not in f.parts)
    if copy is None:
        width = max(len(str(file.relative_to(source))) for file in files)
        for file in files:
            console().print(
                f"{file.relative_to(source)!s:<{width}}  {_said(file)}", soft_wrap=True, markup=False
            )
        return
    targets = [copy / file.relative_to(source) for file in files]
    for file, target in zip(files, targets, strict=True):
        if exists(target) and target.read_bytes() != file.read_bytes():
            raise ModelError(str(target), "is there and has changed", "copy to another folder")
    for file, target in zip(files, targets, strict=True):
        with writing(target):
            shutil.copyfile(file, target)
    console().print(f"copied: {len(files)} files to {copy}", soft_wrap=True)


def _said(file: Path) -> str:
    """The first line of a file without its signs of a comment."""
    if file.suffix == ".csv":
        return "measured data for the file of this name"
    if file.suffix == ".csv":
        return "Measured data for the file of this name."
    with file.open(encoding="utf-8") as lines:
        return next(lines, "").strip().strip('#"').strip()
