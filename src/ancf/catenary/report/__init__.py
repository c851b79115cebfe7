"""The report of a run: one HTML file with matplotlib, the extra ``plot``; PDF, DOCX with ``report``."""

from __future__ import annotations

from .build import write_report, write_reports
from .content import Content

__all__ = ["Content", "write_report", "write_reports"]
