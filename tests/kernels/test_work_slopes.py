"""The slopes of the work of joints' forces: derivatives of x . force by q, v and a, for adjoints."""

import numpy as np
import pytest

from ancf.batches import add_forces
from ancf.compiled import add_work_slopes, kernel
from ancf.solvers.rare import add_all_slopes, knowing
from mechanisms import LEVELS, bare, joints_of, mechanism, moving

#: Weights of all three at once, as of index 1.
MIXED = LEVELS | {"mixed": (0.3, 0.5, 0.2)}
PLACES = ((-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12))


@kernel
def slopes(batches, q, v, a, x, by_q, by_v, by_a, ws):
    add_all_slopes(batches, q, v, a, x, by_q, by_v, by_a, ws)


@kernel
def forces(batches, q, v, a, r, ws):
    add_forces(batches, q, v, a, r, ws)


@pytest.mark.parametrize("kind", [0, 1], ids=["rows", "slides"])
@pytest.mark.parametrize("level", MIXED)
@pytest.mark.parametrize(
    "sliding",
    [{}, {"friction": 0.4, "friction_velocity": 2.0}, {"release": (0.0, 0.6, 0.8)}],
    ids=["smooth", "rubs", "released"],
)
def test_against_differences(kind, level, sliding):
    """In random states and along random vectors, with local axes at a clamp."""
    system = bare(mechanism("free", **sliding))
    system.level[:] = MIXED[level]
    batches = knowing(add_work_slopes, [joints_of(system)[kind]])
    q, v, a = moving(system)
    x, ws = np.random.default_rng(7).uniform(-1, 1, system.size), system.core.ws
    found = np.zeros((3, system.size))
    slopes(batches, q, v, a, x, *found, ws)

    def work(states):
        r = np.zeros(system.size)
        forces(batches, *states, r, ws)
        return x @ r

    for n, made in enumerate(found):
        wanted = np.zeros(system.size)
        for i in range(system.size):
            for place, weight in PLACES:
                states = [y.copy() for y in (q, v, a)]
                states[n][i] += 1e-3 * place
                wanted[i] += weight / 1e-3 * work(states)
        assert np.max(np.abs(made - wanted)) < 1e-9 * max(1.0, np.max(np.abs(wanted)))
