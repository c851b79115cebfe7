"""Random mechanisms of rigid bodies come to a stable rest: chains on all kinds of joints, springs, ropes.

Bodies that may turn where nothing holds them, slides on springs, ropes below: wherever they are drawn, what
is found is balanced, and gives way nowhere.
"""

import numpy as np
import pytest

import ancf

G = 9.81


#: Seeds of those that take more than 300 corrections in one step of the loads.
LONG = 48, 79, 118, 203
#: Up, down, across and askew.
ALONG = np.array([(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.6, 0.0, 0.8)])


class Draw:
    """Random numbers and directions, these perhaps along a few of them in most cases."""

    def __init__(self, seed, along):
        self.rng, self.along = np.random.default_rng(seed), along

    def __getattr__(self, name):
        return getattr(self.rng, name)

    def unit(self):
        if self.along and self.rng.random() < 0.9:
            return ALONG[self.rng.integers(0, len(ALONG))]
        x = self.rng.standard_normal(3)
        return x / np.linalg.norm(x)


def join(model, draw, point, last, kind):
    if kind == "ball":
        model.connect(point, last)
    elif kind == "universal":
        a = draw.unit()
        b = np.cross(a, draw.standard_normal(3))
        model.universal(point, last, tuple(a), tuple(b / np.linalg.norm(b)))
    else:
        way = {"hinge": model.hinge, "slide": model.cylindrical}[kind]
        way(point, last, axis=tuple(draw.unit()))


def mechanism(seed, along=False):
    """A chain of one to four bodies, of sizes and masses over two decades; perhaps with a rope at its end."""
    draw = Draw(seed, along)
    model, last, place = ancf.Model(gravity=(0.0, 0.0, -G)), (0.0, 0.0, 0.0), np.zeros(3)
    size = 10.0 ** draw.uniform(-1.0, 1.0)
    for k in range(draw.integers(1, 5)):
        d, mass = size * draw.unit() * draw.uniform(0.3, 1.0), 10.0 ** draw.uniform(-1.0, 1.0)
        inertia = tuple(mass * size**2 * draw.uniform(0.01, 0.02, 3))
        body = model.add_rigid_body(f"body{k}", at=tuple(place + d), mass=mass, inertia=inertia)
        kind = draw.choice(["ball", "hinge", "universal", "slide", "ball", "hinge"])
        join(model, draw, body.at(*-d), last, kind)
        soft = mass * G / size
        if kind == "slide" or draw.random() < 0.4:
            end, length = place + d + size * draw.unit(), size * draw.uniform(0.3, 1.2)
            model.add_spring(body.centre, tuple(end), stiffness=soft * draw.uniform(0.5, 5.0), length=length)
        last, place = body.at(*d), place + 2.0 * d
    if draw.random() < 0.3:
        section = ancf.Section(EA=1e4 * size, EI=1e-3 * size**3, rhoA=0.3)
        given = {"start": tuple(place), "end": tuple(place + size * draw.unit()), "elements": 5}
        rope = model.add_beam("rope", section=section, **given)
        model.connect(last, rope.start)
        if draw.random() < 0.5:
            model.pin(rope.end)
    return model


def check_rest(model):
    """What is found is stable, and a run that begins there stays."""
    state = ancf.equilibrium(model)
    lowest = ancf.modes(model, about=state, count=1)  # refuses a state that gives way
    assert not any("out of balance" in note for note in lowest.notes)
    run = ancf.simulate(model, start=state, t_end=0.01, step=1e-3)
    energy = sum(body.mass * G * 0.01 for body in model.bodies.values() if hasattr(body, "mass"))
    assert np.max(run.energy.kinetic) < 1e-12 * energy
    return state


@pytest.mark.parametrize("seed", range(24))
def test_they_come_to_a_stable_rest(seed):
    check_rest(mechanism(seed))


@pytest.mark.parametrize("seed", [*range(24), *LONG])
def test_drawn_along_axes(seed):
    """Many of them stand upright, exactly, and fall for long."""
    check_rest(mechanism(seed, along=True))
