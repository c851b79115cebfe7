"""Vibrations about an equilibrium or a steady rotation, and linear equations of motion there."""
