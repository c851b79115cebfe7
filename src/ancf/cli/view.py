"""``ancf view``: a moving picture of a results file, for a browser."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import Any

from ..errors import ModelError
from ..files import exists
from .results_file import open_result
from .screen import console

SUFFIXES = (".html", ".htm")


def view_file(path: Path, output: Path | None, options: dict[str, Any], show: bool = False) -> None:
    """Write the page and print its path.

    Parameters
    ----------
    path : Path
        Results file, or the folder with ``results.h5``.
    output : Path, optional
        Default ``view.html`` beside the results.
    options : dict
        As for :func:`ancf.viz.view.write_view`.
    show : bool
        Open it in a browser.

    Raises
    ------
    ModelError
        The file is no results file or is empty, an option is wrong, plotly is missing, or the page cannot
        be written.

    """
    from ..viz.view import write_view
    from ..viz.view.page import plotly_script

    plotly_script()
    source = path / "results.h5" if exists(path, "is_dir") else path
    target = _target(source, output)
    written = write_view(open_result(source), target, file=source.name, **options)
    console().print(str(written), soft_wrap=True)
    if show:
        webbrowser.open(written.resolve().as_uri())


def _target(source: Path, output: Path | None) -> Path:
    if output is None:
        return source.with_name("view.html")
    if exists(output, "is_dir"):
        return output / "view.html"
    if output.suffix.lower() not in SUFFIXES:
        hint = f"give {output.with_suffix('.html')}"
        raise ModelError(f"-o {output}", "is not the name of an HTML file", hint)
    return output
