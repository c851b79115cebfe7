"""Connections between points, one file per kind."""
