"""Batches with friction as kernels ask them about a step: what they remember is part of one vector."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..system.system import System

#: Arrays of such a memory with derivatives, in this order, and what follows them.
REMEMBERED, BESIDE = ("anchor", "limit", "before"), ("most",)


class Marked:
    """Batches of a system whose memory is that of one step, until it is brought another one.

    Parameters
    ----------
    system : System
    names : list of str

    Attributes
    ----------
    first : (batches + 1,) array
        Where the numbers of each begin.
    now : (numbers,) array
    batches : dict of str to batch
    views : dict of str to array
        The parts of ``now`` by "part.array".
    """

    def __init__(self, system: System, names: list[str]) -> None:
        own = [system.parts[name] for name in names]
        self.first = np.cumsum([0, *(sum(getattr(b, key).size for key in keys_of(b)) for b in own)])
        self.now = np.zeros(self.first[-1])
        self.batches: dict[str, Any] = {}
        self.views: dict[str, FloatArray] = {}
        for name, batch, at in zip(names, own, self.first[:-1].tolist(), strict=True):
            views = {}
            for key in keys_of(batch):
                x = getattr(batch, key)
                views[key] = self.now[at : at + x.size].reshape(x.shape)
                self.views[f"{name}.{key}"] = views[key]
                at += x.size
            if hasattr(batch, "lit"):  # any row may have a limit in some step
                views["lit"] = np.array([len(batch.lit) - 1, *range(len(batch.lit) - 1)])
            self.batches[name] = batch._replace(**views)

    def vector(self, d: dict[str, FloatArray]) -> FloatArray:
        """Derivatives by "part.array" as they lie in ``now``."""
        parts = [d.get(name, np.zeros(x.size)).ravel() for name, x in self.views.items()]
        return np.concatenate([np.zeros(0), *parts])

    def row(self, z: FloatArray) -> dict[str, FloatArray]:
        """The other way round."""
        parts = np.split(z, np.cumsum([x.size for x in self.views.values()])[:-1])
        return {
            name: x.reshape(like.shape).copy()
            for (name, like), x in zip(self.views.items(), parts, strict=True)
            if name.split(".")[1] in REMEMBERED
        }

    def instead(self, system: System) -> Iterable[tuple[Any, Any]]:
        """Batches of the system and these."""
        return [(system.parts[name], batch) for name, batch in self.batches.items()]


def keys_of(batch: Any) -> list[str]:
    """Arrays of the memory of a batch that compiled code follows, as they lie one after the other."""
    return [key for key in (*REMEMBERED, *BESIDE) if key in batch._fields]
