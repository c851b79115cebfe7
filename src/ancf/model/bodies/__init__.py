"""Beams with their initial shapes, point masses and rigid bodies."""
