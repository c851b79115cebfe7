"""Results for other programs: VTKHDF for ParaView, CSV tables. Needs no extra."""

from .csv_files import write_csv
from .polydata import write_vtk

__all__ = ["write_csv", "write_vtk"]
