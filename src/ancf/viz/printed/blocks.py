"""A page's elements as a plain sequence of blocks, which writers of documents go through."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...errors import ModelError

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

HEADINGS = {"h1": 1, "h2": 2, "h3": 3, "summary": 3}
#: What a sheet of paper has no use for.
SKIPPED = ("nav", "link", "style")
PNG = "data:image/png;base64,"
#: Colours of the page by the kind of a cell, or the tone of a paragraph.
TONES = {"inside": "fine", "outside": "bad", "": "ink"}
#: Letters: between columns, of the widest column that is not broken into lines; bold ones by regular ones.
GAP, WIDEST, BOLDER = 3.5, 44.0, 1.15


@dataclass(frozen=True)
class Heading:
    """Heading of level 1, 2 or 3."""

    text: str
    level: int


@dataclass(frozen=True)
class Paragraph:
    """Text; ``kind`` is the class of the page: "", "faint" or "verdict", its ``tone`` as that of a Cell."""

    text: str
    kind: str = ""
    tone: str = ""


@dataclass(frozen=True)
class Cell:
    """Cell of a table; ``kind`` is "", "inside" or "outside"."""

    text: str
    number: bool = False
    kind: str = ""


@dataclass(frozen=True)
class Table:
    """Rows of cells, of which the first ``heads`` are repeated on each page."""

    rows: tuple[tuple[Cell, ...], ...]
    heads: int

    @property
    def columns(self) -> int:
        """Cells of the longest row."""
        return max(len(row) for row in self.rows)

    def widths(self) -> list[float]:
        """Share of the width that each column needs, sum 1."""
        needed = [self._needed(k) for k in range(self.columns)]
        return [width / sum(needed) for width in needed]

    @property
    def letters(self) -> float:
        """Letters that a row needs side by side."""
        return sum(self._needed(k) for k in range(self.columns))

    def _needed(self, k: int) -> float:
        """Letters of a column: its longest text up to a limit or its longest word; heads are bold."""
        found = [
            (row[k].text, BOLDER if i < self.heads else 1.0)
            for i, row in enumerate(self.rows)
            if k < len(row)
        ]
        longest = max((wider * len(text) for text, wider in found), default=0.0)
        word = max((wider * len(w) for text, wider in found for w in text.split()), default=0.0)
        return GAP + max(word, min(WIDEST, longest))


@dataclass(frozen=True)
class Picture:
    """PNG with its caption, of which the first part is bold."""

    png: bytes
    title: str
    caption: str


Block = Heading | Paragraph | Table | Picture


def blocks(elements: Iterable[Element]) -> Iterator[Block]:
    """Blocks of elements in their order; empty paragraphs and what leads around in a page are left out.

    Raises
    ------
    ModelError
        A picture is no PNG.
    """
    for element in elements:
        if element.tag in SKIPPED:
            continue
        if element.tag in HEADINGS:
            yield Heading(text_of(element), HEADINGS[element.tag])
        elif element.tag == "p":
            if text_of(element):
                yield _paragraph(element)
        elif element.tag == "table":
            yield _table(element)
        elif element.tag == "figure":
            yield _picture(element)
        else:
            yield from blocks(element)


def text_of(element: Element) -> str:
    """All text inside, in one line."""
    return " ".join("".join(element.itertext()).split())


def _paragraph(element: Element) -> Paragraph:
    kind, _, tone = element.get("class", "").partition(" ")
    return Paragraph(text_of(element), kind, tone)


def _table(element: Element) -> Table:
    head = element.find("thead")
    rows = [tuple(_cell(cell) for cell in row) for row in element.iter("tr")]
    return Table(tuple(rows), 0 if head is None else len(head))


def _cell(element: Element) -> Cell:
    kinds = element.get("class", "").split()
    kind = next((kind for kind in kinds if kind in ("inside", "outside")), "")
    return Cell(text_of(element), "number" in kinds, kind)


def _picture(element: Element) -> Picture:
    image, caption = element.find(".//img"), element.find("figcaption")
    source = "" if image is None else image.get("src", "")
    if not source.startswith(PNG):
        raise ModelError("report", "has a picture that is no PNG")
    strong = None if caption is None else caption.find("strong")
    title = "" if strong is None else text_of(strong)
    whole = "" if caption is None else text_of(caption)
    return Picture(base64.b64decode(source[len(PNG) :]), title, whole.removeprefix(title).strip())
