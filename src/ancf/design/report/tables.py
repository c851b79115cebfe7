"""The tables of the report."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ...viz.html import pairs, table
from ..statistics import label_of, labelled, outputs_of, parameters_of

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from pandas import DataFrame

HEADS = {
    "saltelli": (
        "parameter",
        "first order S1",
        "± (95 %)",
        "total ST",
        "± (95 %)",
    ),
    "morris": ("parameter", "mean effect µ", "mean size µ*", "± (95 %)", "deviation σ"),
}
#: Parameters in tables of cases.
MOST_PARAMETERS = 6
KEYS = {"saltelli": ("S1", "S1_conf", "ST", "ST_conf"), "morris": ("mu", "mu_star", "mu_star_conf", "sigma")}


def number(value: Any) -> str:
    """A number as tables show it."""
    if value is None:
        return "–"
    return value if isinstance(value, str) else f"{value:.5g}"


def summary(found: dict[str, Any], names: list[str], units: Mapping[str, str]) -> Element:
    """Mean, deviation and extremes of the outputs."""
    heads = ("output", "cases", "mean", "95 % confidence", "deviation", "smallest", "case", "largest", "case")
    rows = (_summary_row(labelled(units, name), found["outputs"][name]) for name in names)
    return table(heads, rows, range(1, len(heads)))


def _summary_row(name: str, row: dict[str, Any]) -> list[str]:
    low, high = row.get("mean_confidence", (None, None))
    within = "–" if low is None else f"{number(low)} to {number(high)}"
    cells = [number(row.get(key)) for key in ("mean", "deviation", "minimum", "maximum")]
    least, most = (str(row.get(key, "–")) for key in ("minimum_case", "maximum_case"))
    return [name, str(row["count"]), cells[0], within, cells[1], cells[2], least, cells[3], most]


def extremes(found: dict[str, Any], names: list[str], units: Mapping[str, str]) -> Element:
    """Parameters of the cases in which outputs are smallest or largest."""
    heads, rows = extreme_cases(found, names, units)
    return table(heads, rows, range(1, len(heads) - 1))


def extreme_cases(
    found: dict[str, Any], names: list[str], units: Mapping[str, str]
) -> tuple[list[str], list[list[str]]]:
    """Heads and rows of a table: cases, their first parameters, and what is extreme in them."""
    cases = {row["case"]: row["parameters"] for row in found["extremes"]}
    heads = [*next(iter(cases.values()), {})][:MOST_PARAMETERS]
    said: dict[int, list[str]] = {}
    for key, text in (("minimum_case", "smallest"), ("maximum_case", "largest")):
        for name in names:
            if key in found["outputs"][name]:
                said.setdefault(found["outputs"][name][key], []).append(f"{text} {name}")
    rows = [
        [str(case), *(number(cases[case][name]) for name in heads), ", ".join(texts)]
        for case, texts in said.items()
    ]
    return ["case", *(labelled(units, name) for name in heads), "in it"], rows


def percentiles(found: dict[str, Any], names: list[str], units: Mapping[str, str]) -> Element:
    """Percentiles of the outputs, with their intervals in a row below."""
    drawn = {name: found["outputs"][name].get("percentiles", []) for name in names}
    heads = ["output", *(f"{p['percent']:g} %" for p in next(rows for rows in drawn.values() if rows))]
    lines: list[list[str]] = []
    for name, rows in drawn.items():
        if rows:
            lines.append([labelled(units, name), *(number(row["value"]) for row in rows)])
            lines.append(["", *(f"{number(row['low'])} … {number(row['high'])}" for row in rows)])
    return table(heads, lines, range(1, len(heads)), wide=True)


def indices(found: dict[str, Any], method: str) -> Element:
    """Sobol' or Morris indices of one output, the largest first."""
    keys = KEYS[method]
    order = "ST" if method == "saltelli" else "mu_star"
    rows = sorted(found["indices"].items(), key=lambda item: -item[1][order])
    lines = ([name, *(f"{row[key]:.4g}" for key in keys)] for name, row in rows)
    return table(HEADS[method], lines, range(1, 5))


def noted(cases: DataFrame, most: int) -> Element:
    """Cases that have notes or warnings."""
    told = cases[(cases["status"] == "ok") & (cases["message"] != "")]
    rows = [[str(index), str(row["message"])] for index, row in told.head(most).iterrows()]
    if len(told) > most:
        rows.append(["…", f"and {len(told) - most} more, see table.csv"])
    return table(("case", "note"), rows, range(1))


def failed(cases: DataFrame, most: int) -> Element:
    """Failed cases with their messages."""
    names = parameters_of(cases)
    wrong = cases[cases["status"] == "failed"]
    rows = [
        [str(index), *(number(row[name]) for name in names[:6]), str(row["message"])]
        for index, row in wrong.head(most).iterrows()
    ]
    if len(wrong) > most:
        rows.append(["…", *("" for _ in names[:6]), f"and {len(wrong) - most} more, see table.csv"])
    return table(["case", *names[:6], "message"], rows, range(1, 1 + len(names[:6])))


def varied(cases: DataFrame, design: dict[str, Any]) -> Element:
    """Parameters and how they vary."""
    rows = []
    for name, given in design["parameters"].items():
        numbers = ", ".join(f"{key} {_short(value)}" for key, value in given.items() if key != "type")
        rows.append([label_of(cases, name), given["type"], numbers])
    return table(("parameter", "distribution", ""), rows)


def _short(value: Any) -> str:
    if not isinstance(value, list):
        return number(value)
    texts = [number(v) for v in value]
    return ", ".join(texts if len(texts) <= 12 else [*texts[:5], "…", *texts[-2:]])


def data(cases: DataFrame, found: dict[str, Any], about: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Names and values of how it was made."""
    design = about.get("design") or {}
    yield "cases", str(found["cases"])
    yield "failed", str(found["failed"])
    for key in ("method", "count", "seed"):
        if key in design:
            yield key, str(design[key])
    for one, other, value in design.get("correlations", []):
        yield f"correlation of {one} and {other}", number(value)
    if "seconds" in about:
        yield "time of all cases together", f"{about['seconds']:.4g} s"


def columns(cases: DataFrame, drawn: bool) -> Element:
    """What the columns of the table are."""
    rows = [(label_of(cases, name), "parameter") for name in parameters_of(cases)]
    rows += [(label_of(cases, name), "output") for name in outputs_of(cases)]
    return pairs([*rows, ("status", "ok or failed"), ("message", "why it failed, or a warning")])
