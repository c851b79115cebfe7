"""Tables of a report: quantities against their ranges, supports, droppers, line, pantograph and run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...viz.html import element, pairs, table
from ..answers.acceptance import LEVELS, time_above
from ..answers.clamp_strain import clamp_strains
from ..answers.cycles import rainflow
from ..answers.passing import DropperForces, dropper_places
from ..answers.quantity import TAGS, shown
from ..answers.state import pulled, state, tensions
from ..answers.table import texts
from ..lines.route import Route

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from ..answers.quantity import Quantity
    from ..lines.line import Line
    from ..lines.wire import Wire
    from .content import Content

MM = 1e3


def quantities(rows: Iterable[Quantity]) -> Element:
    """Each quantity against its range."""
    made = table(
        ("quantity", "value", "unit", "accepted", "verdict", "tag"), [texts(q) for q in rows], numbers=(1, 3)
    )
    _colour(made)
    return made


def beside(names: Sequence[str], lists: Sequence[Sequence[Quantity]]) -> Element:
    """Quantities of several pantographs or runs side by side, by the names of what they are of.

    One that is missing somewhere has an empty cell; limits that differ stand one after the other.
    """
    if len(lists) == 1:
        return quantities(lists[0])
    by_key = [{q.key: q for q in one} for one in lists]
    keys = dict.fromkeys(q.key for one in lists for q in one)
    rows = [_side_by_side([one.get(key) for one in by_key]) for key in keys]
    heads = [text for name in names for text in (name, "verdict")]
    made = table(
        ("quantity", *heads, "unit", "accepted", "tag"),
        rows,
        numbers=(*range(1, 2 * len(lists), 2), 2 * len(lists) + 2),
    )
    _colour(made)
    return made


def _side_by_side(found: Sequence[Quantity | None]) -> tuple[str, ...]:
    first = next(q for q in found if q is not None)
    cells = [text for q in found for text in (("", "") if q is None else (texts(q)[1], texts(q)[4]))]
    limits = dict.fromkeys(texts(q)[3] for q in found if q is not None)
    return (first.name, *cells, texts(first)[2], "; ".join(filter(None, limits)), first.tag or "")


def _colour(made: Element) -> None:
    """Mark verdicts in a table."""
    for cell in made.iter("td"):
        if cell.text in ("inside", "outside"):
            cell.set("class", str(cell.text))


def times_above(content: Content) -> Element:
    """Share of the time above some forces, one column for each pantograph."""
    heads = [content.name(k) if content.several else "time above it [%]" for k in range(len(content.found))]
    shares = [time_above(content.run, LEVELS, k) for k in range(len(content.found))]
    rows = [
        (f"{level:g}", *(shown(float(share[i]), "%") for share in shares)) for i, level in enumerate(LEVELS)
    ]
    return table(("contact force [N]", *heads), rows, numbers=range(1 + len(heads)))


def clamps(content: Content) -> Element:
    """Bending strain of the contact wire at the clamps of the window, cycles of clamps and droppers."""
    forces = {
        (span, number): rainflow(content.run.dropper_force[:, j])
        for j, (span, number, _) in enumerate(dropper_places(content.run))
    }
    rows = []
    for c in clamp_strains(content.run):
        strains = (f"{1e6 * value:.0f}" for value in (c.rest, c.largest, c.smallest, c.cycles.largest))
        force = forces[c.span, c.number]
        many = f"{c.cycles.number(0.5 * c.cycles.largest):g}"
        if f"{c.span}-{c.number}" in content.run.broken_droppers:
            rows.append((str(c.span), str(c.number), f"{c.position:g}", *strains, many, "broken", ""))
            continue
        worst = (shown(force.largest, "N"), f"{force.number(0.5 * force.largest):g}")
        rows.append((str(c.span), str(c.number), f"{c.position:g}", *strains, many, *worst))
    head = ("span", "dropper", "position [m]", "strain at rest [1e-6]", "largest", "smallest", "range")
    cycles = ("cycles above half of it", "range of dropper force [N]", "cycles above half of it")
    return table((*head, *cycles), rows, numbers=range(10))


def tags(rows: Iterable[Quantity]) -> Element:
    """What the tags of some quantities mean."""
    used = dict.fromkeys(q.tag for q in rows if q.tag)
    text = "; ".join(f"{tag}: {TAGS.get(tag, tag)}" for tag in used)
    return element("p", f"Tags of the limits: {text}." if text else "", class_="faint")


def supports(content: Content) -> Element:
    """Loads of each support on the contact wire at rest, and its largest uplift by each pantograph."""
    passed = [{s.number: shown(MM * s.uplift, "mm") for s in found.supports} for found in content.found]
    heads = [
        f"uplift [mm], {content.name(k)}" if content.several else "uplift [mm]" for k in range(len(passed))
    ]
    loads = [
        (f"{side:.0f}", f"{up:.0f}") for _, side, up in (np.round(content.run.form.arm_load) + 0.0).tolist()
    ]
    rows = [
        (str(j + 1), f"{x:g}", *loads[j], *(p.get(j + 1, "not passed") for p in passed))
        for j, x in enumerate(content.run.form.line.supports)
    ]
    head = ("support", "position [m]", "pulls to the left [N]", "carries [N]", *heads)
    return table(head, rows, numbers=range(len(head)))


def droppers(content: Content, k: int) -> Element:
    """Forces of the droppers of the window while a pantograph is in it."""
    head = ("span", "dropper", "position [m]", "at rest [N]", "largest [N]", "smallest [N]")
    slack = ("slack intervals", "slack together [ms]", "longest [ms]")
    rows = [_dropper(d) for d in content.found[k].droppers]
    return table((*head, *slack), rows, numbers=range(9))


def _dropper(d: DropperForces) -> tuple[str, ...]:
    if d.broken:
        return (str(d.span), str(d.number), f"{d.position:g}", "broken", *[""] * 5)
    forces = (shown(force, "N") for force in (d.rest, d.largest, d.smallest))
    slack = (shown(1e3 * time, "ms") for time in (d.slack.seconds, d.slack.longest))
    return (str(d.span), str(d.number), f"{d.position:g}", *forces, str(d.slack.number), *slack)


def schedule(content: Content) -> Element:
    """The dropper schedule: lengths and loads of all droppers at rest."""
    form = content.run.form
    heights = (form.contact_height, form.messenger_height)
    numbers = np.column_stack([MM * np.asarray(a) for a in (form.dropper_length, form.cut_length, *heights)])
    rows = [
        (str(span), str(number), f"{x:g}", *(shown(v, "mm") for v in lengths), shown(float(load), "N"))
        for (span, number, x), lengths, load in zip(
            dropper_places(content.run), numbers.tolist(), form.dropper_load, strict=True
        )
    ]
    lengths = ("length [mm]", "unstretched [mm]", "contact wire at [mm]", "messenger at [mm]")
    load = "load at the lower end [N]"
    return table(("span", "dropper", "position [m]", *lengths, load), rows, numbers=range(8))


def run_data(content: Content) -> Element:
    """Speed, window, filter, times and settings of the run."""
    run = content.run
    rows = [
        ("speed in the window", f"{content.speed_kmh:.4g} km/h ({content.speed_kmh / 3.6:.4g} m/s)"),
        ("evaluated window", f"{run.window[0]:g} m to {run.window[1]:g} m"),
        ("filter", content.found[0].filter.text),
        ("simulated time", f"{run.simulated_seconds:.3f} s"),
        ("CPU time", f"{run.cpu_seconds:.3f} s"),
        ("real-time factor (simulated / CPU time)", f"{run.real_time_factor:.3g}"),
        *flattened(run.settings),
    ]
    return pairs(rows)


def line_data(content: Content) -> Element:
    """The line, with the tags of its values where it has some."""
    known: Mapping[str, str] = content.run.form.line.tags or {}
    return pairs((name, value + _tagged(key, known)) for name, key, value in _line(content))


def _tagged(key: str, known: Mapping[str, str]) -> str:
    """Tags of a value and of its parts, in brackets: ``[EA U, EI V2]``."""
    own = [tag for name, tag in known.items() if name == key]
    parts = [
        f"{name.removeprefix(f'{key}.')} {tag}" for name, tag in known.items() if name.startswith(f"{key}.")
    ]
    return f"  [{', '.join(own + parts)}]" if own or parts else ""


def _line(content: Content) -> Iterator[tuple[str, str, str]]:
    line = content.run.form.line
    yield from _sections(line) if isinstance(line, Route) else _tension_length(line)
    for name, was, low, high in tensions(content.run.form):
        yield f"tension of the {name} in this state [N]", "", f"{pulled(low, high)}, designed {was:.0f}"


def _sections(line: Route) -> Iterator[tuple[str, str, str]]:
    parts = line.parts
    yield "line", "title", line.title
    yield "state", "conditions", state(line)
    ends = [f"{start:g} to {start + part.length:g}" for start, part in zip(line.starts, parts, strict=True)]
    yield "sections [m]", "sections", ", ".join(ends)
    for k, part in enumerate(parts):
        for name, key, value in _tension_length(part):
            if name not in ("line", "state", "source"):
                yield f"section {k + 1}: {name}", key, value
    yield "source", "source", line.source or "not given"


def _tension_length(line: Line) -> Iterator[tuple[str, str, str]]:
    spans = [f"{span.length:g}" for span in line.spans]
    yield "line", "title", line.title
    yield "state", "conditions", state(line)
    yield (
        "spans [m]",
        "spans",
        f"{len(spans)} x {spans[0]}" if len(set(spans)) == 1 else ", ".join(spans),
    )
    yield "number of droppers", "", f"{len(line.dropper_x)}"
    for key, name in (("contact_wire", "contact wire"), ("messenger_wire", "messenger")):
        wire = getattr(line, key)
        if wire is None:
            continue
        yield name, key, _wire(wire) + (f", damping {wire.damping:g} N s/m²" if wire.damping else "")
    if line.contact_spacing is not None:
        yield "two contact wires, apart [m]", "contact_spacing", f"{line.contact_spacing:g}"
    if getattr(line, "auxiliary", None) is not None:
        auxiliary = line.auxiliary
        assert auxiliary is not None
        yield (
            "auxiliary",
            "auxiliary_wire",
            f"{_wire(auxiliary.wire)}, {auxiliary.height:g} m over the contact wire",
        )
        yield "long droppers", "long_droppers", _droppers(auxiliary.droppers)
    if getattr(line, "stitch", None) is not None:
        stitch = line.stitch
        assert stitch is not None
        yield (
            "stitch wires",
            "stitch",
            f"{_wire(stitch.wire)}, {stitch.reach:g} m to either side of a support",
        )
    yield "damping of the wires", "damping", f"alpha {line.damping.alpha:g} 1/s, beta {line.damping.beta:g} s"
    yield "droppers", "droppers", _droppers(line.droppers)
    yield "system height [m]", "system_height", _few(line.system_height)
    yield "stagger [m]", "stagger", _few(line.stagger)
    if np.any(line.cant):
        yield "cant [m]", "cant", _few(line.cant)
    stiffness = line.messenger_support
    yield "messenger support", "messenger_support", "rigid" if stiffness is None else f"{stiffness:g} N/m"
    arms = line.steady_arm if isinstance(line.steady_arm, tuple) else (line.steady_arm,)
    shown = [_given(arm, ("vertical", "lateral", "length", "mass")) for arm in arms]
    yield "steady arm", "steady_arm", shown[0] if len(set(shown)) == 1 else "; ".join(shown)
    yield "contact wire at the supports, at rest", "contact_support", line.contact_support
    yield "anchors", "anchors", line.anchors
    yield "source", "source", line.source or "not given"


def _wire(wire: Wire) -> str:
    """What is said of a wire."""
    return f"{wire.mass:g} kg/m, tension {wire.tension:g} N, EA {wire.EA:g} N, EI {wire.EI:g} N m²"


def _droppers(droppers: Any) -> str:
    kind = f"EA {droppers.EA:g} N" if droppers.EA is not None else f"stiffness {droppers.stiffness:g} N/m"
    slack = "slack in compression" if droppers.slack else "carry compression too"
    clamps = f"clamps {droppers.clamp_contact:g} and {droppers.clamp_messenger:g} kg"
    return f"{kind}, {droppers.mass:g} kg/m, damping {droppers.damping:g} N s/m, {clamps}, {slack}"


def pantograph_data(content: Content, k: int) -> Element:
    """Masses, springs, dampers and forces of one pantograph."""
    p = content.run.pantographs[k]
    rows = [
        ("name", "name", p.name),
        ("title", "title", p.title or "not given"),
        ("masses, base to head [kg]", "masses", _few(p.masses)),
        ("stiffness [N/m]", "stiffness", _springs(p.stiffness)),
        ("damping [N s/m]", "damping", _springs(p.damping)),
        ("static force [N]", "static_force", f"{p.static_force:g}"),
        ("aerodynamic force over v² [N s²/m²]", "aerodynamic", _few(p.aerodynamics)),
        ("lowest spring relaxed at", "relaxed_at", getattr(p, "relaxed_at", "start")),
        ("length of the strip [m]", "strip_length", f"{p.strip_length:g}"),
    ]
    if any(getattr(p, "friction", ())):
        rows.append(("friction [N]", "friction", _few(p.friction)))
    if any(getattr(p, "stops", ())):
        stops = ("none" if pair is None else f"{pair[0]:g} to {pair[1]:g}" for pair in p.stops)
        rows.append(("stops, elongation of the spring [m]", "stops", ", ".join(stops)))
    if getattr(p, "strip_distance", 0.0):
        rows.append(("distance of its two strips [m]", "strip_distance", f"{p.strip_distance:g}"))
    known: Mapping[str, str] = getattr(p, "tags", None) or {}
    return pairs((name, value + _tagged(key, known)) for name, key, value in rows)


def elasticity(content: Content) -> Element:
    """Extremes and non-uniformity of the static elasticity along its span, at each force."""
    found = content.elasticity
    assert found is not None
    rows = [
        (f"{force:g}", f"{np.min(e):.4f}", f"{np.max(e):.4f}", f"{100 * uneven:.1f}")
        for force, e, uneven in zip(found.force, found.value, found.nonuniformity, strict=True)
    ]
    return table(
        ("force [N]", "smallest [mm/N]", "largest [mm/N]", "non-uniformity [%]"), rows, numbers=range(4)
    )


def flattened(settings: Mapping[str, Any], before: str = "") -> list[tuple[str, str]]:
    """Names and texts of settings; those of a group get its name before them."""
    found: list[tuple[str, str]] = []
    for key, value in settings.items():
        name = f"{before}{str(key).replace('_', ' ')}"
        if isinstance(value, Mapping):
            found += flattened(value, f"{name}, ")
        elif value is not None:
            found.append((name, f"{value:.6g}" if isinstance(value, float) else str(value)))
    return found


def _springs(values: Any) -> str:
    """Numbers as they are, curves by what they cover."""
    curves = [isinstance(value, tuple) for value in values]
    if not any(curves):
        return _few(values)
    texts = (
        f"curve from {v[0][1]:g} to {v[-1][1]:g} N" if c else f"{v:g}"
        for v, c in zip(values, curves, strict=True)
    )
    return ", ".join(texts)


def _few(values: Any) -> str:
    texts = [f"{value:g}" for value in np.atleast_1d(values)]
    return texts[0] if len(set(texts)) == 1 and len(texts) > 2 else ", ".join(texts)


def _given(thing: Any, keys: Iterable[str]) -> str:
    units = {"vertical": "N/m vertically", "lateral": "N/m sideways", "length": "m long", "mass": "kg"}
    values = [(getattr(thing, key, None), units[key]) for key in keys]
    return ", ".join(f"{value:g} {unit}" for value, unit in values if value) or "none"
