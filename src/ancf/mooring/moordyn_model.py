"""From an input file of MoorDyn to the tables of a model file, and a list of what has no counterpart.

Both programs mean the same by diameter, drag and added mass (normal on the diameter, tangential on the
surface), by stiffness and damping of the ground, and by the damping BA, the axial damping of a section. Where
BA is negative it is a share of the critical damping of a segment, -BA sqrt(EA m) L/n.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomli_w

from ..errors import ModelError
from ..files import visible
from .moordyn_file import MoorDynFile, Row, at_least, read_moordyn, read_number

#: Words for what holds a point.
FIXED = ("fixed", "fix", "anchor")
COUPLED = ("coupled", "cpld", "vessel", "vesselpinned", "vespin", "coupledpinned", "cpldpin")
FREE = ("free", "point", "pnt", "connect", "con", "connection")
#: Names of the options that are taken, lower case, and what they are where the file says nothing.
GRAVITY, DENSITY, DEPTH = ("g", "gravity"), ("wtrdnsty", "rhow", "rho"), ("wtrdpth", "depth", "wtrdepth")
STIFFNESS, DAMPING, FRICTION = ("kbot", "kb"), ("cbot", "cb"), ("frictioncoefficient", "mu", "mu_kt")
#: How the first of them is written.
WRITTEN = {"g": "g", "wtrdnsty": "WtrDnsty", "kbot": "kBot", "cbot": "cBot"}
DEFAULTS = {GRAVITY: 9.80665, DENSITY: 1025.0, STIFFNESS: 3e6, DAMPING: 3e5, FRICTION: 0.0}
TAKEN = {name for names in (*DEFAULTS, DEPTH) for name in names}
#: Options of their integrator, their start and their output, which mean nothing here.
OF_THE_PROGRAM = {
    "dtm",
    "dtic",
    "tmaxic",
    "cdscaleic",
    "threshic",
    "icgendynamic",
    "tscheme",
    "dtout",
    "writelog",
    "writeunits",
    "disableoutput",
    "disableouttime",
    "fricdamp",
    "statdynfricscale",
}


@dataclass
class Imported:
    """What an input file gives.

    Parameters
    ----------
    tables : dict
        Of a model file.
    left_out : list of str
        What the file has and the model has not.
    notes : list of str
        What to know of the model.
    """

    tables: dict[str, Any]
    left_out: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def toml(self, source: str) -> str:
        """The text of a model file, with the remarks at its head."""
        head = [f"# Made from {source}, an input file of MoorDyn."]
        head += [f"# {note}" for note in self.notes]
        head += [f"# Left out: {item}" for item in self.left_out]
        return "\n".join(map(visible, head)) + "\n" + tomli_w.dumps(self.tables)


def import_moordyn(path: str | Path) -> Imported:
    """Read an input file of MoorDyn, version 2, as a model.

    Line types become sections, lines cables with an element for each segment, fixed and coupled points
    supports that stand still, free ones point masses (or mere joints, where they have neither mass nor
    volume); the options give gravity, water and seabed.

    Raises
    ------
    ModelError
        The file cannot be read; a line has a type, or stands at a point, that the file does not have; a line
        ends at a body or rod; a stiffness is a table.
    """
    file = read_moordyn(path)
    made = Imported({"title": Path(path).stem})
    options = _Options(file, made)
    sections, damped = _sections(file, made)
    points = _points(file)
    tables = made.tables
    tables["gravity"] = [0.0, 0.0, -options.number(GRAVITY)]
    tables["bodies"], ends = _lines(file, points, sections, damped)
    shared = {name: values for name, values in sections.items() if name not in damped}
    if shared:
        tables["sections"] = shared
    _attach(made, points, ends)
    _surround(made, options)
    made.left_out += [
        f"{count} of {name}" for name, count in file.others.items() if name not in ("", "rod types")
    ]
    made.left_out += options.left_out()
    if file.outputs:
        made.left_out.append(f"outputs {' '.join(file.outputs)}: ask results, or give sensors")
    tables["equilibrium"] = {"load_steps": 1}
    return made


def _points(file: MoorDynFile) -> dict[str, Row]:
    """Points by number."""
    points: dict[str, Row] = {}
    for row in file.tables["points"]:
        number = row.cells["id"]
        if number in points:
            raise ModelError(row.where, f'there are two points "{number}"')
        points[number] = row
    return points


class _Options:
    """The options of a file, of which each has several names."""

    def __init__(self, file: MoorDynFile, made: Imported) -> None:
        self._given, self._made = file.options, made

    def find(self, names: tuple[str, ...]) -> float | None:
        for name in names:
            if name in self._given:
                value, where = self._given[name]
                place = f"{where}, {name}"
                return at_least(read_number(value, place), place, above=names in (DENSITY, STIFFNESS))
        return None

    def number(self, names: tuple[str, ...]) -> float:
        found = self.find(names)
        if found is None:
            found = DEFAULTS[names]
            if found != 0.0:
                self._made.notes.append(f"{WRITTEN[names[0]]} is not given: {found:g} was taken.")
        return found

    def left_out(self) -> list[str]:
        others = {k: v for k, v in self._given.items() if k not in TAKEN and k not in OF_THE_PROGRAM}
        return [
            f"option {name} = {value}" for name, (value, _) in others.items() if value not in ("0", "0.0")
        ]


def _sections(file: MoorDynFile, made: Imported) -> tuple[dict[str, Any], dict[str, float]]:
    """Sections by the name of the line type; of those with a share of critical damping that share."""
    sections: dict[str, Any] = {}
    damped: dict[str, float] = {}
    for row in file.tables["line types"]:
        name = row.cells["name"]
        if name in sections:
            raise ModelError(row.where, f'there are two line types "{name}"')
        BA = _static(row, "BA", made)
        if BA < 0.0:
            damped[name] = -BA
        sections[name] = {
            "EA": at_least(_static(row, "EA", made), f"{row.where}, EA", above=True),
            "EI": at_least(_static(row, "EI", made), f"{row.where}, EI"),
            "rhoA": row.positive("mass"),
            "axial_damping": max(BA, 0.0),
            "diameter": row.positive("diameter"),
            "drag": [row.not_negative("Cd"), row.not_negative("CdAx")],
            "added_mass": [row.not_negative("Ca"), row.not_negative("CaAx")],
        }
    return sections, damped


def _static(row: Row, column: str, made: Imported) -> float:
    """A stiffness or damping; of several numbers, of a viscoelastic line, the first."""
    text = row.cells[column]
    first, _, rest = text.partition("|")
    try:
        value = read_number(first, "")
    except ModelError:
        what = f'is "{text}", a table in another file, which no section can have'
        raise ModelError(f"{row.where}, {column}", what, "give the slope where the line works") from None
    if rest:
        made.left_out.append(f"{column} of {row.cells['name']}: {rest} behind {first}")
    return value


def _lines(
    file: MoorDynFile, points: dict[str, Row], sections: dict[str, Any], damped: dict[str, float]
) -> tuple[list[dict[str, Any]], dict[str, list[str]]]:
    """Cables, and which of their ends stand at a point."""
    bodies: list[dict[str, Any]] = []
    ends: dict[str, list[str]] = {}
    for row in file.tables["lines"]:
        kind, name = row.cells["type"], f"line{row.cells['id']}"
        if kind not in sections:
            raise ModelError(f"{row.where}, type", f'there is no line type "{kind}"')
        for key, end in (("a", "start"), ("b", "end")):
            at = _number_of(row.cells[key])
            if at not in points:
                what = f'ends at "{row.cells[key]}", which is no point of the file'
                hint = "lines on bodies and rods cannot be taken, nor files of version 1 with other columns"
                raise ModelError(row.where, what, hint)
            ends.setdefault(at, []).append(f"{name}.{end}")
        segments, length = row.number("segments"), row.positive("length")
        if segments < 1 or segments != int(segments):
            raise ModelError(f"{row.where}, segments", f"is {segments:g}, must be 1, 2, ...")
        section: str | dict[str, Any] = kind
        if kind in damped:
            values = sections[kind]
            critical = math.sqrt(values["EA"] * values["rhoA"]) * length / segments
            section = {**values, "axial_damping": damped[kind] * critical}
        bodies.append(
            {
                "name": name,
                "start": _place(points[_number_of(row.cells["a"])]),
                "end": _place(points[_number_of(row.cells["b"])]),
                "length": length,
                "elements": int(segments),
                "section": section,
            }
        )
    return bodies, ends


def _number_of(text: str) -> str:
    """The number of a point, which may be written as Point3, P3 or 3."""
    lower = text.lower()
    for word in ("connection", "connect", "point", "con", "p"):
        if lower.startswith(word) and lower[len(word) :].isdigit():
            return lower[len(word) :]
    return lower


def _place(row: Row) -> list[float]:
    return [row.number(axis) for axis in "xyz"]


def _attach(made: Imported, points: dict[str, Row], ends: dict[str, list[str]]) -> None:
    """Supports, point masses and joints where lines end."""
    tables = made.tables
    supports: list[dict[str, Any]] = []
    connections: list[dict[str, Any]] = []
    coupled = []
    for number, row in points.items():
        word, meets = row.cells["attachment"].lower(), ends.get(number, [])
        if not meets:
            made.left_out.append(f"point {number}, where no line ends")
            continue
        if word in FIXED or word in COUPLED:
            supports += [{"type": "pin", "point": end} for end in meets]
            if word in COUPLED:
                coupled += meets
        elif word in FREE:
            connections += _free(tables, number, row, meets)
        else:
            what = f'is attached to "{row.cells["attachment"]}", which cannot be taken'
            raise ModelError(row.where, what, f"can be: {', '.join((*FIXED[:1], *COUPLED[:1], *FREE[:1]))}")
    if coupled:
        ends_there = ", ".join(coupled)
        made.notes.append(f"Coupled points stand still: {ends_there}. Give their supports a displacement.")
    tables["supports"] = supports
    if connections:
        tables["connections"] = connections


def _free(tables: dict[str, Any], number: str, row: Row, meets: list[str]) -> list[dict[str, Any]]:
    """A free point: a point mass to which all lines are joined, or the lines joined to each other."""
    mass, volume = row.not_negative("mass", 0.0), row.not_negative("volume", 0.0)
    drag_area, added_mass = row.not_negative("CdA", 0.0), row.not_negative("Ca", 0.0)
    first = meets[0]
    if mass > 0.0:
        first = f"point{number}"
        tables["bodies"].append(
            {
                "type": "point_mass",
                "name": first,
                "at": _place(row),
                "mass": mass,
                "volume": volume,
                "drag_area": drag_area,
                "added_mass": added_mass,
            }
        )
    elif volume > 0.0 or drag_area > 0.0:
        raise ModelError(row.where, "has a volume or drag and no mass", "give it a mass, if a small one")
    others = meets if mass > 0.0 else meets[1:]
    return [{"type": "spherical", "a": first, "b": end} for end in others]


def _surround(made: Imported, options: _Options) -> None:
    """Water below z = 0, and the seabed where a depth is given."""
    tables = made.tables
    tables["fluids"] = [{"name": "water", "density": options.number(DENSITY), "below": 0.0}]
    depth = options.find(DEPTH)
    if depth is None:
        made.notes.append("No depth is given: there is no seabed.")
        return
    tables["grounds"] = [
        {
            "name": "seabed",
            "height": -depth,
            "stiffness": options.number(STIFFNESS),
            "damping": options.number(DAMPING),
            "friction": options.number(FRICTION),
        }
    ]
