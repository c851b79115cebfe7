"""Derivatives of reactions and accelerations in motion, of stored states, against differences of runs."""

from itertools import product

import numpy as np
import pytest

import ancf
from helpers import some
from random_models import RandomModel
from slopes import extrapolated, once

#: "ggl" leaves a part of its shift out of derivatives.
METHOD = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-13), formulation="index2")
GIVEN = {"t_end": 0.02, "step": 1e-3, "integrator": METHOD}


def hung(element="cable"):
    """A beam on a support that shakes, which carries a mass by a joint and a spring."""
    model = ancf.Model(gravity=(0.3, -0.2, -9.81))
    if element == "cable":
        section = ancf.Section(EA=3e3, EI=0.4, rhoA=0.3, bending_damping=0.01)
    else:
        section = ancf.Section.rectangle(0.03, 0.02, E=5e6, rho=500.0, nu=0.3)
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0.1), elements=3, element=element, section=section
    )
    body = model.add_rigid_body("body", at=(1.1, 0.2, 0.1), mass=0.6, inertia=(2e-3, 3e-3, 4e-3))
    model.clamp(beam.start, displacement=(0, 0, "0.01*sin(40*t)"), name="shaker")
    if element == "cable":
        model.connect(body.at(-0.1, -0.2, 0), beam.end, name="hinge")
    else:
        model.hinge(body.at(-0.1, -0.2, 0), beam.end, (0, 1, 0), name="hinge")
    model.add_spring(body, (1.1, 0.2, 0.9), stiffness=60.0, damping=0.5, length=0.6, name="tie")
    return model


ASKED = [
    ("reaction", "shaker"),
    ("reaction_moment", "shaker"),
    ("acceleration", "beam.end"),
    ("acceleration", "body"),
]
NAMES = ["beam.length", "body.mass", "tie.stiffness", "gravity", "beam.start[2]"]


@pytest.mark.parametrize(("element", "name"), some(list(product(["cable", "original", "nonlocking"], NAMES))))
def test_against_differences(element, name):
    model = hung(element)
    run = once(lambda other: ancf.simulate(other, **GIVEN))
    found = ancf.simulate(model, sensitivities=[name], **GIVEN).sensitivity(name)
    force = 0.0
    for question, item in ASKED:
        own = getattr(found, question)(item)
        wanted = extrapolated(lambda m, q=question, i=item: getattr(run(m), q)(i), model, name, 5e-3, 4)
        assert own.shape == (21, 3)
        size = np.max(np.abs(wanted))
        force = size if question == "reaction" else force
        size = max(size, force) if question == "reaction_moment" else size  # what forces leave at arms of 1 m
        assert np.max(np.abs(own - wanted)) < 3e-6 * size, question


@pytest.mark.parametrize("seed", [0, 1, 2, 7, 12])
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_random_models(seed):
    """All supports of models with joints, springs, turning clamps and loads."""
    model = RandomModel(seed).model
    found = ancf.simulate(model, sensitivities=["gravity"], **GIVEN).sensitivity("gravity")
    names = [support.name for support in model.supports]

    def reactions(other):
        run = ancf.simulate(other, **GIVEN)
        return np.stack([run.reaction(name) for name in names])

    wanted = extrapolated(reactions, model, "gravity", 5e-3, 3)
    own = np.stack([found.reaction(name) for name in names])
    assert np.max(np.abs(own - wanted)) < 1e-6 * np.max(np.abs(wanted))


def test_of_one_state_and_of_an_equilibrium():
    """One stored state as in the history; an equilibrium as before, without accelerations."""
    model = hung("original")
    found = ancf.simulate(model, sensitivities=["body.mass"], **GIVEN).sensitivity("body.mass")
    for question, item in ASKED:
        whole = getattr(found, question)(item)
        one = getattr(found.state(7), question)(item)
        assert np.max(np.abs(one - whole[7])) < 1e-6 * np.max(np.abs(whole))
    model.supports.clear()
    model.clamp("beam.start", name="held")
    rest = ancf.equilibrium(model, sensitivities=["body.mass"]).sensitivity("body.mass")
    weight = -np.array(model.gravity)  # of one kilogram; the spring takes its share
    assert rest.reaction("held")[:2] == pytest.approx(weight[:2], abs=0.1 * weight[2])
    assert 0.0 < rest.reaction("held")[2] < weight[2]


def test_gradients_say_so():
    with pytest.raises(ancf.ModelError, match="reaction"):
        ancf.gradient(hung(), 'max(reaction("shaker")[2])', ["body.mass"], **GIVEN)
