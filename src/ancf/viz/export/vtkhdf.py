"""Points that move and cells that stay, in one VTKHDF file of type PolyData with time steps.

The layout is that of VTK's specification of its HDF5 files, version 2: the points and the values of all
steps stand one after the other, cells and constant values once, and the group ``Steps`` holds for each step
where its part begins.  Every reader since VTK 9.3 and ParaView 5.12 knows it.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray

VERSION = (2, 2)
#: Groups of cells, in the order in which the reader numbers them.
TOPOLOGIES = ("Vertices", "Lines", "Polygons", "Strips")


@dataclass(frozen=True)
class Mesh:
    """What does not change with time.

    Parameters
    ----------
    points : int
        Number P of points.
    cells : dict of str to list of (k,)
        Point numbers of each cell, by topology.
    constant : dict of str to (P,)
        Values at the points.
    moving : tuple of str
        Names of the values at the points that change.
    vectors : tuple of str
        Those among them with three components.
    """

    points: int
    cells: dict[str, list[IntArray]]
    constant: dict[str, NDArray[Any]]
    moving: tuple[str, ...]
    vectors: tuple[str, ...] = field(default=())


class TemporalFile:
    """A VTKHDF file that is filled block by block.

    Parameters
    ----------
    path : Path
    mesh : Mesh
    t : (n,) s
    notes : dict
        What the numbers in the file stand for, kept as JSON in the group ``ancf``, which VTK does not read.

    Raises
    ------
    OSError
        The file cannot be written.
    """

    def __init__(self, path: Path, mesh: Mesh, t: FloatArray, notes: dict[str, Any]) -> None:
        self.mesh = mesh
        self._file = h5py.File(path, "w")
        self._root = self._file.create_group("VTKHDF")
        self._root.attrs["Version"] = np.array(VERSION, dtype=np.int64)
        self._root.attrs.create("Type", np.bytes_("PolyData"))
        self._file.create_group("ancf").attrs.update({k: json.dumps(v) for k, v in notes.items()})
        self._create(len(t))
        self._create_steps(t)

    def write(self, first: int, points: FloatArray, values: dict[str, FloatArray]) -> None:
        """Write steps from `first` on: points (k, P, 3) in m, values (k, P) or (k, P, 3)."""
        start = first * self.mesh.points
        rows = slice(start, start + points.shape[0] * self.mesh.points)
        self._root["Points"][rows] = points.reshape(-1, 3)
        for name in self.mesh.moving:
            self._root["PointData"][name][rows] = values[name].reshape(-1, *values[name].shape[2:])

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _create(self, steps: int) -> None:
        """Cells and constant values, and room for the rest."""
        root, mesh = self._root, self.mesh
        root["NumberOfPoints"] = np.array([mesh.points])
        for name in TOPOLOGIES:
            _write_cells(root.create_group(name), mesh.cells.get(name, []))
        rows = steps * mesh.points
        root.create_dataset("Points", (rows, 3), "f8")
        data = root.create_group("PointData")
        for name in mesh.moving:
            data.create_dataset(name, (rows, 3) if name in mesh.vectors else (rows,), "f8")
        for name, values in mesh.constant.items():
            data[name] = values
        root.create_group("CellData")

    def _create_steps(self, t: FloatArray) -> None:
        steps, n = self._root.create_group("Steps"), len(t)
        begin, never = np.arange(n) * self.mesh.points, np.zeros(n, dtype=np.int64)
        steps.attrs["NSteps"] = n
        steps["Values"] = t
        # one part for all steps: VTK 9.3 looks for the cells of a later part behind those of the first
        steps["PartOffsets"], steps["NumberOfParts"] = never, np.ones(n, dtype=np.int64)
        steps["PointOffsets"] = begin
        for name in ("CellOffsets", "ConnectivityIdOffsets"):
            steps[name] = np.zeros((n, len(TOPOLOGIES)), dtype=np.int64)
        offsets = steps.create_group("PointDataOffsets")
        for name in (*self.mesh.moving, *self.mesh.constant):
            offsets[name] = begin if name in self.mesh.moving else never
        steps.create_group("CellDataOffsets")


def _write_cells(group: Any, cells: list[IntArray]) -> None:
    """Cells of one topology."""
    ends = np.cumsum([0, *map(len, cells)], dtype=np.int64)
    group["Connectivity"] = np.concatenate([np.zeros(0, dtype=np.int64), *cells])
    group["Offsets"] = ends
    group["NumberOfCells"] = np.array([len(cells)])
    group["NumberOfConnectivityIds"] = np.array([ends[-1]])
