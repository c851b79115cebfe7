"""Ropes on drums and sheaves beside closed forms."""
