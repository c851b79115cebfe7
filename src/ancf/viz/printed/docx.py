"""DOCX by python-docx: headings of Word; rows and short tables stay on one page, heads are repeated."""

from __future__ import annotations

import datetime
import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import style
from .blocks import TONES, Cell, Heading, Paragraph, Picture, Table, blocks

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

MARGIN, WIDTH = 15.0, 180.0  # mm
#: Size of letters: of text, and of tables by the letters of a row that have to fit.
SIZE, SIZES, LETTERS = 10, (8.5, 6.0), 112.0
#: Rows of a table that fits on a page and is kept there.
ON_A_PAGE = 45


def write(path: Path, title: str, elements: Sequence[Element]) -> None:
    """Write a Word document."""
    from docx import Document
    from docx.shared import Mm, Pt

    document = Document()
    page = document.sections[0]
    page.page_width, page.page_height = Mm(WIDTH + 2 * MARGIN), Mm(297)
    page.left_margin = page.right_margin = page.top_margin = page.bottom_margin = Mm(MARGIN)
    document.styles["Normal"].font.name = "Arial"
    document.styles["Normal"].font.size = Pt(SIZE)
    document.core_properties.title, document.core_properties.author = title, "ancf"
    document.core_properties.comments = ""
    document.core_properties.created = datetime.datetime.now(datetime.UTC)
    for block in blocks(elements):
        if isinstance(block, Heading):
            document.add_heading(block.text, 0 if block.level == 1 else block.level - 1)
        elif isinstance(block, Paragraph):
            _paragraph(document, block)
        elif isinstance(block, Table):
            _table(document, block)
        elif isinstance(block, Picture):
            _picture(document, block)
    document.save(str(path))


def _paragraph(document: Any, block: Paragraph) -> None:
    from docx.shared import Pt, RGBColor

    run = document.add_paragraph().add_run(block.text)
    if block.kind == "faint":
        run.font.size, run.font.color.rgb = Pt(8), RGBColor.from_string(style.GREY.strip("#"))
    run.bold = block.kind == "verdict"
    if block.tone:
        run.font.color.rgb = RGBColor.from_string(style.PAGE[TONES[block.tone]].strip("#"))


def _table(document: Any, block: Table) -> None:
    from docx.oxml import OxmlElement
    from docx.shared import Mm, Pt

    size = max(SIZES[1], min(SIZES[0], SIZES[0] * LETTERS / block.letters))
    made = document.add_table(rows=len(block.rows), cols=block.columns)
    made.style, made.autofit = "Light List" if block.heads else "Table Grid", False
    total = WIDTH * min(1.0, block.letters * size / (SIZES[0] * LETTERS))
    widths = [Mm(share * total) for share in block.widths()]
    for column, width in zip(made.columns, widths, strict=True):
        column.width = width
    kept = len(block.rows) <= ON_A_PAGE
    for k, row in enumerate(block.rows):
        properties = made.rows[k]._tr.get_or_add_trPr()
        properties.append(OxmlElement("w:cantSplit"))
        if k < block.heads:
            properties.append(OxmlElement("w:tblHeader"))
        for j, (cell, place) in enumerate(zip(row, made.rows[k].cells, strict=False)):
            place.width = widths[j]
            _cell(place.paragraphs[0], cell, Pt(size), k < block.heads)
            place.paragraphs[0].paragraph_format.keep_with_next = kept and k + 1 < len(block.rows)
    document.add_paragraph()


def _cell(paragraph: Any, cell: Cell, size: Any, head: bool) -> None:
    from docx.enum.text import WD_ALIGN_PARAGRAPH
    from docx.shared import Pt, RGBColor

    run = paragraph.add_run(cell.text)
    run.font.size, run.bold = size, head or cell.kind == "outside"
    paragraph.paragraph_format.space_after = Pt(1)
    if cell.number:
        paragraph.alignment = WD_ALIGN_PARAGRAPH.RIGHT
    if cell.kind:
        run.font.color.rgb = RGBColor.from_string(style.PAGE[TONES[cell.kind]].strip("#"))


def _picture(document: Any, block: Picture) -> None:
    from docx.shared import Mm, Pt

    paragraph = document.add_paragraph()
    paragraph.paragraph_format.keep_with_next = True
    paragraph.add_run().add_picture(io.BytesIO(block.png), width=Mm(WIDTH))
    below = document.add_paragraph()
    title, caption = below.add_run(f"{block.title} "), below.add_run(block.caption)
    title.bold = True
    title.font.size = caption.font.size = Pt(8)
