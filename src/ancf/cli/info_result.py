"""``ancf info`` of a results file: what was computed, how far, with what, at what cost."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .results_file import reading
from .screen import console, table
from .summary import plural

if TYPE_CHECKING:
    from .. import Result

#: Rows of slack intervals.
MOST_SLACK = 20
STATUS = {
    "complete": "complete",
    "failed": "the solve failed",
    "interrupted": "stopped before its end",
    "running": "not finished: still running, or killed",
}


def show_result(path: Path) -> None:
    """Print a results file, finished or not."""
    title, facts, tables = _read(path)
    out = console()
    out.print(title, style="bold", soft_wrap=True)
    for key, value in facts:
        out.print(f"  {key:<10} {value}", soft_wrap=True)
    for shown in tables:
        out.print()
        out.print(shown)


def _read(path: Path) -> tuple[str, list[tuple[str, str]], list[Any]]:
    import ancf

    with reading(path):
        result = ancf.load(path)
        plain = result.provenance
        return _title(plain, path), _facts(result, plain), [_bodies(plain), *_slack(result)]


def _title(plain: dict[str, Any], path: Path) -> str:
    return str(plain.get("model", {}).get("title") or path)


def _facts(result: Result, plain: dict[str, Any]) -> list[tuple[str, str]]:
    t = result.t
    versions = plain.get("versions", {})
    counters = result.stats.as_dict()
    return [
        ("status", f"{STATUS.get(result.status, result.status)}{_how_far(result, plain)}"),
        ("times", f"{plural(len(t), 'state')}, t = {t[0]:g} ... {t[-1]:g} s" if len(t) else "none"),
        *_sensors(plain),
        *([("inputs", ", ".join(said))] if (said := result._inputs_said()) else []),
        ("counters", ", ".join(f"{key} {value:g}" for key, value in counters.items())),
        ("versions", ", ".join(f"{key} {value}" for key, value in versions.items())),
    ]


def _sensors(plain: dict[str, Any]) -> list[tuple[str, str]]:
    listed = plain.get("settings", {}).get("sensors", [])
    return [("sensors", f"at every step: {', '.join(listed)}")] if listed else []


def _how_far(result: Result, plain: dict[str, Any]) -> str:
    t_end = plain.get("settings", {}).get("t_end")
    if result.status == "complete" or not t_end or not len(result.t):
        return ""
    return f"; reached t = {result.t[-1]:g} s of {t_end:g} s ({100 * result.t[-1] / t_end:.0f} %)"


def _slack(result: Result) -> Iterator[Any]:
    """When ropes and springs that only pull were slack; nothing of histories that are too long to read."""
    from ..results.overview import is_short
    from ..results.slackness import of_ropes

    if not is_short(result):
        return
    found = of_ropes(result)
    if found:
        made = table("slack", "from [s]", "to [s]", "smallest tension [N]", "at", "t [s]")
        for item in found[:MOST_SLACK]:
            numbers = (f"{item.start:.6g}", f"{item.end:.6g}", f"{item.tension:.4g}")
            made.add_row(item.name, *numbers, item.point, f"{item.t:.6g}")
        yield made
    if len(found) > MOST_SLACK:
        yield f"and {plural(len(found) - MOST_SLACK, 'more slack interval')}: result.slack_intervals()"


def _bodies(plain: dict[str, Any]) -> Any:
    made = table("body", "element", "elements", "length [m]")
    for body in plain.get("model", {}).get("bodies", []):
        if body.get("type", "beam") == "beam":
            row = (body["element"], str(body["elements"]), f"{body['length']:g}")
        else:
            row = (body["type"].replace("_", " "), "", "")
        made.add_row(body["name"], *row)
    return made
