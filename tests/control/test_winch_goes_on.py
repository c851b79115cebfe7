"""Winches that are led, in the middle of an acceleration: runs from there, and accelerations of there."""

import numpy as np
import pytest

import ancf

ROPE = {"EA": 400.0, "EI": 0.05, "axial_damping": 0.5}
KINDS = ["input", "function of time", "length"]
METHODS = {
    "trapezoidal": (ancf.Trapezoidal(), 5e-4),
    "generalised-alpha": (ancf.GeneralizedAlpha(0.8), 5e-4),
    "explicit": (ancf.Explicit(check=False), 1e-4),
}


class Hoist:
    """A load on a rope of a seed, at the start or end of which a winch reels."""

    def __init__(self, seed, kind):
        rng = np.random.default_rng(seed)
        self.model = model = ancf.Model(gravity=(0, 0, -9.81))
        self.most, self.way = rng.uniform(1.0, 6.0), float(rng.choice([-1.0, 1.0]))
        section = ancf.Section(**ROPE, rhoA=rng.uniform(0.2, 1.0))
        ends = {"start": (3, 0, 1.5), "end": (4.2, rng.uniform(-0.5, 0.5), 1.2)}
        self.rope = rope = model.add_beam("rope", **ends, elements=int(rng.integers(1, 6)), section=section)
        self.drum, free = (rope.start, rope.end)[:: int(rng.choice([-1, 1]))]
        load = model.add_point_mass("load", at=free.initial_position, mass=rng.uniform(0.3, 2.0))
        model.connect(load, free)
        self.pin = model.pin(self.drum)
        u = model.add_input("u", rope.length if kind == "length" else 0.0)
        if kind == "input":
            model.winch(self.drum, length=rope.length, speed=u, acceleration=self.most)
        elif kind == "length":
            model.winch(self.drum, length=u, speed=0.4, acceleration=self.most)
        else:
            speed = f"{self.way!r}*(0.4*sin(30*t) + t)"
            model.winch(self.drum, length=rope.length, speed=speed, acceleration=self.most)
        self.told = self.way * (1.0 if kind == "input" else 0.3) + (rope.length if kind == "length" else 0.0)

    def began(self, method, step, count):
        run = ancf.stepper(self.model, step=step, integrator=method)
        run.inputs["u"] = self.told
        run.advance(count)
        return run


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("seed", range(4))
def test_a_run_from_there_is_the_one_that_goes_on(seed, method, kind):
    """The drum began without its acceleration: speeds of the rope were an order of the step too small."""
    integrator, step = METHODS[method]
    for moment in (5e-3, 12e-3, 30e-3):
        run = Hoist(seed, kind).began(integrator, step, round(moment / step))
        again = ancf.stepper(Hoist(seed, kind).model, step=step, start=run.state(), integrator=integrator)
        for _ in range(3):
            run.advance(4)
            again.advance(4)
            assert again.natural_length("rope") == run.natural_length("rope")
            np.testing.assert_allclose(again.v, run.v, rtol=0, atol=1e-4 * np.max(np.abs(run.v)))


@pytest.mark.parametrize("kind", KINDS[:2])
@pytest.mark.parametrize("seed", range(6))
def test_accelerations_and_reactions_are_those_under_the_drum(seed, kind):
    """Against the same length as a function of time, whose second rate is known."""
    step, count = 2e-4, 60
    hoist, plain = Hoist(seed, kind), Hoist(seed, "input")

    def tell(run):
        run.inputs["u"] = hoist.told

    given = {"t_end": count * step, "step": step}
    run = ancf.simulate(hoist.model, controller=tell, control_step=step, **given)
    plain.model.supports.remove(next(s for s in plain.model.supports if s is not plain.pin))
    L, a = plain.rope.length, plain.way * plain.most
    plain.model.winch(plain.drum, length=lambda t: L + 0.5 * a * t * t)
    wanted, middle, later = ancf.simulate(plain.model, **given), 0.4 * L, slice(5, None)
    assert run.natural_length(hoist.rope) == pytest.approx(wanted.natural_length(plain.rope), abs=1e-12)
    off = run.acceleration(hoist.rope.at(middle)) - wanted.acceleration(plain.rope.at(middle))
    assert np.max(np.abs(off[later])) < 2e-2 * abs(a)
    off = run.reaction(hoist.pin) - wanted.reaction(plain.pin)
    assert np.max(np.abs(off[later])) < 2e-2 * plain.rope.section.rhoA * L * abs(a)
