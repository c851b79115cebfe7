"""Beams and cables on surfaces: distances, pressure, friction that sticks."""
