"""Several runs as one scene: what belongs to each keeps its name behind that of the run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...results.result import Result
from ..scene import Scene, chosen_times
from .curve import Curve
from .ranges import Range
from .traces import Trace

#: Runs on a page at most: as many as there are colours that one can tell apart.
MOST = 6
Named = TypeVar("Named", bound=Any)


@dataclass(frozen=True, slots=True)
class Part:
    """What a run shows, or what several do, at the same times.

    Parameters
    ----------
    scene : Scene
    traces : sequence of Trace
    curves : sequence of Curve
    ranges : sequence of Range
        For each thread of the scene, or none.
    owners : sequence of (int, str)
        For each thread of the scene of which run it is and of which body.
    """

    scene: Scene
    traces: Sequence[Trace] = ()
    curves: Sequence[Curve] = ()
    ranges: Sequence[Range] = ()
    owners: Sequence[tuple[int, str]] = ()


def labels_of(paths: Sequence[Path]) -> list[str]:
    """Short names of results files: what tells their paths apart."""
    parts = [path.resolve().with_suffix("").parts for path in paths]
    if len(paths) == 1 or len(set(parts)) < len(parts):
        return [f"run {k + 1}" for k in range(len(paths))]
    least = min(map(len, parts))
    first = next((k for k in range(least) if len({p[k] for p in parts}) > 1), least - 1)
    back = next((k for k in range(1, least) if len({p[-k] for p in parts}) > 1), 1) - 1
    cut = [p[first : len(p) - back] for p in parts]
    return ["/".join(c or p[-1:]) for c, p in zip(cut, parts, strict=True)]


def common_times(sources: Iterable[Any], frames: int, start: float | None, end: float | None) -> FloatArray:
    """Times of the run that lasts longest, of which all are drawn."""
    longest = max((source.t for source in sources), key=lambda t: float(t[-1] - t[0]))
    times: FloatArray = longest[chosen_times(longest, frames, start, end)]
    return times


def checked(sources: Mapping[str, Any]) -> None:
    """Refuse what cannot stand beside other runs.

    Raises
    ------
    ModelError
        There are none or too many, or one is no Result with states.
    """
    if not 1 <= len(sources) <= MOST:
        raise ModelError("view", f"shows 1 to {MOST} runs on a page, is given {len(sources)}")
    for label, source in sources.items():
        if not isinstance(source, Result):
            raise ModelError(f'view "{label}"', "is no Result, and only results are compared")
        if len(source.t) == 0:
            raise ModelError(f'view "{label}"', "no state was stored, so there is nothing to show")


def joined(parts: Mapping[str, Part]) -> Part:
    """One scene, one list of traces, curves and extremes of all runs."""
    scenes = {label: _of_run(part.scene, label) for label, part in parts.items()}
    first = next(iter(scenes.values()))
    nets = [net for scene in scenes.values() for net in scene.nets]
    scene = Scene(
        title=" and ".join(dict.fromkeys(part.scene.title for part in parts.values() if part.scene.title)),
        t=first.t,
        stored=max(scene.stored for scene in scenes.values()),
        nets=[net for k, net in enumerate(nets) if not any(_same(net, other) for other in nets[:k])],
        **{
            name: [item for scene in scenes.values() for item in getattr(scene, name)]
            for name in ("threads", "links", "markers", "triads", "strips", "arrows", "combs")
        },
    )
    owners = [(k, thread.name) for k, part in enumerate(parts.values()) for thread in part.scene.threads]
    return Part(
        scene,
        [item for label, part in parts.items() for item in _renamed(part.traces, label)],
        [replace(curve, run=k) for k, part in enumerate(parts.values()) for curve in part.curves],
        [item for label, part in parts.items() for item in _renamed(part.ranges, label)],
        owners,
    )


def _of_run(scene: Scene, label: str) -> Scene:
    lists = ("threads", "links", "markers", "triads", "strips", "arrows", "combs")
    nets = [replace(net, name=f"{label}: {net.name}", on=f"{label}: {net.on}") if net.on else net
            for net in scene.nets]  # fmt: skip
    changes: dict[str, Any] = {name: _renamed(getattr(scene, name), label) for name in lists}
    return replace(scene, nets=nets, **changes)


def _renamed(items: Iterable[Named], label: str) -> list[Named]:
    return [replace(item, name=f"{label}: {item.name}") for item in items]


def _same(net: Any, other: Any) -> bool:
    """Whether two nets at rest are one: the ground that all runs share."""
    return not net.on and not other.on and np.array_equal(net.lines, other.lines)
