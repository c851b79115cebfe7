"""A scene, traces and curves as plain data for the page: names, and numbers in one text of base64."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...model.kinds import by_word, pushing
from ..scene import QUANTITIES, Comb, Net, Scene, Thread, looks
from .curve import Curve
from .ranges import Range
from .traces import Trace

#: Colours run over these quantiles when the extremes are this many times farther apart.
QUANTILES, FAR = (0.005, 0.995), 3.0
#: Supports that may move with a mass.
GUIDES = ("pin", "hold")
Plain = dict[str, Any]


class Numbers:
    """Arrays one after the other: 32-bit numbers, or 16-bit shares of a range.

    What is at rest, and an array that is given again, is kept once.
    """

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0
        self._known: dict[int, tuple[Any, Plain]] = {}

    def floats(self, values: NDArray[Any]) -> Plain:
        """Place and shape of an array with time first; a single row if all rows are the same."""
        known = self._known.get(id(values))
        if known is None:
            rows = np.asarray(values, dtype="<f4")
            kept = rows[:1] if rows.ndim > 1 and _at_rest(rows) else rows
            known = self._known[id(values)] = (values, self._add(kept, {"kind": "f4"}))
        return known[1]

    def shares(self, values: NDArray[Any]) -> Plain:
        """The same in steps of 1/65535 of the array's own range, for what is seen and not measured."""
        low, high = float(values.min()), float(values.max())
        shares = np.round((values - low) * (65535.0 / ((high - low) or 1.0))).astype("<u2")
        return self._add(shares, {"kind": "u2", "low": low, "high": high})

    def _add(self, values: NDArray[Any], plain: Plain) -> Plain:
        data = values.tobytes()
        data += bytes(-len(data) % 4)
        found = {"at": self._size, "shape": list(values.shape), **plain}
        self._parts.append(data)
        self._size += len(data)
        return found

    def text(self) -> str:
        """All of them."""
        return base64.b64encode(b"".join(self._parts)).decode("ascii")


def plain_scene(scene: Scene, numbers: Numbers) -> Plain:
    """The scene; what is alike is put together, time first: (n, count, ...)."""
    links = scene.links
    return {
        "t": numbers.floats(scene.t),
        "box": _box(scene).tolist(),
        "quantities": quantities(scene),
        "threads": [_thread(thread, numbers) for thread in scene.threads],
        "links": _stacked(
            numbers,
            names=[link.name for link in links],
            ends=[link.ends for link in links],
            force=[link.force for link in links],
            slack=[link.slack for link in links],
        ),
        "markers": _markers(scene, numbers),
        "triads": _stacked(
            numbers,
            names=[triad.name for triad in scene.triads],
            centre=[triad.centre for triad in scene.triads],
            axes=[triad.size * triad.axes for triad in scene.triads],
        ),
        "strips": _stacked(
            numbers,
            names=[strip.name for strip in scene.strips],
            ends=[strip.ends for strip in scene.strips],
            force=[_known(strip.force, scene.t) for strip in scene.strips],
        ),
        "arrows": _arrows(scene, numbers),
        "combs": [_comb(comb, numbers) for comb in scene.combs],
        "nets": [_net(net, scene, numbers) for net in scene.nets],
    }


def _comb(comb: Comb, numbers: Numbers) -> Plain:
    """Contact forces of a beam, time first: (n, count, ...)."""
    shares = {key: numbers.shares(getattr(comb, key)) for key in ("force", "slide")}
    return {
        "name": comb.name,
        "ends": numbers.shares(comb.ends),
        "slips": None if comb.slips is None else numbers.shares(comb.slips.astype(np.float64)),
        **shares,
    }


def _net(net: Net, scene: Scene, numbers: Numbers) -> Plain:
    """Lines; of one on a rigid body in units of the axes that are drawn of it, and which they are.

    A surface with waves has the heights of its points at each time.
    """
    plain = {"name": net.name, "kind": net.kind, "lines": net.lines.tolist(), "on": -1}
    if net.on:
        k = [triad.name for triad in scene.triads].index(net.on)
        plain |= {"on": k, "lines": (net.lines / scene.triads[k].size).tolist()}
    if net.heights is not None:
        plain["heights"] = numbers.shares(net.heights)
    return plain


def _corners(net: Net, scene: Scene) -> FloatArray:
    """Points that hold a net, of one on a rigid body wherever that gets."""
    if not net.on:
        return _held_by(net)
    triad = next(triad for triad in scene.triads if triad.name == net.on)
    reach = float(np.max(np.linalg.norm(net.lines, axis=-1)))
    return np.concatenate([triad.centre - reach, triad.centre + reach])


def _held_by(net: Net) -> FloatArray:
    """Points of a net at rest, with waves at their lowest and highest."""
    points = net.lines.reshape(-1, 3)
    if net.heights is None:
        return points
    ends = (net.heights.min(axis=0).ravel(), net.heights.max(axis=0).ravel())
    return np.concatenate([np.column_stack([points[:, :2], z]) for z in ends])


def _box(scene: Scene) -> FloatArray:
    """Of all that is drawn, nets included."""
    corners = np.concatenate([scene.box, *(_corners(net, scene) for net in scene.nets)])
    return np.stack([corners.min(axis=0), corners.max(axis=0)])


def quantities(scene: Scene) -> list[Plain]:
    """Quantities that all threads know, with the limits of their colours over the whole run."""
    found = []
    for name, unit in QUANTITIES.items():
        if scene.threads and all(name in thread.values for thread in scene.threads):
            low, high, clipped = color_limits([thread.values[name] for thread in scene.threads])
            found.append({"name": name, "unit": unit, "low": low, "high": high, "clipped": clipped})
    return found


def color_limits(values: Sequence[FloatArray]) -> tuple[float, float, bool]:
    """Limits of a colour scale, and whether rare values lie outside them."""
    flat = np.concatenate([v.ravel() for v in values])
    low, high = float(flat.min()), float(flat.max())
    inner = np.quantile(flat, QUANTILES)
    if high - low > FAR * (inner[1] - inner[0]) > 0.0:
        return float(inner[0]), float(inner[1]), True
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        high = low + (1e-3 * abs(low) or 1.0)
    return low, high, False


def plain_trace(trace: Trace, numbers: Numbers) -> Plain:
    """A trace."""
    return {"name": trace.name, "t": numbers.floats(trace.t), "position": numbers.floats(trace.position)}


def plain_curve(curve: Curve, numbers: Numbers) -> Plain:
    """A curve."""
    pair = {"t": numbers.floats(curve.t), "values": numbers.floats(curve.values)}
    return {
        "name": curve.name,
        "unit": curve.unit,
        "panel": curve.panel,
        "run": curve.run,
        **pair,
        "scale": curve.scale,
    }


def plain_range(found: Range, numbers: Numbers) -> Plain:
    """Extremes along a body."""
    values = {name: numbers.floats(both) for name, both in found.values.items()}
    return {"x": numbers.floats(found.x), "values": values, "states": found.states}


def _known(force: FloatArray | None, t: FloatArray) -> FloatArray:
    """The force of a strip, or what stands for an unknown one."""
    return np.full(t.shape, np.nan) if force is None else force


def _at_rest(rows: NDArray[Any]) -> bool:
    return np.array_equal(rows, np.broadcast_to(rows[0], rows.shape), equal_nan=True)


def _thread(thread: Thread, numbers: Numbers) -> Plain:
    found = {
        "name": thread.name,
        "element": thread.element,
        "x": numbers.floats(thread.x),
        "position": numbers.floats(thread.position),
        "values": {name: numbers.shares(thread.values[name]) for name in QUANTITIES if name in thread.values},
    }
    if thread.outline is not None:
        # from the centreline, so that 16 bits are fine enough
        found["outline"] = numbers.shares(thread.outline - thread.position[:, :, None])
    return found


def _markers(scene: Scene, numbers: Numbers) -> list[Plain]:
    """Markers by kind, in the order of the legend; what only guides a moving mass would hide it."""
    ways = [m.position for m in scene.markers if m.kind == "point mass" and not _at_rest(m.position)]
    seen = [m for m in scene.markers if m.kind not in GUIDES or not _among(m.position, ways)]
    found = []
    for kind, look in looks().items():
        mine = [m for m in seen if m.kind == kind]
        stacked = _stacked(numbers, [m.name for m in mine], position=[m.position for m in mine])
        if stacked is not None:
            joint = kind in by_word("connections")
            found.append({"kind": kind, "joint": joint, "shape": look.shape, "fill": look.fill, **stacked})
    return found


def _arrows(scene: Scene, numbers: Numbers) -> list[Plain]:
    """Loads by kind; a row of arrows has one name."""
    found = []
    for kind, push in pushing().items():
        mine = [arrow for arrow in scene.arrows if arrow.kind == kind]
        if mine:
            ends = numbers.floats(np.concatenate([arrow.ends for arrow in mine], axis=1))
            size = numbers.floats(np.stack([arrow.size for arrow in mine], axis=1))
            count = [arrow.ends.shape[1] for arrow in mine]
            look = {"kind": kind, "unit": push.unit, "turns": push.turns, "head": mine[0].head}
            names = [arrow.name for arrow in mine]
            found.append({**look, "names": names, "count": count, "ends": ends, "size": size})
    return found


def _among(position: FloatArray, others: Sequence[FloatArray]) -> bool:
    return any(np.array_equal(position, other) for other in others)


def _stacked(numbers: Numbers, names: list[str], **columns: list[NDArray[Any]]) -> Plain | None:
    """Histories (n, ...) of several things as one (n, count, ...); None if there is none."""
    if not names:
        return None
    stacked = {key: numbers.floats(np.stack(parts, axis=1)) for key, parts in columns.items()}
    return {"names": names, **stacked}
