"""Derivatives by numbers that are 0: forwards, backwards and as the difference to a small number."""

import pytest

import ancf
from ancf.model.vary import varied

RUN = {
    "t_end": 0.05,
    "step": 2e-3,
    "integrator": ancf.GeneralizedAlpha(0.8, newton=ancf.Newton(tolerance=1e-13)),
}
FINAL = "last(velocity(bob)[0])"


def swung(**given):
    """A mass on two springs, of which one has what is given."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    bob = model.add_point_mass("bob", at=(0.5, 0, 0), mass=0.2)
    bob.set_motion(velocity=(1.0, 0.2, 0))
    model.add_spring(bob, (0, 0, 0), **({"stiffness": 10.0} | given), name="stay")
    model.add_spring(bob, (0.5, 0, 1.0), stiffness=40.0, friction=0.1, name="other")
    return model


def pulled(element, **given):
    """A cable or beam with such a spring at its end, and a mass there."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    bar = ancf.Section.rectangle(width=0.02, height=0.03, E=1e7, rho=500.0, nu=0.3)
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.3) if element == "cable" else bar
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section, element=element
    )
    model.clamp(beam.start)
    bob = model.add_point_mass("bob", at=(1, 0, 0), mass=0.1)
    model.connect(bob, beam.end)
    model.add_spring(beam.end, (0.8, 0.5, 0.9), **({"stiffness": 20.0} | given), name="stay")
    model.add_force(bob, (0, "sin(50*t)", 1.0))
    return model


MODELS = {
    "springs": swung,
    "springs and a damper": lambda: swung(damping=0.3),
    "a damper": lambda: swung(damping=0.3, stiffness=0.0),
    "a law": lambda: swung(law=[[-0.1, -3.0], [0.0, 0.0], [0.1, 1.0]]),
    "a slack one": lambda: swung(slack=True, length=0.4),
    "cable": lambda: pulled("cable"),
    "nonlocking": lambda: pulled("nonlocking", damping=0.2),
}
NUMBERS = ["friction", "damping", "stiffness"]


@pytest.mark.parametrize("key", NUMBERS)
@pytest.mark.parametrize("build", MODELS)
def test_of_springs(build, key):
    """Backwards there was none by a friction that is 0."""
    model, name = MODELS[build](), f"stay.{key}"
    if build == "a slack one" and key == "friction":
        with pytest.raises(ancf.ModelError, match="a spring that is slack has no friction"):
            ancf.simulate(model, **RUN, sensitivities=[name])
        return
    value = next(getattr(one, key) for one in model.connections if one.name == "stay")
    own = ancf.simulate(model, **RUN, sensitivities=[name]).sensitivity(name).velocity("bob")[-1, 0]
    _, back = ancf.gradient(model, FINAL, [name], **RUN)
    assert back[name] == pytest.approx(own, rel=1e-7, abs=1e-12)
    h = 1e-4 * max(value, 0.1)
    near = [ancf.simulate(varied(model, name, value + k * h), **RUN).velocity("bob")[-1, 0] for k in range(3)]
    wanted = (4.0 * near[1] - 3.0 * near[0] - near[2]) / (2.0 * h)
    assert own == pytest.approx(wanted, rel=1e-4, abs=1e-7)
    assert own != 0.0


def lying():
    model = ancf.Model(gravity=(0, 0, -9.81))
    rope = ancf.Section(EA=1e4, EI=0.05, rhoA=0.2, diameter=0.02)
    line = model.add_beam("line", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=rope)
    line.set_motion(velocity=(1.0, 0, 0))
    return model, line


def on_ground(friction):
    model, _ = lying()
    model.add_ground("touch", height=0.0, stiffness=1e5, damping=1e3, friction=friction)
    return model


def on_plane(friction):
    model, line = lying()
    plane = model.add_surface("plane", ancf.Plane(at=(0, 0, -0.01), normal=(0, 0, 1)))
    model.add_contact(line, plane, stiffness=1e5, damping=1e3, friction=friction, name="touch")
    return model


@pytest.mark.parametrize("build", [on_ground, on_plane])
@pytest.mark.parametrize("asked", ["run", "equilibrium", "gradient"])
def test_friction_that_begins_is_refused(build, asked):
    """That of a ground was none: friction remembers the way, and what is not there remembers nothing."""
    model, name = build(0.0), "touch.friction"
    model.bodies["line"].set_motion(velocity=(0, 0, 0))
    model.pin("line.start")
    ask = {
        "run": lambda: ancf.simulate(model, **RUN, sensitivities=[name]),
        "equilibrium": lambda: ancf.equilibrium(model, sensitivities=[name]),
        "gradient": lambda: ancf.gradient(model, "last(tension(line.start))", [name], **RUN),
    }
    with pytest.raises(ancf.ModelError, match=r"touch\.friction: .*small number in place of 0"):
        ask[asked]()


@pytest.mark.parametrize("friction", [1e-3, 0.2])
def test_friction_that_is_there(friction):
    model, name = on_ground(friction), "touch.friction"
    own = ancf.simulate(model, **RUN, sensitivities=[name]).sensitivity(name).velocity("line.at(0.5)")[-1, 0]
    near = [
        ancf.simulate(varied(model, name, friction * (1 + e)), **RUN).velocity("line.at(0.5)")[-1, 0]
        for e in (1e-3, -1e-3)
    ]
    assert own == pytest.approx((near[0] - near[1]) / (2e-3 * friction), rel=1e-3)
    assert own < -0.1
