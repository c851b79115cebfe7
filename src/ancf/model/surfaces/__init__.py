"""Surfaces, and contacts with them, with strips and between cables."""
