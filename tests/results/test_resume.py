"""A run that goes on from its file: one history, the same to the last bit as from the state in memory."""

import json
import os
import shutil
import signal

import h5py
import numpy as np
import pytest

import ancf
from ancf.results.remembered import of_system
from long_run import started
from runs_to_continue import thrown

METHODS = [
    ancf.Trapezoidal(),
    ancf.GeneralizedAlpha(0.7, newton=ancf.Newton(tolerance=1e-9)),
    ancf.Radau(tolerance=1e-7),
    ancf.Explicit(safety=0.8),
]


def swing():
    """A cable that swings under a force in time, with damping."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="swing")
    section = ancf.Section(EA=5e2, EI=0.1, rhoA=0.4, damping=0.1)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section)
    model.pin(beam.start)
    model.add_force(beam.at(1 / 3), (0, "sin(3*t)", 0))
    return model


def without_checkpoints(path):
    """A copy of a results file as an earlier version would have written it."""
    copy = path.with_name("old.h5")
    shutil.copy(path, copy)
    with h5py.File(copy, "r+") as file:
        del file["checkpoints"]
    return copy


GIVEN = {"step": 1e-3, "output_step": 5e-3, "sensors": ["beam.end"]}


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
class TestMethods:
    def stopped(self, path, method, **more):
        return ancf.simulate(swing(), t_end=0.05, file=path, integrator=method, **GIVEN, **more)

    def test_is_the_run_that_was_not_stopped(self, method, tmp_path):
        """To the last bit; test_checkpoints.py has other models and places."""
        path = tmp_path / "run.h5"
        self.stopped(path, method)
        resumed = ancf.resume(path, t_end=0.1)
        whole = ancf.simulate(swing(), t_end=0.1, integrator=method, **GIVEN)
        if method.name == "radau":  # its steps depend on what is left of a run
            assert resumed.position("beam.end") == pytest.approx(whole.position("beam.end"), abs=1e-7)
            return
        assert (resumed.status, resumed.stats.steps) == ("complete", whole.stats.steps)
        assert np.array_equal(resumed.t, whole.t)
        assert np.array_equal(resumed.q[:], whole.q)
        assert np.array_equal(resumed.energy.supplied, whole.energy.supplied)
        assert np.array_equal(resumed.sensors.position("beam.end"), whole.sensors.position("beam.end"))

    def test_anew_where_there_is_no_checkpoint(self, method, tmp_path):
        """As from the state in memory: work, counters and sensors go on."""
        path = tmp_path / "run.h5"
        first = self.stopped(path, method)
        path = without_checkpoints(path)
        state, stats, work = first.state(), first.stats, first.energy.supplied[-1]
        with pytest.warns(UserWarning, match="no checkpoint"):
            resumed = ancf.resume(path, t_end=0.1)
        wanted = ancf.simulate(swing(), t_end=0.1, start=state, integrator=method, **GIVEN)
        assert resumed.status == "complete"
        assert np.array_equal(resumed.q[11:], wanted.q[1:])
        assert np.array_equal(resumed.v[11:], wanted.v[1:])
        assert np.array_equal(resumed.energy.supplied[11:], wanted.energy.supplied[1:] + work)
        assert resumed.stats.steps == stats.steps + wanted.stats.steps
        ends = [result.sensors.position("beam.end") for result in (resumed, wanted)]
        assert np.array_equal(ends[0][51:], ends[1][1:])
        assert resumed.t == pytest.approx(np.linspace(0, 0.1, 21), abs=1e-15)
        assert resumed.sensors.t == pytest.approx(np.linspace(0, 0.1, 101), abs=1e-15)

    def test_settings_and_provenance(self, method, tmp_path):
        path = tmp_path / "run.h5"
        self.stopped(path, method)
        before = ancf.load(path).provenance
        after = ancf.resume(path, t_end=0.1).provenance
        assert after["settings"] == {**before["settings"], "t_end": 0.1}
        assert after["model"] == before["model"]
        assert [0.04 <= entry["t"] <= 0.05 for entry in after["resumed"]] == [True]


def test_twice_and_into_the_middle_of_a_step(tmp_path):
    """The end need not be a multiple of the step: of a longer run it is no stored time any more."""
    path = tmp_path / "run.h5"
    first = ancf.simulate(swing(), t_end=0.0104, step=1e-3, file=path)
    for end in (0.0205, 0.03):
        result = ancf.resume(path, t_end=end)
        assert result.t[-1] == end
    assert np.all(np.diff(result.t) > 0)
    assert len(first.t) == 12
    assert result.t == pytest.approx(np.linspace(0, 0.03, 31), abs=1e-15)
    assert np.array_equal(result.q[:11], first.q[:11])
    assert [entry["t"] for entry in result.provenance["resumed"]] == pytest.approx([0.007, 0.017])


def test_without_energies(tmp_path):
    path = tmp_path / "run.h5"
    ancf.simulate(swing(), t_end=0.01, step=1e-3, file=path, energy=False)
    with pytest.raises(ancf.ModelError, match="was not accounted for"):
        _ = ancf.resume(path, t_end=0.02).energy


def test_killed_run(tmp_path):
    """kill -9 in another process, then on in this one: the run that was not killed, to the last bit."""
    path = tmp_path / "run.h5"
    child, _ = started(path, 1000)
    with child:
        os.kill(child.pid, signal.SIGKILL)
    killed = ancf.load(path)
    end = float(killed.t[-1]) + 0.01
    resumed = ancf.resume(path, t_end=end)
    assert resumed.status == "complete"
    assert resumed.t[-1] == end
    assert len(resumed.t) == len(killed.t) + 10
    assert np.array_equal(resumed.q[: len(killed.t)], killed.q[:])
    whole = ancf.simulate(killed.model, t_end=end, step=1e-3)
    assert np.array_equal(resumed.q[:], whole.q)
    assert np.array_equal(resumed.energy.total, whole.energy.total)


def test_stopped_run_goes_on_to_its_own_end(tmp_path):
    path = tmp_path / "run.h5"

    def stop(progress):
        if progress.step >= 8:
            raise KeyboardInterrupt

    with pytest.raises(ancf.Interrupted) as caught:
        ancf.simulate(swing(), t_end=0.2, step=1e-3, file=path, progress=stop)
    assert 0 < caught.value.result.t[-1] < 0.2
    result = ancf.resume(path)
    assert (result.status, result.t[-1]) == ("complete", 0.2)


class TestRefused:
    def stored(self, tmp_path, model=None, **given):
        path = tmp_path / "run.h5"
        ancf.simulate(model or swing(), t_end=0.01, step=1e-3, file=path, **given)
        return path

    def refused(self, path, phrase, **given):
        before = path.read_bytes()
        with pytest.raises(ancf.ModelError, match=phrase) as caught:
            ancf.resume(path, **given)
        assert path.read_bytes() == before
        assert [p.name for p in path.parent.iterdir()] == [path.name]
        return caught.value

    def test_nothing_left_to_do(self, tmp_path):
        path = self.stored(tmp_path)
        for end in (None, 0.01, 0.005, -1.0):
            error = self.refused(path, "has reached t = 0.01 s", t_end=end)
            assert (error.where, error.hint) == ("resume.t_end", "give a later t_end")
        self.refused(path, "must be a number", t_end="later")

    def test_python_function(self, tmp_path):
        model = swing()
        model.add_force("beam.end", lambda t: (0, 0, t), name="push")
        error = self.refused(
            self.stored(tmp_path, model), 'lost Python functions.*"<lambda>" of "push"', t_end=1.0
        )
        assert "ancf.resume(file, model=model" in error.hint

    def test_equilibrium(self, tmp_path):
        path = self.stored(tmp_path)
        copy = tmp_path / "run.h5"
        with h5py.File(copy, "r+") as file:
            header = json.loads(file.attrs["header"])
            header["settings"] = {"equilibrium": None}
            file.attrs["header"] = json.dumps(header)
        self.refused(path, "holds an equilibrium and no simulation", t_end=1.0)

    def test_no_state(self, tmp_path):
        path = self.stored(tmp_path)
        with h5py.File(path, "r+") as file:
            file["time"].resize(0, axis=0)
        self.refused(path, "holds no state to go on from", t_end=1.0)

    def test_no_file(self, tmp_path):
        with pytest.raises(ancf.ModelError, match="there is no such file"):
            ancf.resume(tmp_path / "nothing.h5", t_end=1.0)


@pytest.mark.parametrize(("at_end", "mode"), [("clamp", 1), ("release", 2)])
class TestEnds:
    """What was held at an end of its line, or let go, still is."""

    def test_file_and_memory(self, at_end, mode, tmp_path):
        path = tmp_path / "run.h5"
        memory = ancf.simulate(thrown(at_end), t_end=0.1, step=1e-3)
        ancf.simulate(thrown(at_end), t_end=0.1, step=1e-3, file=path)
        loaded = ancf.load(path)
        for result in (memory, loaded):
            assert result.state().known.modes == {"slider": mode}
            assert result.state(10).known.modes == {"slider": 0}
            gone = next(k for k in range(len(result.t)) if result.state(k).known.modes["slider"])
            assert 0.049 <= result.t[gone] <= 0.053
        resumed = ancf.resume(path, t_end=0.2)
        again = ancf.simulate(thrown(at_end), t_end=0.2, step=1e-3, start=memory.state())
        whole = ancf.simulate(thrown(at_end), t_end=0.2, step=1e-3)
        assert np.array_equal(resumed.q[:], whole.q)
        assert again.position("bead") == pytest.approx(whole.position("bead")[100:], abs=1e-9)
        assert of_system(resumed.state().system).modes == {"slider": mode}
        fallen = whole.position("bead")[-1, 2]
        assert fallen == pytest.approx(0.0 if at_end == "clamp" else -0.5 * 9.81 * 0.149**2, abs=4e-3)

    def test_on_from_the_middle(self, at_end, mode):
        """From before the end was reached: it is reached again."""
        whole = ancf.simulate(thrown(at_end), t_end=0.1, step=1e-3)
        again = ancf.simulate(thrown(at_end), t_end=0.1, step=1e-3, start=whole.state(20))
        assert again.position("bead") == pytest.approx(whole.position("bead")[20:], abs=1e-9)
        assert again.state().known.modes == {"slider": mode}
