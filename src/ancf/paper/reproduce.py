"""Write figures of the paper: a picture, a table and its JSON for each."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path

from .. import __version__
from ..errors import ModelError
from ..model.checks import listed, nearest
from ..viz import style
from .figures import FIGURES

#: Called with the name of a figure, how many are done and how many there are.
Progress = Callable[[str, int, int], None]


def reproduce(
    names: Iterable[str],
    folder: str | os.PathLike[str],
    short: bool = False,
    progress: Progress | None = None,
) -> list[Path]:
    """Compute figures and write NAME.png, NAME.csv and NAME.json.

    Parameters
    ----------
    names : iterable of str
        Names of figures, ``fig2``, or ``all``.
    folder : path
        Where to write; made when it does not exist.
    short : bool
        Fewer and shorter runs, to try it out.
    progress : callable, optional
        Called with (name, done, count) before each figure, and with (last name, count, count) at the end.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ModelError
        An unknown name, a folder that cannot be written, or matplotlib is missing.

    """
    wanted = resolve(names)
    style.require_matplotlib()
    target = _writable(Path(folder))
    files: list[Path] = []
    for done, name in enumerate(wanted):
        _report(progress, name, done, len(wanted))
        files += _write(name, target, short)
    _report(progress, wanted[-1], len(wanted), len(wanted))
    return files


def resolve(names: Iterable[str]) -> list[str]:
    """Names of figures in the order given, each once; ``all`` for all there are."""
    given = [names] if isinstance(names, str) else list(names)
    if not given:
        raise ModelError("reproduce", f"no figure named, there are {listed(FIGURES)}", 'or "all"')
    for name in given:
        if name != "all" and name not in FIGURES:
            problem = f'unknown figure "{name}", there are {listed(FIGURES)} and "all"'
            raise ModelError("reproduce", problem, nearest(name, FIGURES))
    return list(dict.fromkeys(n for name in given for n in (FIGURES if name == "all" else [name])))


def _write(name: str, folder: Path, short: bool) -> list[Path]:
    module = FIGURES[name]
    table = module.data(short)
    table.notes.append(f"ancf {__version__}" + (", short form: fewer and shorter runs." if short else "."))
    picture = folder / f"{name}.png"
    with style.new_figure(*module.SIZE) as figure:
        module.draw(table, figure)
        figure.savefig(picture)
    return [picture, *table.write(folder)]


def _writable(folder: Path) -> Path:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / ".ancf-write-test"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise ModelError(str(folder), f"cannot be written: {error.strerror or error}") from None
    return folder


def _report(progress: Progress | None, name: str, done: int, count: int) -> None:
    if progress is not None:
        progress(name, done, count)
