"""Pantographs and the vehicles that carry them."""
