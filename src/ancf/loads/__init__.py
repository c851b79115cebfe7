"""Loads that depend on the state, one file per kind."""
