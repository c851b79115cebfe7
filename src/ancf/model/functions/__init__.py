"""Functions of time: constants, formulas, tables, measured series, inputs."""
