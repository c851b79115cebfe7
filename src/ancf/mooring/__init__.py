"""Mooring lines against other programs and measurements: ``ancf validate mooring``."""
