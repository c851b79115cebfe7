"""Models, lines, states and results are pickled: what comes back gives the same numbers to the last bit."""

import pickle

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.model.file import parse_study
from ancf.model.kinds import CONNECTIONS, LOADS, SUPPORTS
from ancf.model.refine import refined
from registered import study_with

GROUPS = {"supports": SUPPORTS, "loads": LOADS, "connections": CONNECTIONS}


def through(item):
    return pickle.loads(pickle.dumps(item))


def pull(t):
    return (0.0, 0.0, 2.0 * np.sin(5.0 * t))


def drag(t, r, v):
    return -0.3 * v


def wave(u):
    return (u, 0.1 * np.sin(2.0 * u), 0.0)


def rope(elements=4):
    """A model with Python functions, a curved shape, an input and a spring that goes slack."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="rope")
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.2, damping=0.1)
    wire = model.add_beam("wire", path=wave, elements=elements, section=section)
    model.pin(wire.start)
    model.add_force(wire.end, pull)
    model.add_force(wire.end, drag, name="drag")
    push = model.add_input("push", 0.5)
    model.add_force(wire.end, (2 * push, 0.0, 0.0), name="push")
    model.add_spring(wire.end, (1.0, 0.0, 0.5), stiffness=50.0, slack=True, name="dropper")
    return model


def run(model, **more):
    return ancf.simulate(
        model, t_end=0.05, step=1e-3, output_step=5e-3, sensors=["wire.end", "dropper"], **more
    )


def same(one, other):
    assert np.array_equal(one.t, other.t)
    assert np.array_equal(one.q[:], other.q[:])
    assert np.array_equal(one.v[:], other.v[:])
    assert np.array_equal(one.sensors.position("wire.end"), other.sensors.position("wire.end"))
    assert np.array_equal(one.sensors.spring_force("dropper"), other.sensors.spring_force("dropper"))
    assert np.array_equal(one.energy.balance, other.energy.balance)
    assert np.array_equal(one.tension("wire.at(0.5)"), other.tension("wire.at(0.5)"))


@pytest.fixture(scope="module")
def result():
    return run(rope())


class TestModel:
    def test_runs_alike(self, result):
        again = through(rope())
        assert again.to_dict() == rope().to_dict()
        same(run(again), result)

    @pytest.mark.parametrize("elements", [1, 3])
    def test_curved_beams_can_be_refined(self, elements):
        """The shape itself comes along, not its nodes alone."""
        fine, direct = (refined(m) for m in (through(rope(elements)), rope(elements)))
        assert fine.to_dict() == direct.to_dict()

    @pytest.mark.parametrize(
        ("group", "kind"),
        [(g, k) for g, kinds in GROUPS.items() for k in kinds],
        ids=lambda part: getattr(part, "word", part),
    )
    def test_every_kind(self, group, kind):
        model = parse_study(study_with(group, kind)).model
        assert through(model).to_dict() == model.to_dict()

    def test_points_and_names_belong_to_it(self):
        again = through(rope())
        assert again.supports[0].point.body is again.bodies["wire"]
        with pytest.raises(ancf.ModelError, match="is the name of a body already"):
            again.add_point_mass("wire", at=(0, 0, 0), mass=1.0)

    def test_surroundings(self):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.2, diameter=0.02, drag=(1.2, 0.1))
        model.add_beam("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
        model.add_fluid("wind", 1.2, velocity=("0.1*z", "sin(t)", 0.0), above=-0.5)
        model.add_ground("floor", {"x": [0, 1], "y": [0, 1], "z": [[-1, -1], [-1, -1]]}, 1e5)
        assert through(model).to_dict() == model.to_dict()


class TestResult:
    def test_in_memory(self, result):
        same(through(result), result)

    def test_after_it_was_asked(self, result):
        """What was remembered of an answer does not stand in the way."""
        assert len(result.sensors.t) == 51
        assert result.notes == through(result).notes

    def test_of_a_file(self, result, tmp_path, monkeypatch):
        """It is its file, wherever the process is that reads it."""
        monkeypatch.chdir(tmp_path)
        run(rope(), file="here.h5")
        text = pickle.dumps(ancf.load("here.h5"))
        assert len(text) < 20_000
        monkeypatch.chdir("/")
        same(pickle.loads(text), result)

    def test_of_a_file_that_this_process_wrote(self, result, tmp_path):
        made = run(rope(), file=tmp_path / "here.h5")
        again = through(made)
        same(again, result)
        assert again.model.missing_functions() == []

    def test_of_a_file_that_has_gone(self, tmp_path):
        run(rope(), file=tmp_path / "here.h5")
        text = pickle.dumps(ancf.load(tmp_path / "here.h5"))
        (tmp_path / "here.h5").unlink()
        with pytest.raises(ancf.ModelError, match=r"here\.h5: there is no such file"):
            pickle.loads(text)

    @pytest.mark.parametrize("index", [0, 3, -1])
    def test_states_go_on_alike(self, result, index):
        """A state that was pickled is the start of the same motion."""
        state = result.state(index)
        one, other = (
            ancf.simulate(rope(), t_end=state.t + 0.01, step=1e-3, start=start).q[-1]
            for start in (state, through(state))
        )
        assert np.array_equal(one, other)

    def test_equilibrium_and_modes(self):
        model = rope()
        state = ancf.equilibrium(model)
        again = through(state)
        assert np.array_equal(again.q, state.q)
        assert again.model is again.system.model
        modes = ancf.modes(model, about=state, count=3)
        assert np.array_equal(through(modes).shapes, modes.shapes)
        assert np.array_equal(ancf.modes(again.model, about=again, count=3).frequencies, modes.frequencies)


class TestLine:
    def test_line_and_form(self):
        line = catenary.read_line("en50318-2002").excerpt(0, 2)
        assert through(line) == line
        form = catenary.form(line)
        again = through(form)
        assert again.line == line
        for name in ("dropper_natural", "dropper_load", "support_load", "contact_height"):
            assert np.array_equal(getattr(again, name), getattr(form, name))
        assert catenary.assemble(again).model.to_dict() == catenary.assemble(form).model.to_dict()


class TestErrors:
    @pytest.mark.parametrize("kind", [ancf.ModelError, ancf.SolveError])
    @pytest.mark.parametrize("hint", ["", "try this"])
    def test_keep_their_parts(self, kind, hint):
        error = kind("bodies[0]", "is wrong", hint)
        error.add_note("seen twice")
        again = through(error)
        assert type(again) is kind
        assert (again.where, again.what, again.hint, str(again)) == (
            "bodies[0]",
            "is wrong",
            hint,
            str(error),
        )
        assert again.__notes__ == ["seen twice"]

    def test_keep_their_result(self, result):
        error = ancf.SolveError("t = 1 s", "diverged")
        error.result = result
        same(through(error).result, result)
        same(through(ancf.Interrupted(result)).result, result)
