"""The page of a result in a notebook."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any

from ...files import write_text
from .write import view_page


class Framed:
    """A page that shows itself in a notebook.

    Parameters
    ----------
    source : Result, State, Modes or mapping of str to Result
    height : int
        Of the frame, pixels.
    options : dict
        As for :func:`ancf.viz.view.view_page`.

    Raises
    ------
    ModelError
        As :func:`ancf.viz.view.view_page`.
    """

    def __init__(self, source: Any, height: int = 600, **options: Any) -> None:
        self.text, self.height = view_page(source, **options), height

    def __repr__(self) -> str:
        return f"<page of {len(self.text) / 1e6:.1f} MB: .save(path) writes it>"

    def _repr_html_(self) -> str:
        # a page of its own, which neither reads nor changes the notebook's
        style = f"width: 100%; height: {self.height}px; border: 0"
        page = escape(self.text, quote=True)
        allowed = "allow-scripts allow-downloads"
        return f'<iframe srcdoc="{page}" sandbox="{allowed}" style="{style}" title="moving picture"></iframe>'

    def save(self, path: str | Path) -> Path:
        """Write the page to a file."""
        return write_text(Path(path), self.text)
