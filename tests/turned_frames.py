"""Kernels that turn corrections with the nodes, for tests of them."""

from ancf.compiled import kernel
from ancf.solvers.step.corotation import remember, turn, turn_back, turn_forth


@kernel
def turned(frames, before, now):
    remember(frames, before)
    turn(frames, now)


@kernel
def back(frames, r):
    turn_back(frames, r)


@kernel
def forth(frames, r):
    turn_forth(frames, r)
