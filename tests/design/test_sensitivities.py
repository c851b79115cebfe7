"""Sensitivities against extrapolated central differences of whole computations, and Taylor remainders."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import ancf
from ancf.model.vary import names_of, varied
from ancf.paper import cantilever, pendulum, sliding, spin_up
from ancf.sensitivity.parameters import parameters_of
from helpers import EXACT, METHODS, cable
from slopes import extrapolated, off, once, remainder_slopes

BAR = 1e-7  # relative, of the largest derivative in the history
TIGHT = ancf.Newton(tolerance=1e-14, modified=False)


def rope_and_drum():
    """A hanging rope over a drum, a slack and a tight stay, a bead that slides on it."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.05, rhoA=0.1, diameter=0.02)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(4, 0, 0.5), elements=6, length=4.2, section=section)
    model.pin(rope.start)
    model.pin(rope.end)
    model.add_spring(rope.at(1.4), (1.4, 0.2, 1.0), stiffness=40.0, name="stay")
    model.add_spring(rope.at(2.8), (2.8, 0, 1.0), stiffness=40.0, length=9.0, slack=True, name="loose")
    model.add_force(rope.at(2.0), (0.0, 0.6, -0.4), name="pull")
    return model


def solid():
    """A clamped beam with a section under a force and a torque."""
    model, beam = cable("straight", element="nonlocking", elements=2)
    model.clamp(beam.start, stretch="fixed")
    model.gravity = np.array([0.0, 0.0, -0.5])
    model.add_force(beam.end, (0.0, 0.02, 0.05), name="pull")
    model.add_moment(beam.end, (0.01, 0.02, 0.0), name="turn")
    return model


def sliding_bead(length=4.2):
    """A bead on a rope."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.05, rhoA=0.1)
    ends = {"start": (0, 0, 0), "end": (4, 0, 0.5)}
    wire = model.add_beam("wire", **ends, elements=8, length=length, section=section)
    model.pin(wire.start)
    model.pin(wire.end)
    model.slide(model.add_point_mass("bead", at=(2, 0, 0.25), mass=0.5), along=wire, name="on wire")
    return model


STATIC = {
    "rope": (rope_and_drum, ["rope.EA", "rope.EI", "rope.rhoA", "rope.length", "gravity", "pull.force[1]"]),
    "stay": (rope_and_drum, ["stay.stiffness", "stay.length", "stay.b[2]", "gravity[2]", "pull.force"]),
    "solid": (solid, ["beam.E", "beam.nu", "beam.width", "pull.force[2]", "turn.moment[0]", "gravity[2]"]),
    "bead": (sliding_bead, ["bead.mass", "wire.EA", "wire.length", "gravity"]),
}
#: What is asked of them.
ASKED = {
    "rope": {"position": "rope.at(2.4)", "tension": "rope.at(0.3)"},
    "stay": {"position": "rope.at(2.4)", "spring_force": "stay"},
    "solid": {"position": "beam.end", "twist": "beam.end", "slope": "beam.end"},
    "bead": {"position": "bead", "arc_length": "on wire", "multiplier": "on wire"},
}


@pytest.mark.parametrize("case", STATIC)
def test_equilibria(case):
    build, names = STATIC[case]
    model = build()
    state, resting = ancf.equilibrium(model, sensitivities=names), once(ancf.equilibrium)
    for name in names:
        own = state.sensitivity(name)
        for quantity, item in ASKED[case].items():

            def answer(other, quantity=quantity, item=item):
                return getattr(resting(other), quantity)(item)

            step = 1e-3 if name.endswith(".length") else 1e-2
            wanted = extrapolated(answer, model, name, step)
            # what a parameter does not do is round-off on both sides
            if np.max(np.abs(wanted)) > 1e-6 * np.max(np.abs(answer(model))):
                assert off(getattr(own, quantity)(item), wanted) < BAR, (name, quantity)


def exact(formulation="ggl"):
    return ancf.Trapezoidal(newton=TIGHT, formulation=formulation)


def motion(model, t_end, step, method, **more):
    return ancf.simulate(model, t_end=t_end, step=step, integrator=method, **more)


#: Examples of the paper: model, point, end, step, parameters with the steps of their differences.
EXAMPLES = {
    "7.1": (
        lambda: cantilever.build(2),
        "beam.end",
        0.1,
        5e-4,
        {"beam.rhoA": 1e-2, "gravity": 5e-2, "beam.EI": 2e-2},
    ),
    "7.2": (
        lambda: pendulum.build(2),
        "rope.end",
        0.05,
        5e-4,
        {"rope.angular_velocity": 1e-2, "gravity": 5e-2},
    ),
    "7.3": (lambda: spin_up.build(2), "arm.end", 1.0, 0.02, {"arm.EI": 2e-2, "arm.rhoA": 1e-2}),
}


@pytest.mark.parametrize("example", EXAMPLES)
def test_examples_of_the_paper(example):
    build, point, t_end, step, parameters = EXAMPLES[example]
    model = build()
    result = motion(model, t_end, step, exact(), sensitivities=list(parameters))
    for name, width in parameters.items():
        wanted = extrapolated(lambda m: motion(m, t_end, step, exact()).position(point), model, name, width)
        assert off(result.sensitivity(name).position(point), wanted) < BAR, name


def test_sliding_beam():
    """7.4, from the equilibrium of its carrier, which depends on the parameter too."""
    model = sliding.build(4, 1)

    def moved(other, **more):
        start = ancf.equilibrium(other, of=["carrier"], **more)
        return motion(other, 0.3, 5e-3, exact("index2"), start=start, **more)

    result = moved(model, sensitivities=["tip.mass", "gravity"])
    for name in ("tip.mass", "gravity"):
        own = result.sensitivity(name)
        for answer in (lambda r: r.position("tip"), lambda r: r.arc_length("joint")):
            wanted = extrapolated(lambda m, answer=answer: answer(moved(m)), model, name, 2e-2)
            assert off(answer(own), wanted) < BAR, name


def swinging_hub():
    """A rigid body on a hinge with a damped dropper, and a damped rope on a clamp that turns."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    hub = model.add_rigid_body("hub", at=(2.3, 0, 0.2), mass=0.8, inertia=(0.02, 0.03, 0.03))
    model.hinge(hub.at(-0.3, 0, 0), (2.0, 0, 0.2), axis=(0, 1, 0), name="hinge")
    end = hub.at(0.3, 0, 0)
    model.add_spring(end, (2.6, 0, 1.2), stiffness=50.0, damping=0.3, length=0.95, slack=True, name="dropper")
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, damping=0.1, axial_damping=0.5, bending_damping=0.01)
    arm = model.add_beam("arm", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.clamp(arm.start, rotation="0.3*sin(5*t)", axis=(0, 1, 0))
    model.add_moment(arm.end, (0.0, "0.05*t", 0.0), name="twist")
    return model


@pytest.mark.parametrize("method", METHODS)
def test_joints_dampers_and_moving_supports(method):
    model, names = (
        swinging_hub(),
        ["hub.mass", "dropper.length", "dropper.damping", "arm.EI", "arm.axial_damping"],
    )
    names += ["twist.moment", "gravity", "arm.bending_damping"]
    integrator = METHODS[method]
    result = motion(model, 0.03, 1e-3, integrator, sensitivities=names)
    for name in names:
        point = "hub.at(0.3, 0, 0)" if name.startswith(("hub", "dropper", "gravity")) else "arm.end"
        wanted = extrapolated(
            lambda m, p=point: motion(m, 0.03, 1e-3, integrator).position(p), model, name, 2e-2
        )
        assert off(result.sensitivity(name).position(point), wanted) < BAR, name


def test_clamp_that_turns_without_dampers():
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2)
    arm = model.add_beam("arm", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.clamp(arm.start, rotation="0.3*sin(5*t)", axis=(0, 1, 0))
    result = motion(model, 0.03, 1e-3, exact(), sensitivities=["arm.EI", "gravity"])
    for name in ("arm.EI", "gravity"):
        wanted = extrapolated(lambda m: motion(m, 0.03, 1e-3, exact()).position("arm.end"), model, name, 2e-2)
        assert off(result.sensitivity(name).position("arm.end"), wanted) < BAR, name


KINDS = {
    "rope": (rope_and_drum, "rope.at(2.4)"),
    "hub": (swinging_hub, "hub.at(0.3, 0, 0)"),
    "solid": (solid, "beam.end"),
    "bead": (lambda: sliding_bead(4.0), "bead"),
}


@pytest.mark.filterwarnings("ignore:.*the support wins")
@pytest.mark.parametrize("case", KINDS)
def test_taylor_remainders_of_every_number(case):
    """|f(p + h) - f(p) - h f'| falls with the square of h over three decades, for all that a model has."""
    build, point = KINDS[case]
    model = build()
    for name in ("bead", "wire", "rope", "arm", "beam"):
        if name in model.bodies:
            model.bodies[name].set_motion(velocity=(0.0, 0.02, 0.1))
    others = (".s", ".friction_velocity", "hub.at", "hub.at[2]", "hinge.b", "hinge.b[2]", "[0]", "[1]")
    names = [name for name in names_of(model) if not name.endswith(others)]
    if case == "bead":  # it is off the wire then
        names = [name for name in names if not any(word in name for word in (".start", ".end", ".at"))]

    def place(other):
        return motion(other, 0.02, 2e-3, ancf.GeneralizedAlpha(rho_inf=0.8, newton=EXACT)).position(point)

    result = motion(model, 0.02, 2e-3, ancf.GeneralizedAlpha(rho_inf=0.8, newton=EXACT), sensitivities=names)
    checked = 0
    for name in names:
        step = 2e-4 if any(word in name for word in (".start", ".end", ".length", "damping")) else 2e-3
        found = remainder_slopes(place, model, name, result.sensitivity(name).position(point), step)
        assert np.all(np.abs(found - 2.0) < 0.05), (name, found)
        checked += len(found) > 0
    assert checked > 1


def test_modes():
    """Frequencies and shapes about an equilibrium; of a square beam the two frequencies that part."""
    model, names = rope_and_drum(), ["rope.EA", "rope.rhoA", "rope.length", "stay.stiffness", "pull.force[1]"]
    state = ancf.equilibrium(model, sensitivities=names)
    found = ancf.modes(model, about=state, count=4, sensitivities=names)
    point = "rope.at(1.1)"

    def frequencies(other):
        return ancf.modes(other, about=ancf.equilibrium(other), count=4).frequencies

    def shapes(other):
        made = ancf.modes(other, about=ancf.equilibrium(other), count=4).position(point)
        return made * np.sign(np.sum(made * found.position(point), axis=1, keepdims=True))

    for name in names:
        step = 1e-3 if name.endswith("length") else 1e-2
        own = found.sensitivity(name)
        assert off(own.frequencies, extrapolated(frequencies, model, name, step)) < BAR, name
        assert off(own.position(point), extrapolated(shapes, model, name, step)) < 1e-6, name


def test_equal_frequencies_part():
    """A square beam that becomes a rectangle: omega of bending goes with its height in each plane."""
    model = ancf.Model()
    section = ancf.Section.rectangle(0.1, 0.1, E=1e7, rho=500.0)
    beam = model.add_beam(
        "bar", start=(0, 0, 0), end=(2, 0, 0), elements=2, section=section, element="nonlocking"
    )
    model.clamp(beam.start)
    own = ancf.modes(model, count=2, sensitivities=["bar.height", "bar.E"]).sensitivity("bar.height")
    assert list(own.repeated) == [True, True]

    def pair(other):
        return ancf.modes(other, count=2).frequencies

    above, below = (pair(varied(model, "bar.height", 0.1 + e)) for e in (1e-6, -1e-6))
    wanted = (above - below[::-1]) / 2e-6  # they change places
    assert off(own.frequencies, wanted) < 1e-4
    with pytest.raises(ancf.ModelError, match="has the frequency of another one"):
        own.position("bar.end")


class TestBadInput:
    """Each says what is wrong, where, and what to do."""

    @pytest.mark.parametrize(
        ("names", "told"),
        [
            (["beam.EE"], 'has no number "EE"'),
            (["boom.EI"], 'the model has no "boom"'),
            (["gravity", "gravity"], "twice"),
            ("beam.EI", "list of names"),
            ({"EI": 3.0}, "pair"),
            ({"n": (2.0, lambda x: cantilever.build(round(x) + (x > 2)))}, "other unknowns"),
        ],
    )
    def test_names(self, names, told):
        with pytest.raises(ancf.ModelError, match=told):
            ancf.simulate(cantilever.build(2), t_end=0.01, step=1e-3, sensitivities=names)

    @pytest.mark.parametrize("method", [ancf.Radau(), ancf.Explicit()])
    def test_methods_without(self, method):
        with pytest.raises(ancf.ModelError, match="has none"):
            motion(cantilever.build(2), 0.01, 1e-5, method, sensitivities=["gravity"])

    def test_start_that_knows_nothing(self):
        model = rope_and_drum()
        state = ancf.equilibrium(model, sensitivities=["gravity"])
        with pytest.raises(ancf.ModelError, match="does not know how it depends on rope"):
            ancf.simulate(model, t_end=0.01, step=1e-3, start=state, sensitivities=["rope.EA"])
        fixed = state.fixed(["rope.EA"])
        result = ancf.simulate(model, t_end=0.01, step=1e-3, start=fixed, sensitivities=["rope.EA"])
        assert np.all(result.sensitivity("rope.EA").position("rope.at(2)")[0] == 0.0)

    def test_motion_that_does_not_fit_a_joint(self):
        model = sliding_bead(4.0)
        model.bodies["bead"].set_motion(velocity=(0.0, 0.0, 1.0))
        settings = {"t_end": 0.01, "step": 1e-3, "integrator": ancf.GeneralizedAlpha(0.8)}
        result = ancf.simulate(model, sensitivities=["bead.mass"], **settings)

        def speeds(model):
            return ancf.simulate(model, **settings).velocity("bead")

        wanted = extrapolated(speeds, model, "bead.mass", step=1e-2)
        found = result.sensitivity("bead.mass").velocity("bead")
        assert np.max(np.abs(wanted[0])) > 1e-3  # what it takes along depends on its mass from the start
        assert found == pytest.approx(wanted, abs=1e-7 * np.max(np.abs(wanted)))

    def test_what_was_not_asked_for(self):
        model = cantilever.build(2)
        result = ancf.simulate(model, t_end=0.01, step=1e-3, sensitivities=["gravity"])
        with pytest.raises(ancf.ModelError, match="there is none by 'gravitation'"):
            result.sensitivity("gravitation")
        with pytest.raises(ancf.ModelError, match="no sensitivities were asked for"):
            ancf.simulate(model, t_end=0.01, step=1e-3).sensitivity("gravity")


@pytest.mark.filterwarnings("ignore:.*the support wins")
def test_a_number_without_effect_has_the_sensitivity_zero():
    """The hinge takes the spin about its other axes away: what is left are numbers too small to divide by."""
    model = swinging_hub()
    model.bodies["arm"].set_motion(velocity=(0.0, 0.02, 0.1))
    result = motion(model, 0.02, 1e-3, exact(), sensitivities=["hub.angular_velocity[2]", "hub.velocity[2]"])
    found = result.sensitivity("hub.angular_velocity[2]").position("arm.end")
    assert np.max(np.abs(found)) < 1e-12
    assert np.all(np.isfinite(result.sensitivity("hub.velocity[2]").position("arm.end")))


def tension(face, power):
    """A power of the tension somewhere: what is linear in forces, and what is not."""
    return face.tension("rope.at(0.3)") ** power


@pytest.mark.parametrize("case", ["cable", "damped", "solid", "mass", "springs"])
def test_numbers_known_to_be_linear_are_found_to_be(case):
    """What is taken of one value is what differences of order six give, of the whole run and at any place."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    damping = {"axial_damping": 0.3, "bending_damping": 1e-3, "damping": 0.2} if case == "damped" else {}
    if case == "solid":
        section = ancf.Section.rectangle(0.02, 0.03, E=2e7, rho=900.0, nu=0.3)
        beam = model.add_beam(
            "rope", start=(0, 0, 0), end=(0.7, 0, 0.2), elements=2, section=section, element="nonlocking"
        )
    else:
        section = ancf.Section(EA=400.0, EI=0.3, rhoA=0.2, **damping)
        beam = model.add_beam("rope", start=(0, 0, 0), end=(0.7, 0, 0.2), elements=3, section=section)
    model.clamp(beam.start)
    weight = model.add_point_mass("weight", at=(0.7, 0, 0.2), mass=0.1)
    model.connect(weight, beam.end)
    names = {"solid": ["rope.E", "rope.rho"], "mass": ["weight.mass"]}.get(
        case, ["rope.EA", "rope.EI", "rope.rhoA"]
    )
    names += [
        f"rope.{name}"
        for name in ("damping", "axial_damping", "bending_damping")
        if case in ("cable", "damped")
    ]
    if case == "springs":
        model.add_spring(beam.at(0.4), (0.3, 0, 0.5), stiffness=5.0, damping=0.1, length=0.3, name="stay")
        model.add_spring(beam.at(0.2), (0.3, 0, 0.5), stiffness=5.0, length=0.9, slack=True, name="loose")
        names = ["stay.stiffness", "stay.damping", "stay.length", "loose.length"]
    known = parameters_of(model, names, "test")
    assert all(one.linear for one in known)
    unknown = [replace(one, name=f"{one.name} again", linear=False, kinked=False) for one in known]
    result = ancf.simulate(model, t_end=0.02, step=1e-3, sensitivities=[*known, *unknown])
    for name in names:
        one, two = result.sensitivity(name), result.sensitivity(f"{name} again")
        size = np.max(np.abs(two.dv)) + 1e-12
        loose = 1e2 if case == "springs" else 1.0  # without that knowledge steps are tiny: round-off
        assert np.allclose(one.dq, two.dq, rtol=0, atol=1e-9 * loose * size), name
        assert np.allclose(one.dv, two.dv, rtol=0, atol=1e-8 * loose * size), name
        for power in (1, 3):
            question = partial(tension, power=power)
            wanted = two.of(question)
            most = np.max(np.abs(wanted))
            assert np.allclose(one.of(question), wanted, rtol=1e-7, atol=1e-8 * loose * most), name


@pytest.mark.parametrize("elements", [60, 90])
@pytest.mark.parametrize("far", [800.0, 824.0])
def test_a_mooring_line_of_great_stiffness(far, elements):
    """Round-off of forces of a line of 500 MN is more than what a change of its length leaves of them."""

    def line(length):
        model = ancf.Model(gravity=(0, 0, -9.80665))
        chain = ancf.Section(
            EA=493.27e6, EI=0.0, rhoA=114.94, diameter=0.1368, drag=(1.33, 0.2), added_mass=(1.0, 0.07)
        )
        rope = model.add_beam(
            "line", start=(0, 0, -200), end=(far, 0, -20), length=length, elements=elements, section=chain
        )
        model.pin(rope.start)
        model.pin(rope.end)
        model.add_fluid("sea", density=1025.0, below=0.0)
        model.add_ground("seabed", height=-200.0, stiffness=3e6, damping=3e5)
        return model, rope

    model, rope = line(850.0)
    found = ancf.equilibrium(model, sensitivities=["line.length"]).sensitivity("line.length")
    gap = 1e-3
    ends = [ancf.equilibrium(model).tension(rope.end) for model, rope in (line(850 + gap), line(850 - gap))]
    assert found.tension(rope.end) == pytest.approx((ends[0] - ends[1]) / (2 * gap), rel=2e-4)


def test_a_damping_of_zero_beside_another_one():
    """Elements with damping are computed by themselves, against one-sided differences of whole runs."""

    def tip(first, **more):
        model = ancf.Model(gravity=(0, 0, -9.81))
        for name, damping in (("a", first), ("b", 1.0)):
            section = ancf.Section(EA=1e4, EI=1.0, rhoA=0.1, bending_damping=damping)
            beam = model.add_beam(name, start=(0, 0, 0), end=(1, 0, 0), elements=9, section=section)
            model.clamp(beam.start)
        return ancf.simulate(model, t_end=0.01, step=1e-3, integrator=ancf.Trapezoidal(newton=TIGHT), **more)

    name, h = "a.bending_damping", 3e-6
    own = tip(0.0, sensitivities=[name]).sensitivity(name).position("a.end")
    f = [tip(k * h).position("a.end") for k in range(5)]
    weights = (-25 / 12, 4.0, -3.0, 4 / 3, -1 / 4)
    rate = sum(w * x for w, x in zip(weights, f, strict=True)) / h
    assert off(own, rate) < 1e-6


@pytest.mark.parametrize("name", ["beam.start[0]", "beam.start[2]", "beam.end[0]"])
def test_places_far_away(name):
    """A model a kilometre off moves as it does here, and so do its derivatives by places."""

    def clamped(x):
        model = ancf.Model(gravity=(0.0, 0.0, -9.81))
        section = ancf.Section(EA=1e4, EI=0.08, rhoA=0.05)
        beam = model.add_beam("beam", start=(x, 0, 0), end=(x + 1, 0, 0.3), elements=4, section=section)
        model.clamp(beam.start)
        result = ancf.simulate(model, t_end=0.05, step=1e-3, sensitivities=[name])
        return result.sensitivity(name).position(beam.end)

    assert off(clamped(1000.0), clamped(0.0)) < 1e-7


@pytest.mark.parametrize("taut", [5e-5, -5e-5, 0.05])
def test_a_slack_spring_near_its_kink(taut):
    """The steps of differences do not reach it: of a rope whose length turns the spring by ten times more."""
    model = rope_and_drum()
    model.add_spring("rope.at(1.0)", (1.0, 0, 2.0), stiffness=300.0, slack=True, length=9.0, name="near")
    length = float(ancf.equilibrium(model).spring_length("near")) - taut
    model = rope_and_drum()
    model.add_spring("rope.at(1.0)", (1.0, 0, 2.0), stiffness=300.0, slack=True, length=length, name="near")
    state = ancf.equilibrium(model, sensitivities=["rope.length"])

    def answer(other):
        return ancf.equilibrium(other).position("rope.at(2.4)")

    wanted = extrapolated(answer, model, "rope.length", 1e-6)
    found = state.sensitivity("rope.length").position("rope.at(2.4)")
    assert np.max(np.abs(found - wanted)) < 1e-4 * np.max(np.abs(wanted))
