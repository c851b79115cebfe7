"""The slopes of the work of loads, grounds and contacts by the state, against differences of their forces."""

import numpy as np
import pytest

import ancf
from ancf.batches import measure_all
from ancf.compiled import add_measured_work, kernel, measure, take_measured_slopes
from ancf.solvers.rare import add_measured_work_of, knowing, take_measured_slopes_of
from ancf.system.system import System
from sloped import at_time, check_beside, check_slopes
from strained import states

TIME = 0.37
HEIGHTS = np.random.default_rng(1).uniform(-0.1, 0.3, (4, 3)).tolist()
HILLS = {"x": [-1, 0.2, 0.8, 2.0], "y": [-1, 0.1, 2.0], "z": HEIGHTS}


def moved(model, seed=3, speed=1.0):
    system = System(model)
    q, v, a, x, _ = states(system, seed)
    given = q, speed * v, 0.01 * a
    at_time(system, TIME, given)
    return system, given, x


def beams(element="cable"):
    """A cable, or a beam with a section."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    if element == "cable":
        section = ancf.Section(EA=1e3, EI=2.0, rhoA=1.0, diameter=0.05)
    else:
        section = ancf.Section.rectangle(0.2, 0.1, E=1e7, rho=900.0)
    given = {"start": (0, 0, 0), "end": (1.2, 0.3, 0.2), "elements": 2, "section": section}
    return model, model.add_beam("beam", element=element, **given)


@pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
def test_of_moments(element):
    model, beam = beams(element)
    for place, moment in ((beam.end, (0.3, "2*t", -1.2)), (beam.at(0.55), (1.1, 0.2, 0.7))):
        model.add_moment(place, moment)
    system, given, x = moved(model)
    name = next(name for name in system.parts if "moment" in name)
    assert check_slopes(system, name, given, x)[0] > 0.0


@pytest.mark.parametrize("element", ["cable", "nonlocking"])
def test_of_followers(element):
    model, beam = beams(element)
    force = (0.7, 0.0, 0.0) if element == "cable" else (0.7, "3*t", -0.4)
    model.add_follower_force(beam.end, force)
    if element != "cable":
        hub = model.add_rigid_body("hub", at=(2, 0, 0), mass=1.0, inertia=(0.1, 0.2, 0.3))
        model.add_follower_force(hub.at(0.1, 0.2, 0), (1.0, 2.0, 0.5))
    system, given, x = moved(model)
    name = next(name for name in system.parts if "follow" in name)
    assert check_slopes(system, name, given, x, 1e-4)[0] > 0.0
    assert check_beside(system, name, given) > 0.01


def test_of_pressure():
    model, beam = beams()
    model.add_pressure(beam, "5*t", (0.0, 0.6, 0.8))
    system, given, x = moved(model)
    name = next(name for name in system.parts if "pressure" in name)
    assert check_slopes(system, name, given, x)[0] > 0.0
    assert check_beside(system, name, given) > 0.01


def test_of_laws():
    model, beam = beams()
    law = ("-3*x*vx + sin(2*y)", "exp(0.3*z)*vy - 0.2*x**2 + t", "vx*vz - z**3")
    model.add_force(beam.end, law)
    model.add_distributed_load(beam, law)
    system, given, x = moved(model)
    name = next(name for name in system.parts if name == "force")
    assert min(check_slopes(system, name, given, x, share=3e-9)[:2]) > 0.0
    assert check_beside(system, name, given) > 1e-3


@pytest.mark.parametrize("height", [0.05, HILLS], ids=["plane", "hills"])
@pytest.mark.parametrize("speed", [0.0, 0.2, 1.0])
def test_of_grounds(height, speed):
    model, _ = beams()
    model.add_ground("bottom", height=height, stiffness=3e4, damping=2e3)
    system, given, x = moved(model, speed=speed)
    by_q, by_v, _ = check_slopes(system, "ground", given, x, 1e-6, 1e-7)
    assert min(by_q, by_v) > 0.0


@pytest.mark.parametrize("damping", [0.0, 40.0])
@pytest.mark.parametrize("profile", [None, [[0.0, 0.0], [0.5, 0.03], [1.2, 0.0]]], ids=["smooth", "profile"])
def test_of_contacts(profile, damping):
    model, wire = beams()
    head = model.add_point_mass("head", at=(0.5, 0.125, 0.2), mass=1.0)
    more = {} if profile is None else {"profile": profile}
    strip = {"strip": (0.0, 1.0, 0.0), "normal": (0.0, 0.0, 1.0)}
    model.add_contact(head, along=wire, stiffness=5e3, damping=damping, **strip, **more)
    system, given, x = moved(model, 2)
    by_q, by_v, _ = check_slopes(system, "contacts", given, x, 1e-5, 3e-8)
    assert by_q > 0.0
    assert (by_v > 1e-3) == (damping > 0.0)


@kernel
def slopes_of_measured(batches, q, v, dq, dv, out):
    take_measured_slopes_of(batches, 0, q, v, dq, dv, out)


@kernel
def work_of_measured(batches, q, v, y, by_q, by_v):
    add_measured_work_of(batches, 0, q, v, y, by_q, by_v)


@pytest.mark.parametrize("height", [0.2, -0.4], ids=["pushes", "apart"])
@pytest.mark.parametrize("damping", [0.0, 40.0])
def test_of_what_contacts_measure(height, damping):
    """Force, overlap, place on the wire and aside of two strips, along random changes of the state."""
    model, wire = beams()
    for k, place in enumerate((0.3, 0.8)):
        head = model.add_point_mass(f"head {k}", at=(place, 0.125, height), mass=1.0)
        strip = {"strip": (0.1 * k, 1.0, 0.0), "normal": (0.0, 0.0, 1.0)}
        model.add_contact(head, along=wire, stiffness=5e3, damping=damping, **strip)
    system, (q, v, _), _ = moved(model, 2)
    batch, rng = system.parts["contacts"], np.random.default_rng(4)
    batches = knowing(take_measured_slopes, [batch], measure, add_measured_work)
    found, step = np.zeros((2, 4)), 1e-5
    for _ in range(5):
        dq, dv = rng.uniform(-1, 1, (2, system.size))
        slopes_of_measured(batches, q, v, dq, dv, found.reshape(-1))
        wanted = np.zeros((2, 4))
        for place, weight in ((-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12)):
            measured(batches, q + place * step * dq, v + place * step * dv)
            wanted += weight / step * batch.found
        assert np.all((found[:, 0] != 0.0) == (height == 0.2))
        size = np.maximum(np.max(np.abs(wanted), axis=0), 1.0)
        assert np.max(np.abs(found - wanted) / size) < 3e-8
        y, by = rng.uniform(-1, 1, 8), np.zeros((2, system.size))  # the other way round it is the same sum
        work_of_measured(batches, q, v, y, *by)
        own = found.reshape(-1)
        assert by[0] @ dq + by[1] @ dv == pytest.approx(y @ own, abs=1e-12 * np.sum(np.abs(y * own)))


@kernel
def measured(batches, q, v):
    measure_all(batches, q, v)
