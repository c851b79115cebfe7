"""Static equilibrium by load steps, a regularised Newton method and a line search.

Each correction solves (K + mu M) dq = -r.  The mass-weighted term is there only while the plain
matrix K is not positive definite or the corrections are too long: a slack cable has hardly any
stiffness against falling, a compressed one a negative one.  mu goes to zero as the iteration settles,
so that the last corrections are Newton's own.  Corrections are capped; when they do not settle, a line
search looks for the place along the correction where the out-of-balance force does no more work.
Because only positive definite matrices are accepted, the result is a stable equilibrium; but for loads that
follow the motion, whose derivatives GMRES takes where the symmetric matrix converges slowly.
"""

from __future__ import annotations

import time as clock
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...compiled import traits
from ...connections.sliding import LEFT
from ...errors import SolveError
from ...system.core import Core, apply_load, first_event, keep_memory, place_supports, residual
from ...system.system import System
from ..events import happen
from ..record import Stats
from .floating import check_supported
from .iteration import Iteration
from .path import LOAD, follow_path, polish, settle
from .pressed import least_stretch
from .slack import LET_OUT, Slack
from .turning import Turning

STENCIL_STEP = 1e-3  # of the differences that give rates of given motions, s
RENEWED, MOST_RENEWED = 1e-9, 240  # change of what comes last that is none, and rounds
UNMOVED = 1e-10  # correction after it that is round-off, positions in sizes of the model
PRESSED = 1e-9  # by which friction may shorten a cable
MOST_RELEASES = 30  # rounds in which surfaces let go what they pull
MOST_EVENTS = 4  # openings and closings of a contact
SLIPS = (
    "where friction slips for good there is none: simulate, or more friction; "
    "else another stiffness of the contact, shorter elements, or start nearer to it"
)
FINER = 1, 7, 31  # times as many steps of the loads where something touches and no equilibrium was found


class Leaned(NamedTuple):
    """From what friction acts in an equilibrium."""

    shape: FloatArray  # (size,) in which it has no force
    laid: bool  # that is where cables lay without friction, not the initial shape
    memory: dict[str, FloatArray]  # in which the equilibrium was found, by "part.array"


def equilibrium(
    system: System, of: list[str] | None, load_steps: int, time: float
) -> tuple[FloatArray, Stats, Leaned]:
    """State vector of a stable equilibrium under the loads at ``time``, what it took and what friction did.

    Raises
    ------
    ModelError
        A body is not supported.
    SolveError
        The iteration did not converge.
    """
    others = [] if of is None else [name for name in system.model.bodies if name not in of]
    check_supported(system, others)
    system.level[:] = 1.0, 0.0, 0.0
    cpu = clock.process_time()
    q, _ = system.initial_state(time)
    core = system.holding(others) if others else system.core
    h = STENCIL_STEP
    tables = system.inputs.tables(time - h, h, 1, time, np.inf)
    v, a = np.zeros_like(q), np.zeros_like(q)
    place_supports(core.supports, core.loads.value, tables, 0, q, v, a)
    force = np.empty_like(q)
    apply_load(core.loads, tables.value[0], force)
    keep_memory(core.remembering, q, v)  # friction opposes the way from the initial shape
    it = Iteration(system, core, q, force, core.loads.value.copy())
    first = q.copy()
    slack = Slack(system, q, force)
    try:
        halvings = attempt(it, slack, Turning(system.model, time), load_steps)
    finally:
        slack.set(0.0, 0.0)
        core.loads.value[:] = it.inputs
    _whole_multipliers(it)
    polish(it)
    leaned = Leaned(first if it.laid is None else it.laid, it.laid is not None, system.kept_memory())
    keep_memory(core.remembering, it.q, it.zero)
    seconds = clock.process_time() - cpu
    return it.q, Stats(load_steps, it.iterations, it.jacobians, it.jacobians, halvings, seconds), leaned


def _whole_multipliers(it: Iteration) -> None:
    """Let multipliers be the forces of joints without what the scaled gaps added to them.

    In the last digits gaps are round-off, but scaled by a stiffness they are forces, which only multipliers
    that differ by as much balance: left so, these would stiffen or soften what turns.
    """
    joints = it.system.parts.get("joints")
    if joints is None:
        return
    r = np.empty_like(it.q)
    residual(it.core.batches, it.core.ws, it.q, it.zero, it.zero, it.force, r)
    free = ~np.isin(joints.unknown, it.core.supports.held)
    it.q[joints.unknown[free]] += (joints.alpha * r[joints.unknown])[free]
    joints.alpha[:] = 0.0


def bring_on(it: Iteration, slack: Slack, turning: Turning, load_steps: int) -> int:
    """The loads, then what slack cables need, then what comes last; returns the halvings of steps."""
    slack.set(1.0, 1.0)
    turning.begin(it)
    steps = max(load_steps, turning.steps)
    halvings = follow_path(it, lambda share: turning.load(it, share), steps, LOAD)
    if slack.found:
        halvings += follow_path(it, slack.let_out, LET_OUT, "of the slack")
        try:
            halvings += follow_path(it, slack.stiffen, slack.steps, "of the axial stiffness")
        except SolveError as error:
            if hint := slack.too_stiff():
                error.hint = ""  # no finer steps help
                error.advise(hint)
            raise
    settle_contacts(it)
    lay(it)
    return halvings


def lay(it: Iteration) -> None:
    """Friction from the initial shape; or from where cables come down without it, if it would press one.

    A slack line that was drawn straight is far from where it lies: friction that opposes all of that way is
    more than its tension can bear, and a line on the ground buckles under less than elements can show.
    """
    ways = [(batch, own) for batch in it.core.batches if (own := traits(batch).laid) is not None]
    before, mu = it.q, it.mu
    try:
        bring_late(it)
    except SolveError:
        if not ways:
            raise
    else:
        if not ways or least_stretch(it.system, it.q) > min(least_stretch(it.system, before), 1.0) - PRESSED:
            return
    it.q, it.mu, it.laid = before, mu, before.copy()
    for batch, way in ways:
        way(batch, it.q)
    bring_late(it)


def grips(core: Core, q: FloatArray, holds: bool) -> bool:
    """Let friction and surfaces hold what they touch, or not; whether there is any friction."""
    ways = [(batch, own) for batch in core.batches if (own := traits(batch).early) is not None]
    found = [early(batch, q, holds) for batch, early in ways]
    return any(found)


def attempt(it: Iteration, slack: Slack, turning: Turning, load_steps: int) -> int:
    """Bring on the loads while what is touched holds, or while it only pushes and there is no friction.

    Where friction alone holds a cable there is no equilibrium without it, and a cable that just touches has
    no stiffness until something presses it; where it has to slide into its place, holding it may press it
    together until it buckles.
    """
    first, q = None, it.q.copy()
    for (finer, holds), plain in product(_attempts(it.core, q), _plain(it)):
        it.q, it.mu, it.held, it.plain, it.laid = q.copy(), 0.0, holds, plain, None
        it.system.bring_memory(it.begun)
        grips(it.core, it.q, holds)
        try:
            halvings = bring_on(it, slack, turning, finer * load_steps)
            if holds:
                let_go(it)
            return halvings
        except SolveError as error:
            slack.set(0.0, 0.0)
            first = first or error
    grips(it.core, q, False)
    assert first is not None
    raise first


def _plain(it: Iteration) -> tuple[bool, ...]:
    """Whether an indefinite matrix is taken as it is, one attempt after the other.

    A cable that hangs in a current has a stable equilibrium that a regularised iteration finds, and others;
    beams under moments may have one whose symmetric matrix is indefinite.
    """
    if not it.follows:
        return (True,)
    return (False, True) if it.system.model.fluids else (True, False)


def _attempts(core: Core, q: FloatArray) -> list[tuple[int, bool]]:
    """How much finer the loads come on, and whether what they touch holds, one attempt after the other.

    Contact with friction has kinks, at which the iteration may go to and fro for ever: from another side, as
    after other steps, it goes past them.
    """
    if grips(core, q, False):
        ways: tuple[bool, ...] = True, False
    elif _holding(core):
        ways = False, True
    else:
        return [(1, False)]
    return [(finer, holds) for finer in FINER for holds in ways]


def _holding(core: Core) -> list[tuple[Any, Any]]:
    """What may hold against its nature, and how it lets go."""
    return [(batch, own) for batch in core.batches if (own := traits(batch).free) is not None]


def let_go(it: Iteration) -> None:
    """Let go, step by step, what surfaces pull, and at last all that they hold."""
    held = _holding(it.core)
    for number in range(MOST_RELEASES if held else 0):
        last = number + 1 == MOST_RELEASES
        pulled = sum(free(batch, it.q, last) for batch, free in held)
        if pulled:
            problem = settle(it, 1.0)
            if problem is not None:
                hint = SLIPS if _late(it.core) else "start nearer to the equilibrium"
                raise it.failure("equilibrium", problem, hint)
            bring_late(it)
        elif not last:
            break
    for batch, free in held:
        free(batch, it.q, True)


def _late(core: Core) -> list[tuple[Any, Any]]:
    """What comes last, such as friction, and how it is renewed."""
    ways = [(batch, own(batch)) for batch in core.batches if (own := traits(batch).late) is not None]
    return [(batch, way) for batch, way in ways if way is not None]


def bring_late(it: Iteration) -> None:
    """Bring on what comes last, such as friction, and renew it until it fits the equilibrium."""
    found = _late(it.core)
    for _ in range(MOST_RENEWED if found else 0):
        changes, before = [way(batch, it.q) for batch, way in found], it.q
        if max(changes) < RENEWED:
            return
        problem = settle(it, 1.0)
        if problem is not None:
            raise it.failure("equilibrium with friction", problem, SLIPS)
        if it.length((it.q - before)[: it.system.n]) < UNMOVED:
            return
    if found:
        what = f"friction did not settle in {MOST_RENEWED} rounds"
        raise it.failure("equilibrium with friction", what, SLIPS)


def settle_contacts(it: Iteration) -> None:
    """Open the contacts that pull and close those that overlap until all are right."""
    for _ in range(MOST_EVENTS * len(it.arcs)):
        code = first_event(it.core.joints.tail, it.q)
        if code < 0 or code % 4 == LEFT:
            return
        happen(it.system, it.q, it.zero.copy(), int(code), "equilibrium")
        problem = settle(it, 1.0)
        if problem is not None:
            raise it.failure("equilibrium", problem, "give more load_steps")
