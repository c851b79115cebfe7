"""The slopes of the work of pressures of surfaces, by the state and by numbers, against differences."""

import numpy as np
import pytest
from test_surface_kernels import KINDS, beside, shaken

from ancf.compiled import add_number_work, kernel, traits
from ancf.contact.press_slopes import OWN
from ancf.contact.touch import ROOM
from ancf.solvers.rare import add_number_work_of, knowing
from ancf.system.system import System
from sloped import PLACES, check_slopes, found_slopes, work_of

#: Fields of the numbers, in their order.
NUMBERED = "data", "weight", "shape"


@kernel
def number_works(batches, q, v, a, x, out, ws):
    add_number_work_of(batches, 0, q, v, a, x, out, ws)


def pressed(kind, on, damping, seed=4):
    """A beam that a surface presses, which moves with a body where it is on one; states and a direction."""
    system = System(beside(KINDS[kind], on=on, depth=0.003, damping=damping))
    q, v = shaken(system, 2e-4, seed)
    rng = np.random.default_rng(seed)
    if on:  # also not quite a rigid body, as it drifts
        body = system.slots["body"].ravel()
        for c in range(3):
            q[body + c] += 1e-4 * rng.standard_normal(len(body))
            v[body + c] += 0.05 * rng.standard_normal(len(body))
    x = rng.standard_normal(system.size)
    return system, (q, v, np.zeros(system.size)), x


@pytest.mark.parametrize("damping", [0.0, 50.0, 400.0])
@pytest.mark.parametrize("on", [False, True], ids=["ground", "body"])
@pytest.mark.parametrize("kind", KINDS)
def test_by_the_state(kind, on, damping):
    system, given, x = pressed(kind, on, damping)
    by_q, by_v, by_a = check_slopes(system, "pressing", given, x, 1e-7, 1e-6)
    assert by_q > 1.0
    assert (by_v > 1e-6) == (damping > 0.0)
    assert by_a < 1e-6


@pytest.mark.parametrize("on", [False, True], ids=["ground", "body"])
@pytest.mark.parametrize("kind", ["mesh", "sphere", "sheave"])
def test_by_numbers(kind, on):
    system, given, x = pressed(kind, on, 50.0)
    batch = system.parts["pressing"]
    found = np.zeros(len(traits(batch).numbers(batch)))
    number_works(knowing(add_number_work, [batch]), *given, x, found, system.core.ws)
    wanted = []
    for field in NUMBERED:
        for i in range(getattr(batch, field).size):
            wanted.append(0.0)
            for place, weight in PLACES:
                moved = getattr(batch, field).copy()
                step = 1e-4 * min(abs(moved.flat[i]) or 1e-3, 1e6)
                moved.flat[i] += place * step
                work = work_of(batch._replace(**{field: moved}), system, given, x)
                wanted[-1] += weight / step * work
    used = np.ones(batch.data.shape, dtype=bool)
    used[:, OWN:] = False
    wanted = np.array(wanted)[np.concatenate([used.ravel(), np.ones(len(wanted) - used.size, dtype=bool)])]
    assert np.count_nonzero(found) > 5
    size = np.maximum(np.abs(wanted), 1e-3 * np.max(np.abs(wanted)))
    assert np.max(np.abs(found - wanted) / size) < 1e-6


def test_what_is_far_is_not_looked_at():
    system, given, x = pressed("sphere", False, 0.0)
    batch, places = system.parts["pressing"], system.slots["rope"][:, 0].ravel()
    assert np.any(found_slopes(batch, system, given, x))
    given[0][places + 2] += 1.0
    assert not np.any(found_slopes(batch, system, given, x))
    assert np.all(batch.far[:, ROOM] > 0.5)
    given[0][places + 2] -= 1.0
    assert np.any(found_slopes(batch, system, given, x))
