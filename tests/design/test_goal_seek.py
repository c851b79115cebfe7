"""Numbers of equilibria: their gradients against differences, and goals that are sought with them."""

import numpy as np
import pytest

import ancf


def hanging(length=10.4, EA=2e4, mass=3.0):
    """A rope between two masts with a mass in it and a stay of springs."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=EA, EI=0.5, rhoA=0.4)
    rope = model.add_beam(
        "rope", start=(0, 0, 0), end=(10, 0, 0.5), length=length, elements=8, section=section
    )
    model.pin(rope.start, name="west")
    model.pin(rope.end, name="east")
    bob = model.add_point_mass("bob", at=(5, 0, 0.25), mass=mass)
    model.connect(bob, rope.at(0.5 * length))
    model.add_spring(rope.at(0.3 * length), (3, 0, -4), stiffness=40.0, length=3.0, name="stay")
    return model


NAMES = ("rope.length", "rope.EA", "bob.mass", "stay.stiffness", "gravity")
NUMBERS = (
    "tension(rope.start)",
    "position(bob)[2]",
    "(tension(rope.end) - 60)**2",
    "norm(position(bob) - position(rope.start))",
    "spring_force(stay) / tension(rope.start)",
    "last(position(bob)[2]) + max(tension(rope.start))",
    "reaction(west)[2]",
)


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("name", NAMES)
def test_gradients_are_those_of_differences(number, name):
    from ancf.model.vary import value_of, varied

    model = hanging()
    value, slope = ancf.gradient(model, number, [name])
    x = value_of(model, name)
    h = 1e-4 * x
    around = [ancf.gradient(varied(model, name, x + k * h), number, [])[0] for k in (-2, -1, 1, 2)]
    wanted = np.dot(around, [1, -8, 8, -1]) / (12 * h)
    assert value == pytest.approx(ancf.gradient(model, number, [])[0], rel=1e-12)
    assert slope[name] == pytest.approx(wanted, rel=2e-5, abs=1e-7 * max(abs(value), 1.0) / x)


@pytest.mark.parametrize("target", [57.0, 70.0, 90.0])
@pytest.mark.parametrize("built", [False, True])
def test_a_target_tension_is_met(target, built):
    """By the natural length of the rope; a function that builds the model does the same."""
    model, name = (hanging, "length") if built else (hanging(), "rope.length")
    found = ancf.minimise(model, f"(tension(rope.start) - {target})**2", {name: (10.15, 11.0)})
    assert found.converged
    state = ancf.equilibrium(hanging(length=found.values[name]))
    assert state.tension("rope.start") == pytest.approx(target, rel=1e-5)


def test_within_a_constraint():
    """The least tension with which the mass hangs no lower: the optimum is on the constraint."""
    bounds = {"rope.length": (10.15, 11.0)}
    found = ancf.minimise(
        hanging(), "tension(rope.start)", bounds, constraints={"position(bob)[2]": (-1.0, None)}
    )
    assert found.constraints["position(bob)[2]"] == pytest.approx(-1.0, abs=1e-6)
    looser = ancf.minimise(
        hanging(), "tension(rope.start)", bounds, constraints={"position(bob)[2]": (-1.2, None)}
    )
    assert looser.objective < found.objective


def test_an_equilibrium_of_ones_own():
    """``begin`` finds it: of some bodies, or in steps of the loads."""
    asked = []

    def begin(model, sensitivities):
        asked.append(len(sensitivities))
        return ancf.equilibrium(model, load_steps=2, sensitivities=sensitivities)

    found = ancf.minimise(
        hanging(), "(tension(rope.start) - 60)**2", {"rope.length": (10.15, 11.0)}, begin=begin
    )
    plain = ancf.minimise(hanging(), "(tension(rope.start) - 60)**2", {"rope.length": (10.15, 11.0)})
    assert found.values == pytest.approx(plain.values, rel=1e-6)
    assert len(asked) == found.gradients


@pytest.mark.parametrize("ask", [ancf.gradient, ancf.minimise])
@pytest.mark.parametrize(
    ("given", "phrase"),
    [
        ({"t_end": 1.0}, "step: is missing (give t_end and step, or none for the equilibrium)"),
        ({"step": 1e-3}, "t_end: is missing (give t_end and step, or none for the equilibrium)"),
        ({"integrator": ancf.Trapezoidal()}, "integrator: has no effect on an equilibrium"),
    ],
)
def test_half_a_simulation_is_refused(ask, given, phrase):
    with pytest.raises(ancf.ModelError) as caught:
        ask(
            hanging(),
            "tension(rope.start)",
            {"rope.length": (10.1, 11.0)} if ask is ancf.minimise else [],
            **given,
        )
    assert f"{ask.__name__}.{phrase}" in str(caught.value)
