"""Random worlds with machinery and a winch: runs that go on from a state with another step or method."""

import numpy as np
import pytest

import ancf
from helpers import some
from random_gear import Gear

T_END, MIDDLE, TOLD = 0.024, 0.012, 2e-3
METHODS = {"trapezoidal": ancf.Trapezoidal(), "alpha": ancf.GeneralizedAlpha(rho_inf=0.8)}
ROPE = {"EA": 400.0, "EI": 0.05, "rhoA": 0.5, "diameter": 0.04, "axial_damping": 0.5}


class Hoist(Gear):
    """With a load on a rope that a winch reels, and a force, both led or given as functions of time."""

    def __init__(self, seed, led):
        super().__init__(seed, rough=led)
        rng, m = np.random.default_rng(seed + 5), self.model
        self.led = led
        speed = m.add_input("speed", 0.0) if led else "-0.3*sin(60*t)"
        force = m.add_input("force", 0.3) if led else "0.3 + sin(40*t)"
        ends = {"start": (3, 0, 1.5), "end": (4.2, 0.1, 1.2)}
        rope = m.add_beam("rope", **ends, elements=3, section=ancf.Section(**ROPE))
        m.pin(rope.start)
        load = m.add_point_mass("load", at=ends["end"], mass=1.0)
        m.connect(load, rope.end)
        m.winch(rope.start, length=rope.length, speed=speed, acceleration=3.0 if led else 100.0)
        if led:
            roll = m.add_surface("roll", ancf.Cylinder(0.2, at=(3.6, 0.05, 1.12), axis=(0, 1, 0)))
            m.add_contact(rope, roll, stiffness=4e3, damping=10.0, friction=0.3)
        m.add_force(self._end(rng), (force, force, 0))
        m.add_force(load, (0, force, 0))
        self.points += [load.point, rope.at(0.5)]

    def control(self, run):
        run.inputs["force"] = 0.3 + np.sin(40 * run.t) - 0.5 * run.velocity(self.points[0])[0]
        run.inputs["speed"] = -0.3 if run.t < MIDDLE - 1e-9 else 0.4

    def run(self, t_end, step, method, start=None):
        how = {"controller": self.control, "control_step": TOLD} if self.led else {}
        return ancf.simulate(
            self.model, t_end=t_end, step=step, start=start, integrator=METHODS[method], **how
        )

    def ends(self, run):
        """Places and velocities."""
        return np.array([[run.position(point)[-1], run.velocity(point)[-1]] for point in self.points])


def whole(seed, led, step, method="trapezoidal"):
    hoist = Hoist(seed, led)
    return hoist.ends(hoist.run(T_END, step, method))


def in_two(seed, led, steps, methods):
    """The second half by another model of the same seed, from the state of the first one."""
    state = Hoist(seed, led).run(MIDDLE, steps[0], methods[0]).state()
    hoist = Hoist(seed, led)
    return hoist.ends(hoist.run(T_END, steps[1], methods[1], state))


def off(found, wanted):
    return float(np.max(np.abs(found - wanted)))


#: Steps of the halves of a run as shares of a step, and whether the method changes between them.
WAYS = {"finer": (1.0, 0.5, False), "coarser": (0.5, 1.0, False), "another method": (1.0, 1.0, True)}
#: Whose motion steps of 0.5 ms resolve: 7 meets an edge.
SEEDS = [3, 5, 8, 11, 12, 13, 15, 16, 20]


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("led", [False, True], ids=["given", "led"])
@pytest.mark.parametrize("seed", some(SEEDS, 3))
def test_a_run_in_two_is_as_good_as_the_whole(seed, led):
    """Against steps of 31 us: no worse than the coarser of its steps, and better with half of them.

    What is led acts from the middle of a step on, a drum has its speed from step to step: an order of one.
    """
    wanted = whole(seed, led, 3.125e-5)
    for method, other in (("trapezoidal", "alpha"), ("alpha", "trapezoidal")):
        left = {step: off(whole(seed, led, step, method), wanted) for step in (5e-4, 2.5e-4)}
        for name, (first, second, changes) in WAYS.items():
            methods = method, other if changes else method
            found = [off(in_two(seed, led, (first * step, second * step), methods), wanted) for step in left]
            assert all(error < 1.2 * most for error, most in zip(found, left.values(), strict=True)), name
            assert found[1] < found[0] / 1.5, name
        again = in_two(seed, led, (2.5e-4, 2.5e-4), (method, method))
        assert off(again, whole(seed, led, 2.5e-4, method)) < 0.06 * left[2.5e-4]
