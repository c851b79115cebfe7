"""Sensitivities over what happens to sliding joints, and from motions that joints change at the start."""

import numpy as np
import pytest
from jointed import NEWTON

import ancf
from ancf.model.vary import value_of, varied
from ancf.solvers.stepping import Run
from helpers import some
from motions import ball
from slopes import remainder_slopes

G = 9.81
DOWN = np.array([0.6, 0.0, -0.8])  # along an inclined wire
#: Of the shift that "ggl" makes in each step a part is left out, see docs/theory/sensitivities.md.
EXACT = {
    "trapezoidal index2": ancf.Trapezoidal(newton=NEWTON, formulation="index2"),
    "generalized index3": ancf.GeneralizedAlpha(0.8, newton=NEWTON, formulation="index3"),
}
ALL = EXACT | {
    "trapezoidal ggl": ancf.Trapezoidal(newton=NEWTON),
    "generalized ggl": ancf.GeneralizedAlpha(0.8, newton=NEWTON, formulation="ggl"),
}


def on_rod(how):
    """A bead slides down a rod that is held, on a spring, to the end of its line."""
    model = ancf.Model(gravity=(0, 0, -G))
    rod = model.add_rigid_body("rod", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
    model.clamp(rod)
    bead = model.add_point_mass("bead", at=DOWN, mass=1.0)
    model.add_spring(bead, (0.5, 0.3, 0.2), stiffness=3.0, length=0.2, name="coil")
    model.slide(bead, along=rod, line=((0, 0, 0), 1.5 * DOWN), at_end=how, name="ring")
    return model, ["bead.mass", "gravity", "coil.stiffness", "coil.length"], 0.45


def on_cable(how):
    """A bead runs to the end of a cable, whose initial motion does not follow the bead."""
    model = ancf.Model(gravity=(0, 0, -G))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(1, 0, -0.3), elements=3, section=section)
    model.pin(wire.start, displacement=(0, 0, "0.01*sin(9*t)"))
    tip = model.add_point_mass("tip", at=(1, 0, -0.3), mass=0.5)
    model.connect(tip, wire.end)
    model.add_spring(tip, (1, 0, 0.7), stiffness=60.0, damping=0.4, length=0.9, name="coil")
    bead = model.add_point_mass("bead", at=wire.initial_position(0.9), mass=0.3)
    bead.set_motion(velocity=(3.0, 0, -0.9))
    model.slide(bead, along=wire, at_end=how, name="ring", mass=0.05)
    return (
        model,
        [
            "wire.EA",
            "wire.EI",
            "wire.rhoA",
            "bead.mass",
            "ring.mass",
            "gravity",
            "coil.length",
            "wire.length",
        ],
        0.09,
    )


def two_on_a_cable(how):
    """Another bead runs to the start of it before."""
    model, names, t_end = on_cable(how)
    wire = model.bodies["wire"]
    other = model.add_point_mass("other", at=wire.initial_position(0.12), mass=0.1)
    other.set_motion(velocity=(-2.0, 0, 0.6))
    model.slide(other, along=wire, at_end="clamp", name="loop")
    return model, [*names, "other.mass"], t_end


def leaping():
    """A pan that a wire lets fall and catches again, both in the plane."""
    model, pan, _ = ball(force=(0, 0, f"{2 * G} + 30*sin(20*t)"))
    pan.set_motion(velocity=(1.0, 0, 0))
    return model, ["pan.mass", "gravity"], 0.45


def leaping_on_a_cable():
    """The same on a cable whose end is moved: it opens and closes some times."""
    model = ancf.Model(gravity=(0, 0, -G))
    section = ancf.Section(EA=5000.0, EI=5.0, rhoA=1.0)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=section)
    model.pin(wire.start)
    model.pin(wire.end, displacement=("0.01*sin(9*t)", 0, 0))
    pan = model.add_point_mass("pan", at=(0.5, 0, 0), mass=1.0)
    pan.set_motion(velocity=(1.0, 0, 0))
    model.add_force(pan, (0, 0, "14 + 25*sin(30*t)"))
    model.slide(pan, along=wire, unilateral=(0, 0, 1), name="contact")
    return model, ["wire.EA", "wire.EI", "wire.rhoA", "pan.mass", "gravity"], 0.4


def cases():
    """Models, numbers of them and the end of the run, with the methods that are exact there."""
    found = {f"rod {how}": (on_rod, (how,), ALL) for how in ("clamp", "release")}
    found |= {f"cable {how}": (on_cable, (how,), EXACT) for how in ("clamp", "release")}
    found |= {f"two, {how}": (two_on_a_cable, (how,), EXACT) for how in ("clamp", "release")}
    found |= {"leaping": (leaping, (), ALL), "leaping on a cable": (leaping_on_a_cable, (), EXACT)}
    return [
        pytest.param(make, given, method, id=f"{name}, {key}")
        for name, (make, given, methods) in found.items()
        for key, method in methods.items()
    ]


def run(model, t_end, method, **more):
    return ancf.simulate(model, t_end=t_end, step=1e-3, integrator=method, **more)


def mass_of(names):
    """Name of the mass that slides."""
    return next(name.split(".")[0] for name in names if name in ("bead.mass", "pan.mass"))


def jumps_of(monkeypatch):
    """Numbers of the steps after which a run jumps, as they come."""
    numbers, happened = [], Run.happened

    def counted(self, code, t, number):
        numbers.append(number)
        happened(self, code, t, number)

    monkeypatch.setattr(Run, "happened", counted)
    return numbers


def states(model, kept, t_end, method):
    """All of a run that has derivatives."""
    found = run(model, t_end, method)
    return np.concatenate([found.q[:, kept], found.v], axis=1)


def followed(make, given, method, monkeypatch):
    """A model, its end, the unknowns that are no multipliers, and derivatives over at least one jump."""
    numbers = jumps_of(monkeypatch)
    model, names, t_end = make(*given)
    result = run(model, t_end, method, sensitivities=names)
    assert numbers
    assert max(numbers) < 1e3 * t_end - 5
    kept = np.setdiff1d(np.arange(result.system.size), result.system.multipliers)
    slopes = {}
    for name in names:
        own = result.sensitivity(name)
        slopes[name] = np.concatenate([own.dq[:, kept], own.dv], axis=1)
        assert np.max(np.abs(slopes[name][max(numbers) + 1 :])) > 0.0, name
    return model, t_end, kept, slopes


@pytest.mark.parametrize(("make", "given", "method"), some([*cases()]))
def test_differences(make, given, method, monkeypatch):
    """Of all states, extrapolated from changes with which each jump stays after its step."""
    model, t_end, kept, slopes = followed(make, given, method, monkeypatch)
    for name, slope in slopes.items():
        p = value_of(model, name)
        each = []
        for h in (2e-5 * p, 1e-5 * p):
            above, below = (states(varied(model, name, p + x), kept, t_end, method) for x in (h, -h))
            each.append((above - below) / (2 * h))
        wanted = (4 * each[1] - each[0]) / 3
        # velocities of "index3" have round-off of 1e-11, which is divided by a change of 1e-5
        assert np.max(np.abs(slope - wanted)) < 5e-6 * np.max(np.abs(wanted)), name


@pytest.mark.parametrize(("make", "given", "method"), some([*cases()]))
def test_remainders(make, given, method, monkeypatch):
    """|f(p + h) - f(p) - h f'| of all states falls with the square of h, as far as it is no round-off."""
    model, t_end, kept, slopes = followed(make, given, method, monkeypatch)
    for name, slope in slopes.items():
        own = (lambda varied: states(varied, kept, t_end, method), model, name, slope)
        orders = remainder_slopes(*own, step=2e-5, noise=3e-11)
        assert orders == pytest.approx(2.0, abs=0.05), name


@pytest.mark.parametrize("how", ["clamp", "release"])
def test_a_function_of_the_number(how):
    """Models that are built anew know what has happened to other joints before."""
    model, _, t_end = two_on_a_cable(how)

    def build(value):
        return varied(model, "wire.EA", value)

    method = EXACT["generalized index3"]
    named = run(model, t_end, method, sensitivities=["wire.EA"]).sensitivity("wire.EA")
    built = run(model, t_end, method, sensitivities={"built": (500.0, build)}).sensitivity("built")
    for wanted, found in ((named.dq, built.dq), (named.dv, built.dv)):
        assert found == pytest.approx(wanted, abs=1e-7 * np.max(np.abs(wanted)))


@pytest.mark.parametrize("how", ["clamp", "release"])
def test_a_motion_of_a_support(how):
    """It moves what is held before the jump and after it."""
    _, _, t_end = on_cable(how)

    def build(value):
        model, _, _ = on_cable(how)
        wire = model.bodies["wire"]
        model.hold(wire.at(wire.length / 3), position="y", displacement=(0, f"{value}*sin(20*t)", 0))
        return model

    method = EXACT["generalized index3"]
    own = run(build(0.02), t_end, method, sensitivities={"swing": (0.02, build)}).sensitivity("swing")
    above, below = (run(build(0.02 + x), t_end, method) for x in (1e-6, -1e-6))
    places = [x.position("wire.at(0.3)") for x in (own, above, below)]
    for found, one, other in ((own.dv, above.v, below.v), places):
        wanted = (one - other) / 2e-6
        assert np.max(np.abs(found - wanted)) < 1e-5 * np.max(np.abs(wanted))


@pytest.mark.parametrize("every", [2, 7])
@pytest.mark.parametrize("make", [lambda: on_cable("clamp"), leaping_on_a_cable])
def test_stored_states_and_sensors(make, every):
    """What is stored of each step, of some, and by sensors is the same; a damper feels the velocities."""
    model, names, t_end = make()
    method, coil = EXACT["generalized index3"], "coil.length" in names
    points = model.bodies[mass_of(names)], model.bodies["wire"].at(0.31)
    whole = run(model, t_end, method, sensitivities=names)
    sensed = {"sensors": [*points, *(["coil"] if coil else [])], "output_step": every * 1e-3}
    some = run(model, t_end, method, sensitivities=names, **sensed)
    at = np.searchsorted(whole.t, some.t - 1e-9)
    asked = [("position", point) for point in points] + [("velocity", point) for point in points]
    asked += [("spring_force", "coil")] if coil else []
    for name in names:
        one, other = whole.sensitivity(name), some.sensitivity(name)
        assert other.dq == pytest.approx(one.dq[at], rel=1e-12, abs=1e-12 * np.max(np.abs(one.dq)))
        assert other.dv == pytest.approx(one.dv[at], rel=1e-12, abs=1e-12 * np.max(np.abs(one.dv)))
        for question, item in asked:
            wanted = getattr(one, question)(item)
            found = getattr(some.sensors.sensitivity(name), question)(item)
            assert found == pytest.approx(wanted, abs=1e-7 * np.max(np.abs(wanted)))


@pytest.mark.parametrize("method", EXACT)
@pytest.mark.parametrize("make", [lambda: on_rod("clamp"), lambda: on_cable("release"), leaping_on_a_cable])
def test_gradients(make, method):
    """They go forwards then, with the same numbers as differences."""
    model, names, t_end = make()
    body = mass_of(names)
    text = f"integral(norm(velocity({body}))**2)"
    settings = {"t_end": t_end, "step": 1e-3, "integrator": EXACT[method]}
    _, slope = ancf.gradient(model, text, names, **settings)
    for name in ("gravity", f"{body}.mass"):
        p = value_of(model, name)
        sides = [ancf.gradient(varied(model, name, p + h), text, [], **settings)[0] for h in (3e-5, -3e-5)]
        assert slope[name] == pytest.approx((sides[0] - sides[1]) / 6e-5, rel=1e-6)


def floored(model):
    """The same with a rope on a ground, whose friction remembers the way."""
    section = ancf.Section(EA=1e4, EI=1.0, rhoA=0.3, diameter=0.02)
    model.add_beam("rope", start=(3, 0, 0.01), end=(4, 0, 0.01), elements=2, section=section)
    model.add_ground("floor", height=0.0, stiffness=1e4, friction=0.3, on=["rope"])
    return model


class TestRefusals:
    def test_friction_that_remembers(self):
        model, names, t_end = on_rod("release")
        with pytest.raises(ancf.SolveError, match="friction with memory is not followed"):
            run(floored(model), t_end, ancf.Trapezoidal(), sensitivities=names)

    @pytest.mark.parametrize("method", ALL)
    def test_friction_that_remembers_and_a_motion_that_joints_change(self, method):
        model, names, _ = on_cable("clamp")
        with pytest.raises(ancf.ModelError, match="joints change the initial motion"):
            run(floored(model), 0.01, ALL[method], sensitivities=names)

    @pytest.mark.parametrize("method", ALL)
    @pytest.mark.parametrize("speed", [-0.3, 0.3])
    def test_pulled_open_at_the_start(self, speed, method):
        """The motion has been shifted with the contact closed, which is open then."""
        model, pan, _ = ball(force=(0, 0, 2 * G - 8.0))
        pan.set_motion(velocity=(0.5, 0, speed))
        with pytest.raises(ancf.SolveError, match="where the run starts"):
            run(model, 0.05, ALL[method], sensitivities=["pan.mass"])
