"""Static equilibrium, time stepping and modes of a System.

Here stands what all methods share (statuses, records, sensors, snapshots) and what puts a step and a run
together (``newmark``, ``block``, ``stepping``); the folders below have the parts and the other methods.
"""
