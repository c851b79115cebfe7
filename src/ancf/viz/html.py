"""Elements of a page: small builders on the standard library's tree, so that all text is escaped."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable, Sequence
from importlib.resources import files
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

#: What an element holds.
Piece = Element | str
#: Columns from which on a table takes the room of the window.
MANY = 9
#: A number that a browser would break at its exponent.
EXPONENT = re.compile(r"(-?\d[\d.]*[eE]-\d+)")
#: A name with a number, which a browser would break at the hyphen.
NUMBERED = re.compile(r"(\S+-\d+)")
#: Width of an SVG, and pixels of the page for one of its points: a figure over two columns fills the page.
DRAWN_WIDTH, POINT = re.compile(r'<svg\b[^>]*?\bwidth="([\d.]+)pt"'), 1.65


def element(tag: str, *pieces: Piece, **attributes: str) -> Element:
    """Element with text and elements inside; ``class_`` stands for the attribute ``class``."""
    made = Element(tag, {key.rstrip("_").replace("_", "-"): value for key, value in attributes.items()})
    for piece in pieces:
        if isinstance(piece, Element):
            made.append(piece)
        elif len(made):
            made[-1].tail = (made[-1].tail or "") + piece
        else:
            made.text = (made.text or "") + piece
    return made


def section(title: str, name: str, *pieces: Piece) -> Element:
    """Section with a heading, to which ``#name`` leads."""
    return element("section", element("h2", title), *pieces, id=name)


def table(
    head: Sequence[str],
    rows: Iterable[Sequence[str]],
    numbers: Iterable[int] = (),
    wide: bool = False,
    **more: str,
) -> Element:
    """Table of texts; columns whose place is in `numbers` are aligned to the right.

    With many columns, or if it is `wide`, it takes the room of the window that it needs.
    """
    right = set(numbers)
    cells = [{"class_": "number"} if i in right else {} for i in range(len(head))]
    top = element("tr", *(_head(text, a) for text, a in zip(head, cells, strict=True)))
    body = [
        element(
            "tr",
            *(
                element("td", *(_whole(text) if not a else [text]), **a)
                for text, a in zip(row, cells, strict=True)
            ),
        )
        for row in rows
    ]
    return element(
        "div",
        element("table", element("thead", top), element("tbody", *body), **more),
        class_="scroll wide" if wide or len(head) >= MANY else "scroll",
        tabindex="0",
    )


def _whole(text: str) -> list[Piece]:
    """Text whose numbers as 1e-06 stay on one line: a browser would break them behind the e-."""
    parts = EXPONENT.split(text)
    return [element("span", part, class_="whole") if k % 2 else part for k, part in enumerate(parts) if part]


def _head(text: str, look: dict[str, str]) -> Element:
    """Head of a column; where there is nothing to read, a screen reader finds no head."""
    return element("th", *_joined(text), scope="col", **look) if text else element("td", **look)


def _joined(text: str) -> list[Piece]:
    """Text whose words that end in a number stay on one line: "after-2" is a name."""
    parts = NUMBERED.split(text)
    return [element("span", part, class_="whole") if k % 2 else part for k, part in enumerate(parts) if part]


def pairs(rows: Iterable[tuple[str, str]]) -> Element:
    """Table of names and values without a head."""
    lines = [
        element("tr", element("th", name, scope="row"), element("td", *_whole(value))) for name, value in rows
    ]
    return element(
        "div", element("table", element("tbody", *lines), class_="pairs"), class_="scroll", tabindex="0"
    )


def figure(name: str, title: str, caption: str, drawn: str | bytes) -> Element:
    """Figure with its picture inside the page, SVG as text or PNG as bytes; ids stay apart.

    An SVG is as large as its letters ask for, however narrow it is drawn; on narrow screens it scrolls.
    """
    content, kind = (drawn, "png") if isinstance(drawn, bytes) else (drawn.encode("utf-8"), "svg+xml")
    width = DRAWN_WIDTH.search(drawn) if isinstance(drawn, str) else None
    most = POINT * float(width[1]) if width else None
    text = element("figcaption", element("strong", f"{title}. "), caption)
    return element("figure", framed(content, kind, f"{title}. {caption}", most), text, id=f"figure-{name}")


def framed(content: bytes, kind: str, alt: str, most: float | None = None) -> Element:
    """Picture that scrolls within the page where this is narrow, `most` pixels wide, see :func:`picture`."""
    look = {"style": f"max-width: {most:.0f}px; min-width: min(34rem, {most:.0f}px)"} if most else {}
    return element("div", picture(content, kind, alt, **look), class_="scroll", tabindex="0")


def picture(content: bytes, kind: str, alt: str, **more: str) -> Element:
    """Picture inside the page; `kind` is ``png`` or ``svg+xml``, `alt` is what it shows, in words."""
    coded = base64.b64encode(content).decode("ascii")
    return element("img", src=f"data:image/{kind};base64,{coded}", alt=alt, **more)


def folded(title: str, *pieces: Piece) -> Element:
    """Block that shows its title alone until it is opened."""
    return element("details", element("summary", title), *pieces)


def page(title: str, *pieces: Piece, css: str = "") -> str:
    """Whole page; it needs no other file and no network.

    Parameters
    ----------
    title : str
    pieces : elements and texts
        What the page shows.
    css : str
        Rules beyond those that all pages share.

    """
    shared = files(__package__).joinpath("page.css").read_text(encoding="utf-8")
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", title),
        element("link", rel="icon", href="data:,"),
        element("style", shared + css),
    )
    tree = element("html", head, element("body", element("main", *pieces)), lang="en")
    return "<!DOCTYPE html>\n" + ElementTree.tostring(tree, encoding="unicode", method="html") + "\n"
