"""Compiled kernels: one decorator, one cache, one way to add a kind of force.

A *batch* is a NamedTuple of flat arrays that holds all parts of one kind (all cable elements, all
springs, ...).  Each kind implements the operations below for its own batch type; a compiled
loop over the batches of a System finds the right one by type.  Kernels take arrays, write into
their arguments, allocate nothing and know no objects.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Flag, auto
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba import types
from numba.extending import overload

from . import kept, kernel_cache
from .asked import OF_SENSITIVITIES
from .asked import add_changes as add_changes
from .asked import add_force_slopes as add_force_slopes
from .asked import add_measured_work as add_measured_work
from .asked import add_memory_changes as add_memory_changes
from .asked import add_memory_slopes as add_memory_slopes
from .asked import add_number_work as add_number_work
from .asked import add_rate_stiffness as add_rate_stiffness
from .asked import add_rate_work as add_rate_work
from .asked import add_slopes_beside as add_slopes_beside
from .asked import add_tangent_work as add_tangent_work
from .asked import add_work_slopes as add_work_slopes
from .asked import choose_memory as choose_memory
from .asked import remember_along as remember_along
from .asked import take_measured_slopes as take_measured_slopes
from .asked import take_memory_back as take_memory_back
from .asked import take_memory_work as take_memory_work
from .parts import PartCompiler, part

F = TypeVar("F", bound=Callable[..., Any])

kernel_cache.share()

# IEEE special values must survive (they are how a diverged step is seen), so no "nnan", no "ninf".
_OPTIONS: dict[str, Any] = {
    "fastmath": {"contract", "nsz", "arcp"},
    "error_model": "numpy",
    "_nrt": False,
    "no_cfunc_wrapper": True,
}
#: What only kernels call has no entry for Python, which saves a third of the time to compile.
_CALLED: Any = {**_OPTIONS, "no_cpython_wrapper": True}
#: And what they take in is translated with them.
PART: Any = {**_CALLED, "pipeline_class": PartCompiler}
#: And is vectorised with the loops that call it.
FORMULA: Any = {**PART, "forceinline": True}


#: Type in kernels of the vectors that operations take.
VECTOR = types.Array(types.float64, 1, "C")

#: Folders whose files hold kernels, or constants of kernels.
FOLDERS = ("simd", "elements", "bodies", "connections", "loads", "contact", "linalg", "system", "solvers")


def stamped() -> list[Path]:
    """Sources that hold kernels: when anything in them has changed, all kernels are compiled anew."""
    root = Path(__file__).parent
    kernels = (
        root / "asked.py",
        root / "compiled.py",
        root / "kept.py",
        root / "parts.py",
        root / "records.py",
        root / "addresses.py",
        root / "operations.py",
        root / "batches.py",
        root / "choices.py",
        root / "vectors.py",
        root / "words.py",
    )
    return [*kernels, *(f for folder in FOLDERS for f in sorted((root / folder).rglob("*.py")))]


def _package_stamp() -> str:
    return hashlib.sha256(b"".join(f.read_bytes() for f in stamped())).hexdigest()


_STAMP = _package_stamp()


def kernel(function: F) -> F:
    """Compile ``function`` with numba on first use and cache it on disk, where there is a place for it."""
    dispatcher: Any = numba.njit(**_OPTIONS)(function)
    kernel_cache.use(dispatcher, _STAMP)
    return cast(F, dispatcher)


def inlined_kernel(function: F) -> F:
    """Like :func:`kernel`, but kernels take its code in: a call would pass hundreds of numbers."""
    dispatcher: Any = numba.njit(**_OPTIONS, forceinline=True)(function)
    kernel_cache.use(dispatcher, _STAMP)
    return cast(F, dispatcher)


def separate_kernel(function: F) -> F:
    """Compile ``function`` for kernels that call it by its address, and cache it like :func:`kernel`."""
    return part(function, _CALLED, lambda dispatcher: kernel_cache.use(dispatcher, _STAMP))


def inline_kernel(function: F) -> F:
    """Compile ``function`` as a part of the kernels that call it; Python cannot call it."""
    return part(function, PART, _keep)


def formula(function: F, finish: Callable[[Any], None] | None = None) -> F:
    """Put the code of a small kernel into the loops that call it, which can only then be vectorised."""

    def finished(dispatcher: Any) -> None:
        _keep(dispatcher)
        if finish is not None:
            finish(dispatcher)

    return part(function, FORMULA, finished)


def _keep(dispatcher: Any) -> None:
    """Look for what a part compiles, and leave it, where other processes do."""
    kept.use(dispatcher, _STAMP)


def add_force(batch, q, v, a, r, ws):
    """Add the batch's inertia and internal forces at (q, v, a) to the residual ``r``."""
    raise TypeError(f"no force for {type(batch).__name__}")


def add_inertia(batch, a, r, ws):
    """Add the batch's mass matrix times ``a`` to ``r``."""
    raise TypeError(f"no inertia for {type(batch).__name__}")


def add_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add ``c_mass M + c_damping C + c_stiffness K`` of the batch to the block values ``A``."""
    raise TypeError(f"no tangent for {type(batch).__name__}")


def strain_energy(batch, q, ws):
    """Elastic energy of the batch, J."""
    raise TypeError(f"no energy for {type(batch).__name__}")


def find_event(batch, q):
    """Code of what has happened to the batch in the state q and ends a block of steps, else -1."""
    raise TypeError(f"no events of {type(batch).__name__}")


def no_event(batch, q):
    """For batches to which nothing happens."""
    return -1


def measure(batch, q, v):
    """Renew what the batch leaves for sensors, see :mod:`ancf.solvers.sampling`, in the state q, v."""
    raise TypeError(f"nothing to measure on {type(batch).__name__}")


def remember(batch, q, v):
    """Bring the memory of the batch up to the state q, v of an accepted step."""
    raise TypeError(f"{type(batch).__name__} remembers nothing")


def inverted(batch, q, ws):
    """Slot of r_y at the start of the first element with a collapsed or inverted section, else -1."""
    raise TypeError(f"no check of {type(batch).__name__}")


def never_inverted(batch, q, ws):
    """For batches without cross-sections."""
    return -1


def no_inertia(batch, a, r, ws):
    """For batches without mass."""


def no_energy(batch, q, ws):
    """For batches that store nothing, as loads and joints."""
    return 0.0


class Role(Flag):
    """What a batch is for besides its forces; what treats batches differently asks for it, not for types."""

    NONE = 0
    CONSTRAINS = auto()  #: has rows with multipliers
    SLIDES = auto()  #: of them, rows that change as bodies move: they come last and are renewed in every step
    EXTERNAL = auto()  #: a load: the work of its forces is supplied
    DISSIPATES = auto()  #: what its forces lose without velocities is dissipated
    RUBS = auto()  #: friction: all work of its forces is dissipated, also what they do without velocities
    MEASURES = auto()  #: leaves something for sensors


@dataclass(frozen=True)
class Traits:
    """What a System knows of a kind of batch besides the compiled operations.

    Parameters
    ----------
    role : Role
    slots : tuple of str
        Fields with unknowns, -1 for none: they are renumbered when the order of elimination is known.
    couples : function, optional
        ``couples(batch)``: pairs of blocks of unknowns that it couples, (m, 2); default all pairs in a row of
        ``base``.
    bind : function, optional
        ``bind(plain, seen, places)``: the batch with its places in the matrix; `plain` has the unknowns
        themselves, `seen` their shadows.  Default: ``dest`` from ``base``.
    damped : function, optional
        ``damped(batch)``: whether it does dissipate; of batches with that role.
    row : function, optional
        ``row(batch, j, q, v, row)``, compiled: of what stays out of the matrix of a time step, the stiffness
        and damping of part j and in ``row`` its direction, for equilibria and modes.
    turn : function, optional
        ``turn(batch, j, q, v, a, c)``, compiled: how the force F of part j of ``row`` turns with the motion:
        F and a number n, with F (c a^T + a c^T + n a a^T) in the matrix.
    rows : function, optional
        ``rows(batch, q)``: the same of a batch whose parts have many, (m, size), stiffnesses (m,) and
        dampings (m,).
    stick : function, optional
        ``stick(batch)``: lets friction hold what it acts on, as small vibrations about a state find it.
    still : function, optional
        ``still(batch, q, A, factor)``: adds what its tangent leaves to the masses of a time step.
    memory : tuple of str
        Arrays of floats with what the batch remembers of the motion so far, see :func:`remember`: a step
        that is tried again finds them as they were, states and files keep them.
    goes_round : bool
        What it remembers is how often it has gone round, which equilibria follow where supports turn far.
    follows : function, optional
        ``follows(batch)``: whether a load may take energy from nothing, as a moment in fixed directions or a
        current does, so that its matrix says nothing about stability; default every load does.
    late : function, optional
        ``late(batch)``: what an equilibrium brings on when all else is there, as the friction of a ground: a
        function of the batch and of q that renews it and returns its relative change; or None.
    laid : function, optional
        ``laid(batch, q)``: lets such friction hold from the state q on, as if all that touches had come there
        without it.
    early : function, optional
        ``early(batch, q, holds)``: lets friction hold what touches in the initial shape q of an equilibrium,
        while the loads come on, or takes it away; returns whether there is friction.
    free : function, optional
        ``free(batch, q, every)``: lets go what it holds in an equilibrium against its nature, as
        points that a surface pulls, or all that it holds; returns how much that was.
    turning_mass : function, optional
        ``turning_mass(batch)``: whether it has a mass that changes with the state; default it has none.
    exact : function, optional
        ``exact(batch, moving)``: whether its matrices are the derivatives of its forces, in motion or at
        rest, which sensitivities ask for; default they are not.
    inertial : function, optional
        ``inertial(batch)``: the batch with its mass alone, where the forces of that depend on velocities:
        what they lose without velocities is not dissipated.
    resting : tuple, optional
        Kernels of `early`, `late` and `free`, and the types of what they take behind the record of the batch.
    some : function, optional
        ``some(batch, rows)``: the batch with some of its parts, for forces alone, of one whose parts do not
        know of each other.
    numbers : function, optional
        ``numbers(batch)``: those by which :func:`add_number_work` differentiates, (m,): in stiffnesses,
        masses and the like they are linear.
    numbered : tuple of str
        The fields of which they are made.
    joined : function, optional
        ``joined(batch, other)``: the batch as it knows what all numbers do that one of both has, as dampings
        that are zero in the other; default the batch itself.
    sloped : function, optional
        ``sloped(batch)``: whether :func:`add_work_slopes` knows all of its forces; default it does, if there
        is one.
    kinds : function, optional
        ``kinds(batch, rates)``: what :func:`add_changes` wants to know of a change of the numbers, (m,):
        whole numbers (k,), all zero if there is none.
    """

    role: Role = Role.NONE
    slots: tuple[str, ...] = ("base",)
    couples: Callable[[Any], Any] | None = None
    bind: Callable[[Any, Any, Any], Any] | None = None
    damped: Callable[[Any], bool] | None = None
    row: Callable[..., Any] | None = None
    turn: Callable[..., Any] | None = None
    rows: Callable[[Any, Any], tuple[Any, Any, Any]] | None = None
    stick: Callable[[Any], None] | None = None
    still: Callable[[Any, Any, Any, float], None] | None = None
    memory: tuple[str, ...] = ()
    goes_round: bool = False
    follows: Callable[[Any], bool] | None = None
    late: Callable[[Any], Callable[[Any, Any], float] | None] | None = None
    laid: Callable[[Any, Any], None] | None = None
    early: Callable[[Any, Any, bool], bool] | None = None
    free: Callable[[Any, Any, bool], int] | None = None
    turning_mass: Callable[[Any], bool] | None = None
    exact: Callable[[Any, bool], bool] | None = None
    inertial: Callable[[Any], Any] | None = None
    resting: tuple[tuple[Any, tuple[Any, ...]], ...] = ()
    some: Callable[[Any, Any], Any] | None = None
    numbers: Callable[[Any], Any] | None = None
    numbered: tuple[str, ...] = ()
    joined: Callable[[Any, Any], Any] | None = None
    kinds: Callable[[Any, Any], Any] | None = None
    sloped: Callable[[Any], bool] | None = None


_TRAITS: dict[type, Traits] = {}


def traits(batch: Any) -> Traits:
    """What is known of a batch of its kind."""
    return _TRAITS[type(batch)]


def with_role(batches: Iterable[Any], role: Role) -> tuple[Any, ...]:
    """Those of the batches that have a role."""
    return tuple(batch for batch in batches if role in traits(batch).role)


def describe(batch_type: type, **given: Any) -> None:
    """Keep the :class:`Traits` of a kind of batch."""
    found = Traits(**given)
    if Role.EXTERNAL in found.role and found.role & (Role.DISSIPATES | Role.RUBS):
        raise ValueError(f"{batch_type.__name__}: what is supplied is not dissipated as well")
    if Role.DISSIPATES in found.role and found.damped is None:
        raise ValueError(f"{batch_type.__name__}: damped() says whether it does dissipate")
    _TRAITS[batch_type] = found


def implements(
    batch_type: type,
    *,
    force: Callable[..., Any],
    tangent: Callable[..., Any],
    inertia: Callable[..., Any] = no_inertia,
    energy: Callable[..., Any] = no_energy,
    event: Callable[..., Any] = no_event,
    inverted: Callable[..., Any] = never_inverted,
    measure: Callable[..., Any] | None = None,
    remember: Callable[..., Any] | None = None,
    **given: Any,
) -> None:
    """Register the operations of a kind of batch (see the functions above) and its :class:`Traits`.

    ``given``: traits, and operations by the names in ``OF_SENSITIVITIES``.  The first array of a batch has a
    row for each of its parts: nothing is compiled for one without rows.
    """
    rare = {stub: given.pop(name) for name, stub in OF_SENSITIVITIES.items() if name in given}
    describe(batch_type, **given)
    operations: dict[Any, Any] = {
        add_force: force,
        add_inertia: inertia,
        add_tangent: tangent,
        strain_energy: energy,
        find_event: event,
        _inverted: inverted,
        _measure: measure,
        _remember: remember,
        **rare,
    }
    for stub, function in operations.items():
        if function is not None:
            _DOES[batch_type, stub] = function.py_func if hasattr(function, "py_func") else function


def _choose_by_kind(stub: Callable[..., Any]) -> None:
    """Let kernels that call an operation take the one of the kind of batch.

    One choice for all kinds: numba tries all that there are, at every call that it compiles.
    """

    @overload(stub, jit_options=PART, strict=False)
    def _choose(batch, *arguments):
        kind = getattr(getattr(batch, "batch", batch), "instance_class", None)
        return _DOES.get((kind, stub))


def does_something(batch_type: type, stub: Callable[..., Any]) -> bool:
    """Whether an operation of a kind of batch does anything; not all kinds have the last of ``_STUBS``."""
    if (batch_type, add_force) not in _DOES:
        raise TypeError(f"no operations for {batch_type.__name__}")
    return _DOES.get((batch_type, stub), no_energy) not in _NOTHING


#: Operations that do nothing.
_NOTHING = {no_inertia, no_energy, no_event, never_inverted}
_DOES: dict[tuple[Any, Any], Callable[..., Any]] = {}
_inverted, _measure, _remember = inverted, measure, remember  # the parameters of implements hide the names
_STUBS: tuple[Any, ...] = (
    *(add_force, add_inertia, add_tangent, strain_energy, find_event, inverted, measure, remember),
    *OF_SENSITIVITIES.values(),
)
for _stub in _STUBS:
    _choose_by_kind(_stub)
