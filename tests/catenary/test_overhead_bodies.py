"""Pantographs that are no chains: rigid bodies in the model, frames that another program computes."""

import numpy as np
import pytest

import ancf
from ancf.catenary import Pantograph, assemble, form, run, statistics
from overhead_lines import COARSE, short_line

SPEED, START = 40.0, 12.0
FRAME, HEAD, SPRING, DAMPER, FORCE = 15.0, 7.2, 4200.0, 10.0, 120.0
STEP, CONTACT = 1e-3, 50e3


def add_lever(overhead, mass, length):
    """A level rod, hinged on the roof, whose end carries the head: its inertia there is that of mass/3."""
    model, there = overhead.model, overhead.contact_at(START)
    push = model.add_force(there, (0.0, 0.0, FORCE))
    strip = float(ancf.equilibrium(model).position(there)[2]) + FORCE / CONTACT
    model.loads.remove(push)
    tip, way = np.array([START, 0.0, strip - 0.5]), (f"{SPEED!r}*t", 0.0, 0.0)
    inertia = mass * length**2 / 12.0
    rod = model.add_rigid_body(
        "lever", at=tip - [0.5 * length, 0, 0], mass=mass, inertia=(0.1, inertia, inertia)
    )
    for k, y in enumerate((-0.2, 0.2)):
        bearing = model.add_point_mass(f"bearing {k + 1}", at=tip - [length, -y, 0.0], mass=1.0)
        model.pin(bearing, displacement=way)
        bearing.set_motion(velocity=(SPEED, 0.0, 0.0))
        model.connect(bearing, rod.at(-0.5 * length, y, 0.0))
    head = model.add_point_mass("head", at=(START, 0.0, strip), mass=HEAD)
    model.hold(head, position="xy", displacement=way)
    for body in (rod, head):
        body.set_motion(velocity=(SPEED, 0.0, 0.0))
    end = rod.at(0.5 * length, 0.0, 0.0)
    model.add_spring(end, head, stiffness=SPRING, damping=DAMPER, length=0.5 + FORCE / SPRING)
    model.add_force(rod.at(0.0, 0.0, 0.0), (0.0, 0.0, 9.81 * mass), name="balance")
    model.add_force(end, (0.0, 0.0, FORCE), name="lift")
    model.add_force(head, (0.0, 0.0, 9.81 * HEAD), name="balance of the head")
    return model.add_contact(head, overhead.contact_wire, stiffness=CONTACT, name="strip on wire")


def force_of(overhead, contact):
    rest = ancf.equilibrium(overhead.model)
    settings = {"integrator": ancf.GeneralizedAlpha(0.9), "sensors": [contact], "energy": False}
    result = ancf.simulate(overhead.model, t_end=2.0, step=STEP, start=rest, **settings)
    return result.sensors.contact_force(contact)


@pytest.mark.parametrize(("mass", "length"), [(24.0, 1.6), (45.0, 2.2)])
def test_lever_of_a_rigid_body(mass, length):
    """A level lever swings like a mass of a third of its own below the head."""
    found = form(short_line(), COARSE)
    overhead, other = assemble(found), assemble(found)
    lever = force_of(overhead, add_lever(overhead, mass, length))
    unit = Pantograph(
        masses=(mass / 3.0, HEAD), stiffness=(0.0, SPRING), damping=(1e-6, DAMPER), static_force=FORCE
    )
    chain = force_of(other, other.add_pantograph(unit, SPEED, start=START).meter)
    assert np.std(chain) > 10.0
    assert np.std(lever) == pytest.approx(np.std(chain), rel=2e-3)
    assert lever == pytest.approx(chain, abs=0.02 * FORCE)


class Frame:
    """The lower mass of a pantograph, computed by another program that is given the motion of the head."""

    def __init__(self, parts=10):
        self.z, self.v, self.start, self.parts = 0.0, 0.0, None, parts

    def __call__(self, run):
        head, rate = (
            float(x[2]) for x in (run.position("pantograph mass 1"), run.velocity("pantograph mass 1"))
        )
        self.start = head if self.start is None else self.start
        head, part = head - self.start, STEP / self.parts
        for _ in range(self.parts):
            pull = SPRING * (self.z - head) + DAMPER * (self.v - rate)
            self.v += part * (-50.0 * self.z - 90.0 * self.v - pull) / FRAME
            self.z += part * self.v
            head += part * rate
        run.inputs["pantograph_force"] = SPRING * (self.z - head) + DAMPER * (self.v - rate)


WAY = {"speed": SPEED, "step": STEP, "window": (66.0, 98.0), "until": 104.0, "start": START}


def test_frame_of_another_program():
    """The head runs along the line, its frame is computed outside: as if both were one."""
    found = form(short_line(), COARSE)
    whole = Pantograph(
        masses=(FRAME, HEAD), stiffness=(50.0, SPRING), damping=(90.0, DAMPER), static_force=FORCE
    )
    head = Pantograph(masses=(HEAD,), stiffness=(0.0,), damping=(1e-6,), static_force=FORCE)
    runs = (
        run(found, pantograph=whole, **WAY),
        run(found, pantograph=head, controller=Frame(), control_step=STEP, **WAY),
    )
    one, other = (statistics(made) for made in runs)
    assert other["mean_force"].value == pytest.approx(one["mean_force"].value, rel=2e-3)
    assert other["deviation"].value == pytest.approx(one["deviation"].value, rel=0.01)


def test_one_mass_of_two_strips_is_active():
    """Both strips have half of what the controller gives."""
    found = form(short_line(), COARSE)
    unit = Pantograph(masses=(HEAD,), stiffness=(0.0,), damping=(5.0,), static_force=80.0, strip_distance=0.5)

    def push(run):
        run.inputs["pantograph_force"] = 40.0

    made = run(found, pantograph=unit, controller=push, control_step=STEP, **WAY)
    by_strip = made.recordings[0].by_strip[made.t > 0.5].mean(axis=0)
    assert by_strip.sum() == pytest.approx(120.0, rel=0.05)
    assert by_strip == pytest.approx([60.0, 60.0], rel=0.1)
