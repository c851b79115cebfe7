"""Forces, moments, pressures, and laws of the state."""
