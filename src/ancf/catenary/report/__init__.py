"""The report of a run as one HTML file; needs matplotlib, the extra ``plot``."""

from __future__ import annotations

from .build import write_report
from .content import Content

__all__ = ["Content", "write_report"]
