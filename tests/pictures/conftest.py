"""Runs of which several files make pictures."""

import pytest

import ancf


@pytest.fixture(scope="module")
def built():
    """A cable in a plane with a mass at its end, a slack and a taut spring; its clamp and its result."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="Rope")
    section = ancf.Section(EA=1e3, EI=0.05, rhoA=0.1)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
    ball = model.add_point_mass("ball", at=(1, 0, 0), mass=0.1)
    model.connect(ball, rope.end)
    model.clamp(rope.start)
    model.add_spring(rope.at(0.5), (0.5, 0, 0.3), stiffness=10.0, name="taut")
    model.add_spring(rope.at(0.5), (0.5, 0, -0.5), stiffness=10.0, slack=True, name="loose")
    result = ancf.simulate(model, t_end=0.2, step=1e-3, output_step=2e-3, sensors=["rope.end", "taut"])
    return model, result


@pytest.fixture(scope="module")
def model(built):
    return built[0]


@pytest.fixture(scope="module")
def result(built):
    return built[1]


@pytest.fixture(scope="module")
def spatial():
    """A beam with a cross-section, pushed out of its plane."""
    model = ancf.Model()
    section = ancf.Section.rectangle(0.05, 0.1, E=1e6, rho=1e3)
    arm = model.add_beam(
        "arm", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section, element="nonlocking"
    )
    model.clamp(arm.start)
    model.add_force(arm.end, (0, 8, 5))
    return ancf.simulate(model, t_end=0.3, step=5e-3)
