"""Studies: many variants of a model or a line, their outputs in a table, and what the table says."""
