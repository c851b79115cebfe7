"""Newton's iterations along a path of equilibria: steps that are halved, and a line search."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...arrays import FloatArray
from ...errors import SolveError
from ...system.core import find_inverted
from ..failures import inverted
from ..status import VANISHED
from .adrift import adrift
from .free_spin import softest_mode
from .iteration import MORE_MU, Iteration

LOAD = "of the load"  # what a path is one of, for messages
TOLERANCE = 1e-12  # of a correction, positions relative to the size of the model
MAX_ITERATIONS = 300  # in a load step; of joined bodies up to MOST_ITERATIONS while as many leave less than
MOST_ITERATIONS, LEFT = 3000, 0.8  # this of the residual: they may fall for long
PLAIN = 150  # of them without a line search
MOST_HALVINGS = 12  # of a load step
POLISHED = 5  # corrections of a state that has settled
LEAST_SLOPE = 1e-6  # |r_x| of a cable, below which its direction and curvature mean nothing
WHOLE = 1e-12  # of the path, by which its end may be missed
SPUN = 1e-5  # accepted where sections or bodies spin freely, which leaves their angle open
LONGEST = 0.3  # largest change of a slope, or of a position in sizes of the model, in one correction
NO_MOTION = 1e-300  # of a correction: the share that LONGEST leaves of it is whole
REDUCED = 0.5  # of the residual: what a correction leaves when round-off has not been reached
GROWN = 2.0  # of the residual: what is more is a jump of the forces, and no round-off
BALANCED = 1e-6  # of a correction: there is an equilibrium, which may be unstable
DISTURBANCE = 1e-3  # along the softest mode, to leave an unstable equilibrium
SLOW = 0.2  # of the correction before, where loads that follow keep the symmetric matrix from converging
NEAR = 1e-2  # of a correction: mu is no longer needed
LESS_MU = 0.1  # factor of mu after LONG_STEP of a correction; MORE_MU after less than SHORT_STEP of it
LONG_STEP, SHORT_STEP = 0.3, 0.05
BISECTIONS = 40  # of a correction, to where a strip touches: LONGEST becomes 3e-13
TRIALS = 12  # of a line search
WORK_LEFT = 0.8  # of the out-of-balance work along the correction, with which a line search is content
LEAST_PART, MOST_PART = 0.1, 0.7  # of the interval in which it looks next


def follow_path(it: Iteration, load: Callable[[float], float], steps: int, of: str) -> int:
    """Equilibria along a path from 0 to 1; a step that fails is halved.  Returns the number of halvings.

    ``load(share)`` prepares a point of the path and returns the share of the loads there.
    """
    share, part, halvings = 0.0, 1.0 / steps, 0
    while share < 1.0 - WHOLE:
        before = it.q.copy()
        with np.errstate(all="ignore"):  # what overflows on the way is seen and halved
            problem = settle(it, load(min(share + part, 1.0)))
        if problem is None:
            share = min(share + part, 1.0)
            continue
        where, halvings = f"equilibrium at {share:.4g} {of}", halvings + 1
        away = adrift(it, where) if halvings > MOST_HALVINGS else None
        it.q, it.mu = before, 0.0
        part = 0.5 * part
        if halvings > MOST_HALVINGS:
            raise away or it.failure(where, problem, _advice(it, problem, share == 0.0 and of == LOAD))
    return halvings


def _advice(it: Iteration, problem: str, unloaded: bool) -> str:
    """What to do about a path that cannot be followed; ``unloaded``: from where no load acts yet."""
    if problem.endswith(VANISHED):
        return "the load is too large for EA and EI, or a clamp must hold the stretch"
    turning = [beam.name for beam in it.system.model.beams.values() if beam.turns_its_bend]
    if turning:
        what = f'"{turning[0]}" is bent by nature, and nothing resists that this bend turns'
        return f'{what}: hold its plane at each node (position and slope), or take element="nonlocking"'
    if it.last < NEAR and (name := _cable_at(it, it.last_moved)):
        what = f'"{name}" finds no rest: where it has no tension nothing holds it sideways'
        return f"{what}; hold or pull its ends, give it EI, or begin a run from the initial shape"
    if unloaded:
        alone = "if none help, natural lengths alone leave no equilibrium near the initial shape"
        return f"give more load_steps; {alone}: draw it nearer to one, or run it with damping from there"
    return "give more load_steps"


def _cable_at(it: Iteration, slot: int) -> str:
    """Name of the cable to which an entry of the state vector belongs, "" if it is none's."""
    for name, beam in it.system.model.beams.items():
        first = it.system.slots[name]
        if not beam.has_section and np.any((first <= slot) & (slot < first + 3)):
            return name
    return ""


def settle(it: Iteration, share: float) -> str | None:
    """Newton iterations for one share of the loads; None, or what went wrong."""
    r = it.out_of_balance(it.q, share)
    it.mixed.correct(it.zero)
    disturbed, norm, it.last, before, begun = False, np.inf, np.inf, np.inf, it.iterations
    for number in range(MOST_ITERATIONS if it.expected else MAX_ITERATIONS):
        if not np.all(np.isfinite(r)):
            return "the forces are not finite"
        if number % MAX_ITERATIONS == 0:
            size = float(np.linalg.norm(r))
            if not size < LEFT * before:
                break
            before = size
        regular = it.mu == 0.0
        try:
            dq = it.correction(r)
        except SolveError as error:
            if it.arcs:  # it says at which end
                raise
            return error.what
        it.iterations += 1
        if it.lacks_slopes() and it.length(dq) > SLOW * norm:
            dq = it.followed(dq, r, share)
        it.last = norm = it.length(dq)
        it.last_moved = int(np.argmax(np.abs(dq) * it.core.weight))
        accepted = max(it.accepted, SPUN) if it.spinning else it.accepted
        settled = norm <= TOLERANCE or (norm <= accepted and _stalled(it, dq, r, share))
        if not settled and it.mu > 0.0 and norm <= SPUN:
            # what nothing holds goes as far as round-off lets it
            settled = it.drifts(dq) and _stalled(it, dq, r, share)
        if settled and (it.mu == 0.0 or it.harmless()):
            it.q = it.moved(dq, 1.0)
            it.renew_multipliers(share)
            if disturbed or not it.is_unstable():
                return _degenerate(it, share)
        elif disturbed or not (regular and it.mu > 0.0 and norm < BALANCED and not it.harmless()):
            r = _advance(it, dq, r, share, number)
            continue
        disturbed = True  # balanced, but not stable
        it.q = disturb(it)
        it.mixed.correct(it.zero)
        r = it.out_of_balance(it.q, share)
    taken = it.iterations - begun
    return f"Newton's method did not converge in {taken} iterations, last correction {norm:.2e}"


def polish(it: Iteration) -> None:
    """Corrections under all loads with the last factors, while each takes half of what is left."""
    if not it.expected or it.core.joints.tail:
        return
    r = it.out_of_balance(it.q, 1.0)
    for _ in range(POLISHED):
        q = it.moved(it.solve(r), 1.0)
        left = it.out_of_balance(q, 1.0)
        if not np.linalg.norm(left) < REDUCED * np.linalg.norm(r):
            return
        it.q, r = q, left


def _advance(it: Iteration, dq: FloatArray, r: FloatArray, share: float, number: int) -> FloatArray:
    """Take a correction, the ``number``-th, or a part of it; what is out of balance then."""
    norm = it.last
    longest = min(1.0, LONGEST / max(norm, NO_MOTION))
    if longest < 1.0:  # what nothing holds goes as far as it is let
        longest = until_touching(it, dq, longest)
    if number < PLAIN:
        s, r = longest, it.out_of_balance(it.moved(dq, longest), share)
    else:
        s, r = line_search(it, dq, r, share, longest)
    before, it.q = it.q, it.moved(dq, s)
    it.mixed.correct(it.q - before)
    it.mu = relax(it.mu, s, norm, it.ratio) if it.mu > 0.0 else 0.0
    return r


def _degenerate(it: Iteration, share: float) -> str | None:
    """What makes a settled state worthless.

    A section that is inside out, a cable without a tangent, or a joint whose direction has vanished.
    """
    slot = find_inverted(it.core.batches, it.core.ws, it.q)
    if slot >= 0:
        return ": ".join(inverted(it.system, slot)[:2])
    found = it.system.shortest_slope(it.q)
    if found is not None and found[1] < LEAST_SLOPE:
        return f"{found[0]}: {VANISHED}"
    name = it.overtaxed(share)
    return None if name is None else f'"{name}" has no direction left in which it could carry its load'


def _stalled(it: Iteration, dq: FloatArray, r: FloatArray, share: float) -> bool:
    """Round-off: the correction does not reduce the residual any more, nor make it much larger."""
    ahead, now = np.linalg.norm(it.out_of_balance(it.moved(dq, 1.0), share)), np.linalg.norm(r)
    return bool(REDUCED * now <= ahead <= GROWN * now)


def until_touching(it: Iteration, dq: FloatArray, longest: float) -> float:
    """Part of a correction, at most ``longest``, at which the next strip that is open touches its wire.

    A head that only its contact will hold has no stiffness until then: a share of the size of the model
    would press it so deep into the wire that the wire is not found again.
    """
    closed = it.strips(it.q)
    low, high = 0.0, longest
    if not np.any(it.strips(it.moved(dq, high)) & ~closed):
        return longest
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if np.any(it.strips(it.moved(dq, middle)) & ~closed):
            high = middle
        else:
            low = middle
    return high


def relax(mu: float, s: float, norm: float, ratio: float) -> float:
    """Next regularisation: less after a long step, more after a short one, none near the equilibrium.

    Above the largest ratio of stiffness to mass the correction is one down the slope, and short because mu is
    large: it says nothing of how near that is.
    """
    if s == 1.0 and norm < NEAR and mu < ratio:
        return 0.0
    return LESS_MU * mu if s > LONG_STEP else (mu if s > SHORT_STEP else MORE_MU * mu)


def line_search(
    it: Iteration, dq: FloatArray, r: FloatArray, share: float, longest: float
) -> tuple[float, FloatArray]:
    """Part of the correction to take, at most ``longest``, and the residual there."""
    work0 = float(dq @ r)
    if work0 <= 0.0:  # indefinite matrix: there is nothing to search for
        return longest, it.out_of_balance(it.moved(dq, longest), share)
    low, high, w_low = 0.0, longest, work0
    ahead = r
    for _ in range(TRIALS):
        ahead = it.out_of_balance(it.moved(dq, high), share)
        w = float(dq @ ahead)
        if np.isfinite(w) and (abs(w) <= WORK_LEFT * work0 or (w > 0.0 and high == longest)):
            return high, ahead
        if np.isfinite(w) and w > 0.0:
            low, w_low = high, w
            high = 0.5 * (high + longest)
            continue
        longest = high
        ratio = w_low / (w_low - w) if np.isfinite(w) else LEAST_PART
        high = low + float(np.clip(ratio, LEAST_PART, MOST_PART)) * (high - low)
    return high, ahead


def disturb(it: Iteration) -> FloatArray:
    """State moved a little along the softest mode."""
    x = softest_mode(it.solve, it.system.n, it.core.supports.held)
    return it.moved(x / it.length(x), DISTURBANCE)
