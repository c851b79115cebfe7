"""What a run along a line does with the parts of it that sleep, and what it says of a state then."""

from __future__ import annotations

import time as clock
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...connections.contact_build import no_contacts
from ...records import place
from ...system.core import residual
from ..account import Account
from ..block import show_at
from ..bridge import Bridge
from ..sampling import Sampling
from ..step.scheme import Scheme
from .arrays import FarPlan
from .spans import FarSpans


class Asleep(Account):
    """Part of :class:`ancf.solvers.stepping.Run`: spans that sleep, see :mod:`ancf.system.far`."""

    far: FarSpans | None = None
    scheme: Scheme
    sampling: Sampling
    bridge: Bridge
    kernels: Any
    h: float
    seconds: float

    def reduce(self, plan: FarPlan) -> FarSpans:
        """Let parts of a line sleep that nothing touches; after :meth:`start`."""
        begin = clock.process_time()
        B, G = self.scheme.of(self.h)
        step = self.h, 1.0 / B, G / B
        self.far = FarSpans(self.system, self.memory, plan, self.sampling.unknowns, step)
        self.far.begin()
        self.seconds += clock.process_time() - begin
        self.__dict__.pop("kernels", None)
        _ = self.kernels  # there are more now: they are compiled outside the CPU time of the run
        return self.far

    @property
    def sleeps(self) -> bool:
        """Whether a part sleeps now."""
        return self.far is not None and self.far.some

    def now(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """State vectors q, v, and work dissipated and supplied, as they are now and will be changed.

        Where parts sleep, copies in which these are where they move to.
        """
        m, core = self.memory, self.system.core
        if not self.sleeps:
            return m.q, m.v, m.work
        show_at(self.kernels[1].show_far, place(core), place(m), True)
        q, v = m.q.copy(), m.v.copy()
        show_at(self.kernels[1].show_far, place(core), place(m), False)
        return q, v, m.work

    def felt(self) -> tuple[FloatArray, FloatArray]:
        """Accelerations, and forces out of balance, which in held rows are reactions, of the state now."""
        m, core, r = self.memory, self.system.core, np.zeros(self.system.size)
        asleep, contacts = self.sleeps, self.system.parts.get("contacts", no_contacts())
        found = contacts.found.copy()  # the next search begins there: to ask changes nothing
        with self.awake():
            residual(core.batches, core.ws, m.q, m.v, m.a, m.f, r)
            contacts.found[:] = found
            return m.a.copy() if asleep else m.a, r

    def awake(self) -> AbstractContextManager[None]:
        """No part sleeps for a while."""
        return nullcontext() if self.far is None else self.far.woken()

    def turn(self) -> None:
        """Parts of a line wake or fall asleep."""
        if self.far is not None:
            self.far.turn()

    def bridged(self, t: float, h: float, number: int, status: int) -> None:
        """Step ``number`` from t to t + h, which has failed with a status; no part sleeps in it."""
        asleep = [] if self.far is None else self.far.wake_all()
        self.bridge.cross(t, h, number)
        if self.far is not None:
            self.far.sleep_on(asleep)
