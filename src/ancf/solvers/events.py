"""What happens to sliding joints between two steps: contact opens and closes, the carrier ends."""

from __future__ import annotations

from ..arrays import FloatArray
from ..connections.sliding import FREE, FROZEN, LEFT, PULLS, SlidingBatch
from ..errors import SolveError
from ..model.joints.basic import Slide
from ..system.system import System


def happen(system: System, q: FloatArray, v: FloatArray, code: int, when: str) -> None:
    """Change the joint to which the event with this code has happened, and its unknowns in q and v.

    Raises
    ------
    SolveError
        The sliding point has left the carrier and the joint's ``at_end`` is "stop".
    """
    batch = system.parts["slides"]
    k, what = code // 4, code % 4
    joint = [c for c in system.model.connections if isinstance(c, Slide)][k]
    if what == LEFT:
        _end(system, batch, k, joint, q, v, when)
    else:
        batch.open[k] = int(what == PULLS)


def _end(
    system: System, batch: SlidingBatch, k: int, joint: Slide, q: FloatArray, v: FloatArray, when: str
) -> None:
    last = batch.first[k + 1] - 1
    start, end = float(batch.x[batch.first[k], 0]), float(batch.x[last].sum())
    unknown = int(batch.unknown[k]) + 3
    s = float(q[unknown])
    if joint.at_end == "stop":
        side = "end" if s > end else "start"
        what = f"has reached the {side} of {joint.carrier.name}: s = {s:.6g} m, {start:g} to {end:.6g} m"
        hint = 'give at_end="clamp" or "release", or a longer carrier'
        raise SolveError(f"{when}, {joint.name}", what, hint)
    batch.mode[k] = FROZEN if joint.at_end == "clamp" else FREE
    q[unknown], v[unknown] = min(max(s, start), end), 0.0
