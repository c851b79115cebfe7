"""The crane of ``crane.py`` as an environment of Gymnasium, for controllers that learn.

``pip install 'ancf[control]'``. Observed are the trolley's distance from its target and its speed, the load's
distance aside of the trolley and its rate; the action is the thrust, from -1 to 1. The reward of a step is
minus what the regulator of ``crane.py`` weighs, so that its gains can be compared with what is learned.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import ancf

_spec = importlib.util.spec_from_file_location("crane", Path(__file__).with_name("crane.py"))
crane = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(crane)


class CraneEnv(gymnasium.Env):
    """Bring the load to the target and let it hang there.

    Parameters
    ----------
    elements : int
        Of the rope.
    duration : float
        Of an episode, s.
    """

    metadata = {"render_modes": []}  # noqa: RUF012, as Gymnasium has it

    def __init__(self, elements: int = 4, duration: float = crane.T_END) -> None:
        most = np.full(4, np.inf, dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-most, most, dtype=np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,), dtype=np.float32)
        self.model = crane.build(elements)
        self.rest = ancf.equilibrium(crane.build(elements, locked=True))
        self.duration, self.target = duration, crane.TARGET
        self.run: ancf.Stepper | None = None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        """Start at rest, with a target from 1 to 3 m, or ``options={"target": ...}``."""
        super().reset(seed=seed)
        self.target = float((options or {}).get("target", self.np_random.uniform(1.0, 3.0)))
        self.run = ancf.stepper(self.model, step=crane.STEP, start=self.rest)
        return self._observed(), {}

    def step(self, action):
        """Push for a control step."""
        thrust = crane.MOST * float(np.clip(action, -1.0, 1.0)[0])
        self.run.inputs["thrust"] = thrust
        failed = False
        try:
            self.run.advance(round(crane.CONTROL_STEP / crane.STEP))
        except ancf.SolveError:
            failed = True
        seen = self._observed()
        cost = 100.0 * seen[0] ** 2 + seen[1] ** 2 + 1000.0 * seen[2] ** 2 + seen[3] ** 2 + 0.02 * thrust**2
        over = self.run.t >= self.duration - 0.5 * crane.STEP
        return seen, -crane.CONTROL_STEP * float(cost), failed, over, {"t": self.run.t}

    def _observed(self):
        trolley, load = (self.run.position(name)[0] for name in ("trolley", "load"))
        rates = [self.run.velocity(name)[0] for name in ("trolley", "load")]
        return np.array([trolley - self.target, rates[0], load - trolley, rates[1] - rates[0]], np.float32)


if __name__ == "__main__":
    env, K, total = CraneEnv(), crane.gains(), 0.0
    seen, _ = env.reset(options={"target": crane.TARGET})
    over = False
    while not over:
        push = np.clip(-K @ seen / crane.MOST, -1.0, 1.0)
        seen, reward, failed, late, _ = env.step(np.array([push], np.float32))
        total, over = total + reward, failed or late
    away = 1000 * (seen[0] + seen[2])
    print(f"return of the regulator: {total:.1f}; the load is {away:.1f} mm from its target")
