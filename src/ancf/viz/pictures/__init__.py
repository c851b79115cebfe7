"""Figures and movies of results with matplotlib; needs the extra `plot`."""
