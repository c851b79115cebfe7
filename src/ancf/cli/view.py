"""``ancf view``: a moving picture of a results file, for a browser."""

from __future__ import annotations

import time
import webbrowser
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..errors import ModelError
from ..files import MOST_NAMED, RESULTS, exists, results_at
from .results_file import open_result
from .screen import console

SUFFIXES = (".html", ".htm")
#: How often a file that is not there yet is looked for, and how long one may be unreadable, s.
WAIT, PATIENCE = 0.5, 10.0


def view_file(
    paths: list[Path], output: Path | None, options: dict[str, Any], show: bool = False, live: bool = False
) -> None:
    """Write the page and print its path, or serve one that follows a run.

    Parameters
    ----------
    paths : list of Path
        Results files, or the folders with ``results.h5``; several are compared. One line file shows the line
        at rest.
    output : Path, optional
        Default ``view.html`` beside the first one.
    options : dict
        As for :func:`ancf.viz.view.shown_of`.
    show : bool
        Open it in a browser.
    live : bool
        Serve the page until Ctrl-C.

    Raises
    ------
    ModelError
        A file is no results file or is empty, an option is wrong, plotly is missing, or the page cannot
        be written.

    """
    from ..viz.view import labels_of, write_view
    from ..viz.view.page import plotly_script

    plotly_script()
    if live:
        files = [path / RESULTS if exists(path, "is_dir") else path for path in paths]  # it may come yet
        _follow(files, output, options, show)
        return
    sources = [results_at(path) for path in paths]
    target = _target(sources[0], output)
    if len(sources) == 1 and sources[0].suffix == ".toml":
        written = _line_at_rest(sources[0], target, options)
    elif len(sources) == 1:
        written = write_view(open_result(sources[0]), target, file=sources[0].name, **options)
    else:
        named = dict(zip(labels_of(sources), map(open_result, sources), strict=True))
        written = write_view(named, target, **options)
    console().print(str(written), soft_wrap=True)
    if show:
        webbrowser.open(written.resolve().as_uri())


def _line_at_rest(path: Path, target: Path, options: dict[str, Any]) -> Path:
    """The page of an overhead line at rest, in the state of its file."""
    from ..model.file import read_toml
    from ..model.file.kinds import LINE, MODEL, kind_of, refuse

    data = read_toml(path, "model file")
    if kind_of(data) in ("", MODEL):
        raise ModelError(str(path), "is a model file, which has no results yet", f"ancf run {path} -o out")
    refuse(path, data, LINE)
    import ancf

    from .. import catenary
    from ..viz.view.frame import Framed

    overhead = catenary.assemble(catenary.form(catenary.read_line(path)))
    return Framed(ancf.equilibrium(overhead.model), **options).save(target)


def _follow(sources: list[Path], output: Path | None, options: dict[str, Any], show: bool) -> None:
    """Wait for the first states of a run, and show it until Ctrl-C."""
    from ..viz.view.live import LiveView

    if len(sources) > 1 or output is not None:
        raise ModelError("--live", "follows one results file and writes none", "leave -o and other files out")
    [path] = sources
    if not exists(path):
        console().print(f"waiting for {path}{_others(path)}", soft_wrap=True)
    while not _begun(path):
        time.sleep(WAIT)
    view = LiveView(path, options)
    console().print(f"{view.url} follows {path}; Ctrl-C ends it", soft_wrap=True)
    if show:
        webbrowser.open(view.url)
    with suppress(KeyboardInterrupt):
        view.serve()


def _others(path: Path) -> str:
    """Of a file that is not there yet the runs beside it and in folders there, which may be meant."""
    found = [*path.parent.glob("*.h5"), *path.parent.glob(f"*/{RESULTS}")] if path.name == RESULTS else []
    named = [str(file.parent if file.name == RESULTS else file) for file in sorted(found)]
    more = f" and {len(named) - MOST_NAMED} more" if len(named) > MOST_NAMED else ""
    return f"; other runs are in {', '.join(named[:MOST_NAMED])}{more}" if named else ""


def _begun(path: Path) -> bool:
    """Whether the file has a state; a file that is being made cannot be read yet."""
    import ancf

    if not exists(path):
        return False
    try:
        return len(ancf.load(path).t) > 0
    except ModelError:
        if time.time() - path.stat().st_mtime < PATIENCE:
            return False
        raise


def _target(source: Path, output: Path | None) -> Path:
    if output is None:
        return source.with_name("view.html")
    if exists(output, "is_dir"):
        return output / "view.html"
    if output.suffix.lower() not in SUFFIXES:
        hint = f"give {output.with_suffix('.html')}"
        raise ModelError(f"-o {output}", "is not the name of an HTML file", hint)
    return output
