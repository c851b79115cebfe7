"""A page made of the elements of ``viz/html.py`` as PDF or Word document; needs the extra ``report``.

PDF by ReportLab and DOCX by python-docx: plain Python, no browser and no system library. ReportLab keeps a
table on one page where it fits there and repeats the head of a longer one, which a browser does not promise.
"""

from __future__ import annotations

from .formats import FORMATS, HTML, available, chosen, write_printed

__all__ = ["FORMATS", "HTML", "available", "chosen", "write_printed"]
