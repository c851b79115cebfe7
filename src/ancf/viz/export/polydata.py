"""A result as a moving mesh for ParaView: one VTKHDF file."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import ModelError
from ...files import drafted, writing
from ...model import checks
from ...model.bodies.beam import Beam
from ...results.modes import Modes
from ..scene import QUANTITIES, Scene, make_scene
from ..scene.sampling import CORNERS
from .parts import Part, part_kinds, parts
from .vtkhdf import TOPOLOGIES, Mesh, TemporalFile

SUFFIXES = (".vtkhdf", ".hdf")
#: Points along the centrelines, and of all times together, at most: the latter are 72 MB.
POINTS, TOTAL = 4000, 1_000_000
#: Numbers that are put together in memory at once.
BLOCK = 1_000_000
FRAMES_OF_A_MODE = 60
#: Values that change with time, and the one with three components.
MOVING, DISPLACEMENT = (*QUANTITIES, "force", "slack"), "displacement"
UNITS = {**QUANTITIES, "force": "N", "slack": "1 or 0", DISPLACEMENT: "m", "s": "m"}


def write_vtk(
    source: Any,
    path: str | Path,
    frames: int | None = None,
    *,
    points: int | None = None,
    start: float | None = None,
    end: float | None = None,
    mode: int = 0,
) -> Path:
    """Write a result as one VTKHDF file with time steps, which ParaView 5.12 or later plays.

    Points carry ``tension`` in N, ``curvature`` in 1/m, ``speed`` in m/s and arc length ``s`` in m on beams
    and cables, ``force`` in N and ``slack`` (1 or 0) on springs, and ``displacement`` in m since the first of
    the times. A value that does not apply is NaN. The numbers ``kind`` and ``part`` tell things apart; their
    names stand in the attributes ``kinds`` and ``parts`` of the group ``ancf``.

    Parameters
    ----------
    source : Result, State or Modes
    path : path
        Ends in ``.vtkhdf``.
    frames : int, optional
        At most so many stored states, evenly spaced in time; default all, of a mode 60.
    points : int, optional
        About so many points on all centrelines together; default up to 4000, fewer when there are many
        states, but all nodes.
    start, end : float, s
        Times between which states are taken; default all.
    mode : int
        Of Modes: which one, from 0.

    Returns
    -------
    Path

    Raises
    ------
    ModelError
        The file has another suffix or cannot be written, or nothing was stored.
    """
    file = _checked(path)
    count = _count(source, frames)
    wanted = _points(source, count) if points is None else points
    return write_scene(make_scene(source, frames=count, points=wanted, start=start, end=end, mode=mode), file)


def write_scene(scene: Scene, path: Path) -> Path:
    """Write a scene; see :func:`write_vtk`."""
    items = list(parts(scene))
    mesh, notes = _mesh(items), {"title": scene.title, **_names(items)}
    first, size = _points_of(items, slice(0, 1)), max(1, BLOCK // sum(p.points.shape[1] for p in items))
    with (
        writing(path),
        drafted(path) as draft,
        closing(TemporalFile(draft, mesh, scene.t, notes)) as file,
    ):
        for k in range(0, len(scene.t), size):
            rows = slice(k, k + size)
            moved = _points_of(items, rows)
            values = {name: _values_of(items, name, rows) for name in mesh.moving if name != DISPLACEMENT}
            file.write(k, moved, {**values, DISPLACEMENT: moved - first})
    return path


def _mesh(items: Sequence[Part]) -> Mesh:
    """Cells with the numbers of the points in the file, and what is constant at them."""
    counts = [part.points.shape[1] for part in items]
    begins = np.cumsum([0, *counts])
    cells: dict[str, list[IntArray]] = {name: [] for name in TOPOLOGIES}
    for part, begin in zip(items, begins.tolist(), strict=False):
        for name, own in part.cells.items():
            cells[name] += [begin + cell for cell in own]
    present = [name for name in MOVING if any(name in part.values for part in items)]
    moving = (*present, DISPLACEMENT)
    return Mesh(int(begins[-1]), cells, _constant(items, counts), moving, (DISPLACEMENT,))


def _constant(items: Sequence[Part], counts: Sequence[int]) -> dict[str, Any]:
    numbers = {name: k for k, name in enumerate(_names(items)["parts"])}
    unknown = np.full(max(counts), np.nan)
    kinds = part_kinds()
    return {
        "kind": np.repeat([kinds.index(part.kind) for part in items], counts).astype(np.int32),
        "part": np.repeat([numbers[part.name] for part in items], counts).astype(np.int32),
        "s": np.concatenate(
            [unknown[:m] if part.s is None else part.s for part, m in zip(items, counts, strict=True)]
        ),
    }


def _names(items: Sequence[Part]) -> dict[str, Any]:
    """What the numbers and names in the file stand for."""
    return {"kinds": part_kinds(), "parts": list(dict.fromkeys(part.name for part in items)), "units": UNITS}


def _points_of(items: Sequence[Part], rows: slice) -> FloatArray:
    """Points (k, P, 3) of all parts at some times."""
    return np.concatenate([part.points[rows] for part in items], axis=1)


def _values_of(items: Sequence[Part], name: str, rows: slice) -> FloatArray:
    """Values (k, P) of all parts at some times; NaN where they do not apply."""
    return np.concatenate(
        [part.values[name][rows] if name in part.values else _nothing(part.points[rows]) for part in items],
        axis=1,
    )


def _nothing(points: FloatArray) -> FloatArray:
    return np.full(points.shape[:2], np.nan)


def _count(source: Any, frames: int | None) -> int:
    """Number of times that are wanted at most."""
    if frames is not None:
        return checks.integer(frames, "write_vtk.frames", 1, 1_000_000)
    return FRAMES_OF_A_MODE if isinstance(source, Modes) else max(1, int(np.size(getattr(source, "t", 0.0))))


def _points(source: Any, count: int) -> int:
    """Number of points along the centrelines: all nodes, more as long as the file stays small."""
    known = getattr(source, "about", source)
    beams = [body for body in getattr(known, "bodies", {}).values() if isinstance(body, Beam)]
    solid = any(beam.has_section for beam in beams)
    most = min(POINTS, TOTAL // (count * (1 + CORNERS * solid)))
    return max(2, most, sum(beam.elements for beam in beams))


def _checked(path: str | Path) -> Path:
    if not isinstance(path, str | Path):
        raise ModelError("write_vtk.path", f"must be a path, is {checks.shown(path)}")
    if Path(path).suffix.lower() not in SUFFIXES:
        raise ModelError(str(path), "has a suffix that ParaView does not know", "end it in .vtkhdf")
    return Path(path)
