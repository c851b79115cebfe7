"""Random worlds whose runs have derivatives: with supports, waves and winches, without what has none."""

from __future__ import annotations

from typing import Any

import numpy as np

import ancf
from ancf.model.surfaces.surface import Surface
from ancf.model.vary import names_of
from random_worlds import World


class SlopedWorld(World):
    """Without friction between cables and between bodies; held, reeled and in waves here and there."""

    def __init__(self, seed: int) -> None:
        super().__init__(seed)
        self.met: set[str] = set()  # numbers that would part a joint
        rng = np.random.default_rng(seed + 10_000)
        self._hold(rng)
        if rng.random() < 0.5 and not self.model.fluids:
            self._sea(rng)
        if rng.random() < 0.3:
            self._reel(rng)

    def _touch(self, name: str, one: Any, other: Any, n: Any, rng: Any, per: float) -> None:
        self._rubs = name in self.beams and isinstance(other, Surface)
        super()._touch(name, one, other, n, rng, per)

    def _law(self, rng: Any, per: float) -> dict[str, Any]:
        given = super()._law(rng, per)
        if per < 2.0 and not self._rubs:
            del given["friction"], given["stick"]
        return given

    def _hold(self, rng: Any) -> None:
        """A pin that moves, a clamp, or a ball joint to a body of its own."""
        beam = self.beams[str(rng.choice(sorted(self.beams)))][0]
        kind = str(rng.choice(["pin", "clamp", "ball", "free"]))
        if kind == "pin":
            self.model.pin(beam.start, displacement=("0.001*sin(40*t)", 0, 0), name="held")
        elif kind == "clamp":
            self.model.clamp(beam.start, name="held")
        elif kind == "ball":
            at = beam.start.initial_position - [0.1, 0.0, 0.0]
            hub = self.model.add_rigid_body("hub", at=at, mass=0.7, inertia=(0.01, 0.02, 0.015))
            hub.set_motion(velocity=beam.velocity)
            self.model.connect(beam.start, hub.at(0.1, 0, 0), name="held")
            self.met = {"hub.at", f"{beam.name}.start", f"{beam.name}.end"}

    def _sea(self, rng: Any) -> None:
        waves = {"spectrum": "regular", "height": rng.uniform(0.1, 0.4), "period": rng.uniform(1, 3)}
        speed = tuple(rng.uniform(-1, 1, 3) * [1, 1, 0])
        self.model.add_fluid("sea", rng.uniform(50, 300), velocity=speed, below=0.1, waves=waves)

    def _reel(self, rng: Any) -> None:
        """A cable of its own, that a winch pays out."""
        section = ancf.Section(
            EA=400.0, EI=0.1, rhoA=0.5, diameter=0.05, drag=(1.0, 0.1), added_mass=(1.0, 0.2)
        )
        line = self.model.add_beam("line", start=(2, 0, 1), end=(2.8, 0, 0.7), elements=2, section=section)
        self.model.pin(line.start, name="drum pin")
        length = f"{line.length!r} + 0.1*sin({rng.uniform(1, 5):.3f}*t)**2"
        self.model.winch(line.start, length=length, name="drum")

    def numbers(self, rng: Any, count: int) -> list[str]:
        """Some numbers of the model that may change to both sides, of each key one at the most."""
        by: dict[str, list[str]] = {}
        for name in names_of(self.model):
            by.setdefault(name.partition("[")[0], []).append(name)
        keys = [key for key in sorted(by) if not (key in self.met or self._one_sided(key))]
        return [str(rng.choice(by[key])) for key in rng.permutation(keys)[:count]]

    def _one_sided(self, key: str) -> bool:
        """Whether a number is zero and may not be negative, or nothing has to do with it."""
        owner, _, field = key.rpartition(".")
        model = self.model
        items = {x.name: x for x in (*model.connections, *model.grounds, *model.bodies.values())}
        item = items.get(owner)
        zero = isinstance(getattr(item, field, None), float) and getattr(item, field) == 0.0
        slides = not getattr(item, "friction", 1.0) and field in ("stick", "friction_velocity")
        return field.endswith("damping") or zero or slides
