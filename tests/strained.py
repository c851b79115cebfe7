"""Damped cables and springs in strained shapes and in motion."""

import numpy as np
import pytest

import ancf

SECTIONS = {
    "plain": {},
    "axial": {"axial_damping": 5.0},
    "bending": {"bending_damping": 0.5},
    "all": {"axial_damping": 5.0, "bending_damping": 0.5, "damping": 0.3, "slope_damping": 0.2},
}


def cable(strain, elements, shape, **damping):
    model = ancf.Model()
    section = ancf.Section(EA=100.0, EI=1.0, rhoA=0.1, **damping)
    given = {"elements": elements, "section": section, "strain": strain}
    if shape == "straight":
        return model, model.add_beam("beam", start=(0, 0, 0), end=(1.2, 0.3, 0), **given)

    def arc(s):
        return np.array([np.sin(s), 1.0 - np.cos(s), 0.0])

    return model, model.add_beam("beam", path=arc, **given)


SOLIDLY = {
    "plain": {},
    "axial": {"axial_damping": 5.0},
    "bending": {"bending_damping": 0.5},
    "external": {"damping": 0.3},
    "all": {"axial_damping": 5.0, "bending_damping": 0.5, "damping": 0.3},
}
SHAPES = {
    "rectangle": lambda **more: ancf.Section.rectangle(0.2, 0.1, E=1e3, rho=9.0, **more),
    "circle": lambda **more: ancf.Section.circle(0.2, E=1e3, nu=0.3, rho=9.0, **more),
}


def of_solids(test):
    """Let a test have all beams with a cross-section: element, shape, section, damping and elements."""
    for name, values in (
        ("element", ["original", "nonlocking"]),
        ("shape", ["straight", "curved"]),
        ("section", SHAPES),
        ("damping", SOLIDLY),
        ("elements", [3, 9]),
    ):
        test = pytest.mark.parametrize(name, values)(test)
    return test


def solid(element, shape, section="rectangle", elements=3, **damping):
    """A beam with a cross-section, straight or bent to an arc that it has without forces, and half of it."""
    model = ancf.Model()
    given = {"element": element, "elements": elements, "section": SHAPES[section](**damping)}
    if shape == "straight":
        return model, model.add_beam("beam", start=(0, 0, 0), end=(1.2, 0.3, 0), **given)

    def arc(s):
        return np.array([np.sin(s), 1.0 - np.cos(s), 0.1 * s])

    return model, model.add_beam("beam", path=arc, poisson="centreline", **given)


def sprung():
    """Springs with and without dampers, curves, friction, slack and stretched."""
    model, beam = cable("material", 3, "straight")
    places = {"stiffness": 10.0, "length": 0.3}
    model.add_spring(beam.at(0.77), (0.5, 0.5, 1), damping=30.0, **places)
    model.add_spring(beam.end, (0.5, 0.5, 1), friction=2.0, friction_velocity=0.4, **places)
    model.add_spring(beam.at(0.2), beam.at(0.9), stiffness=7.0, length=0.2, slack=True)
    model.add_spring(beam.at(0.3), (0, 0, 0.1), stiffness=7.0, length=5.0, slack=True)
    return model


def states(system, seed):
    """A strained shape, velocities, accelerations and x, and where they come from."""
    rng = np.random.default_rng(seed)
    used = np.append(system.numbering.used(), np.zeros(system.size - system.n))
    q, v, a, x = (by * used * rng.uniform(-1, 1, system.size) for by in (0.02, 0.5, 500.0, 1.0))
    return q + system.initial_shape(), v, a, x, rng
