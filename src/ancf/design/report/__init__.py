"""The report of a study: one HTML file with figures and tables."""

from .build import write_report

__all__ = ["write_report"]
