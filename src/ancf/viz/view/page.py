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
from .curve import Curve
from .encode import Numbers, Plain, plain_curve, plain_scene, plain_trace
from .traces import Trace

#: What the threads can be coloured by.
COLORS = (*QUANTITIES, "plain")
#: Scripts in the order in which they need each other.
SCRIPTS = ("data.js", "layers.js", "legend.js", "scene.js", "plots.js", "viewer.js")


@dataclass(frozen=True)
class Options:
    """How the page opens, and what else is on it.

    Parameters
    ----------
    color : "tension", "curvature", "speed" or "plain"
    traces : sequence of Trace
    about : About

    Raises
    ------
    ModelError
        There is no such colour.
    """

    color: str = "tension"
    traces: Sequence[Trace] = ()
    about: About = field(default_factory=About)

    def __post_init__(self) -> None:
        checks.choice(self.color, "view.color", COLORS)


def page(scene: Scene, curves: Sequence[Curve], title: str, options: Options | None = None) -> str:
    """HTML text of the whole page.

    Parameters
    ----------
    scene : Scene
    curves : sequence of Curve
        Time plots; none leaves their side out.
    title : str
    options : Options, optional

    Raises
    ------
    ModelError
        plotly is not installed.
    """
    plotly = plotly_script()
    options = options or Options()
    told = options.about
    shown = {
        "title": escape(title),
        "badge": f'<span class="badge {"good" if told.good else "bad"}">{escape(told.status)}</span>'
        if told.status
        else "",
        "made": escape(told.made),
        "foot": escape(_foot(scene, told.file)),
        "style": _variables() + _text("viewer.css"),
        "data": _safe(json.dumps(_data(scene, curves, options), separators=(",", ":"))),
        "plotly": _safe(plotly),
        "script": _safe("\n".join(_text(name) for name in SCRIPTS)),
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda found: shown[found[1]], _text("template.html"))


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


def _data(scene: Scene, curves: Sequence[Curve], options: Options) -> Plain:
    numbers = Numbers()
    made = {
        "scene": plain_scene(scene, numbers),
        "traces": [plain_trace(trace, numbers) for trace in options.traces],
        "curves": [plain_curve(curve, numbers) for curve in curves],
        "color": options.color,
        "looks": _looks(),
    }
    return {**made, "numbers": numbers.text()}


def _looks() -> dict[str, Any]:
    """Colours for the scripts."""
    scale = style.SEQUENTIAL
    return {
        "blue": style.BLUE,
        "orange": style.ORANGE,
        "green": style.GREEN,
        "grey": style.GREY,
        "light": style.LIGHT,
        "grid": style.GRID,
        "curves": [look.color for look in style.LOOKS],
        "scale": [[k / (len(scale) - 1), color] for k, color in enumerate(scale)],
    }


def _variables() -> str:
    """The same for the style sheet."""
    return (
        f":root {{ --blue: {style.BLUE}; --orange: {style.ORANGE}; --green: {style.GREEN}; "
        f"--grey: {style.GREY}; --light: {style.LIGHT}; }}\n"
    )


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
