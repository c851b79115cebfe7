"""The page: a scene and curves inside one HTML text that needs no other file and no network."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape
from importlib.resources import files
from typing import Any

from ...errors import ModelError
from ...model import checks
from .. import style
from ..scene import QUANTITIES, Scene
from .about import About
from .encode import Numbers, Plain, plain_curve, plain_range, plain_scene, plain_trace
from .ranges import MOVES
from .together import Part

#: What the threads can be coloured by.
COLORS = (*QUANTITIES, "plain")
#: Scripts in the order in which they need each other.
SCRIPTS: tuple[str, ...] = (
    "data.js",
    "theme.js",
    "saving.js",
    "layers.js",
    "legend.js",
    "scene.js",
    "sources.js",
    "plots.js",
    "viewer.js",
)
#: The one that asks a local server for more of a run that goes on; pages from disk have it not.
LIVE = "live.js"


@dataclass(frozen=True)
class Options:
    """How the page opens, and what else is on it.

    Parameters
    ----------
    color : "tension", "curvature", "speed" or "plain"
    about : About
    runs : sequence of str
        Names of several runs.
    live : bool
        The page asks the server that it comes from for more.

    Raises
    ------
    ModelError
        There is no such colour.
    """

    color: str = "tension"
    about: About = field(default_factory=About)
    runs: Sequence[str] = ()
    live: bool = False

    def __post_init__(self) -> None:
        checks.choice(self.color, "view.color", COLORS)


def page(shown: Part | Scene, title: str, options: Options | None = None) -> str:
    """HTML text of the whole page.

    Parameters
    ----------
    shown : Part or Scene
        The moving picture, and its time plots; none leaves their side out.
    title : str
    options : Options, optional

    Raises
    ------
    ModelError
        plotly is not installed.
    """
    plotly = plotly_script()
    options = options or Options()
    scripts = (*SCRIPTS, LIVE) if options.live else SCRIPTS
    told = options.about
    parts = {
        "title": escape(title),
        "badge": f'<span class="badge {"good" if told.good else "bad"}">{escape(told.status)}</span>'
        if told.status
        else "",
        "made": escape(told.made),
        "foot": escape(_foot((shown.scene if isinstance(shown, Part) else shown), told.file)),
        "style": _variables() + _text("viewer.css"),
        "data": _safe(json.dumps(page_data(shown, options), separators=(",", ":"))),
        "plotly": _safe(plotly),
        "drawn": escape(f"drawn by plotly.js {plotly_version(plotly)}"),
        "script": _safe("\n".join([*map(_text, scripts), _text("begin.js")])),
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], _text("template.html"))


def plotly_version(script: str) -> str:
    """Version of the library that a page holds, from its first lines; "" if they do not say."""
    found = re.search(r"plotly\.js v(\d[\w.-]*)", script[:400])
    return found[1] if found else ""


def plotly_script() -> str:
    """The library that draws, as text.

    Raises
    ------
    ModelError
        It is not installed.
    """
    try:
        from plotly.offline import get_plotlyjs
    except ImportError:
        raise ModelError("viewer", "plotly is not installed", "pip install 'ancf[view]'") from None
    script: str = get_plotlyjs()
    return script


def page_data(shown: Part | Scene, options: Options) -> Plain:
    """What the page's scripts read; what is drawn, and words about it."""
    part = shown if isinstance(shown, Part) else Part(shown)
    numbers = Numbers()
    told = options.about
    made = {
        "scene": plain_scene(part.scene, numbers),
        "traces": [plain_trace(trace, numbers) for trace in part.traces],
        "curves": [plain_curve(curve, numbers) for curve in part.curves],
        "ranges": [plain_range(found, numbers) for found in part.ranges],
        "owners": part.owners or [(0, thread.name) for thread in part.scene.threads],
        "runs": list(options.runs),
        "moves": list(MOVES),
        "color": options.color,
        "looks": _looks(),
        "status": {"text": told.status, "good": told.good},
        "foot": _foot(part.scene, told.file),
    }
    return {**made, "numbers": numbers.text()}


def _looks() -> dict[str, Any]:
    """Colours for the scripts, of a light and a dark page."""
    return {name: _palette(name == "dark") for name in ("light", "dark")}


def _palette(dark: bool) -> dict[str, Any]:
    if dark:
        named, curves, scale = style.DARK, style.DARK_CURVES, style.DARK_SEQUENTIAL
    else:
        named, curves, scale = style.PAGE, tuple(look.color for look in style.LOOKS), style.SEQUENTIAL
    stops = [[k / (len(scale) - 1), color] for k, color in enumerate(scale)]
    return {**named, "curves": list(curves), "scale": stops}


def _variables() -> str:
    """The same for the style sheet."""
    light, dark = (
        " ".join(f"--{name}: {color};" for name, color in named.items()) for named in (style.PAGE, style.DARK)
    )
    return f":root {{ {light} }}\n@media (prefers-color-scheme: dark) {{ :root {{ {dark} }} }}\n"


def _foot(scene: Scene, file: str) -> str:
    count = len(scene.t)
    part = "" if count == scene.stored else f" of {scene.stored}"
    states = f"{count}{part} state{'s' if scene.stored > 1 else ''}"
    return f"{file}: {states}" if file else states


def _text(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def _safe(script: str) -> str:
    """A script that does not end its element early."""
    return re.sub(r"<(?=/script|!--)", r"\\u003c", script, flags=re.IGNORECASE)
