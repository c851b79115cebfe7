"""Results for other programs: VTKHDF for ParaView, CSV tables, Parquet tables by the extra ``data``."""

from .csv_files import write_csv
from .parquet_files import write_parquet
from .polydata import write_vtk
from .workbook import write_xlsx

__all__ = ["write_csv", "write_parquet", "write_vtk", "write_xlsx"]
