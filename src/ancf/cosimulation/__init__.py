"""Models as units of co-simulation by the functional mock-up interface (FMI)."""
