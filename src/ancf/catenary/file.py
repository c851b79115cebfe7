"""Line files: TOML, checked key by key, read into a Line or refused with the path of what is wrong."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ..errors import ModelError
from ..model.file import parameters, read_toml
from ..model.file.fields import Entry
from ..model.file.messages import combined, of_validation
from ..model.file.paths import changed
from .entries import TABLES, LineEntry, SpanEntry, StitchEntry, WireEntry
from .fittings import Droppers, SteadyArm
from .line import Line, check_size
from .span import Span
from .stitch import StitchWire
from .wire import Rayleigh, Wire
from .wires import wire_data

PLAIN = (
    "title",
    "source",
    "tags",
    "system_height",
    "messenger_support",
    "messenger_clamp",
    "stagger",
    "messenger_stagger",
    "contact_support",
    "anchors",
    "gravity",
)


def read_file(path: str | Path, values: Mapping[str, Any] | None = None) -> Line:
    """Read a line file; `values` replace those at some paths, see :func:`ancf.model.file.paths.changed`.

    Raises
    ------
    ModelError
        The file cannot be read, is no TOML, or describes no valid line; all problems in one error.

    """
    tables = changed(read_toml(Path(path), "line file"), values or {})
    return parse_line(tables, str(path))


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
    droppers = sum(given.repeat * len(given.droppers) for given in entry.spans)
    check_size(sum(given.repeat for given in entry.spans), droppers, "spans")
    spans = [span for i, given in enumerate(entry.spans) for span in _spans(given, i)]
    with _in_file(entry):
        return Line(
            spans=tuple(spans),
            contact_wire=_wire(entry.contact_wire, "contact_wire"),
            messenger_wire=_wire(entry.messenger_wire, "messenger_wire"),
            droppers=Droppers(**entry.droppers.given()),
            steady_arm=SteadyArm(**entry.steady_arm.given()),
            damping=Rayleigh(**entry.damping.given()),
            stitch=_stitch(entry.stitch),
            **{key: getattr(entry, key) for key in PLAIN},
        )


def _entry(parts: tuple[int | str, ...]) -> type[Entry]:
    """Table in which a place in the file is."""
    return TABLES.get(str(parts[0]), LineEntry) if parts else LineEntry


def _stitch(given: StitchEntry | None) -> StitchWire | None:
    return None if given is None else StitchWire(wire=_wire(given, "stitch"), reach=given.reach)


def _wire(given: WireEntry, where: str) -> Wire:
    """A wire of the catalogue with what else is given, or one of its own numbers."""
    own = given.given("reach")
    if given.type is not None:
        return Wire(**(wire_data(given.type, f"{where}.type") | own))
    for key in ("EA", "EI", "mass"):
        if own.get(key) is None:
            what = WireEntry.model_fields[key].description or ""
            raise ModelError(f"{where}.{key}", "is missing", f'{what.rstrip(".")}; or a type, "CuAg AC-100"')
    return Wire(**own)


def _spans(given: SpanEntry, index: int) -> list[Span]:
    try:
        span = Span(length=given.length, droppers=tuple(given.droppers), pre_sag=given.pre_sag)
    except ModelError as error:
        where = f"spans[{index}]" + error.where.removeprefix("span")
        raise ModelError(where, error.what, error.hint) from None
    return [span] * given.repeat


@contextmanager
def _in_file(entry: LineEntry) -> Iterator[None]:
    """Name the places of a line as they are named in the file: ``line.stagger`` is ``stagger``."""
    try:
        yield
    except ModelError as error:
        where = error.where.removeprefix("line.")
        key = where.partition("[")[0]
        if key in ("system_height", "stagger") and not isinstance(getattr(entry, key), list):
            where = key
        raise ModelError(where, error.what, error.hint) from None
