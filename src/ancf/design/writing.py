"""The files of a study: table.csv, table.parquet, study.json and report.html."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._version import __version__
from ..files import cell, drafted, to_json, writing
from .extras import extra
from .finished import finished
from .sampling import DESIGN

if TYPE_CHECKING:
    from pandas import DataFrame

PACKAGES = ("numpy", "scipy", "numba", "pandas", "SALib")


def write_all(folder: Path, table: DataFrame, about: dict[str, Any], report: bool) -> None:
    """Write all files of a study into its folder, unless they are there as they would be written now.

    ``study.json``, which is the last, is there when all are.

    Raises
    ------
    ModelError
        A file cannot be written, or matplotlib is missing for the report.
    """
    if _written(folder, about, report):
        return
    (folder / "study.json").unlink(missing_ok=True)
    from .statistics import summary

    design = table.attrs.get(DESIGN)
    found = summary(table, design)
    with writing(folder / "table.csv"):
        with drafted(folder / "table.csv") as draft:
            _plain(table).to_csv(draft, lineterminator="\n")
        with drafted(folder / "table.parquet") as draft:
            extra("pyarrow")
            _without_attributes(table).to_parquet(draft)
    if report:
        from .report import write_report

        write_report(folder / "report.html", table, found, {**about, "design": design})
    with writing(folder / "study.json"), drafted(folder / "study.json") as draft:
        text = to_json({**_about(table, design, about), "statistics": found}, indent=2)
        draft.write_text(text, encoding="utf-8", errors="backslashreplace")


def _written(folder: Path, about: dict[str, Any], report: bool) -> bool:
    """Whether the files are there and of this table."""
    then = finished(folder, about["files"], report) or {}
    return all(then.get(key) == about[key] for key in ("stamp", "title"))


def _about(table: DataFrame, design: Any, about: dict[str, Any]) -> dict[str, Any]:
    failed = int((table["status"] == "failed").sum())
    return {
        **about,
        "design": design,
        "cases": len(table),
        "failed": failed,
        **_first(table, "failed", table["status"] == "failed"),
        **_first(table, "noted", (table["status"] == "ok") & (table["message"] != "")),
        "parameters": table.attrs["parameters"],
        "outputs": table.attrs["outputs"],
        "versions": {"ancf": __version__, **{name: _version(name) for name in PACKAGES}},
    }


def _first(table: DataFrame, said: str, rows: Any) -> dict[str, Any]:
    """The first case of some, and its message."""
    found = table[rows]
    if not len(found):
        return {}
    return {f"first_{said}": {"case": int(found.index[0]), "message": str(found["message"].iloc[0])}}


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _plain(table: DataFrame) -> DataFrame:
    """Texts that a spreadsheet would compute are spelt out."""
    texts = [name for name in table.columns if table[name].dtype.kind not in "iufb"]
    return table.assign(**{name: table[name].map(cell) for name in texts})


def _without_attributes(table: DataFrame) -> DataFrame:
    made = table.copy()
    made.attrs = {}
    return made
