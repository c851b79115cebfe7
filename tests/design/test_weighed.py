"""lambda . R_p of an adjoint, from what numbers of batches do, against differences of residuals."""

import numpy as np
import pytest

import ancf
from ancf.sensitivity.family import Family
from ancf.sensitivity.nearby import Nearby
from ancf.sensitivity.parameters import parameters_of
from ancf.sensitivity.weighed import Weighed
from ancf.solvers.derivatives.sensitivity import Way
from ancf.system.system import System

DAMPED = {"axial_damping": 2.0, "bending_damping": 0.1, "damping": 0.2, "slope_damping": 0.05}
OF_SECTIONS = ["EA", "EI", "rhoA", "axial_damping", "bending_damping", "damping", "slope_damping"]
OF_SOLIDS = ["E", "rho", "nu", "axial_damping", "bending_damping", "damping"]


def two_cables(elements, gravity=-9.81, **damping):
    """A damped cable and one of the given section, with springs, a mass, and loads in time."""
    model = ancf.Model(gravity=(0, 0, gravity))
    own = ancf.Section(EA=300.0, EI=0.7, rhoA=0.2, **damping)
    a = model.add_beam("a", start=(0, 0, 0), end=(1, 0.2, 0), elements=elements, section=own)
    other = ancf.Section(EA=200.0, EI=0.5, rhoA=0.1, **DAMPED)
    b = model.add_beam("b", start=(0, 1, 0), end=(1, 1, 0.1), elements=5, section=other, strain="paper")
    model.add_point_mass("m", at=(2, 1, 0), mass=0.5)
    model.pin(a.start)
    model.pin(b.start, displacement=(0, 0, "0.1*sin(9*t)"))
    model.add_spring(a.end, b.at(0.7), stiffness=20.0, damping=0.1, length=0.3, name="between")
    model.add_spring(b.end, "m", stiffness=30.0, length=0.8, name="held")
    model.add_force(a.at(0.3), (0, "sin(7*t)", -1.0), name="push")
    model.add_distributed_load(b, (0.1, 0, "-cos(5*t)"), name="wind")
    return model


def solid():
    """A beam with a cross-section on a spring."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section.rectangle(width=0.1, height=0.1, E=1e6, rho=500.0, nu=0.3)
    beam = model.add_beam(
        "a", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section, element="original"
    )
    model.pin(beam.start)
    model.add_spring(beam.end, (1, 0, 1), stiffness=20.0, length=0.3, name="held")
    return model


def clamped():
    """A cable and a spring; the clamp turns with the ends."""
    model = ancf.Model(gravity=(0, 0.3, -9.81))
    section = ancf.Section(EA=300.0, EI=0.7, rhoA=0.2)
    beam = model.add_beam("a", start=(0, 0, 0), end=(1, 0.2, 0.1), elements=3, section=section)
    model.clamp(beam.start)
    model.add_force(beam.at(0.3), (0, "sin(7*t)", -1.0), name="push")
    model.add_spring(beam.end, (1, 0, 1), stiffness=20.0, length=0.3, name="held")
    return model


CASES = {
    "plain": lambda: two_cables(3),
    "damped": lambda: two_cables(9, **DAMPED),
    "without weight": lambda: two_cables(8, gravity=0.0, damping=0.1),
    "clamped": clamped,
    "solid": solid,
}
NAMES = {
    "clamped": ["a.EI", "a.start[0]", "a.start[1]", "a.start[2]", "a.end[1]", "a.end[2]", "held.length"],
    "solid": [*(f"a.{key}" for key in OF_SOLIDS), "held.length", "gravity[2]", "a.length"],
    "others": [
        *(f"b.{key}" for key in OF_SECTIONS),
        *("between.stiffness", "gravity[2]", "a.length", "m.mass", "a.start[1]", "held.length"),
        *("push.force", "b.length", "wind.load", "between.damping", "gravity[0]"),
        *(f"a.{key}" for key in OF_SECTIONS),
    ],
}


@pytest.mark.parametrize("case", CASES)
def test_the_sum_over_the_steps(case):
    """Of random states and lambda: for every parameter what its pushes make, and in any order of them."""
    model = CASES[case]()
    system, count = System(model), 5
    names = NAMES.get(case, NAMES["others"])
    families = [Family(p, system, shifts=True) for p in parameters_of(model, names, "test")]
    nearby = Nearby(families, system, shifts=True)
    weighed = Weighed(nearby)
    rng = np.random.default_rng(3)
    used = np.append(system.numbering.used(), np.zeros(system.size - system.n))
    q, v, a, lam = (by * used * rng.uniform(-1, 1, (count, system.size)) for by in (0.02, 0.5, 3.0, 1.0))
    q += system.initial_shape()
    lam[:, system.held] = 0.0
    when = 0.1, 0.02, 0.0, 1.0
    tables = system.inputs.tables(*when[:2], count, *when[2:])
    way = Way(q, v, a)
    push = nearby.at_steps(Way(*(x.copy() for x in way)), when, tables, gaps=False).push
    wanted, size = np.sum(push * lam, axis=(1, 2)), np.sum(np.abs(push * lam), axis=(1, 2))
    turned = np.zeros((weighed.turning, 3, 3))
    found = weighed.at_steps(Way(*(x.copy() for x in way)), when, tables, lam.copy(), turned)
    found += weighed.in_all(when, tables)
    assert nearby.plain
    for k in nearby.plain:
        assert abs(found[k] - wanted[k]) <= 2e-9 * size[k], names[k]
    known = {names[k] for k in weighed.rates}
    assert known >= {name for name in names if name[2:] in (*OF_SECTIONS, *OF_SOLIDS) and name[0] == "a"}
    if case == "damped":
        sections = {f"{body}.{key}" for body in "ab" for key in OF_SECTIONS}
        assert known >= sections | {"a.length", "m.mass", "held.length", "gravity[2]"}


def test_a_gradient_by_many_is_that_of_each():
    model = two_cables(4, **DAMPED)
    names, settings = NAMES["others"], {"t_end": 0.05, "step": 1e-3}
    objective = "integral(norm(velocity(a.end))**2) + last(tension(b.at(0.3)))**2"
    _, slope = ancf.gradient(model, objective, names, **settings)
    _, again = ancf.gradient(model, objective, names[::-1], **settings)
    result = ancf.simulate(model, sensitivities=names, **settings)
    v, t, tension = result.velocity("a.end"), np.asarray(result.t), result.tension("b.at(0.3)")
    for name in names:
        own = result.sensitivity(name)
        wanted = np.trapezoid(2.0 * np.sum(v * own.velocity("a.end"), axis=1), t)
        wanted += 2.0 * tension[-1] * own.tension("b.at(0.3)")[-1]
        assert slope[name] == pytest.approx(wanted, rel=1e-7), name
        assert again[name] == pytest.approx(slope[name], rel=1e-9), name
