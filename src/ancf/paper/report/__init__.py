"""The page and the JSON of a reproduction."""

from __future__ import annotations

from .build import write_page
from .summary import write_summary

__all__ = ["write_page", "write_summary"]
