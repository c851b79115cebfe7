"""Derivatives by a length of what points at nodes, near them and near the end answer.

The point stays where it is and the nodes move: with another length it may be in the next element, whose
tension is another one, or no longer on the beam.
"""

import numpy as np
import pytest

import ancf
from ancf.model.vary import varied
from helpers import some

LENGTH, WEIGHT = 4.0, 0.2 * 9.81
ROPE = ancf.Section(EA=1e4, EI=0.05, rhoA=0.2)
NEAR = 1e-4  # m: less than the length changes in the differences


def hanging(elements, upwards):
    model = ancf.Model(gravity=(0, 0, -9.81))
    ends = (
        {"start": (0, 0, -LENGTH), "end": (0, 0, 0)}
        if upwards
        else {"start": (0, 0, 0), "end": (0, 0, -LENGTH)}
    )
    rope = model.add_beam("rope", **ends, elements=elements, section=ROPE)
    model.clamp(rope.end if upwards else rope.start)
    return model, rope


def asked(rope):
    """Places at nodes, beside them, and next to the end."""
    nodes = rope.node_x[1:-1]
    return [*nodes, *(nodes - NEAR), *(nodes + NEAR), rope.length - NEAR, NEAR]


@pytest.mark.parametrize("upwards", [False, True])
@pytest.mark.parametrize("elements", some([2, 1, 5, 8]))
def test_tension_of_a_hanging_rope(elements, upwards):
    """w per metre below the support at a given distance from it, none at one from the free end."""
    model, rope = hanging(elements, upwards)
    state = ancf.equilibrium(model, sensitivities=["rope.length"])
    points = [rope.at(float(x)) for x in asked(rope)]
    run = ancf.simulate(
        model, t_end=2e-3, step=1e-3, start=state, sensitivities=["rope.length"], sensors=points
    )
    wanted = 0.0 if upwards else WEIGHT
    own, history = state.sensitivity("rope.length"), run.sensitivity("rope.length")
    recorded = run.sensors.sensitivity("rope.length")
    for point in points:
        assert own.tension(point) == pytest.approx(wanted, abs=1e-6)
        assert history.tension(point)[-1] == pytest.approx(wanted, abs=1e-5)
        assert recorded.tension(point)[-1] == pytest.approx(wanted, abs=1e-5)
        assert recorded.acceleration(point)[-1] == pytest.approx(np.zeros(3), abs=1e-3)
    for point in points[:2]:
        number = f"last(tension({point}))"
        _, slope = ancf.gradient(model, number, ["rope.length"], t_end=2e-3, step=1e-3, start=state)
        assert slope["rope.length"] == pytest.approx(wanted, abs=1e-5)


def sagging(section, element):
    model = ancf.Model(gravity=(0, 0.5, -9.81))
    wire = model.add_beam(
        "wire",
        start=(0, 0, 0),
        end=(3.9, 0.1, 0.4),
        length=LENGTH,
        elements=5,
        section=section,
        element=element,
    )
    model.pin(wire.start)
    model.pin(wire.end)
    if element != "cable":
        model.hold(wire.start, twist=True)
    model.add_force(wire.at(1.3), (0.0, 0.3, 1.0))
    return model, wire


FLAT = ancf.Section.rectangle(width=0.02, height=0.03, E=1e7, rho=500.0, nu=0.3)
QUESTIONS = ["position", "tension", "curvature", "slope"]


@pytest.mark.parametrize(("section", "element"), [(ROPE, "cable"), (FLAT, "nonlocking")])
@pytest.mark.parametrize("question", QUESTIONS)
def test_is_the_limit_from_the_side_of_its_element(section, element, question):
    """Differences of so small a step that a point a little further on stays in the element."""
    model, wire = sagging(section, element)
    own = ancf.equilibrium(model, sensitivities=["wire.length"]).sensitivity("wire.length")
    step, inside = 1e-4, 4e-4
    around = [ancf.equilibrium(varied(model, "wire.length", LENGTH + s)) for s in (step, -step)]
    for node in wire.node_x[1:-1]:
        place = float(node) + inside
        one, two = (
            np.asarray(getattr(state, question)(state.model.bodies["wire"].at(place))) for state in around
        )
        wanted, found = (one - two) / (2 * step), np.asarray(getattr(own, question)(wire.at(float(node))))
        size = np.max(np.abs(wanted))
        assert found == pytest.approx(wanted, abs=1e-2 * size)
        assert found == pytest.approx(np.asarray(getattr(own, question)(wire.at(place))), abs=1e-2 * size)


@pytest.mark.parametrize("place", [0.8, 1.6, 2.4 - NEAR, LENGTH - NEAR])
def test_shapes_of_modes(place):
    model, wire = sagging(ROPE, "cable")
    state = ancf.equilibrium(model, sensitivities=["wire.length"])
    modes = ancf.modes(model, about=state, count=2, sensitivities=["wire.length"])
    own = modes.sensitivity("wire.length")
    here, beside = own.position(wire.at(place)), own.position(wire.at(place - 2 * NEAR))
    assert here == pytest.approx(beside, abs=1e-2 * np.max(np.abs(here)))
