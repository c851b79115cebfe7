"""Static equilibrium, time stepping and modes of a System."""
