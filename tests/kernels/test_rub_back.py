"""What friction on surfaces remembers, backwards: the transposed of what it is forwards, to round-off."""

import numpy as np
from test_ground_back import check_numbers, check_states
from test_rub_slopes import BODIES, DAMPINGS, FRICTIONS, SHAPES, lying


@SHAPES
@BODIES
@FRICTIONS
@DAMPINGS
def test_states_and_memories(kind, on, friction, damping):
    system, batch, given, memory = lying(kind, on, friction, damping)
    points, rows = batch.limit.size, len(batch.most)
    smooth = np.concatenate([np.ones(len(memory)), np.zeros(rows)])  # what rows may do has no derivative
    limits = slice(3 * points, 4 * points)
    smooth[limits] = np.where(memory[limits] > 1e9, 0.0, 1.0)  # of what sticks the limit does not count
    check_states(batch, system, given, len(smooth), smooth)


@SHAPES
@BODIES
@FRICTIONS
@DAMPINGS
def test_numbers(kind, on, friction, damping):
    system, batch, given, memory = lying(kind, on, friction, damping)
    check_numbers(batch, system, given, len(memory) + len(batch.most))
