"""What users try first, by other words, is told what does it."""

import copy
import pickle
import re
from types import SimpleNamespace

import numpy as np
import pytest

import ancf
from ancf.model.other_words import OF_MODEL, OF_PACKAGE, OF_RESULT


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("add_seabed", "add_ground"),
        ("add_cable", "add_beam"),
        ("add_buoy", "add_rigid_body"),
        ("add_pulley", "add_surface"),
        ("add_current", "add_fluid"),
        ("add_mass", "add_point_mass"),
        ("fix", "clamp"),
        ("revolute", "hinge"),
        ("add_hinge", "hinge"),
        ("Hinge", "hinge"),
        ("torsion_spring", "add_torsion_spring"),
        ("add_winch", "winch"),
        ("add_water", "add_fluid"),
        ("add_tendon", "add_beam"),
        ("add_damper", "add_spring"),
        ("beam", "add_beam"),
    ],
)
def test_methods(name, said):
    model = ancf.Model()
    with pytest.raises(AttributeError, match=f"has no attribute '{name}': .*{said}") as error:
        getattr(model, name)
    hint = str(error.value).split(": ", 1)[1]
    assert all(hasattr(model, word) for word in (said, hint.split("(")[0]))


@pytest.mark.parametrize("words", [OF_MODEL, OF_RESULT, OF_PACKAGE], ids=["model", "result", "package"])
def test_hints_name_what_is_there(words):
    """Everything that is called in a hint can be called; no word is an attribute already."""
    places = (ancf, ancf.Model(), ancf.Result, ancf.State, ancf.Series, ancf.Waves, ancf.Section, catch_all())
    for word, hint in words.items():
        called = re.findall(r"(\w+)\(", hint)
        assert called or re.search(r"ancf docs|ancf export|^t$|energy|[A-Z]\w+Error", hint), word
        for name in called:
            assert any(hasattr(place, name) for place in places), (word, name)


def catch_all():
    """What a hint calls beside the package: pictures, frequencies, rotations of scipy, arrays."""
    names = ("save", "set_motion", "max", "write_view", "from_matrix", "as_quat", "as_euler", "at", "animate")
    return SimpleNamespace(**dict.fromkeys(names))


@pytest.fixture(scope="module")
def swung():
    """A rope that a joint carries, a support with a name, one without, and two at one node."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.5)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section, length=1.02)
    body = model.add_rigid_body("hook", at=(1, 0, 0), mass=1.0, inertia=(1.0, 1.0, 1.0))
    model.connect(rope.end, body, name="tie")
    model.pin(rope.start, name="fairlead")
    model.clamp(body)
    model.hold(rope.at(0.51), position="y", name="left")
    model.hold(rope.at(0.51), slope="y", name="right")
    start = ancf.equilibrium(model)
    sensors = ["fairlead", "clamp at hook.centre"]
    return ancf.simulate(model, t_end=0.02, step=0.01, start=start, sensors=sensors)


@pytest.mark.parametrize("known", ["state", "result", "sensors"])
def test_questions_by_other_words(swung, known):
    answers = {"state": swung.state(), "result": swung, "sensors": swung.sensors}[known]
    for name, said in (("angle", "joint_angle"), ("reaction_force", "reaction"), ("max_tension", "tension")):
        with pytest.raises(AttributeError, match=rf"has no attribute '{name}': .*{said}\("):
            getattr(answers, name)
    with pytest.raises(AttributeError, match=r"has no attribute 'frobnicate'$"):
        answers.frobnicate  # noqa: B018
    assert not hasattr(answers, "_nothing")


@pytest.mark.parametrize(("name", "said"), [("Hinge", "hinge"), ("run", "simulate"), ("JONSWAP", "jonswap")])
def test_names_of_the_package(name, said):
    with pytest.raises(AttributeError, match=f"module 'ancf' has no attribute '{name}': .*{said}"):
        getattr(ancf, name)


@pytest.mark.parametrize(
    ("cls", "name", "said"),
    [
        ("Waves", "airy", r"Waves\.regular\(height=, period="),
        ("Waves", "stokes_5th", r"waves are linear: Waves\.regular"),
        ("Waves", "irregular", r"Waves\.jonswap\(.*Waves\.pierson_moskowitz"),
        ("Waves", "PM", r"Waves\.pierson_moskowitz"),
        ("Section", "tube", r"Section\.from_moments\(A="),
        ("Section", "round", r"Section\.circle\(diameter="),
        ("Section", "rope", r"Section\(EA=, EI=, rhoA="),
        ("Series", "from_csv", r"Series\.read\("),
    ],
)
def test_names_of_classes(cls, name, said):
    """What they say is there; an unknown word says nothing more, and objects and their copies are as ever."""
    kind = getattr(ancf, cls)
    with pytest.raises(AttributeError, match=rf"^{cls} has no attribute '{name}': .*{said}") as caught:
        getattr(kind, name)
    for word in re.findall(rf"{cls}\.(\w+)", str(caught.value)):
        assert callable(getattr(kind, word))
    with pytest.raises(AttributeError, match=r"has no attribute 'frobnicate'$"):
        kind.frobnicate  # noqa: B018


def test_objects_of_told_classes():
    waves = ancf.Waves.regular(height=1.0, period=5.0)
    assert not hasattr(waves, "airy")
    for copied in (pickle.loads(pickle.dumps(waves)), copy.deepcopy(waves)):
        assert (copied.height, copied.period) == (1.0, 5.0)
    section = ancf.Section(EA=1.0, EI=2.0, rhoA=3.0)
    assert copy.deepcopy(section) == section


@pytest.mark.parametrize("given", [{}, {"speed": 0.1}, {"speed": 0.1, "acceleration": 1.0}])
def test_a_winch_without_a_length(given):
    """What the message says is right."""
    model = ancf.Model()
    line = model.add_beam(
        "line", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1e3, EI=1.0, rhoA=1.0)
    )
    with pytest.raises(ancf.ModelError, match=r'winch: wants "length" .*length=line.length, beside speed='):
        model.winch(line.start, **given)
    if "acceleration" in given:
        model.pin(line.start)
        model.winch(line.start, length=line.length, **given)


@pytest.mark.parametrize("known", ["state", "result", "sensors"])
@pytest.mark.parametrize("question", ["reaction", "reaction_moment"])
def test_a_support_by_its_point(swung, known, question):
    """As by its name, for an end of a rope and for a rigid body, as objects and as texts."""
    answers = {"state": swung.state(), "result": swung, "sensors": swung.sensors}[known]
    bodies = swung.model.bodies
    ask = getattr(answers, question)
    for name, points in (
        ("fairlead", (bodies["rope"].start, "rope.start")),
        ("clamp at hook.centre", (bodies["hook"], bodies["hook"].centre, "hook", "hook.centre")),
    ):
        for point in points:
            np.testing.assert_array_equal(ask(point), ask(name))


@pytest.mark.parametrize(
    ("point", "said"),
    [
        (
            "rope.end",
            r'rope\.end: is held by no support here; supports are: "fairlead".*joint_force\("tie"\)',
        ),
        ("rope.at(0.51)", r'is held by several supports: "left", "right" \(ask one\)'),
        ("fairled", 'unknown support .*did you mean "fairlead"'),
        ("rope", 'unknown support .*known: "fairlead"'),
    ],
)
def test_a_point_without_a_support(swung, point, said):
    with pytest.raises(ancf.ModelError, match=said):
        swung.reaction(point)
    with pytest.raises(ancf.ModelError, match="is no support that the sensors have recorded"):
        swung.sensors.reaction(point)


@pytest.mark.parametrize("recorded", ["left", "right"])
def test_a_point_of_several_supports_of_which_one_was_recorded(recorded):
    """The point stands for the one that can be asked."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    mass = model.add_point_mass("mass", at=(0, 0, 0), mass=2.0)
    for name, held in (("left", "xy"), ("right", "z")):
        model.hold(mass, position=held, name=name)
    result = ancf.simulate(model, t_end=0.02, step=0.01, sensors=[recorded])
    np.testing.assert_array_equal(result.sensors.reaction("mass"), result.sensors.reaction(recorded))
    with pytest.raises(ancf.ModelError, match="is held by several supports"):
        result.reaction("mass")


@pytest.mark.parametrize("question", ["position", "tension", "curvature"])
def test_a_support_that_is_asked_as_a_point(swung, question):
    with pytest.raises(ancf.ModelError, match=r"support of that name holds rope\.start: ask that"):
        getattr(swung, question)("fairlead")


def test_what_is_no_point_is_named(swung):
    model = swung.model
    for item, noun in (
        (model.connections[0], 'spherical joint "tie"'),
        (model.supports[0], 'pin "fairlead"'),
    ):
        with pytest.raises(ancf.ModelError, match=f"must be a point, is the {noun}.*its point is rope"):
            model.add_force(item, (0, 0, 1.0))


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: ancf.Section(EA=1.0, EI=1.0, rhoA=1.0, drag=1.2), r"normal to the axis.*\(1\.2, 0\.01\)"),
        (lambda: ancf.Section(EA=1.0, EI=1.0, rhoA=1.0, added_mass=1), r"normal to the axis.*\(1, 0\.0\)"),
        (lambda: ancf.Section(EA=1.0, EI=1.0, rhoA=1.0, Cd=1.2), 'did you mean "drag"'),
        (lambda: sea(velocity=0.5), r"along x it is \(0\.5, 0, 0\)"),
        (lambda: sea(velocity="0.5*t"), r'along x it is \["0\.5\*t", 0, 0\]'),
        (lambda: sea(velocity=(0.5, 0.1)), r"2 components, wanted 3 \(along x, y and z\)"),
        (lambda: sea(velocity={"depth": [0, 1], "speed": [1, 2]}), r'keys "z" and "velocity".*"z": \[0'),
        (
            lambda: sea(velocity={"z": [0, 1], "velocity": [1, 2]}),
            r"one number at each height.*\[\[1\.0, 0, 0\]",
        ),
        (lambda: sea(current=(1, 0, 0)), 'did you mean "velocity"'),
        (lambda: ancf.Waves.jonswap(Hs=2.0, Tp=8.0), 'did you mean "height"'),
        (lambda: ancf.Waves(height=2.0), r"Waves\.regular\(\.\.\.\)"),
        (lambda: ancf.Model().hinge("a", "b", axis=(0, 0, 1), stiffness=3.0), "add_torsion_spring"),
        (
            lambda: wheel().hinge("wheel", (0, 0, 0), axis="y"),
            r"three numbers, is 'y' \(\(0, 1, 0\) is along y\)",
        ),
        (
            lambda: wheel().add_torsion_spring("wheel", (0, 0, 0), axis=(0, 1, 0), stiffness=0.0),
            r"joint_angle\(hinge\)",
        ),
        (lambda: ancf.Model().add_rigid_body("b", at=(0, 0, 0), mass=1, inertia=2.0), r"\(2, 2, 2\)"),
        (lambda: wheel().bodies["wheel"].set_motion(angular_velocity=3.0), r"along z it is \(0, 0, 3\)"),
        (
            lambda: ancf.simulate(wheel(), t_end=1.0, step=0.1, start="equilibrium"),
            r"start=ancf\.equilibrium",
        ),
        (
            lambda: ancf.simulate(wheel(), t_end=1.0, step=0.1, sensors=["position(wheel)"]),
            'list .*: "wheel"',
        ),
        (
            lambda: ancf.simulate(wheel(), t_end=1.0, step=0.1, controller=lambda t, y: None),
            "one argument, the",
        ),
        (lambda: ancf.simulate(wheel(), t_end=0.1, step=0.1).to_csv("run.csv"), r'to_csv\("tables"\)'),
        (lambda: ancf.Series([0, 1], [0, 1], unit="degrees"), 'did you mean "deg"'),
        (lambda: wheel().add_pressure(wheel().bodies["wheel"].centre, 1.0, axis=(0, 0, 1)), 'is "wheel"'),
        (lambda: ancf.sample({"EA": [1, 2]}), 'method="grid"'),
        (lambda: ancf.simulate(wheel(), t_end=1.0, dt=0.1), 'did you mean "step"'),
        (lambda: run().to_pandas(points=["wheel"]), 'did you mean "items"'),
        (lambda: run().to_pandas(columns=["wheel"]), 'did you mean "items"'),
        (lambda: run().plot_shape(t=[0.0]), 'did you mean "times"'),
        (lambda: ancf.calibrate(wheel, {}, parameters={}, controller=print), "a build function that returns"),
        (lambda: ancf.gradient(wheel(), "", [], t_end=1, step=1, controller=print), "simulate takes one"),
    ],
)
def test_messages_say_what_to_write(call, said):
    with pytest.raises(ancf.ModelError, match=said):
        call()


def sea(**given):
    """A fluid of an empty model."""
    return ancf.Model().add_fluid("sea", density=1025.0, **given)


def run():
    """A run of it."""
    return ancf.simulate(wheel(), t_end=0.1, step=0.1)


def wheel():
    """A model with a rigid body."""
    model = ancf.Model()
    model.add_rigid_body("wheel", at=(0, 0, 0), mass=1.0, inertia=(1.0, 1.0, 1.0))
    return model


@pytest.mark.parametrize("key", ["displacement", "rotation", "rotation_vector"])
@pytest.mark.parametrize("relative", [False, True])
def test_a_motion_that_begins_elsewhere(key, relative):
    """A series whose first value is not zero takes a body from its joint; relative=True is the cure."""
    model = wheel()
    rope = model.add_beam(
        "rope", start=(1, 0, 0), end=(1, 0, -2), elements=2, section=ancf.Section(EA=1e4, EI=0.1, rhoA=0.1)
    )
    model.connect(rope.start, model.bodies["wheel"].at(1, 0, 0))
    series = ancf.Series([0.0, 1.0, 2.0], [0.3, 0.4, 0.3], relative=relative, ramp=0.5 if relative else None)
    model.clamp("wheel", **{key: series if key == "rotation" else [0, 0, series]}, name="motion")
    if relative:
        assert ancf.simulate(model, t_end=0.01, step=0.01).status == "complete"
        return
    with pytest.raises(ancf.ModelError, match=rf'"motion" begins its {key} with 0\.3 .*: relative=True'):
        ancf.simulate(model, t_end=0.01, step=0.01)


@pytest.mark.parametrize("name", ["frobnicate", "linearise", "suffix", "add_rotational_massage"])
def test_nothing_is_guessed(name):
    with pytest.raises(AttributeError) as error:
        getattr(ancf.Model(), name)
    assert str(error.value) == f"Model has no attribute '{name}'"


def test_gravity_is_a_vector():
    with pytest.raises(ancf.ModelError, match=r"Model.gravity: .*\(0, 0, -9.81\) where z points upwards"):
        ancf.Model(gravity=9.81)


def test_a_file_in_place_of_its_columns():
    model = ancf.Model()
    line = model.add_beam(
        "line", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1, EI=1, rhoA=1)
    )
    with pytest.raises(ancf.ModelError, match=r"ancf\.Series\.read"):
        model.pin(line.start, displacement="vessel.csv")


@pytest.mark.parametrize("name", ["Heave", "HEAVE", "heav"])
def test_a_column_of_nearly_that_name(name, tmp_path):
    (tmp_path / "vessel.csv").write_text("t [s],heave [m]\n0,1\n1,2\n")
    with pytest.raises(ancf.ModelError, match='did you mean "heave"'):
        ancf.Series.read(tmp_path / "vessel.csv", name)


@pytest.mark.parametrize(
    ("data", "said"),
    [({"time": [0, 1], "a": [0, 1]}, 'the times stand under "t", not "time"'), ({"a": [0, 1]}, 'wanted "t"')],
)
def test_data_without_times(data, said):
    with pytest.raises(ancf.ModelError, match=said):
        ancf.calibrate(lambda k: wheel(), data, parameters={"k": (0.1, 1.0)}, step=0.1)


def test_a_study_of_a_number_without_a_name():
    samples = ancf.sample({"k": [1.0, 2.0]}, method="grid")
    with pytest.raises(ancf.ModelError, match=r'return \{"tension": 1\.0\}'):
        ancf.study(lambda k: 2.0 * k, samples, workers=0)
