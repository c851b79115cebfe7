"""Sensitivities in results files: the same numbers as in memory, and what of a file there is not."""

import pickle

import h5py
import numpy as np
import pytest

import ancf

NAMES = ["rope.EA", "rope.length", "stay.stiffness", "gravity", "rope.start[2]"]
RUN = {"t_end": 0.0204, "step": 1e-3}  # the last step is shorter


def swinging():
    """A cable on a spring, with a motion of its own."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=400.0, EI=0.3, rhoA=0.2, bending_damping=1e-3)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(0.7, 0, 0.2), elements=3, section=section)
    rope.set_motion(velocity=(0.0, 0.2, 0.0))
    model.pin(rope.start)
    model.add_spring(rope.end, (1.0, 0.2, 0.5), stiffness=3.0, length=0.2, name="stay")
    return model


def asked(result, name):
    """Answers of sensitivities of some kinds."""
    own = result.sensitivity(name)
    found = [own.dq, own.dv, own.position("rope.end"), own.tension("rope.at(0.4)"), own.spring_force("stay")]
    return [*found, own.of(lambda face: face.tension("rope.at(0.2)") ** 2), own.energy.strain]


@pytest.fixture(params=[None, 4e-3], ids=["all", "some"])
def both(request, tmp_path):
    """A run with a file, whose derivatives are in memory, and the file; every step is stored, or some are."""
    settings = {**RUN, "sensitivities": NAMES, "sensors": ["rope.end", "stay"], "output_step": request.param}
    file = tmp_path / "run.h5"
    return ancf.simulate(swinging(), **settings, file=file), ancf.load(file)


@pytest.mark.filterwarnings("ignore:.*the support wins")
@pytest.mark.parametrize("name", NAMES)
def test_a_file_answers_as_memory(both, name):
    memory, file = both
    for one, two in zip(asked(memory, name), asked(file, name), strict=True):
        assert np.array_equal(one, two)
    mine, theirs = (r.sensors.sensitivity(name) for r in both)
    assert np.array_equal(mine.position("rope.end"), theirs.position("rope.end"))
    assert np.array_equal(mine.spring_force("stay"), theirs.spring_force("stay"))
    assert np.array_equal(memory.state(3).sensitivity(name).dq, file.state(3).sensitivity(name).dq)


@pytest.mark.filterwarnings("ignore:.*the support wins")
def test_saved_and_pickled(tmp_path):
    result = ancf.simulate(swinging(), **RUN, sensitivities=NAMES[:2])
    result.save(tmp_path / "saved.h5")
    saved = ancf.load(tmp_path / "saved.h5")
    saved.save(tmp_path / "copied.h5")
    for again in (saved, ancf.load(tmp_path / "copied.h5"), pickle.loads(pickle.dumps(saved))):
        for one, two in zip(asked(result, "rope.length"), asked(again, "rope.length"), strict=True):
            assert np.array_equal(one, two)


@pytest.mark.filterwarnings("ignore:.*the support wins")
@pytest.mark.parametrize("method", [ancf.Trapezoidal(), ancf.GeneralizedAlpha(0.6)], ids=["half", "damped"])
def test_places_follow_from_velocities(method, tmp_path):
    """In memory they are computed when they are asked for; a file has what the steps found."""
    settings = {**RUN, "integrator": method, "sensitivities": NAMES}
    memory = ancf.simulate(swinging(), **settings)
    ancf.simulate(swinging(), **settings, file=tmp_path / "run.h5")
    file = ancf.load(tmp_path / "run.h5")
    for name in NAMES:
        one, two = memory.sensitivity(name), file.sensitivity(name)
        assert np.array_equal(one.dv, two.dv)
        assert np.allclose(one.dq, two.dq, rtol=0, atol=1e-13 * np.max(np.abs(two.dq)))
        assert one.dq is one.dq


@pytest.mark.filterwarnings("ignore:.*the support wins")
def test_another_run_starts_from_a_file(tmp_path):
    """From the file of another run, or from the result that made it."""
    first = ancf.simulate(swinging(), **RUN, sensitivities=NAMES[:2], file=tmp_path / "first.h5")
    starts = first.state(), ancf.load(tmp_path / "first.h5").state()
    one, two = (
        ancf.simulate(swinging(), t_end=0.03, step=1e-3, start=start, sensitivities=NAMES[:2])
        for start in starts
    )
    dq, again = (r.sensitivity("rope.EA").dq for r in (one, two))
    assert np.allclose(dq, again, rtol=0, atol=1e-10 * np.max(np.abs(dq)))


@pytest.mark.filterwarnings("ignore:.*the support wins")
class TestRefused:
    def test_a_resumed_run(self, tmp_path):
        ancf.simulate(swinging(), **RUN, sensitivities=["rope.EA"], file=tmp_path / "run.h5")
        with pytest.raises(ancf.ModelError, match=r"sensitivities by .rope\.EA.*does not carry on"):
            ancf.resume(tmp_path / "run.h5", t_end=0.05)

    def test_a_parameter_that_is_a_function(self, tmp_path):
        """It is there in memory; the file has the others."""
        built = {"own": (1.0, lambda x: swinging()), "rope.EA": (400.0, lambda x: swinging())}
        result = ancf.simulate(swinging(), **RUN, sensitivities=built, file=tmp_path / "run.h5")
        assert not np.any(result.sensitivity("own").dq)
        with pytest.raises(ancf.ModelError, match="no sensitivities"):
            ancf.load(tmp_path / "run.h5").sensitivity("own")

    def test_a_name_that_the_file_has_not(self, both):
        with pytest.raises(ancf.ModelError, match=r"there is none by .*rope\.EI.*rope\.EA"):
            both[1].sensitivity("rope.EI")

    @pytest.mark.parametrize("data", ["q", "v"])
    @pytest.mark.parametrize(("more", "wider"), [(1, 0), (7, 0), (0, 1), (0, -1)])
    def test_what_does_not_belong_to_the_states(self, both, tmp_path, data, more, wider):
        """More rows than states, or of another width."""
        memory, _ = both
        memory.save(tmp_path / "other.h5")
        with h5py.File(tmp_path / "other.h5", "r+") as file:
            group = file["sensitivities/1"]
            rows, width = group[data].shape
            del group[data]
            group[data] = np.zeros((rows + more, width + wider))
        with pytest.raises(ancf.ModelError, match=f"sensitivities/1/{data} does not fit") as caught:
            ancf.load(tmp_path / "other.h5")
        assert str(len(memory.t)) in caught.value.what
