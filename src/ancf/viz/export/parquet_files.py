"""A result as Parquet tables, for pandas, DuckDB, Spark and spreadsheets that read them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...files import drafted, writing
from ...results.result import Result
from .csv_files import all_tables
from .frames import library
from .tables import Column


def write_parquet(result: Result, folder: str | Path, points: Sequence[str] | None = None) -> list[Path]:
    """Write the tables of :func:`ancf.viz.export.write_csv` as Parquet files, with the same columns.

    Raises
    ------
    ModelError
        As of ``write_csv``; pandas or pyarrow is missing.
    """
    library("pyarrow", "write_parquet")
    place, found = all_tables(result, folder, points, "write_parquet")
    with writing(place, place):
        return [_write(place / f"{name}.parquet", columns) for name, columns in found]


def _write(path: Path, columns: list[Column]) -> Path:
    frame = library("pandas", "write_parquet").DataFrame(dict(columns))
    with drafted(path) as draft:
        frame.to_parquet(draft, engine="pyarrow", index=False)
    return path
