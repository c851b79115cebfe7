"""Surfaces given by triangles: closed meshes, also from STL files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...errors import ModelError
from ...reading import as_input
from .. import checks
from .shape import AT, Parameter, Shape

#: Of the size of a mesh: corners of an STL file that are as near are one.
SAME = 1e-7
#: Of the size: twice the height of a triangle without area.
FLAT = 1e-12
#: Distance of a point from the origin of its mesh at which round-off reaches a tenth of a millimetre, m.
FURTHEST = 1e11
#: Bytes before the triangles of a binary STL file, and of a triangle: twelve numbers and two bytes.
HEAD, RECORD = 84, np.dtype([("numbers", "<f4", (4, 3)), ("more", "<u2")])


@dataclass(frozen=True, eq=False)
class Mesh(Shape):
    """A closed surface of triangles.

    Parameters
    ----------
    file : path, optional
        STL, binary or text.
    points : (n, 3), optional
        Instead of a file.
    triangles : (m, 3) of int, optional
        Rows of `points`, counter-clockwise seen from outside, or all the other way round.
    scale : float
        Metres of a unit of the file or of `points`: 1e-3 for millimetres.
    at : (3,) m
        Where the origin of the file lies; on a rigid body in body axes from the centre of mass.
    """

    file: Any = None
    points: Any = None
    triangles: Any = None
    scale: Any = 1.0
    at: Any = (0.0, 0.0, 0.0)

    parameters = (
        Parameter("file", "path", "-", "STL file, binary or text"),
        Parameter("points", "points", "in units of scale", "Corners, instead of a file"),
        Parameter("triangles", "triangles", "-", "Rows of points, counter-clockwise seen from outside"),
        Parameter("scale", "positive", "m", "Metres of a unit of the file or of points"),
        AT,
    )

    def check(self) -> None:
        """Read the file; the mesh is closed, and its triangles look outwards."""
        if (self.file is None) == (self.points is None):
            raise ModelError("Mesh.file", "give either file, or points and triangles")
        if self.file is not None:
            points, triangles = _merged(read_stl(Path(self.file)))
        elif self.triangles is None:
            raise ModelError("Mesh.triangles", "is missing")
        else:
            points, triangles = self.points, self.triangles
            outside = (triangles < 0) | (triangles >= len(points))
            if np.any(outside):
                k = int(np.flatnonzero(outside.any(axis=1))[0])
                raise ModelError(f"Mesh.triangles[{k}]", f"names a point that is none of the {len(points)}")
        points = points * checks.positive(self.scale, "Mesh.scale")
        furthest = float(np.max(np.abs(points)))
        if furthest > FURTHEST:
            what = f"has points {furthest:.3g} m away: distances from it are not known to 0.1 mm"
            raise ModelError("Mesh.scale", what, f"within {FURTHEST:g} m; 1e-3 for a file in millimetres")
        corners = points[triangles]
        double = np.linalg.norm(
            np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
        )
        size = float(np.max(np.ptp(points, axis=0)))
        if np.any(double <= FLAT * size**2):
            k = int(np.argmin(double))
            raise ModelError(f"Mesh.triangles[{k}]", "has no area", "repair the mesh where it was made")
        _check_closed(points, triangles)
        volume = float(np.sum(corners[:, 0] * np.cross(corners[:, 1], corners[:, 2]))) / 6.0
        if volume < 0.0:
            triangles = triangles[:, ::-1].copy()
        for key, value in (("file", None), ("points", points), ("triangles", triangles), ("scale", 1.0)):
            object.__setattr__(self, key, value)

    @property
    def corners(self) -> FloatArray:
        """Of all triangles, (m, 3, 3) m from `at`."""
        found: FloatArray = self.points[self.triangles]
        return found

    @property
    def narrowest(self) -> float:
        """The least extent of all three."""
        return float(np.min(np.ptp(self.points, axis=0)))

    @property
    def lines(self) -> FloatArray:
        """Edges (k, 2, 3) m from `at`, as a picture draws them."""
        ends = np.sort(
            np.concatenate([self.triangles[:, [0, 1]], self.triangles[:, [1, 2]], self.triangles[:, [2, 0]]])
        )
        found: FloatArray = self.points[np.unique(ends, axis=0)]
        return found


def _check_closed(points: FloatArray, triangles: NDArray[np.int64]) -> None:
    """Each edge belongs to two triangles, which run along it in opposite directions."""
    ways = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, first, count = np.unique(ways, axis=0, return_index=True, return_counts=True)
    edges, met = np.unique(np.sort(ways, axis=1), axis=0, return_counts=True)
    hint = "close its holes, and let all triangles look the same way, in the program that made it"
    if np.any(met != 2):
        bad = int(np.flatnonzero(met != 2)[0])
        where = 0.5 * (points[edges[bad, 0]] + points[edges[bad, 1]])
        what = f"is not closed: {int(np.sum(met == 1))} edges have one triangle"
        if not np.any(met == 1):
            what = f"branches: {int(np.sum(met > 2))} edges have more than two triangles"
        raise ModelError("Mesh", f"{what}, such as that at {np.round(where, 9).tolist()} m", hint)
    if np.any(count > 1):
        a, b = ways[first[int(np.flatnonzero(count > 1)[0])]]
        where = 0.5 * (points[a] + points[b])
        what = f"has triangles that look inwards and others outwards, as at {np.round(where, 9).tolist()} m"
        raise ModelError("Mesh", what, hint)


def _merged(corners: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
    """Points and triangles of corners (m, 3, 3), those in one place merged."""
    from scipy.spatial import cKDTree

    flat = corners.reshape(-1, 3)
    size = float(np.max(np.ptp(flat, axis=0)))
    least = np.arange(len(flat))
    pairs = cKDTree(flat).query_pairs(SAME * size, output_type="ndarray")
    np.minimum.at(least, pairs.max(axis=1), pairs.min(axis=1))
    kept, index = np.unique(least, return_inverse=True)
    return flat[kept], index.reshape(-1, 3).astype(np.int64)


def read_stl(path: Path) -> FloatArray:
    """Corners (m, 3, 3) of the triangles of an STL file, binary or text.

    Raises
    ------
    ModelError
        It cannot be read, or holds no triangles.
    """
    try:
        data = as_input(path).read_bytes()
    except OSError as error:
        raise ModelError("Mesh.file", f'"{path}" cannot be read: {error.strerror}') from None
    count = int.from_bytes(data[80:HEAD], "little") if len(data) >= HEAD else -1
    if count >= 0 and len(data) == HEAD + count * RECORD.itemsize:
        found = np.frombuffer(data, RECORD, offset=HEAD)["numbers"][:, 1:].astype(np.float64)
    else:
        words = [word for line in data.lower().splitlines() if not _is_name(line) for word in line.split()]
        at = [k for k, word in enumerate(words) if word == b"vertex"]
        there = (len(data) - HEAD) // RECORD.itemsize
        if not at and count > there:
            what = f"{count} triangles are announced, and there are bytes for {there}"
            raise ModelError("Mesh.file", f'"{path}" is cut off, or no STL file: {what}')
        try:
            found = np.array([[float(x) for x in words[k + 1 : k + 4]] for k in at], dtype=np.float64)
            found = found.reshape(-1, 3, 3)
        except ValueError:
            raise ModelError("Mesh.file", f'"{path}" is no STL file, or is cut off') from None
    if not len(found) or not np.all(np.isfinite(found)):
        raise ModelError("Mesh.file", f'"{path}" holds no triangles, or numbers that are not finite')
    return found


def _is_name(line: bytes) -> bool:
    """Whether a line of a text file names a solid, with any words whatever."""
    start = line.split(maxsplit=1)[:1]
    return start in ([b"solid"], [b"endsolid"]) and b"facet normal" not in line
