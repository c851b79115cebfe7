"""Questions to a results file read it a few times, however many states it has: each read takes a tenth of a
millisecond, and there may be thousands."""

import numpy as np
import pytest

import ancf
from ancf.results.read_store import Rows


def model():
    """Two cables with a joint, a spring, a support of each kind and a load."""
    made = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.5, rhoA=0.2, axial_damping=1.0, bending_damping=0.001)
    one = made.add_beam("one", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section)
    two = made.add_beam("two", start=(1, 0, 0), end=(2, 0, 0), elements=3, section=section)
    made.clamp(one.start, name="clamp")
    made.connect(one.end, two.start, name="ball")
    made.pin(two.end, name="pin")
    made.add_spring(one.at(0.5), (0.5, 0, 1), stiffness=10.0, name="spring")
    return made


QUESTIONS = {
    "t": lambda r: r.t,
    "position": lambda r: r.position("two.at(0.4)"),
    "velocity": lambda r: r.velocity("one.end"),
    "acceleration": lambda r: r.acceleration("one.end"),
    "slope": lambda r: r.slope("one.end"),
    "tension": lambda r: r.tension("one.end"),
    "curvature": lambda r: r.curvature("one.at(0.3)"),
    "bending moment": lambda r: r.bending_moment("one.start"),
    "reaction": lambda r: r.reaction("pin"),
    "moment of a support": lambda r: r.reaction_moment("clamp"),
    "spring": lambda r: r.spring_force("spring"),
    "momentum": lambda r: r.momentum,
    "energy": lambda r: r.energy.total,
    "state": lambda r: [r.state(-1).position("one.end")],
    "notes": lambda r: r.notes,
    "said": str,
    "slack": lambda r: r.slack_intervals(),
    "table": lambda r: r.to_pandas(),
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Files of a short and a long run."""
    folder, made = tmp_path_factory.mktemp("reads"), {}
    for states in (10, 600):
        made[states] = folder / f"{states}.h5"
        ancf.simulate(model(), t_end=1e-3 * states, step=1e-3, file=made[states])
    return made


@pytest.mark.parametrize("question", QUESTIONS)
def test_long_files_are_read_as_often_as_short_ones(question, files, monkeypatch):
    take, read = Rows.__getitem__, []

    def counted(self, key):
        read.append(key)
        return take(self, key)

    monkeypatch.setattr(Rows, "__getitem__", counted)
    counts = []
    for states, path in files.items():
        result = ancf.load(path)
        read.clear()
        answer = QUESTIONS[question](result)
        counts.append(len(read))
        if isinstance(answer, np.ndarray):
            assert len(answer) == states + 1
    assert counts[1] <= counts[0] + 2


def test_states_of_a_file_are_arrays_for_numpy(tmp_path):
    """np.asarray of them was an array without dimensions, and len() an error."""
    made = model()
    ran = ancf.simulate(made, t_end=0.004, step=1e-3, file=tmp_path / "run.h5")
    read = ancf.load(tmp_path / "run.h5")
    memory = ancf.simulate(made, t_end=0.004, step=1e-3)
    for result in (ran, read):
        np.testing.assert_array_equal(np.asarray(result.q), memory.q)
        np.testing.assert_array_equal(np.abs(result.v), np.abs(memory.v))
        assert len(result.q) == 5
        assert sum(1 for _ in result.q) == 5
        for beyond in (5, -6):
            with pytest.raises(IndexError, match="there are 5"):
                result.q[beyond]
