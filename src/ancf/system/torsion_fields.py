"""What torsion springs do, from state vectors: the same face for one state or a history."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..connections.torsion import TorsionBatch
from ..connections.torsion_build import torsion_springs
from ..errors import ModelError, named
from ..model.joints.torsion import TorsionSpring
from ..model.names import unknown
from .fields import Fields

#: Under which name a system keeps how far its torsion springs have turned.
MEMORY = "torsion springs.last"


class TorsionFields(Fields):
    """Angles and moments of torsion springs; shapes are () for a state, (n_t,) for a history.

    A torsion spring is the object that the model gave, or its name. In a history full turns are counted from
    time to time, so that the last angle is that which the spring remembers; where it remembers none, the
    first one, as that of a state, is within half a turn of the initial one.
    """

    model: Any

    def has_angle(self, name: str) -> bool:
        """Whether a joint has an angle, see :class:`ancf.system.joint_angles.JointAngles`."""
        raise NotImplementedError

    def torsion_angle(self, spring: TorsionSpring | str) -> FloatArray:
        """Angle by which the first end of a torsion spring has turned against the second, rad.

        Raises
        ------
        ModelError
            There is no such torsion spring.
        """
        item, batch = self._torsion(spring)
        angle: FloatArray = angle_of(batch, self.q)
        angle = np.unwrap(angle) if angle.ndim else angle
        last = self._turned_to(item)
        if last is None or not angle.size:
            return angle
        turned: FloatArray = angle + 2 * np.pi * np.round((last - np.ravel(angle)[-1]) / (2 * np.pi))
        return turned

    def _turned_to(self, spring: TorsionSpring) -> float | None:
        """The angle that a spring remembers of the last state, with its turns; None where it is not known."""
        return None

    def _remembered_turn(self, spring: TorsionSpring, memory: dict[str, FloatArray]) -> float | None:
        """The same from what batches remember, see ``System.memory``."""
        found = memory.get(MEMORY)
        return None if found is None else float(found[list(self.torsion_springs).index(spring.name)])

    def torsion_moment(self, spring: TorsionSpring | str) -> FloatArray:
        """Moment of a torsion spring about its axis, N m, damping included, positive against a growing angle.

        Raises
        ------
        ModelError
            There is no such torsion spring.
        """
        item, batch = self._torsion(spring)
        rate = rate_of(batch, self.q, self.rates)
        moment: FloatArray = item.stiffness * (self.torsion_angle(spring) - item.angle) + item.damping * rate
        return moment

    @property
    def torsion_springs(self) -> dict[str, TorsionSpring]:
        """Torsion springs by name."""
        return torsion_springs_of(self.model.connections)

    def _torsion(self, spring: Any) -> tuple[TorsionSpring, TorsionBatch]:
        name = getattr(spring, "name", spring)
        found = self.torsion_springs.get(name) if isinstance(name, str) else None
        if found is None:
            if isinstance(name, str) and self.has_angle(name):
                raise ModelError(named(name), "is no torsion spring", f'joint_angle("{name}") is its angle')
            raise unknown("spring", "torsion spring", name, self.torsion_springs)
        batch = torsion_springs([found], self.slots)
        if not is_known(batch):
            raise ModelError(f'"{name}"', "was not recorded by the sensors", "list it in sensors")
        return found, batch


def torsion_springs_of(connections: list[Any]) -> dict[str, TorsionSpring]:
    """Torsion springs among the connections of a model, by name."""
    return {item.name: item for item in connections if isinstance(item, TorsionSpring)}


def angles(batch: TorsionBatch, q: FloatArray) -> FloatArray:
    """Angles (n,) of all springs of a batch in the state q (size,), next to those that it remembers, rad."""
    now = np.empty(len(batch.base))
    for e, last in enumerate(batch.last.tolist()):
        one = TorsionBatch._make(array[e : e + 1] for array in batch)
        now[e] = angle_of(one, q)
        now[e] += 2 * np.pi * np.round((last - now[e]) / (2 * np.pi))
    return now


def angle_of(batch: TorsionBatch, q: Any) -> Any:
    """Angle of the one spring of a batch in states (..., size), within half a turn, rad."""
    S, C = _sums(batch, q, None)
    return batch.data[0, 3] * np.arctan2(S, C)


def rate_of(batch: TorsionBatch, q: Any, v: Any) -> Any:
    """Its rate, rad/s."""
    S, C, dS, dC = _sums(batch, q, v)
    return batch.data[0, 3] * (C * dS - S * dC) / (S * S + C * C)


def is_known(batch: TorsionBatch) -> bool:
    """Whether all unknowns of the one spring of a batch were recorded."""
    used = batch.base[(batch.base >= 0) | np.any(_factors(batch) != 0.0, axis=0)]
    return not np.any(used < 0)


def _factors(batch: TorsionBatch) -> FloatArray:
    """What each slot is multiplied with, (4, 6)."""
    turned = np.concatenate([batch.turned[0], np.zeros((2, 3))])
    return np.concatenate([turned, batch.frame[0].reshape(4, 3)], axis=1)


def _sums(batch: TorsionBatch, q: Any, v: Any) -> tuple[Any, ...]:
    """S and C of the one spring of a batch, and with rates theirs."""

    def vectors(x: Any, fixed: float) -> tuple[FloatArray, FloatArray]:
        places = batch.base[0][:, None] + np.arange(3)
        values = np.stack(
            [x[..., row.tolist()] if row[0] >= 0 else np.zeros((*x.shape[:-1], 3)) for row in places]
        )
        turned = np.einsum("ki,i...c->k...c", batch.turned[0], values[:3])
        axes = np.einsum("kji,i...c->kj...c", batch.frame[0], values[3:])
        constant = batch.constant[0].reshape(2, 2, *(1,) * (values.ndim - 2), 3)
        return turned, axes + fixed * constant

    p, axes = vectors(q, 1.0)
    S, C = (np.sum(p * axes[:, j], axis=(0, -1)) for j in (1, 0))
    if v is None:
        return S, C
    dp, daxes = vectors(v, 0.0)
    dS, dC = (np.sum(dp * axes[:, j] + p * daxes[:, j], axis=(0, -1)) for j in (1, 0))
    return S, C, dS, dC
