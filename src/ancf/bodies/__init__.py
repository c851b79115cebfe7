"""Bodies that do not deform: point masses and rigid bodies."""
