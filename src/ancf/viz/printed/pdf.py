"""PDF by ReportLab: A4, numbered pages, tables on one page where they fit, else with their head repeated."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

from .. import style
from .blocks import TONES, Block, Heading, Picture, Table, blocks
from .blocks import Paragraph as Text

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

#: Points in a millimetre.
MM = 72.0 / style.MM_PER_INCH
MARGIN, WIDTH, HEIGHT = 15 * MM, 180 * MM, 267 * MM
#: That ReportLab leaves at the edges of a frame, points.
PADDING = 6.0
#: Size of letters: of text, and of tables by the letters of a row that have to fit.
SIZE, SIZES, LETTERS = 9.0, (8.0, 5.5), 118.0
FONT, BOLD = "DejaVu", "DejaVu-Bold"
#: Space of the headings above a table that has a page of its own.
HEADINGS = 20 * MM
#: Space that the head and the first rows of a long table want.
TOP_OF_TABLE = 50 * MM


def write(path: Path, title: str, elements: Sequence[Element]) -> None:
    """Write a PDF file; it is the same whenever it is written of the same elements."""
    from reportlab.platypus import SimpleDocTemplate

    style.require_matplotlib()
    _register_fonts()
    document = SimpleDocTemplate(
        str(path), title=title, author="ancf", invariant=1,
        pagesize=(WIDTH + 2 * MARGIN, HEIGHT + 2 * MARGIN),
        leftMargin=MARGIN - PADDING, rightMargin=MARGIN - PADDING, topMargin=MARGIN, bottomMargin=MARGIN,
    )  # fmt: skip
    parts = list(_flow(list(blocks(elements))))
    with _binary():
        document.build(parts, onFirstPage=_numbered, onLaterPages=_numbered)


@contextmanager
def _binary() -> Iterator[None]:
    """Pictures as bytes: written as letters they take a quarter more space and half of the time."""
    from reportlab import rl_config

    kept, rl_config.useA85 = rl_config.useA85, 0
    try:
        yield
    finally:
        rl_config.useA85 = kept


def _register_fonts() -> None:
    """DejaVu Sans, which comes with matplotlib: the fonts of PDF itself have no Greek letters."""
    import matplotlib
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFont

    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    for name, file in ((FONT, "DejaVuSans.ttf"), (BOLD, "DejaVuSans-Bold.ttf")):
        pdfmetrics.registerFont(TTFont(name, str(folder / file)))
    pdfmetrics.registerFontFamily(FONT, normal=FONT, bold=BOLD, italic=FONT, boldItalic=BOLD)


def _numbered(canvas: Any, document: Any) -> None:
    canvas.saveState()
    canvas.setFont(FONT, 7)
    canvas.drawRightString(MARGIN + WIDTH, 8 * MM, str(document.page))
    canvas.restoreState()


def _style(name: str, size: float, bold: bool = False, **more: Any) -> Any:
    from reportlab.lib.styles import ParagraphStyle

    return ParagraphStyle(name, fontName=BOLD if bold else FONT, fontSize=size, leading=1.3 * size, **more)


def _flow(found: Sequence[Block]) -> Iterator[Any]:
    """Headings stay with what follows them, tables and pictures on one page unless they are longer."""
    from reportlab.platypus import CondPageBreak, KeepTogether

    styles, waiting = _styles(), []
    for block in found:
        if isinstance(block, Heading):
            waiting += _heading(block, styles)
            continue
        parts = _parts(block, styles)
        long = isinstance(block, Table) and parts[0].wrap(WIDTH, HEIGHT)[1] > HEIGHT - HEADINGS
        yield from (
            [CondPageBreak(TOP_OF_TABLE), *waiting, *parts] if long else [KeepTogether(waiting + parts)]
        )
        waiting = []
    yield from waiting


def _styles() -> dict[Any, Any]:
    from reportlab.lib.colors import HexColor

    return {
        "": _style("text", SIZE, spaceAfter=4),
        "faint": _style("faint", 7.5, spaceAfter=4, textColor=HexColor(style.GREY)),
        "verdict": _style("verdict", SIZE, spaceBefore=4, spaceAfter=6, leftIndent=6),
        1: _style("title", 16, True, spaceAfter=4),
        2: _style("section", 12, True, spaceBefore=14, spaceAfter=2),
        3: _style("part", SIZE + 0.5, True, spaceBefore=8, spaceAfter=2),
    }


def _heading(block: Heading, styles: dict[Any, Any]) -> list[Any]:
    from reportlab.lib.colors import HexColor
    from reportlab.platypus import HRFlowable, Paragraph

    rule = HRFlowable(width="100%", thickness=1, color=HexColor(style.BLUE), spaceAfter=5)
    return [Paragraph(escape(block.text), styles[block.level]), *([rule] if block.level == 2 else [])]


def _parts(block: Block, styles: dict[Any, Any]) -> list[Any]:
    from reportlab.platypus import Paragraph

    if isinstance(block, Table):
        return [_table(block)]
    if isinstance(block, Picture):
        return _picture(block, styles["faint"])
    assert isinstance(block, Text)
    text = escape(block.text)
    if block.tone:
        text = f'<font color="{style.PAGE[TONES[block.tone]]}">{text}</font>'
    return [Paragraph(text, styles.get(block.kind, styles[""]))]


def _table(block: Table) -> Any:
    """Between its rows it may be split, and its head comes again."""
    from reportlab.platypus import LongTable, Paragraph

    size = max(SIZES[1], min(SIZES[0], SIZES[0] * LETTERS / block.letters))
    width = WIDTH * min(1.0, block.letters * size / (SIZES[0] * LETTERS))
    looks = {
        (number, bold): _style("cell", size, bold, alignment=2 if number else 0)
        for number in (False, True)
        for bold in (False, True)
    }
    colours = {kind: style.PAGE[name] for kind, name in TONES.items()}
    rows = [
        [
            Paragraph(
                f'<font color="{colours[cell.kind]}">{escape(cell.text)}</font>',
                looks[cell.number, k < block.heads or cell.kind == "outside"],
            )
            for cell in row
        ]
        + [""] * (block.columns - len(row))
        for k, row in enumerate(block.rows)
    ]
    widths = [share * width for share in block.widths()]
    made = LongTable(
        rows, colWidths=widths, repeatRows=block.heads, hAlign="LEFT", spaceBefore=3, spaceAfter=8
    )
    made.setStyle(_lines(block))
    return made


def _lines(block: Table) -> list[Any]:
    """Lines below the rows, a stronger one below the head, and the space around texts."""
    from reportlab.lib.colors import HexColor

    whole, last = ((0, 0), (-1, -1)), block.heads - 1
    found: list[Any] = [
        ("LINEBELOW", *whole, 0.3, HexColor(style.LIGHT)),
        ("VALIGN", *whole, "TOP"),
        ("LEFTPADDING", *whole, 0),
        ("RIGHTPADDING", *whole, 6),
        ("TOPPADDING", *whole, 1.5),
        ("BOTTOMPADDING", *whole, 1.5),
    ]
    if block.heads:
        found.append(("LINEBELOW", (0, last), (-1, last), 0.8, HexColor(style.BLACK)))
    return found


def _picture(block: Picture, below: Any) -> list[Any]:
    from reportlab.lib.utils import ImageReader
    from reportlab.platypus import Image, Paragraph

    across, down = ImageReader(io.BytesIO(block.png)).getSize()
    width = min(WIDTH, across / style.DPI * 72.0)
    height = width * down / across
    if height > 0.85 * HEIGHT:
        width, height = width * 0.85 * HEIGHT / height, 0.85 * HEIGHT
    text = f"<b>{escape(block.title)}</b> {escape(block.caption)}"
    image = Image(io.BytesIO(block.png), width=width, height=height, hAlign="LEFT")
    return [image, Paragraph(text, below)]
