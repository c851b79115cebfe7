"""Gradients of numbers of a run: the adjoint against differences and against forward sensitivities."""

import numpy as np
import pytest

import ancf
from ancf.design.backwards import gradient_of
from ancf.design.formulas import Formula, Vocabulary
from ancf.design.gradient import OF_RUN, Histories, slopes_of
from ancf.paper import cantilever
from ancf.sensitivity import adjoint, adjoint_joints, blocks
from ancf.sensitivity.adjoint import Adjoint
from ancf.sensitivity.adjoint_joints import adjoint_of
from ancf.system.system import System
from ancf.viz.pictures.questions import ask
from slopes import extrapolated

TIGHT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14, modified=False))
INDEX2 = ancf.Trapezoidal(newton=TIGHT.newton, formulation="index2")
OBJECTIVES = [
    "last(position(beam.end)[2])",
    "integral(norm(velocity(beam.end))**2)",
    "smoothmax(tension(beam.at(0.3)), 20)",
    "deviation(position(beam.at(0.7))[0]) + mean(t * position(beam.end)[1])",
    "at(speed(beam.end), 0.0123)",
]


SECTION = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, damping=0.1)


def swinging(moves=True):
    """A cable with drag, a force, a spring and a clamp that moves."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, damping=0.1)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.clamp(beam.start, displacement=(0, 0, "0.02*sin(9*t)") if moves else None)
    model.add_force(beam.end, (0.1, "0.5*sin(9*t)", 0.0), name="push")
    model.add_spring(beam.end, (1.0, 0.1, 0.8), stiffness=5.0, length=0.7, name="stay")
    return model


NAMES = ["beam.EI", "beam.rhoA", "beam.damping", "beam.length", "gravity", "push.force", "stay.length"]
NAMES += ["beam.start[1]"]


def strongly_damped(elements, stays):
    """A cable on springs whose dampings are stiff beside a step: velocities add much to its stiffness."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, axial_damping=5.0, bending_damping=0.05, damping=0.1)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
    beam.set_motion(angular_velocity=(0.0, 3.0, 2.0))
    model.pin(beam.start)
    for k in range(stays):
        model.add_spring(
            beam.at(1 - 0.2 * k), (1, 0, 0.8), stiffness=50.0, length=0.7, damping=3.0, name=f"s{k}"
        )
    return model


@pytest.mark.parametrize("method", [TIGHT, ancf.GeneralizedAlpha(rho_inf=0.7, newton=TIGHT.newton)])
@pytest.mark.parametrize(("elements", "stays", "steps"), [(3, 0, 90), (9, 1, 45), (4, 3, 60)])
def test_strong_damping(elements, stays, steps, method):
    """Corrections that begin with a guess from the steps before end where those without one would."""
    model, names = strongly_damped(elements, stays), ["beam.EI", "beam.axial_damping", "beam.bending_damping"]
    names += ["beam.length", "gravity[2]", *(f"s{k}.damping" for k in range(stays))]
    given = {"t_end": steps * 2e-3, "step": 2e-3, "integrator": method}
    objective = "integral(norm(velocity(beam.end))**2)"
    _, slope = ancf.gradient(model, objective, names, **given)
    result = ancf.simulate(model, sensitivities=names, **given)
    _, slopes = slopes_of(Formula(objective, "test", OF_RUN), result.t, result)
    size = max(map(abs, slope.values()))
    for name in names:
        own = result.sensitivity(name)
        wanted = sum(np.sum(x * own.of(lambda f, p=pair: ask(f, *p))) for pair, x in slopes.items())
        assert slope[name] == pytest.approx(wanted, rel=1e-9, abs=1e-11 * size), name


def settings(method=TIGHT):
    return {"t_end": 0.0307, "step": 1e-3, "integrator": method}


@pytest.mark.parametrize("method", [TIGHT, ancf.GeneralizedAlpha(rho_inf=0.7, newton=TIGHT.newton)])
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_adjoint_is_the_forward_derivative(objective, method):
    """To round-off, for every parameter: they share nothing but the derivative of the residual."""
    model = swinging()
    value, slope = ancf.gradient(model, objective, NAMES, **settings(method))
    result = ancf.simulate(model, sensitivities=NAMES, **settings(method))
    formula = Formula(objective, "test", OF_RUN)
    again, slopes = slopes_of(formula, result.t, result)
    assert value == pytest.approx(again, rel=1e-13)
    for name in NAMES:
        own = result.sensitivity(name)
        wanted = sum(np.sum(x * own.of(lambda f, p=pair: ask(f, *p))) for pair, x in slopes.items())
        assert slope[name] == pytest.approx(wanted, rel=1e-7, abs=1e-9 * max(map(abs, slope.values()))), name


def damped():
    """A cable with damping of strains on a clamp that turns about fixed axes, and a damped spring."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(
        EA=500.0, EI=0.5, rhoA=0.2, axial_damping=0.5, bending_damping=0.01, slope_damping=0.1
    )
    beam = model.add_beam("beam", start=(0, 0, 0), end=(0.8, 0.6, 0), elements=3, section=section)
    model.clamp(beam.start, displacement=("0.02*sin(9*t)", 0, 0))
    model.add_spring(beam.at(0.4), (1.0, 0.1, 0.8), stiffness=5.0, damping=0.4, length=0.7, name="stay")
    beam.set_motion(velocity=(0.1, 0.0, 0.3))
    return model


@pytest.mark.filterwarnings("ignore:.*the support wins")
def test_damped_models_go_backwards():
    """The adjoint, whose matrix has the antisymmetric half with the other sign, against differences."""
    model, objective = damped(), OBJECTIVES[1]
    names = ["beam.EI", "beam.bending_damping", "beam.axial_damping", "stay.damping"]
    assert adjoint_of(System(model)) is Adjoint
    _, slope = ancf.gradient(model, objective, names, **settings())
    for name in slope:
        wanted = extrapolated(lambda m: ancf.gradient(m, objective, [], **settings())[0], model, name, 2e-2)
        assert abs(slope[name] - wanted) < 1e-7 * abs(wanted), name


@pytest.mark.parametrize("steps", [1, 7, 8, 9])
def test_any_number_of_steps_and_of_parameters(steps):
    """Matrices are made for eight steps at once, and parameters go eight abreast: rests are no others."""
    model, given = swinging(), {"t_end": 1e-3 * steps, "step": 1e-3}
    names = NAMES + [f"beam.{end}[{k}]" for end in ("start", "end") for k in (0, 2)]
    result = ancf.simulate(model, sensitivities=names, **given)
    _, slope = ancf.gradient(model, OBJECTIVES[0], names, **given)
    for name in names[steps % 3 :: 3]:  # other ones with each number of steps
        alone = ancf.simulate(model, sensitivities=[name], **given).sensitivity(name)
        wanted = alone.position("beam.end")
        scale = 1e-8 * np.abs(wanted).max()  # what a difference of residuals leaves of round-off
        assert result.sensitivity(name).position("beam.end") == pytest.approx(wanted, abs=scale)
        assert ancf.gradient(model, OBJECTIVES[0], [name], **given)[1][name] == pytest.approx(slope[name])


@pytest.mark.parametrize("objective", OBJECTIVES[:3])
def test_against_differences(objective):
    model = swinging()
    _, slope = ancf.gradient(model, objective, ["beam.EI", "gravity"], **settings())
    for name in slope:
        wanted = extrapolated(lambda m: ancf.gradient(m, objective, [], **settings())[0], model, name, 2e-2)
        assert abs(slope[name] - wanted) < 1e-7 * abs(wanted), name


def test_steps_taken_again_give_the_same(monkeypatch):
    model = cantilever.build(2)
    given = {"t_end": 0.05, "step": 5e-4}
    first = ancf.gradient(model, OBJECTIVES[1], ["beam.EI", "gravity"], **given)
    monkeypatch.setattr(blocks, "KEPT", 0.0)
    again = ancf.gradient(model, OBJECTIVES[1], ["beam.EI", "gravity"], **given)
    assert again[0] == first[0]
    assert again[1] == pytest.approx(first[1], rel=1e-10)


@pytest.mark.parametrize("method", [TIGHT, ancf.GeneralizedAlpha(rho_inf=0.5, newton=TIGHT.newton)])
@pytest.mark.parametrize(("elements", "steps"), [(2, 40), (3, 75)])
def test_positions_from_velocities(elements, steps, method, monkeypatch):
    """What supports move is kept, all else follows from velocities: local axes turn, and a body is held."""
    model = swinging()
    rope = model.add_beam("rope", start=(1, 0, 0), end=(2, 0.3, 0), elements=elements, section=SECTION)
    model.clamp(rope.end, displacement=("0.01*sin(40*t)", 0, "0.3*t**2"))
    model.connect(rope.start, model.bodies["beam"].end)
    names = ["beam.EI", "rope.EA", "push.force", "stay.length"]
    objective = OBJECTIVES[1] + " + 1e-3*integral(tension(rope.at(0.9))**2)"
    given = {"t_end": steps * 1e-3, "step": 1e-3, "integrator": method}
    first = ancf.gradient(model, objective, names, **given)
    made, kept = [], blocks.Keeping.__init__

    def less(self, system, steps, remembers):
        monkeypatch.setattr(blocks, "KEPT", 20.0 * system.size * steps)
        kept(self, system, steps, remembers)
        made.append((self.all, self.some))

    monkeypatch.setattr(blocks.Keeping, "__init__", less)
    again = ancf.gradient(model, objective, names, **given)
    assert made == [(False, True)]
    assert again[0] == first[0]
    assert again[1] == pytest.approx(first[1], rel=1e-9)


@pytest.mark.parametrize(("elements", "steps"), [(2, 400), (1500, 150), (2000, 200)])
def test_no_more_snapshots_than_steps_between_them(elements, steps, monkeypatch):
    """Of large models as well, whose snapshots are as large as some steps."""
    made = []

    class Counted(adjoint.Adjoint):
        def forwards(self, others=None):
            found = super().forwards(others)
            made.append(len([block for block in self.blocks if block.snapshot is not None]))
            return found

    monkeypatch.setattr(blocks, "KEPT", 0.0)
    monkeypatch.setattr(adjoint_joints, "Adjoint", Counted)
    ancf.gradient(cantilever.build(elements), OBJECTIVES[1], ["beam.EI"], t_end=steps * 1e-4, step=1e-4)
    assert 2 <= made[0] <= 1.5 * np.sqrt(steps)  # energies are looked at between blocks


def test_from_an_equilibrium():
    model = swinging(moves=False)

    def value(other, names=()):
        start = ancf.equilibrium(other, sensitivities=names)
        return ancf.gradient(other, OBJECTIVES[0], names, start=start, **settings())

    _, slope = value(model, ["beam.EI", "stay.length"])
    for name in slope:
        wanted = extrapolated(lambda m: value(m)[0], model, name, 2e-2)
        assert abs(slope[name] - wanted) < 1e-7 * abs(wanted), name


@pytest.mark.parametrize(
    "text",
    [
        "max(x(a))",
        "min(x(a)) * range(x(a))",
        "percentile(x(a), 30)",
        "rms(x(a)) / mean(abs(x(a)))",
        "first(x(a)) ** 3",
        "smoothmax(sin(x(a)) + ramp(x(a), 0, 2), 3)",
        "deviation(exp(-x(a)))",
        "integral(where(t > 0.5, x(a), tanh(x(a))))",
        "at(sqrt(4 + x(a)), 0.33)",
        "last(norm(y(a)) * y(a)[1])",
        "mean(max(min(x(a), 0.3), 0.1)) + mean(log(3 + x(a)) - cos(x(a)) ** 2)",
    ],
)
def test_formulas_backwards(text):
    """Each rule of the language against differences by every number of the histories."""
    words = Vocabulary(("t",), ("x", "y"))
    rng = np.random.default_rng(3)
    t, x, y = np.linspace(0, 1, 7), rng.uniform(-1, 1, 7), rng.uniform(-1, 1, (7, 3))
    formula, histories = Formula(text, "test", words), {("x", "a"): x, ("y", "a"): y}
    value, slopes = gradient_of(formula, Histories(t, histories))
    assert value == formula(Histories(t, histories))
    for key, slope in slopes.items():
        wanted = np.zeros_like(histories[key])
        for place in np.ndindex(wanted.shape):
            near = []
            for e in (1e-5, -1e-5):
                moved = {k: h.copy() for k, h in histories.items()}
                moved[key][place] += e
                near.append(formula(Histories(t, moved)))
            wanted[place] = (near[0] - near[1]) / 2e-5
        assert np.max(np.abs(slope - wanted)) < 1e-8


def test_bad_objectives():
    model = cantilever.build(2)
    with pytest.raises(ancf.ModelError, match="gives numbers of shape"):
        ancf.gradient(model, "position(beam.end)", ["gravity"], t_end=0.01, step=1e-3)
    with pytest.raises(ancf.ModelError, match="unknown name"):
        ancf.gradient(model, "max(weight(beam.end))", ["gravity"], t_end=0.01, step=1e-3)


def drawn(t, r, v):
    """A law that numba does not compile."""
    return [0.0, float(str(0.3 * t)), -0.1]


def test_laws_in_python_go_forwards():
    """A pendulum of a rigid body with a law that is called once a step: it takes sensitivities instead."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    hub = model.add_rigid_body("hub", at=(0.5, 0, 0), mass=1.0, inertia=(0.01, 0.1, 0.1))
    model.hinge(hub.at(-0.5, 0, 0), (0.0, 0.0, 0.0), axis=(0, 1, 0), name="hinge")
    model.add_force(hub.centre, drawn)
    assert adjoint_of(System(model)) is None
    text, given = "integral(position(hub.centre)[2])", {"t_end": 0.1, "step": 2e-3, "integrator": INDEX2}
    _, slope = ancf.gradient(model, text, ["gravity", "hub.inertia"], **given)
    for name in slope:
        wanted = extrapolated(lambda m: ancf.gradient(m, text, [], **given)[0], model, name, 2e-2)
        assert abs(slope[name] - wanted) < 1e-7 * abs(wanted)
