"""Sensitivities through friction that remembers the way: against extrapolated differences of whole runs."""

import numpy as np
import pytest

import ancf
from ancf.sensitivity.parameters import parameters_of
from slopes import extrapolated, off

TIGHT = ancf.Newton(tolerance=1e-14, modified=False)
TRAPEZOIDAL = ancf.Trapezoidal(newton=TIGHT)
DAMPED = ancf.GeneralizedAlpha(rho_inf=0.8, newton=TIGHT)


def dragged(pull=6.0, aside=0.0, elements=2, friction=0.3, height=-0.0005, drum=False):
    """A cable on a ground, perhaps on a drum as well, dragged to and fro by its end."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=2e3, EI=0.5, rhoA=0.5, diameter=0.02)
    line = model.add_beam("line", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
    model.add_ground("on", height=height, stiffness=5e5, damping=2e3, friction=friction, stick=2e4)
    if drum:
        surface = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0, 1, 0), at=(0.5, 0, -0.2102)))
        model.add_contact(line, surface, stiffness=2e4, damping=30.0, friction=0.2, name="over")
    model.add_force(line.end, lambda t: (pull * np.sin(30 * t), aside * np.sin(17 * t), 0.0))
    return model


def thrown():
    """The same, which slips on the ground from the start on."""
    model = dragged(height=1e-4)
    model.bodies["line"].set_motion(velocity=(0.4, 0.1, 0.0))
    return model


def fallen(friction=0.3, turns=False, radius=0.2):
    """A cable with one end held that falls on a drum, which may turn with its block."""
    model = ancf.Model(gravity=(0.2, 0.3, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, diameter=0.02)
    line = model.add_beam("line", start=(0, 0, 0), end=(1, 0.02, 0), elements=3, section=section)
    place, on = (0.5, 0, -0.0102 - radius), {}
    if turns:
        block = model.add_rigid_body("block", at=place, mass=0.3, inertia=(2e-3, 3e-3, 2e-3))
        model.hinge(block.at(0, 0, 0), place, axis=(0, 1, 0), name="hinge")
        place, on = (0.0, 0.0, 0.0), {"on": block}
    drum = model.add_surface("drum", ancf.Cylinder(radius=radius, axis=(0, 1, 0), at=place), **on)
    model.add_contact(line, drum, stiffness=2e4, damping=30.0, friction=friction, name="on")
    model.pin(line.start)
    return model


def laid(friction=0.4, elements=6, bent=True, length=15.2):
    """A mooring whose upper end moves: lowered onto the ground, or from a path on which it nearly lies.

    A long one would be pressed by friction from where it is drawn: that acts from where it comes down.
    """
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e5, EI=1.0, rhoA=5.0, diameter=0.05)
    model.add_ground("on", height=-5.0, stiffness=2e5, damping=1e4, friction=friction, stick=5e4)
    shape = {"path": [(0, 0, -5), (8, 0, -5), (14, 0.5, 0)]}
    shape = shape if bent else {"start": (0, 0, -4.995), "end": (14, 0.5, 0), "length": length}
    line = model.add_beam("line", elements=elements, section=section, **shape)
    model.pin(line.start, name="left")
    model.pin(line.end, displacement=lambda t: (0.05 * np.sin(6 * t) ** 2, 0.0, 0.0))
    return model


def hung(friction=0.3, elements=8):
    """A rope over a drum with a force at its end."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=5e3, EI=0.05, rhoA=0.2, diameter=0.02)
    line = model.add_beam("line", start=(-0.8, 0, 0), end=(0.6, 0.02, 0), elements=elements, section=section)
    drum = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0, 1, 0), at=(0, 0, -0.2102)))
    model.add_contact(line, drum, stiffness=1e5, damping=30.0, friction=friction, name="on")
    model.pin(line.start, name="left")
    model.add_force(line.end, lambda t: (0.0, 0.0, -3.0 - np.sin(9 * t)))
    return model


def shape_of(model, names=()):
    """Places and forces of the equilibrium."""
    state = ancf.equilibrium(model, sensitivities=names)
    line = model.bodies["line"]
    points = [line.at(part * line.length) for part in (0.1, 0.5, 0.8)]

    def answers(one):
        forces = [*one.reaction("left"), one.tension(points[2])]
        return np.concatenate([*map(one.position, points), 1e-3 * np.array(forces)])

    return answers(state), [answers(state.sensitivity(name)) for name in names]


@pytest.mark.parametrize(
    ("model", "names"),
    [
        (laid(), ["line.EA", "line.rhoA", "on.friction", "on.stiffness"]),
        (laid(bent=False, elements=8), ["line.EA", "line.rhoA", "gravity[2]"]),
        (laid(friction=0.02), ["on.friction", "line.rhoA"]),
        (laid(friction=0.8, bent=False, length=17.0, elements=8), ["line.EA", "line.rhoA"]),
        (hung(), ["line.EA", "line.rhoA", "on.friction", "on.stiffness"]),
        (hung(0.05, elements=6), ["gravity[2]", "on.friction"]),
    ],
    ids=["path", "lowered", "little", "long", "drum", "slippery"],
)
def test_equilibria(model, names):
    """Against extrapolated differences of equilibria, each found anew."""
    for name, mine in zip(names, shape_of(model, names)[1], strict=True):
        theirs = extrapolated(lambda own: shape_of(own)[0], model, name, step=4e-4, levels=2)
        assert off(mine, theirs) < 1e-7, name


@pytest.mark.parametrize(
    ("model", "names", "bar"),
    [
        (laid(bent=False), ["line.EA", "on.stiffness"], 1e-7),
        (laid(), ["on.friction", "line.rhoA"], 1e-7),
        (laid(bent=False, elements=8), ["gravity[2]"], 1e-7),
        (laid(friction=0.8, bent=False, length=17.0, elements=8), ["line.rhoA"], 1e-7),
        (hung(), ["on.friction", "line.EA", "on.stiffness"], 1e-6),
        (hung(0.05, elements=6), ["line.rhoA"], 1e-7),
    ],
    ids=["lowered", "path", "finer", "long", "drum", "slippery"],
)
def test_runs_from_equilibria(model, names, bar):
    """There points are just at their limits; a second run goes on from the first."""
    given = {"step": 2e-3, "integrator": DAMPED}

    def runs(own, names=()):
        start = ancf.equilibrium(own, sensitivities=names)
        first = ancf.simulate(own, start=start, t_end=0.03, sensitivities=names, **given)
        return ancf.simulate(own, start=first.state(), t_end=0.05, sensitivities=names, **given)

    result = runs(model, names)
    for name in names:
        theirs = extrapolated(lambda own: runs(own).q[:], model, name, step=1e-4, levels=2)
        assert off(result.sensitivity(name).dq, theirs) < bar, name


def path(model, **given):
    result = ancf.simulate(model, **given)
    return result, np.asarray(result.position(model.bodies["line"].end))


def apart(model, names, method, step, steps=30, change=1e-4):
    """Largest difference to those of runs by parameter, in the largest derivative."""
    given = {"t_end": steps * step, "step": step, "integrator": method}
    result, _ = path(model, sensitivities=names, **given)
    found = {}
    for name in names:
        mine = np.asarray(result.sensitivity(name).position(model.bodies["line"].end))
        found[name] = off(
            mine, extrapolated(lambda own: path(own, **given)[1], model, name, step=change, levels=2)
        )
    return found


@pytest.mark.parametrize(
    ("model", "method", "step", "names", "change"),
    [
        (dragged(pull=0.3), TRAPEZOIDAL, 1e-3, ["line.rhoA", "line.length"], 1e-4),
        (dragged(), DAMPED, 1e-3, ["line.EA", "line.rhoA", "on.stick"], 1e-4),
        (dragged(), DAMPED, 1e-3, ["line.length"], 1e-6),
        (dragged(elements=3), TRAPEZOIDAL, 5e-4, ["line.EA"], 1e-4),
        (dragged(aside=4.0), DAMPED, 1e-3, ["on.friction", "on.damping", "line.rhoA"], 1e-4),
        (thrown(), DAMPED, 1e-3, ["on.friction", "on.stiffness"], 1e-4),
    ],
    ids=["sticks", "slips", "length", "fine", "aside", "touches"],
)
def test_grounds(model, method, step, names, change):
    found = apart(model, names, method, step, change=change)
    assert max(found.values()) < 1e-7, found


@pytest.mark.parametrize(
    ("model", "method", "step", "names", "change", "bar"),
    [
        (fallen(), TRAPEZOIDAL, 1e-3, ["on.stiffness", "line.length"], 1e-4, 1e-7),
        (fallen(0.02), DAMPED, 2e-3, ["on.friction", "line.EA"], 1e-4, 2e-7),
        (fallen(0.1, turns=True), DAMPED, 1e-3, ["on.friction", "gravity[0]"], 1e-3, 5e-6),
    ],
    ids=["sticks", "slips", "turns"],
)
def test_drums(model, method, step, names, change, bar):
    """Round-off of the runs, which grows as changes get smaller, leaves differences by these fewer digits."""
    found = apart(model, names, method, step, change=change)
    assert max(found.values()) < bar, found


HILLS = {
    "x": [-1.0, 0.2, 0.7, 2.0],
    "y": [-1.0, 1.0],
    "z": [[-0.01, 0.0], [0.001, -0.002], [-0.002, 0.0], [0.0, 0.0]],
}


@pytest.mark.parametrize(
    ("given", "method", "step"),
    [
        ({"elements": 2, "friction": 0.05}, DAMPED, 1e-3),
        ({"elements": 5, "friction": 0.3}, TRAPEZOIDAL, 5e-4),
        ({"elements": 3, "friction": 2.0}, DAMPED, 5e-4),
        ({"elements": 3, "friction": 0.3, "height": HILLS}, DAMPED, 5e-4),
        ({"elements": 3, "friction": 0.3, "drum": True}, DAMPED, 5e-4),
    ],
    ids=["slips", "some", "sticks", "hills", "drum"],
)
def test_many_at_once(given, method, step):
    """Eleven parameters, over blocks of steps that do not fit eight; the same one by one."""
    names = ["line.EA", "line.EI", "line.rhoA", "line.length", "line.diameter", "gravity[0]", "gravity[2]"]
    names += ["on.friction", "on.stiffness", "on.damping", "on.stick"]
    model, run = dragged(aside=4.0, **given), {"t_end": 37 * step, "step": step, "integrator": method}
    together = ancf.simulate(model, sensitivities=names, **run)
    for name in names:
        alone = ancf.simulate(model, sensitivities=[name], **run).sensitivity(name)
        change = np.abs(together.sensitivity(name).dq - alone.dq)
        assert np.max(change) <= 1e-10 * np.max(np.abs(alone.dq)), name
    hilly = "height" in given  # whose edges changes are not to reach: differences have more round-off
    others = ["line.EA", "gravity[2]", "on.damping"]
    found = apart(model, others, method, step, steps=37, change=1e-5 if hilly else 1e-4)
    found |= apart(model, ["line.length"], method, step, steps=37, change=1e-6)
    assert max(found.values()) < (1e-6 if hilly else 1e-7), found


def test_starts_stay_as_they_are():
    """A second run from the same state has the same derivatives."""
    model, given = laid(bent=False), {"t_end": 0.02, "step": 2e-3}
    start = ancf.equilibrium(model, sensitivities=["line.EA"])
    first, second = (ancf.simulate(model, start=start, sensitivities=["line.EA"], **given) for _ in range(2))
    assert np.array_equal(first.sensitivity("line.EA").dq, second.sensitivity("line.EA").dq)


def test_remainder():
    """Of Taylor's formula: of order two where events stay."""
    model, given = dragged(aside=4.0), {"t_end": 0.03, "step": 1e-3, "integrator": DAMPED}
    result, here = path(model, sensitivities=["on.friction"], **given)
    slope = np.asarray(result.sensitivity("on.friction").position(model.bodies["line"].end))
    (parameter,) = parameters_of(model, ["on.friction"], "test")
    changes = 1e-3 * 0.5 ** np.arange(3)
    left = [np.max(np.abs(path(parameter.at(0.3 + h), **given)[1] - here - h * slope)) for h in changes]
    orders = np.log2(np.array(left[:-1]) / left[1:])
    assert np.all(np.abs(orders - 2.0) < 0.05), orders


def on_turning_ground(y):
    """The dragged cable, whose ground leans."""
    model = dragged()
    ground = model.grounds[0]
    tilted = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = model.bodies["line"].section
    line = tilted.add_beam("line", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    given = {"stiffness": ground.stiffness, "damping": ground.damping, "friction": 0.3, "stick": 2e4}
    tilted.add_ground("on", height=-0.0005, normal=(0.0, y, 1.0), **given)
    tilted.pin(line.start, displacement=(0.0, 0.0, f"{0.01 + y}*sin(9*t)**2"))
    return tilted


def test_gradients_that_go_forwards():
    """Where a parameter changes how a support moves, as it changes a ground."""
    given, end = {"t_end": 0.02, "step": 1e-3}, "last(position(line.end)[2])"
    lean = {"lean": (0.01, on_turning_ground)}
    _, slope = ancf.gradient(on_turning_ground(0.01), end, lean, **given)
    result = ancf.simulate(on_turning_ground(0.01), sensitivities=lean, **given)
    mine = result.sensitivity("lean").position(result.model.bodies["line"].end)[-1, 2]
    assert slope["lean"] == pytest.approx(mine, rel=1e-12)


def test_what_is_refused():
    with pytest.raises(ancf.ModelError, match="remembers the way"):
        ancf.simulate(rolling(), t_end=0.004, step=1e-3, sensitivities=["gravity[2]"])
    model, given = dragged(), {"t_end": 0.004, "step": 1e-3}
    result = ancf.simulate(model, sensitivities=["line.EA"], **given)
    with pytest.raises(ancf.ModelError, match="derivatives of what friction remembers") as error:
        ancf.simulate(model, start=result.state(1), sensitivities=["line.EA"], **given)
    assert "start from an equilibrium" in str(error.value)


def rolling():
    """A ball on a floor, with friction that sticks."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    ball = model.add_rigid_body("ball", at=(0, 0, 0.1), mass=1.0, inertia=(4e-3, 4e-3, 4e-3))
    skin = model.add_surface("skin", ancf.Sphere(radius=0.1), on=ball)
    floor = model.add_surface("floor", ancf.Plane(at=(0, 0, 0), normal=(0, 0, 1)))
    model.add_contact(skin, floor, stiffness=1e5, damping=300.0, friction=0.3)
    return model
