"""What bodies move in and lie on: fluids, waves, gusts, grounds."""
