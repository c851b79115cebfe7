"""A scene as parts of a polygonal mesh: points that move, cells between them, values at the points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ...arrays import FloatArray, IntArray
from ...model.elements import KINDS
from ...model.kinds import pushing
from ..scene import Arrow, Link, Marker, Scene, Strip, Thread, Triad, looks


def part_kinds() -> tuple[str, ...]:
    """Kinds of parts; the array ``kind`` holds the number of one of these."""
    return (*KINDS, "surface", "spring", "strip", "axes", *looks(), *pushing())


@dataclass(frozen=True)
class Part:
    """One thing of a scene.

    Parameters
    ----------
    name : str
        Of the beam, body, spring, support, joint or contact.
    kind : str
        One of ``part_kinds()``.
    points : (n, m, 3) m
    cells : dict of str to list of (k,)
        Numbers of points in this part, by topology of VTK.
    values : dict of str to (n, m)
    s : (m,) m, optional
        Reference arc lengths.
    """

    name: str
    kind: str
    points: FloatArray
    cells: dict[str, list[IntArray]]
    values: dict[str, FloatArray] = field(default_factory=dict)
    s: FloatArray | None = None


def parts(scene: Scene) -> Iterator[Part]:
    """All parts: lines, surfaces and vertices."""
    for thread in scene.threads:
        yield _line(thread)
        if thread.outline is not None:
            yield _surface(thread, thread.outline)
    yield from map(_spring, scene.links)
    yield from map(_strip, scene.strips)
    yield from map(_axes, scene.triads)
    yield from map(_vertex, scene.markers)
    yield from map(_arrows, scene.arrows)


def _line(thread: Thread) -> Part:
    cells = {"Lines": [np.arange(len(thread.x))]}
    return Part(thread.name, thread.element, thread.position, cells, thread.values, thread.x)


def _surface(thread: Thread, outline: FloatArray) -> Part:
    """Sides as quadrilaterals and two ends; all corners of a section have the values of its centre."""
    n, m, corners = outline.shape[:3]
    at = np.arange(m * corners).reshape(m, corners)
    after = np.roll(at, -1, axis=1)
    sides = np.stack([at[:-1], after[:-1], after[1:], at[1:]], axis=-1).reshape(-1, 4)
    cells = {"Polygons": [*sides, at[0, ::-1], at[-1]]}
    values = {name: np.repeat(value, corners, axis=1) for name, value in thread.values.items()}
    points = outline.reshape(n, m * corners, 3)
    return Part(thread.name, "surface", points, cells, values, np.repeat(thread.x, corners))


def _spring(link: Link) -> Part:
    values = {"force": _at_both(link.force), "slack": _at_both(link.slack.astype(np.float64))}
    return Part(link.name, "spring", link.ends, {"Lines": [np.arange(2)]}, values)


def _strip(strip: Strip) -> Part:
    values = {} if strip.force is None else {"force": _at_both(strip.force)}
    return Part(strip.name, "strip", strip.ends, {"Lines": [np.arange(2)]}, values)


def _axes(triad: Triad) -> Part:
    """Three lines from the centre."""
    tips = triad.centre[:, None] + triad.size * np.swapaxes(triad.axes, 1, 2)
    points = np.concatenate([triad.centre[:, None], tips], axis=1)
    return Part(triad.name, "axes", points, {"Lines": [np.array([0, k]) for k in (1, 2, 3)]})


def _arrows(arrow: Arrow) -> Part:
    """A line each, from tail to tip."""
    n, k = arrow.ends.shape[:2]
    cells = {"Lines": list(np.arange(2 * k).reshape(k, 2))}
    return Part(arrow.name, arrow.kind, arrow.ends.reshape(n, 2 * k, 3), cells)


def _vertex(marker: Marker) -> Part:
    return Part(marker.name, marker.kind, marker.position[:, None], {"Vertices": [np.arange(1)]})


def _at_both(values: FloatArray) -> FloatArray:
    """Values (n,) of a line at its two points."""
    return np.repeat(values[:, None], 2, axis=1)
