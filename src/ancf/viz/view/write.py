"""From a result, a state or modes to the page and its file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...errors import ModelError
from ...files import write_text
from ...model import checks
from ...model.beam import Beam
from ...results.modes import Modes
from ...results.result import Result
from ...results.state import State
from ..scene import make_scene
from ..scene.sampling import CORNERS
from .about import about
from .curves import curves
from .histories import Histories
from .page import COLORS, Options, page, plotly_script
from .traces import traces, traces_of_scene

#: States on a page, and bytes of the bodies' numbers at most.
FRAMES, BYTES = 240, 3_200_000
#: Bytes of a point of a cable, and of a corner of a section.
OF_POINT, OF_CORNER = 18, 6
#: Points on all centrelines together at most: more are not seen.
POINTS = 2000


def view_page(
    source: Result | State | Modes,
    *,
    frames: int = FRAMES,
    color: str = "tension",
    trace: Sequence[str] | None = None,
    start: float | None = None,
    end: float | None = None,
    mode: int = 0,
    title: str | None = None,
    file: str = "",
) -> str:
    """HTML text of a page with the moving picture of a result, a state or a mode.

    Parameters
    ----------
    source : Result, State or Modes
    frames : int
        States that are shown at most.
    color : "tension", "curvature", "speed" or "plain"
        Colour of the bodies when the page opens.
    trace : sequence of str, optional
        Points whose paths are drawn, such as "beam.end"; default up to three that move most.
    start, end : float, s
        Part of the run that is shown; default all.
    mode : int
        Which one of Modes, from 0.
    title : str, optional
        Default that of the model.
    file : str
        Name of the results file, for the foot of the page.

    Raises
    ------
    ModelError
        plotly is missing, an option is wrong, or there is nothing to show.
    """
    plotly_script()
    checks.choice(color, "view.color", COLORS)
    checks.integer(frames, "view.frames", 1, 100_000)
    if isinstance(source, Result) and len(source.t) == 0:
        raise ModelError(file or "view", "no state was stored, so there is nothing to show")
    scene = make_scene(source, frames=frames, points=_points(source, frames), start=start, end=end, mode=mode)
    drawn, lines = [], []
    if isinstance(source, Result):
        states = Histories(source)
        drawn = traces(states, scene, trace)
        lines = curves(source, states, drawn, scene)
    elif trace:
        raise ModelError("view.trace", "only a Result has traces of chosen points", "leave it out")
    elif isinstance(source, Modes):
        drawn = traces_of_scene(scene)
    if len(scene.t) == 1:
        drawn, lines = [], []
    options = Options(color=color, traces=drawn, about=about(source, file))
    return page(scene, lines, title or scene.title or file or "ancf", options)


def write_view(source: Result | State | Modes, path: str | Path, **options: Any) -> Path:
    """Write the page of :func:`view_page`, which takes the options, to a file.

    Raises
    ------
    ModelError
        As :func:`view_page`; or the file cannot be written.
    """
    return write_text(Path(path), view_page(source, **options))


def _points(source: Any, frames: int) -> int:
    """Points on the centrelines for which the page does not grow too large."""
    bodies = source.about.bodies if isinstance(source, Modes) else source.bodies
    solid = any(isinstance(body, Beam) and body.has_section for body in bodies.values())
    each = OF_POINT + (CORNERS * OF_CORNER if solid else 0)
    return min(POINTS, max(2, BYTES // (frames * each)))
