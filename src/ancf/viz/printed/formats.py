"""Formats of printed reports: which there are, which can be written here, and writing them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from ...errors import ModelError
from ...files import drafted, writing
from ...model import checks

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element


@dataclass(frozen=True)
class Format:
    """A format beside HTML.

    Parameters
    ----------
    package, module : str
        What it needs, as pip and as Python call it.
    write : callable
        Writes a title and elements to a path.
    """

    package: str
    module: str
    write: Callable[[Path, str, Sequence[Element]], None]


def _pdf(path: Path, title: str, elements: Sequence[Element]) -> None:
    from .pdf import write

    write(path, title, elements)


def _docx(path: Path, title: str, elements: Sequence[Element]) -> None:
    from .docx import write

    write(path, title, elements)


HTML = "html"
FORMATS = {"pdf": Format("reportlab", "reportlab", _pdf), "docx": Format("python-docx", "docx", _docx)}


def available() -> tuple[str, ...]:
    """Formats whose packages are installed, "html" among them."""
    return (HTML, *(name for name, kind in FORMATS.items() if find_spec(kind.module) is not None))


def chosen(given: str | Iterable[str] | None, where: str = "--to") -> tuple[str, ...]:
    """Formats that are asked for, "pdf,docx" or a sequence; all that are available by default.

    Raises
    ------
    ModelError
        One is not known, or its package is missing.
    """
    if given is None:
        return available()
    names = [name.strip() for name in (given.split(",") if isinstance(given, str) else given)]
    for name in names:
        checks.choice(name, where, (HTML, *FORMATS))
        if name != HTML and name not in available():
            what = f"{FORMATS[name].package} is not installed, which writes {name.upper()}"
            raise ModelError(where, what, "pip install 'ancf[report]'")
    return tuple(dict.fromkeys(names))


def write_printed(path: Path, title: str, elements: Sequence[Element]) -> Path:
    """Write elements as the format that the file's name ends with; pictures have to be PNG.

    Parameters
    ----------
    path : Path
        ``NAME.pdf`` or ``NAME.docx``.
    title : str
        Of the document.
    elements : sequence of Element
        Headings, paragraphs, tables, figures and sections of them.

    Raises
    ------
    ModelError
        The file cannot be written.
    """
    with writing(path), drafted(path) as draft:
        FORMATS[path.suffix.removeprefix(".")].write(draft, title, elements)
    return path
