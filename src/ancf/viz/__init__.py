"""Figures; needs the extra `plot`, and nothing in the core imports it."""
