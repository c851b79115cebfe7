"""When a new matrix pays for itself.

A kept matrix that fits less and less costs iterations long before it fails to contract.  What a step takes
beyond the steps just after a renewal is added up; a renewal pays once that excess has become what it costs.
Whether it did is seen in the step after: the limit is halved if it took fewer iterations, doubled if not.
A matrix that was made for another reason may fit badly from the beginning, as that of a first step that began
far from where it ended: with it what a step takes beyond the fewest iterations possible is added up.
"""

from __future__ import annotations

from ...compiled import formula
from .memory import EXCESS, H_FACTOR, LIMIT, USUAL, WORN

#: Between which the limit moves, in iterations; it begins with the least.
LEAST_LIMIT, GREATEST_LIMIT = 8.0, 1024.0
UNKNOWN = -1.0
#: Of an accepted correction the second shows how large an error it leaves.
FEWEST = 2.0


@formula
def renewed(s):
    """The matrix is new: what it costs shows in the steps to come."""
    s.memo[USUAL], s.memo[EXCESS] = UNKNOWN, 0.0


@formula
def count(s, iterations, fresh):
    """Add up what a converged step took; a matrix that costs more than a new one is given up."""
    if fresh:
        return
    if s.memo[USUAL] == UNKNOWN and s.memo[WORN] > 0.0:
        helped = iterations < s.memo[WORN]
        limit = 0.5 * s.memo[LIMIT] if helped else 2.0 * s.memo[LIMIT]
        s.memo[LIMIT], s.memo[WORN] = min(max(limit, LEAST_LIMIT), GREATEST_LIMIT), 0.0
        s.memo[USUAL] = iterations
        return
    if s.memo[USUAL] == UNKNOWN:
        s.memo[USUAL] = FEWEST
    s.memo[EXCESS] += max(iterations - s.memo[USUAL], 0.0)
    if s.memo[EXCESS] > s.memo[LIMIT]:
        s.memo[H_FACTOR], s.memo[WORN] = 0.0, iterations
