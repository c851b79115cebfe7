"""What is asked with a thing of another kind is answered by its name, never by an error from inside."""

from functools import cache

import numpy as np
import pytest

import ancf
from ancf import ModelError
from overhead_lines import short_line


def _model():
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e4, EI=1.0, rhoA=0.5)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.clamp(beam.start)
    return model


@cache
def _result():
    return ancf.simulate(_model(), t_end=0.004, step=1e-3)


HUGE = 10**400
#: Of each question all that it is not about.
KINDS = {
    "number": 3,
    "none": None,
    "text": "text",
    "list": [1.0],
    "array": np.ones(2),
    "line": short_line(),
    "model": _model(),
    "huge": HUGE,
}
PLACE, BOUNDS = "final(beam.end.position[2])", {"beam.EI": (0.5, 2.0)}
TIME = {"t_end": 2e-3, "step": 1e-3}


def _least(**changes):
    given = {"objective": PLACE, "parameters": BOUNDS, "most": 1} | TIME
    return ancf.minimise(_model(), **(given | changes))


def _tuned(**changes):
    return ancf.calibrate(lambda EI: _model(), {}, {"EI": (0.5, 2.0)}, **changes)


def _sampled(other):
    return ancf.sample({"a": ancf.Uniform(1.0, 2.0)}, count=4, correlations=other)


#: What is asked with it, the place that is named, and the kinds that it may be.
ASKED = [
    (lambda other: _result().state(other), "state.index", ["number"]),
    (lambda other: ancf.stable_step(other), "stable_step.model", ["model"]),
    (lambda other: _least(objective=other), "minimise.objective", ["text"]),
    (lambda other: _least(start=other), "minimise.start", ["none"]),
    (lambda other: _least(constraints=other), "minimise.constraints", ["none"]),
    (lambda other: _least(begin=other), "minimise.begin", ["none"]),
    (lambda other: _tuned(start=other), "calibrate.start", ["none"]),
    (_sampled, "sample.correlations", ["none"]),
    (lambda other: ancf.verify(_model(), **TIME, sensors=other), "verify.sensors", ["none"]),
    (lambda other: ancf.verify(_model(), **TIME, outputs=other), "verify.outputs", ["none", "list", "array"]),
    (lambda other: ancf.GeneralizedAlpha(newton=other), "GeneralizedAlpha.newton", []),
    (lambda other: ancf.Trapezoidal(newton=other), "Trapezoidal.newton", []),
    (lambda o: ancf.Sheave(radius=1, groove=0.1, depth=0.2, angle=o), "Sheave.angle", ["number"]),
    (lambda other: ancf.Reeving([other], axis=(0, 1, 0), start=(0, 0, 0), end=(1, 0, 0)), "wheels[0]", []),
    (lambda o: ancf.FmuController(o, step=1e-3, inputs={}, outputs={}), "FmuController.path", ["text"]),
    (lambda other: ancf.stepper(_model(), step=1e-3).save(other), "save.file", ["text"]),
    (lambda o: ancf.equilibrium(_model(), sensitivities=o), "equilibrium.sensitivities", ["none"]),
    (lambda o: ancf.modes(_model(), sensitivities=o), "modes.sensitivities", ["none"]),
    (lambda o: ancf.simulate(_model(), **TIME, sensitivities=o), "simulate.sensitivities", ["none"]),
    (lambda other: _result().to_csv(other), "result.to_csv.folder", ["text"]),
    (lambda other: _result().to_excel(other), "result.to_excel.path", ["text"]),
    (lambda other: _result().input(other), "input", []),
    (lambda other: _result().input_changes(other), "input", []),
]


@pytest.mark.parametrize(
    ("ask", "where", "kind"),
    [(ask, where, kind) for ask, where, taken in ASKED for kind in KINDS if kind not in taken],
)
def test_another_kind_is_named(ask, where, kind):
    """They ended with TypeError, AttributeError or IndexError."""
    with pytest.raises(ModelError) as error:
        ask(KINDS[kind])
    assert where in error.value.where


@pytest.mark.parametrize("index", [4.0, 0.5, True, "1", 5, -6, 99, np.float64(1.0)])
def test_states_have_whole_numbers(index):
    with pytest.raises(ModelError, match=r"state\.index"):
        _result().state(index)


@pytest.mark.parametrize("index", [0, 4, -1, -5, np.int64(2)])
def test_states_of_whole_numbers(index):
    assert _result().state(index).t == _result().t[index]


@pytest.mark.parametrize(
    "ask",
    [
        "multiplier",
        "joint_force",
        "joint_angle",
        "joint_rate",
        "joint_displacement",
        "joint_velocity",
        "arc_length",
        "arc_rate",
        "normal_force",
        "contact_force",
        "contact_gap",
        "friction_force",
        "slipping",
        "angular_velocity",
    ],
)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("of", ["result", "state"])
def test_what_is_no_joint(ask, kind, of):
    """What has no hash, as a line, ended with "unhashable type"."""
    asked = _result() if of == "result" else _result().state()
    with pytest.raises(ModelError):
        getattr(asked, ask)(KINDS[kind])


@pytest.mark.parametrize("ask", ["has_force", "has_moment", "has_angle", "has_angles", "has_travel"])
@pytest.mark.parametrize("kind", KINDS)
def test_there_is_no_such_joint(ask, kind):
    assert getattr(_result(), ask)(KINDS[kind]) is False


@pytest.mark.parametrize(
    "ask",
    [
        lambda: ancf.Model(gravity=HUGE),
        lambda: ancf.Sphere(radius=1.0, at=HUGE),
        lambda: ancf.Plane(normal=-HUGE),
        lambda: ancf.Section(EA=1.0, EI=1.0, rhoA=1.0, diameter=0.1, drag=HUGE),
    ],
)
def test_numbers_beyond_all(ask):
    """The advice of the message could not be written: OverflowError."""
    with pytest.raises(ModelError, match="must be"):
        ask()


class Told:
    """Takes whatever it is given, as functions do; its objects are called with one thing."""

    def __init__(self, *given):
        self.given = given

    def __call__(self, one):
        return None


#: What is called as a function, and the place that is named.
CALLED = [
    (lambda other: ancf.simulate(_model(), **TIME, progress=other), "simulate.progress"),
    (lambda other: ancf.simulate(_model(), **TIME, controller=other), "simulate.controller"),
    (lambda other: ancf.resume("none.h5", progress=other), "resume.progress"),
    (lambda other: ancf.verify(_model(), **TIME, start=other), "verify.start"),
    (lambda other: _least(begin=other), "minimise.begin"),
    (lambda other: ancf.minimise(other, PLACE, BOUNDS, **TIME, most=1), "minimise.model"),
    (lambda other: ancf.catenary.run(short_line(), speed=60, progress=other), "run.progress"),
    (lambda other: ancf.catenary.run(short_line(), speed=60, modify=other), "run.modify"),
    (lambda o: ancf.equilibrium(_model(), sensitivities={"a": (1.0, o)}), "equilibrium.sensitivities"),
]


@pytest.mark.parametrize("given", [int, Told, ancf.Model, 3, "print"], ids=str)
@pytest.mark.parametrize(("ask", "where"), CALLED, ids=[where for _, where in CALLED])
def test_what_is_no_function(ask, where, given):
    """A class made one of its objects, which nobody looked at, or ended with an error from inside."""
    with pytest.raises(ModelError, match="must be a") as error:
        ask(given)
    assert where in error.value.where
    if isinstance(given, type) and "sensitivities" not in where:
        assert f"is the class {given.__name__}" in error.value.what


def test_objects_that_can_be_called_are_functions():
    run = ancf.simulate(_model(), **TIME, progress=Told(), controller=Told())
    assert len(run.t) == 3


@pytest.mark.parametrize(
    "item", [np.ones((2, 2)), [np.ones((2, 3))], np.array([["beam.end"]]), [["beam.end"]], [int]], ids=repr
)
def test_sensors_are_no_tables(item):
    for ask in (ancf.verify, ancf.simulate):
        model = _model()
        ball = model.add_point_mass("ball", at=(0, 0, 1), mass=1.0)
        model.add_spring(ball, (0, 0, 2), stiffness=5.0, name="stay")
        with pytest.raises(ModelError, match=r"\.sensors(\[0\])?: must be a (list of )?points?"):
            ask(model, **TIME, sensors=item)


@pytest.mark.parametrize("size", [np.ones(3), [1, 3], "3", 3.0, 2, 0, -1, True, int], ids=repr)
def test_sizes_of_series(size):
    with pytest.raises(ModelError, match=r"Series\.size: must be 1 or 3"):
        ancf.Series([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], size=size)
