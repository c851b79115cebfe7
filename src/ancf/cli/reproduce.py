"""``ancf reproduce``: figures of the paper."""

from __future__ import annotations

from pathlib import Path

from ancf.cli.screen import Screen, console


def reproduce_figures(names: list[str], folder: Path, short: bool = False, quiet: bool = False) -> None:
    """Compute the named figures, or all, and print the files that were written."""
    from ancf import paper

    screen = Screen(quiet)
    screen.announce_compilation()
    with screen.counted() as report:
        files = paper.reproduce(names, folder, short=short, progress=report)
    if not quiet:
        console().print("\n".join(str(file) for file in files), soft_wrap=True)
