"""A moving picture of a result: one HTML page for a browser, which works without a network."""

from .curve import Curve
from .page import COLORS, Options, page
from .traces import Trace
from .write import view_page, write_view

__all__ = ["COLORS", "Curve", "Options", "Trace", "page", "view_page", "write_view"]
