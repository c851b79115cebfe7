"""Beams with a cross-section in the model file."""

import copy
import tomllib

import numpy as np
import pytest

from ancf.errors import ModelError
from ancf.model import Section
from ancf.model.file import parse_study

TEXT = """
[sections.strip]
shape = "rectangle"
width = 0.04
height = 0.02
E = 1e8
rho = 500
nu = 0.3
J = 2.5e-8
shear_factors = [0.8, 0.85]
[sections.pipe]
shape = "moments"
A = 1e-3
I_y = 1e-7
I_z = 2e-7
J = 2e-7
I_yyyy = 1e-10
E = 2e11
rho = 7850
[sections.rope]
EA = 1e4
EI = 0.08
rhoA = 0.05
[[bodies]]
name = "beam"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 4
section = "strip"
element = "original"
poisson = "full"
gauss = [4, 2]
y_axis = [1, 0, 2]
[[bodies]]
name = "tube"
path = [[1, 0, 0], [2, 0.5, 0], [3, 0.5, 0], [4, 0, 0]]
elements = 6
section = "pipe"
element = "nonlocking"
strain = "green"
[[supports]]
type = "clamp"
point = "beam.start"
[[supports]]
type = "hold"
point = "tube.end"
position = "yz"
twist = true
[[supports]]
type = "hold"
point = "beam.end"
slope_y = "xz"
slope_z = "y"
[[loads]]
type = "force"
point = "beam.at(0.5, 0.02, -0.01)"
force = [0, 0, 1]
[[loads]]
type = "moment"
point = "tube.at(0.5)"
moment = [1, 0, 0]
[[connections]]
type = "spring"
a = "beam.at(1, 0.02, 0)"
b = [1, 0, 1]
stiffness = 100
[simulation]
t_end = 1.0
step = 0.1
outputs = ["beam.at(0.5, 0.01, 0)"]
"""
DATA = tomllib.loads(TEXT)
MISSING = type("Missing", (), {"__repr__": lambda self: "missing"})()  # the same name in every process


def changed(path, value):
    data = copy.deepcopy(DATA)
    table = data
    for key in path[:-1]:
        table = table[key]
    if value is MISSING:
        del table[path[-1]]
    else:
        table[path[-1]] = value
    return data


def test_a_whole_file():
    study = parse_study(DATA)
    model = study.model
    beam, tube = model.body("beam"), model.body("tube")
    assert (beam.element, beam.strain, beam.poisson, beam.gauss) == ("original", "green", "full", (4, 2))
    np.testing.assert_allclose(beam.node_y, np.tile([0, 0, 1], (5, 1)))
    assert beam.section == Section.rectangle(0.04, 0.02, 1e8, 500, 0.3, J=2.5e-8, shear_factors=(0.8, 0.85))
    wanted = Section.from_moments(A=1e-3, I_y=1e-7, I_z=2e-7, J=2e-7, I_yyyy=1e-10, E=2e11, rho=7850)
    assert tube.section == wanted
    assert (tube.element, tube.strain, tube.poisson) == ("nonlocking", "green", "centreline")
    assert model.supports[1].held == {"position y", "position z", "twist"}
    assert model.supports[2].held == {"slope_y x", "slope_y z", "slope_z y"}
    assert model.loads[0].point == beam.at(0.5, 0.02, -0.01)
    assert model.connections[0].a == beam.at(1, 0.02)
    assert study.simulation.outputs == ("beam.at(0.5, 0.01, 0)",)


STRIP, PIPE, BEAM = ("sections", "strip"), ("sections", "pipe"), ("bodies", 0)
HOLD, GUIDE, FORCE = ("supports", 1), ("supports", 2), ("loads", 0)
BAD = [
    ((*STRIP, "shape"), "moment", "sections.strip.shape", 'did you mean "moments"?'),
    ((*STRIP, "J"), -1, "sections.strip.J", "must be > 0, is -1"),
    ((*STRIP, "A"), 1.0, "sections.strip.A", "unknown key"),
    ((*STRIP, "shear_factors"), [1], "sections.strip.shear_factors", "has 1 entries, wanted 2"),
    ((*STRIP, "shear_factors"), [1, 0], "sections.strip.shear_factors[1]", "must be > 0"),
    ((*STRIP, "shear_factors"), 1, "sections.strip.shear_factors", "must be a list"),
    ((*PIPE, "J"), MISSING, "sections.pipe.J", "is missing (Torsion constant [m^4])"),
    ((*PIPE, "A"), MISSING, "sections.pipe.A", "is missing (Area [m^2])"),
    ((*PIPE, "I_y"), 0, "sections.pipe.I_y", "must be > 0"),
    ((*PIPE, "I_yy"), 1, "sections.pipe.I_yy", "did you mean"),
    ((*PIPE, "I_yyyy"), 1e-12, "sections.pipe.I_yyyy", "must be >= I_z^2/A"),
    ((*PIPE, "nu"), 0.5, "sections.pipe.nu", "must be < 0.5"),
    ((*BEAM, "element"), "nonloking", "bodies[0].element", 'did you mean "nonlocking"?'),
    ((*BEAM, "section"), "rope", "bodies[0].section", "needs A, I_y, I_z, J, E, nu, rho"),
    ((*BEAM, "element"), "cable", "bodies[0].section", "one bending stiffness"),
    ((*BEAM, "strain"), "paper", "bodies[0].strain", "is a strain measure of cables"),
    ((*BEAM, "strain"), "Green", "bodies[0].strain", 'did you mean "green"?'),
    ((*BEAM, "gauss"), [5, 1], "bodies[0].gauss[1]", "between 2 and 10"),
    (("bodies", 1, "gauss"), [5, 4], "bodies[1].gauss[1]", "must be 3"),
    ((*BEAM, "y_axis"), [1, 0, 0], "bodies[0].y_axis", "along the tangent"),
    ((*BEAM, "y_axis"), [0, 0, 0], "bodies[0].y_axis", "zero vector"),
    ((*BEAM, "y_axis"), [0, 1], "bodies[0].y_axis", "wanted 3"),
    (("supports", 0, "point"), "beam.at(0.5, 0.01, 0)", "supports[0].point", "must be on the centreline"),
    ((*HOLD, "twist"), 1, "supports[1].twist", "true or false"),
    ((*HOLD, "slope_y"), "x", "supports[1].twist", "not both"),
    ((*GUIDE, "slope_y"), "xx", "supports[2].slope_y", "at most once"),
    ((*GUIDE, "slope_x"), "x", "supports[2].slope_x", "did you mean"),
    ((*FORCE, "point"), "beam.at(0.5, 0.03, 0)", "loads[0].point", "outside the cross-section"),
    ((*FORCE, "point"), "beam.at(0.5, y, 0)", "loads[0].point", '"y" is no place along local y'),
    (("simulation", "outputs"), ["tube.at(1, 2)", "beam.at(1, 2)"], "simulation.outputs[1]", "outside the"),
]


@pytest.mark.parametrize(("path", "value", "where", "phrase"), BAD, ids=lambda v: str(v)[:30])
def test_bad_value(path, value, where, phrase):
    with pytest.raises(ModelError) as caught:
        parse_study(changed(path, value))
    assert caught.value.where == where
    assert phrase in str(caught.value)


def test_a_cable_has_no_section_to_hold():
    """The same file with a cable in the place of the tube."""
    data = changed(("bodies", 1, "element"), "cable")
    data["bodies"][1] |= {"section": "rope", "strain": "paper"}
    data["loads"][0]["point"] = "tube.at(1, 0.01, 0)"
    with pytest.raises(ModelError) as caught:
        parse_study(data)
    message = str(caught.value)
    assert 'supports[1].twist: "tube" is a cable and has no r_y' in message
    assert "a cable has no cross-section to place a point in" in message
