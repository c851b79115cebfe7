"""A line as its designer describes it, in Python and in files; no numerics."""
