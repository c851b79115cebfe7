"""In which state a line was looked at, in words: for titles, tables and files."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..lines.conditions import Conditions

if TYPE_CHECKING:
    from ..forms.route_form import AnyForm
    from ..lines.line import Line
    from ..lines.route import Route

#: What pulls the ends, by what the file says.
ENDS = {"tension": "ends pulled by weights", "fixed": "fixed ends", "spring": "ends pulled by springs"}
#: Names of the wires in the order of ``Form.pull``.
WIRES = ("contact wire", "messenger", "auxiliary", "second contact wire")


def changes(line: Line | Route) -> str:
    """What differs from the design, "40 °C, wind 25 m/s"; nothing as designed."""
    air, plain = line.parts[0].conditions, Conditions()
    texts = {
        "temperature": f"{air.temperature} °C" if air.temperature is None else f"{air.temperature:g} °C",
        "wind": f"wind {air.wind:g} m/s",
        "turbulence": f"turbulence {air.turbulence:g}",
        "ice": f"ice {air.ice:g} kg/m",
        "wear": f"contact wire worn by {100.0 * air.wear:g} %",
        "contact_tension": f"contact wire pulled with {air.contact_tension} N",
        "messenger_tension": f"messenger pulled with {air.messenger_tension} N",
    }
    said = [text for key, text in texts.items() if getattr(air, key) != getattr(plain, key)]
    parts = line.parts
    if any(part.dropper_lengths is not None or part.dropper_errors is not None for part in parts):
        said.append("droppers as built")
    return ", ".join(said)


def state(line: Line | Route) -> str:
    """The conditions and what pulls the ends: "as designed, 10 °C, fixed ends".

    Of a route whose sections differ in it "fixed ends (section 1), ends pulled by weights (sections 2, 3)".
    """
    first = line.parts[0]
    told = changes(line) or "as designed"
    if first.conditions.temperature is None:
        told += f", {first.temperature:g} °C"
    return f"{told}, {_ends(line)}"


def _ends(line: Line | Route) -> str:
    """What pulls the ends of all sections."""
    of: dict[str, list[str]] = {}
    for number, part in enumerate(line.parts, start=1):
        of.setdefault(ENDS[part.anchors], []).append(f"{number}")
    if len(of) == 1:
        return next(iter(of))
    return ", ".join(
        f"{text} (section{'s' if len(at) > 1 else ''} {', '.join(at)})" for text, at in of.items()
    )


def titled(line: Line | Route) -> str:
    """Title of the line, with the state if it is not that of the design."""
    return ", ".join(filter(None, (line.title, changes(line))))


def tensions(found: AnyForm) -> Iterator[tuple[str, float, float, float]]:
    """Name of each wire, its tension as designed, and the smallest and largest at its ends at rest, N."""
    parts = (found,) if not hasattr(found, "forms") else found.forms
    for number, form in enumerate(parts, start=1):
        line = form.line
        third = None if line.auxiliary is None else line.auxiliary.wire
        wires = (line.contact_wire, line.messenger_wire, third, line.contact_wire if line.twin else None)
        for name, wire, pull in zip(WIRES, wires, form.pull, strict=False):
            if wire is not None:
                told = name if len(parts) == 1 else f"section {number}: {name}"
                yield told, float(wire.tension), float(pull.min()), float(pull.max())


def pulled(low: float, high: float) -> str:
    """One tension, or the smallest and largest, N."""
    return f"{low:.0f}" if high - low < 0.5 else f"{low:.0f} to {high:.0f}"


def at_rest(found: AnyForm) -> str:
    """Tensions of this state beside those of the design: "contact wire 9876 N (designed 10000)"."""
    rows = tensions(found)
    return ", ".join(f"{name} {pulled(low, high)} N (designed {was:.0f})" for name, was, low, high in rows)
