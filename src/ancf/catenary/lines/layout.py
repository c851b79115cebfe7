"""The supports of a line as a table: what it says of spans, heights, staggers and steady arms."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

from ...errors import ModelError
from .csv_table import Row, file_of, read_table
from .entries import LineEntry, SupportEntry
from .fittings import SteadyArm
from .span import DropperRule, Span

#: Values of a support that become one value for each support of the line.
OF_SUPPORTS = ("height", "system_height", "stagger", "messenger_stagger", "cant")
#: Values of a support that change its steady arm, by their name there.
OF_ARMS = {
    "arm_vertical": "vertical",
    "arm_lateral": "lateral",
    "arm_length": "length",
    "arm_angle": "angle",
    "arm_mass": "mass",
    "arm_side": "side",
    "arm_push": "push",
    "uplift_stop": "uplift_stop",
}
#: Columns of words, and what they mean.
WORDS: dict[str, dict[str, str | bool]] = {
    "arm_side": {"left": "left", "right": "right"},
    "arm_push": {"yes": True, "no": False},
}
LENGTHS = ("natural_length_mm",)


def supports_of(entry: LineEntry, folder: Path) -> list[tuple[str, Row]]:
    """Rows of the supports with their places for messages, from the file or from a table of its own."""
    if isinstance(entry.supports, str):
        path = file_of(folder, entry.supports, "supports")
        known, lists = tuple(SupportEntry.model_fields), ("droppers", "long_droppers")
        rows = read_table(path, ("position",), known, lists=lists, words=WORDS)
        return [(f"{path}, row {k + 1}, column ", row) for k, row in enumerate(rows)]
    given = [support.given() for support in entry.supports or ()]
    return [(f"supports[{k}].", row) for k, row in enumerate(given)]


def laid_out(entry: LineEntry, rows: list[tuple[str, Row]]) -> dict[str, Any]:
    """What the rows say of a Line: ``spans`` and more."""
    if len(rows) < 2:
        raise ModelError("supports", f"has {len(rows)} rows", "give at least two supports")
    made: dict[str, Any] = {"spans": tuple(_span(entry, *pair) for pair in pairwise(rows))}
    for key in OF_SUPPORTS:
        if any(key in row for _, row in rows):
            made[key] = tuple(_filled(entry, key, where, row) for where, row in rows)
    if any(key in row for _, row in rows for key in OF_ARMS):
        made["steady_arm"] = tuple(_arm(entry, where, row) for where, row in rows)
    return made


def _filled(entry: LineEntry, key: str, where: str, row: Row) -> Any:
    """A value of a support, or the one number that the file has for all."""
    if key in row:
        return row[key]
    common = getattr(entry, key)
    if isinstance(common, list) or key not in entry.model_fields_set or (key.endswith("stagger") and common):
        raise ModelError(f"{where}{key}", "is empty, other supports have it", "give it for each support")
    return common


def _span(entry: LineEntry, begin: tuple[str, Row], end: tuple[str, Row]) -> Span:
    (where, row), (behind, following) = begin, end
    start, stop, radius = row["position"], following["position"], row.get("radius")
    assert isinstance(start, float)
    assert isinstance(stop, float)
    assert radius is None or isinstance(radius, float)
    if stop <= start:
        raise ModelError(
            f"{behind}position", f"is {stop:g} m, behind one at {start:g} m", "sort the supports"
        )
    droppers: Any = row.get("droppers", ())
    if not droppers and entry.dropper_rule is not None:
        droppers = DropperRule(**entry.dropper_rule.given())
    try:
        return Span(
            length=stop - start,
            droppers=droppers,
            pre_sag=row.get("pre_sag", 0.0),
            radius=radius,
            long_droppers=row.get("long_droppers"),
        )
    except ModelError as error:
        key = error.where.removeprefix("span.").partition("[")[0].partition(".")[0]
        place = f"{behind}position" if key == "length" else f"{where}{key}"
        raise ModelError(place, error.what, error.hint or "units are m") from None


def _arm(entry: LineEntry, where: str, row: Row) -> SteadyArm:
    own = {name: row[key] for key, name in OF_ARMS.items() if key in row}
    given: dict[str, Any] = entry.steady_arm.given() | own
    if "length" in own:
        given.pop("vertical", None)
    if "vertical" in own:
        for key in ("length", "angle"):
            given.pop(key, None)
    arm = SteadyArm(**given)
    try:
        arm.check("arm")
    except ModelError as error:
        key = error.where.removeprefix("arm.")
        names = {name: column for column, name in OF_ARMS.items()}
        raise ModelError(f"{where}{names.get(key, key)}", error.what, error.hint) from None
    return arm


def lengths_of(given: str | list[float] | None, folder: Path, count: int) -> tuple[float, ...] | None:
    """Natural lengths of the droppers in m, from a list in m, or in mm from a CSV file like the schedule."""
    if given is None:
        return None
    if isinstance(given, list):
        return tuple(given)
    path = file_of(folder, given, "dropper_lengths")
    rows = read_table(path, LENGTHS, LENGTHS, others=True)
    if len(rows) != count:
        what = f"has {len(rows)} rows, the line has {count} droppers"
        raise ModelError(str(path), what, "as ancf catenary form -o writes its schedule")
    values = []
    for k, row in enumerate(rows):
        value = row[LENGTHS[0]]
        assert isinstance(value, float)
        if value <= 0.0:
            where = f"{path}, row {k + 1}, column {LENGTHS[0]}"
            raise ModelError(where, f"is {value:g} mm, a dropper has a length > 0")
        values.append(1e-3 * value)
    return tuple(values)
