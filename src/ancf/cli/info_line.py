"""``ancf info`` of a line file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .screen import console, table
from .summary import plural

if TYPE_CHECKING:
    from ..catenary import Line, Route


def show_line(path: Path, data: dict[str, Any]) -> None:
    """Print what a line consists of; it must fit together as strings."""
    from ..catenary.forms.form import check
    from ..catenary.lines.file import parse_track

    line = parse_track(data, str(path))
    for part in line.parts:
        check(part)
    out = console()
    out.print(line.title or str(path), style="bold", soft_wrap=True)
    for key, value in _facts(line):
        out.print(f"  {key:<10} {value}", soft_wrap=True)
    out.print()
    out.print(_wires(line))


def size_of(line: Line | Route) -> str:
    """Spans, droppers, length and wave speed."""
    size = f"{plural(len(line.spans), 'span')}, {plural(line.dropper_x.size, 'dropper')}"
    return f"{size}, {line.length:g} m, wave speed {3.6 * line.wave_speed:.0f} km/h"


def _facts(line: Line | Route) -> Iterator[tuple[str, str]]:
    lengths = [span.length for span in line.spans]
    yield "line", size_of(line)
    yield "spans", f"{min(lengths):g} to {max(lengths):g} m"
    first = line.parts[0]
    if len(line.parts) > 1:
        yield "sections", f"{len(line.parts)}, which overlap"
    yield "supports", f"contact wire {first.contact_support}, anchors: {first.anchors}"
    yield "stagger", f"{min(line.stagger):g} to {max(line.stagger):g} m"
    if line.tags:
        unsure = sum(tag.startswith("U") for tag in line.tags.values())
        yield "tags", f"{len(line.tags)} values are tagged, {unsure} of them U: not yet checked"
    if line.source:
        yield "source", line.source


def _wires(line: Line | Route) -> Any:
    made = table("wire", "tension [kN]", "mass [kg/m]", "EA [MN]", "EI [N m^2]", "wave speed [km/h]")
    line = line.parts[0]
    wires = {"contact wire": line.contact_wire}
    if line.messenger_wire is not None:
        wires["messenger"] = line.messenger_wire
    if line.stitch is not None:
        wires["stitch wire"] = line.stitch.wire
    if line.auxiliary is not None:
        wires["auxiliary"] = line.auxiliary.wire
    for name, wire in wires.items():
        numbers = 1e-3 * wire.tension, wire.mass, 1e-6 * wire.EA, wire.EI, 3.6 * wire.wave_speed
        made.add_row(name, *(f"{number:.5g}" for number in numbers))
    return made
