"""How a step ends, and what a run counts: the same numbers for all methods."""

from __future__ import annotations

OK, DIVERGED, NOT_FINITE, SINGULAR, SLOW, INVERTED, FAR, UNBALANCED, TOO_MANY = range(9)
TURN = 15  # a step is OK, and a part of the model has to wake or may sleep, see far
EVENT = 16  # plus the code of an event after a step that is OK
#: What is said of INVERTED.
COLLAPSED = "the cross-section has collapsed or turned inside out"
VANISHED = "the cable is pressed together until its tangent r_x vanishes"
THROUGH = "it goes through a surface that it touches"
#: Names of what is counted, and their places.
COUNTS = ("steps", "newton_iterations", "jacobians", "factorizations", "retries")
STEPS, ITERATIONS, JACOBIANS, FACTORIZATIONS, RETRIES = range(5)
