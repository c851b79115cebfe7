"""From a result, a state or modes to the page and its file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ...errors import ModelError
from ...files import write_text
from ...model import checks
from ...model.bodies.beam import Beam
from ...results.modes import Modes
from ...results.result import Result
from ..scene import Scene, make_scene
from ..scene.sampling import CORNERS
from .about import about, about_all
from .curves import curves
from .histories import Histories
from .page import COLORS, Options, page, plotly_script
from .ranges import ranges
from .together import Part, checked, common_times, joined
from .traces import Trace, traces, traces_of_scene

#: States on a page, and bytes of the bodies' numbers at most.
FRAMES, BYTES = 240, 3_200_000
#: Bytes of a point of a cable, and of a corner of a section.
OF_POINT, OF_CORNER = 18, 6
#: Points on all centrelines together at most: more are not seen.
POINTS = 2000


def view_page(source: Any, **options: Any) -> str:
    """HTML text of a page with the moving picture of a result, a state or a mode, or of several results.

    Parameters
    ----------
    source : Result, State, Modes or mapping of str to Result
        Several runs, by the names that they get on the page.
    options
        As for :func:`shown_of`, and ``title``: a title, default that of the model.

    Raises
    ------
    ModelError
        plotly is missing, an option is wrong, or there is nothing to show.
    """
    plotly_script()
    title = options.pop("title", None)
    part, how = shown_of(source, **options)
    return page(part, title or part.scene.title or how.about.file or "ancf", how)


def shown_of(
    source: Any,
    *,
    frames: int = FRAMES,
    color: str | None = None,
    trace: Sequence[str] | None = None,
    start: float | None = None,
    end: float | None = None,
    mode: int = 0,
    file: str = "",
    live: bool = False,
) -> tuple[Part, Options]:
    """What a page shows of a result, a state, a mode or of several results.

    Parameters
    ----------
    source : Result, State, Modes or mapping of str to Result
    frames : int
        States that are shown at most.
    color : "tension", "curvature", "speed" or "plain"
        Colour of the bodies when the page opens; default "tension", of several runs "plain": one for each.
    trace : sequence of str, optional
        Points whose paths are drawn, such as "beam.end"; default up to three that move most.
    start, end : float, s
        Part of the run that is shown; default all.
    mode : int
        Which one of Modes, from 0.
    file : str
        Name of the results file, for the foot of the page.
    live : bool
        The page asks its server for more.

    Raises
    ------
    ModelError
        An option is wrong, or there is nothing to show.
    """
    several = isinstance(source, Mapping) and len(source) > 1
    color = checks.choice(color or ("plain" if several else "tension"), "view.color", COLORS)
    checks.integer(frames, "view.frames", 1, 100_000)
    if isinstance(source, Mapping):
        checked(source)
    if isinstance(source, Mapping) and not several:
        [source] = source.values()
    if several:
        part = _compared(source, frames, trace, start, end)
        words, runs = about_all(source, file), list(source)
    else:
        part, words, runs = _alone(source, frames, trace, start, end, mode, file), about(source, file), []
    if len(part.scene.t) == 1:
        part = Part(part.scene, owners=part.owners)
    return part, Options(color=color, about=words, runs=runs, live=live)


def _alone(
    source: Any,
    frames: int,
    trace: Sequence[str] | None,
    start: float | None,
    end: float | None,
    mode: int,
    file: str,
) -> Part:
    if isinstance(source, Result) and len(source.t) == 0:
        raise ModelError(file or "view", "no state was stored, so there is nothing to show")
    scene = make_scene(source, frames=frames, points=_points(source, frames), start=start, end=end, mode=mode)
    if isinstance(source, Result):
        return _of_result(source, scene, trace)
    if trace:
        raise ModelError("view.trace", "only a Result has traces of chosen points", "leave it out")
    return Part(scene, traces_of_scene(scene) if isinstance(source, Modes) else [])


def _of_result(source: Result, scene: Scene, trace: Sequence[str] | None) -> Part:
    states = Histories(source)
    drawn = traces(states, scene, trace)
    return Part(scene, drawn, curves(source, states, drawn, scene), ranges(states, scene))


def _compared(
    sources: Mapping[str, Result],
    frames: int,
    trace: Sequence[str] | None,
    start: float | None,
    end: float | None,
) -> Part:
    """All at the times of the one that lasts longest; the same points are traced, where a run has them."""
    times = common_times(sources.values(), frames, start, end)
    parts: dict[str, Part] = {}
    for label, source in sources.items():
        points = min(_points(source, frames), POINTS) // len(sources)
        scene = make_scene(source, points=max(points, 2), times=times)
        first = next(iter(parts.values()), None)
        wanted = trace if first is None or trace is not None else _known(source, first.traces)
        parts[label] = _of_result(source, scene, wanted)
    return joined(parts)


def _known(source: Result, drawn: Sequence[Trace]) -> list[str]:
    """Traced points of another run that are in this one too."""
    return [trace.name for trace in drawn if trace.name.split(".")[0] in source.bodies]


def write_view(source: Any, path: str | Path, **options: Any) -> Path:
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
