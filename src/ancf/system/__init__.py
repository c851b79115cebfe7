"""A Model compiled once to flat arrays: unknowns, batches, residual, matrix, constraints."""
