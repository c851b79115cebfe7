"""Numbers of runs with their gradients as functions of other programs that differentiate."""
