"""Input files of MoorDyn, version 2: what stands in their sections, line by line.

The format is that of the program's own documentation (https://moordyn.readthedocs.io, "Inputs"): sections
begin with a line of dashes and their name, tables have two lines of headings, columns stand in a fixed order.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import ModelError
from ..reading import as_input

#: Words in the line of dashes that begins a section, as the program has them, and what is in it.
SECTIONS = {
    "LINE TYPES": "line types",
    "LINE DICTIONARY": "line types",
    "LINE TYPE": "line types",
    "ROD TYPES": "rod types",
    "ROD DICTIONARY": "rod types",
    "BODIES": "bodies",
    "BODY LIST": "bodies",
    "BODY PROPERTIES": "bodies",
    "RODS": "rods",
    "ROD LIST": "rods",
    "ROD PROPERTIES": "rods",
    "POINTS": "points",
    "POINT LIST": "points",
    "POINT PROPERTIES": "points",
    "CONNECTION PROPERTIES": "points",
    "NODE PROPERTIES": "points",
    "LINES": "lines",
    "LINE LIST": "lines",
    "LINE PROPERTIES": "lines",
    "FAILURE": "failures",
    "CONTROL": "control",
    "EXTERNAL LOADS": "external loads",
    "OPTIONS": "options",
    "SOLVER OPTIONS": "options",
    "OUTPUTS": "outputs",
}
#: Sections without headings.
PLAIN = ("options", "outputs")
#: Columns of the tables in their order; those behind the mark need not be there.
COLUMNS: dict[str, tuple[tuple[str, ...], int]] = {
    "line types": (
        ("name", "diameter", "mass", "EA", "BA", "EI", "Cd", "Ca", "CdAx", "CaAx"),
        10,
    ),
    "points": (("id", "attachment", "x", "y", "z", "mass", "volume", "CdA", "Ca"), 5),
    "lines": (("id", "type", "a", "b", "length", "segments"), 6),
}


@dataclass(frozen=True)
class Row:
    """A row of a table.

    Parameters
    ----------
    where : str
        File and line, for messages.
    cells : dict of str
        By column.
    """

    where: str
    cells: dict[str, str]

    def number(self, column: str, default: float | None = None) -> float:
        """A number of the row.

        Raises
        ------
        ModelError
            It is none.
        """
        text = self.cells.get(column)
        if text is None and default is not None:
            return default
        return read_number(text or "", f"{self.where}, {column}")

    def positive(self, column: str) -> float:
        """A number of the row that is not zero or less."""
        return at_least(self.number(column), f"{self.where}, {column}", above=True)

    def not_negative(self, column: str, default: float | None = None) -> float:
        """A number of the row that is zero or more."""
        return at_least(self.number(column, default), f"{self.where}, {column}")


@dataclass
class MoorDynFile:
    """Tables, options and what else stands in a file.

    Parameters
    ----------
    path : str
    tables : dict of list of Row
        ``"line types"``, ``"points"``, ``"lines"``.
    options : dict of (str, str)
        Values by lower-case name, with their places.
    others : dict of int
        How many rows there are in sections that are not read.
    outputs : list of str
    """

    path: str
    tables: dict[str, list[Row]] = field(default_factory=lambda: {name: [] for name in COLUMNS})
    options: dict[str, tuple[str, str]] = field(default_factory=dict)
    others: dict[str, int] = field(default_factory=dict)
    outputs: list[str] = field(default_factory=list)


def read_number(text: str, where: str) -> float:
    """A number as the program writes it, with e, E, d or D before the exponent.

    Raises
    ------
    ModelError
        It is none.
    """
    try:
        value = float(text.lower().replace("d", "e"))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ModelError(where, f'is "{text}", must be a number')
    return value


def at_least(value: float, where: str, above: bool = False) -> float:
    """A number that is zero or more, with `above` more than zero.

    Raises
    ------
    ModelError
        It is not.
    """
    if value < 0.0 or (above and value == 0.0):
        raise ModelError(where, f"is {value:g}, must be {'>' if above else '>='} 0")
    return value


def read_moordyn(path: str | Path) -> MoorDynFile:
    """Read an input file of MoorDyn, version 2.

    Raises
    ------
    ModelError
        The file cannot be read, has no lines or points, or a row has too few columns.
    """
    try:
        text = as_input(Path(path)).read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise ModelError(str(path), f"cannot be read: {error.strerror or error}") from None
    found = MoorDynFile(str(path))
    section, headings = "", 0
    for number, line in enumerate(text.splitlines(), start=1):
        if line.lstrip().startswith("---"):
            section = _section(line)
            headings = 0 if section in PLAIN or not section else 2
            if section == "end":
                break
        elif headings > 0:
            headings -= 1
        elif section and line.split():
            _take(found, section, line.split(), f"{path}, line {number}")
    for name in ("points", "lines", "line types"):
        if not found.tables[name]:
            what = f'has no section with {name}, which begins with "--- {name.upper()} ---"'
            raise ModelError(str(path), what, "is it an input file of MoorDyn, version 2?")
    return found


def _section(line: str) -> str:
    """What a line of dashes begins; "" for what is not known, "end" for the end of the file."""
    words = " ".join(line.replace("-", " ").upper().split())
    if "END" in words.split():
        return "end"
    fitting = [name for name in SECTIONS if name in words]
    if not fitting:
        return words.lower()
    return SECTIONS[max(fitting, key=len)]


def _take(found: MoorDynFile, section: str, words: list[str], where: str) -> None:
    if section == "options":
        if len(words) > 1:
            found.options[words[1].lower()] = (words[0], where)
    elif section == "outputs":
        if words[0].upper() != "END":
            found.outputs += words
    elif section in COLUMNS:
        columns, least = COLUMNS[section]
        if len(words) < least:
            what = f"has {len(words)} columns, of {section} at least {least}: {', '.join(columns[:least])}"
            raise ModelError(where, what, "files of version 1 have others: convert them to version 2")
        found.tables[section].append(Row(where, dict(zip(columns, words, strict=False))))
    else:
        found.others[section] = found.others.get(section, 0) + 1
