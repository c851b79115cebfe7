"""Line files: TOML, checked key by key, read into a Line or refused with the path of what is wrong."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from ...errors import ModelError
from ...model import checks
from ...model.file import parameters, read_toml
from ...model.file.fields import Entry
from ...model.file.kinds import LINE, refuse
from ...model.file.messages import combined, of_validation
from ...model.file.paths import changed
from .auxiliary import Auxiliary
from .conditions import Conditions
from .csv_table import Row, file_of
from .entries import (
    TABLES,
    ContactWireEntry,
    LineEntry,
    RuleEntry,
    SectionEntry,
    SpanEntry,
    StitchEntry,
    WireEntry,
)
from .fittings import DropperErrors, Droppers, Load, SteadyArm, Tensioner
from .galloping import read_lift
from .layout import OF_SUPPORTS, laid_out, lengths_of, supports_of
from .line import Line
from .line_parts import check_size
from .route import Route
from .span import DropperRule, Span
from .stitch import StitchWire
from .wire import Rayleigh, Wire
from .wires import wire_data

#: Keys that say where supports are: a section gives its own.
LAYOUTS = {"spans", "supports"}
PLAIN = (
    "title",
    "source",
    "tags",
    "system_height",
    "messenger_support",
    "messenger_clamp",
    "stagger",
    "messenger_stagger",
    "cant",
    "contact_support",
    "anchors",
    "gravity",
    "height",
    "messenger_support_mass",
    "temperature",
)


def read_file(path: str | Path, values: Mapping[str, Any] | None = None) -> Line | Route:
    """Read a line file; `values` replace those at some paths, see :func:`ancf.model.file.paths.changed`.

    Raises
    ------
    ModelError
        The file cannot be read, is no TOML, or describes no valid line; all problems in one error.

    """
    path = checks.path(path, "read_line.path")
    given: object = values
    if given is not None and not isinstance(given, Mapping):
        what = f"must be a mapping, is {checks.shown(values)}"
        raise ModelError("read_line.values", what, '{"contact_wire.tension": 20e3}')
    data = read_toml(path, "line file")
    refuse(path, data, LINE)
    return parse_track(other_values(data, values or {}), str(path))


#: Tables of the states of a line, which need not stand in its file.
STATES = ("conditions", "dropper_errors")


def other_values(tables: dict[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Tables of a line file with other values at some paths; those of its states need not stand there."""
    named = [key for key in STATES if any(path.startswith(f"{key}.") for path in values)]
    return changed(with_states(tables, named), values)


def with_states(tables: dict[str, Any], names: Iterable[str] = STATES) -> dict[str, Any]:
    """Tables of a line file with those of its states, empty where it has none."""
    return {name: {} for name in names} | tables


def parse_track(data: dict[str, Any], source: str = "line") -> Line | Route:
    """Make a Line, or a Route out of a file with ``[[sections]]``.

    A section has ``start``, where its first support is on the track, and any key of a line file; what it
    does not give is that of the whole file.

    Raises
    ------
    ModelError
        As :func:`parse_line`; ``where`` begins with ``sections[1]``.

    """
    parameters.refuse_keys(data, LineEntry.model_fields)
    if "sections" not in data:
        return parse_line(data, source)
    sections = data["sections"]
    if not isinstance(sections, list) or not sections or not all(isinstance(one, dict) for one in sections):
        raise ModelError("sections", "must be tables", "[[sections]] with start, and spans or supports each")
    common = {key: value for key, value in data.items() if key != "sections"}
    if common.get("loads") and len(sections) > 1:
        hint = "write [[sections.loads]] below its [[sections]], position from the first support there"
        raise ModelError("loads", "stand above the sections: each of them would carry all of them", hint)
    lines, starts = [], []
    for k, own in enumerate(sections):
        where = f"sections[{k}]"
        given = {key: value for key, value in own.items() if key != "start"}
        base = {k: v for k, v in common.items() if not (k in LAYOUTS and LAYOUTS & given.keys())}
        try:
            lines.append(parse_line(base | given, source))
        except ModelError as error:
            place = where if error.where == source else f"{where}.{error.where}"
            place = error.where if ".csv" in error.where else place
            raise ModelError(place, error.what, error.hint) from None
        if "start" not in own:
            raise ModelError(f"{where}.start", "is missing", "track position of its first support, m")
        starts.append(checks.number(own["start"], f"{where}.start"))
    plain = {key: common[key] for key in ("title", "source", "tags") if key in common}
    return Route(lines=tuple(lines), starts=tuple(starts), report=lines[0].report, **plain)


def parse_line(data: dict[str, Any], source: str = "line") -> Line:
    """Make a Line from the tables of a line file.

    Parameters
    ----------
    data : dict
        What TOML of a line file gives.
    source : str
        Its name, for a list of several problems.

    Raises
    ------
    ModelError
        ``where`` is the path in the file, ``contact_wire.EA``; for several problems it is `source`.

    """
    try:
        with parameters.given(data, {}):
            entry = LineEntry.model_validate(data)
    except ValidationError as error:
        raise combined(of_validation(error, _entry), source) from None
    folder = Path(source).parent
    entry = _with_lift(entry, folder)
    if (entry.spans is None) == (entry.supports is None):
        what = "is missing" if entry.spans is None else "and supports are given both"
        raise ModelError("spans", what, "give spans, or supports")
    rows = [] if entry.supports is None else supports_of(entry, folder)
    laid = _laid(entry, rows)
    wires = 1 if own_spacing(entry.contact_wire) is None else 2
    count = wires * sum(len(span.droppers) for span in laid["spans"])
    plain = {key: getattr(entry, key) for key in PLAIN}
    plain["system_height"] = 0.0 if entry.system_height is None else entry.system_height
    with _in_file(entry, rows):
        line = _line(
            entry,
            plain
            | laid
            | {
                "rows": tuple(where for where, _ in rows),
                "dropper_lengths": lengths_of(entry.dropper_lengths, folder, count),
            },
        )
    return line


def _line(entry: LineEntry, plain: dict[str, Any]) -> Line:
    tensioner, conditions = entry.tensioner, entry.conditions
    given: dict[str, Any] = {"steady_arm": SteadyArm(**entry.steady_arm.given())} | plain
    if entry.messenger_wire is not None:
        if entry.droppers is not None:
            given["droppers"] = Droppers(**entry.droppers.given())
        if not np.any(given["system_height"]):
            what = LineEntry.model_fields["system_height"].description or ""
            raise ModelError("line.system_height", "is missing", what.rstrip("."))
    return Line(
        contact_wire=_wire(entry.contact_wire, "contact_wire"),
        messenger_wire=None
        if entry.messenger_wire is None
        else _wire(entry.messenger_wire, "messenger_wire"),
        contact_spacing=own_spacing(entry.contact_wire),
        damping=Rayleigh(**entry.damping.given()),
        stitch=_stitch(entry.stitch),
        auxiliary=_auxiliary(entry),
        tensioner=Tensioner() if tensioner is None else Tensioner(**tensioner.given()),
        conditions=Conditions() if conditions is None else Conditions(**_of_all(entry, conditions.given())),
        dropper_errors=None
        if entry.dropper_errors is None
        else DropperErrors(**entry.dropper_errors.given()),
        report={} if entry.report is None else entry.report.given(),
        loads=tuple(Load(**load.given()) for load in entry.loads),
        **given,
    )


def _laid(entry: LineEntry, rows: list[tuple[str, Row]]) -> dict[str, Any]:
    """Spans of the file, or what its table of supports says."""
    if entry.spans is None:
        return laid_out(entry, rows)
    check_size(sum(given.repeat for given in entry.spans), 0, "spans")
    spans = [span for i, given in enumerate(entry.spans) for span in _spans(entry, given, i)]
    check_size(0, sum(len(span.droppers) for span in spans), "spans")
    return {"spans": tuple(spans)}


def _with_lift(entry: LineEntry, folder: Path) -> LineEntry:
    """The tables of lift that its wires name, read."""
    for key in ("contact_wire", "messenger_wire", "stitch", "auxiliary_wire"):
        wire = getattr(entry, key)
        if wire is not None and isinstance(wire.lift, str):
            read = wire.model_copy(update={"lift": read_lift(file_of(folder, wire.lift, f"{key}.lift"))})
            entry = entry.model_copy(update={key: read})
    return entry


def _entry(parts: tuple[int | str, ...]) -> type[Entry]:
    """Table in which a place in the file is."""
    if "<rule>" in parts or "places" in parts[1:]:
        return RuleEntry
    return TABLES.get(str(parts[0]), LineEntry) if parts else LineEntry


def _stitch(given: StitchEntry | None) -> StitchWire | None:
    return None if given is None else StitchWire(wire=_wire(given, "stitch"), reach=given.reach)


def _auxiliary(entry: LineEntry) -> Auxiliary | None:
    given, droppers = entry.auxiliary_wire, entry.long_droppers
    if given is None or droppers is None:
        if given is not None or droppers is not None:
            missing = "long_droppers" if droppers is None else "auxiliary_wire"
            what = LineEntry.model_fields[missing].description or ""
            raise ModelError(f"line.{missing}", "is missing", what.rstrip("."))
        return None
    places = None if given.places is None else DropperRule(**given.places.given())
    wire = _wire(given, "auxiliary_wire")
    return Auxiliary(wire=wire, height=given.height, droppers=Droppers(**droppers.given()), places=places)


def _of_all(entry: LineEntry, conditions: dict[str, Any]) -> dict[str, Any]:
    """Conditions with the tensions of all wires that act as one: as in the design a file has that of each."""
    spaced = own_spacing(entry.contact_wire) is not None
    counts = {
        "contact_tension": 1 if spaced else entry.contact_wire.count,
        "messenger_tension": 1 if entry.messenger_wire is None else entry.messenger_wire.count,
    }
    return {key: counts.get(key, 1) * value for key, value in conditions.items()}


def _wire(given: WireEntry | ContactWireEntry, where: str) -> Wire:
    """A wire of the catalogue with what else is given, or one of its own numbers."""
    own = given.given("reach", "count", "height", "places", "spacing")
    count = 1 if own_spacing(given, where) is not None else given.count
    if own.get("tension") is None:
        if not own.get("rail"):
            what = ContactWireEntry.model_fields["tension"].description or ""
            raise ModelError(f"{where}.tension", "is missing", what.rstrip("."))
        own["tension"] = 0.0
    if given.type is not None:
        return Wire(**(wire_data(given.type, f"{where}.type") | own)).times(count)
    for key in ("EA", "EI", "mass"):
        if own.get(key) is None:
            what = SectionEntry.model_fields[key].description or ""
            raise ModelError(f"{where}.{key}", "is missing", f'{what.rstrip(".")}; or a type, "CuAg AC-100"')
    return Wire(**own).times(count)


def own_spacing(given: WireEntry | ContactWireEntry, where: str = "contact_wire") -> float | None:
    """Distance of two contact wires that are each computed, m; None for one, or several as one."""
    spacing: float | None = getattr(given, "spacing", None)
    if spacing is not None and given.count != 2:
        what = f"is given with count = {given.count}"
        raise ModelError(f"{where}.spacing", what, "it belongs to count = 2, two wires side by side")
    return spacing


def _spans(entry: LineEntry, given: SpanEntry, index: int) -> list[Span]:
    droppers: Any = given.droppers if given.droppers is not None else entry.dropper_rule
    if droppers is None:
        if entry.messenger_wire is not None:
            what = SpanEntry.model_fields["droppers"].description or ""
            raise ModelError(f"spans[{index}].droppers", "is missing", what)
        droppers = ()
    if isinstance(droppers, list):
        check_size(0, given.repeat * len(droppers), "spans")
    try:
        if isinstance(droppers, RuleEntry):
            droppers = DropperRule(**droppers.given())
        long: Any = given.long_droppers
        if isinstance(long, RuleEntry):
            long = DropperRule(**long.given())
        span = Span(
            length=given.length,
            droppers=droppers,
            pre_sag=given.pre_sag,
            radius=given.radius,
            long_droppers=long,
        )
    except ModelError as error:
        where = f"spans[{index}]" + error.where.removeprefix("span")
        raise ModelError(where, error.what, error.hint) from None
    return [span] * given.repeat


@contextmanager
def _in_file(entry: LineEntry, rows: list[tuple[str, Row]]) -> Iterator[None]:
    """Name the places of a line as they are named in the file: ``line.stagger`` is ``stagger``."""
    try:
        yield
    except ModelError as error:
        where = error.where.removeprefix("line.").replace("auxiliary.droppers", "long_droppers")
        where = where.replace("auxiliary.", "auxiliary_wire.").replace("_wire.wire.", "_wire.")
        where = where.replace("contact_spacing", "contact_wire.spacing")
        key, _, index = where.partition("[")
        k = int(index.partition("]")[0]) if index else 0
        if key in OF_SUPPORTS and index and k < len(rows) and key in rows[k][1]:
            raise ModelError(f"{rows[k][0]}{key}", error.what, error.hint) from None
        if key in OF_SUPPORTS and not isinstance(getattr(entry, key), list):
            where = key
        raise ModelError(where, error.what, error.hint) from None
