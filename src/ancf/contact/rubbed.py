"""What friction is in all of a contact: sums that sensors record and that states remember."""

from __future__ import annotations

from ..compiled import formula, inline_kernel

#: Columns of ``found``: friction of all places added up by size, N, and the share of it that slips.
RUBBED, SLIPPED = 2, 3
#: Share of a normal force by which the one of the next step is expected to differ at most.
GROWS = 0.1


@inline_kernel
def ahead(N, before):
    """The normal force a step later, if it goes on to change as it did, and changes by little."""
    if before == 0.0:
        return N
    return min(max(2.0 * N - before, (1.0 - GROWS) * N), (1.0 + GROWS) * N)


@formula
def nothing_found(batch):
    """Begin sums of friction."""
    for j in range(batch.found.shape[0]):
        batch.found[j, RUBBED], batch.found[j, SLIPPED] = 0.0, 0.0


@formula
def find(batch, j, force, slips):
    """Add the size of a friction force to the sums of contact j."""
    batch.found[j, RUBBED] += force
    batch.found[j, SLIPPED] += force if slips else 0.0


@formula
def share_found(batch):
    """End sums of friction: what slips as a share."""
    for j in range(batch.found.shape[0]):
        if batch.found[j, RUBBED] > 0.0:
            batch.found[j, SLIPPED] /= batch.found[j, RUBBED]
