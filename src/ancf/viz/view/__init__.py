"""A moving picture of a result: one HTML page for a browser, which works without a network."""

from .curve import Curve
from .page import COLORS, Options, page
from .together import Part, labels_of
from .traces import Trace
from .write import shown_of, view_page, write_view

__all__ = [
    "COLORS",
    "Curve",
    "Options",
    "Part",
    "Trace",
    "labels_of",
    "page",
    "shown_of",
    "view_page",
    "write_view",
]
