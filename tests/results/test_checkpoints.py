"""A run that was stopped anywhere and goes on is the run that was not stopped, to the last bit."""

import shutil
from typing import NamedTuple

import h5py
import numpy as np
import pytest
from test_resume import without_checkpoints

import ancf
from ancf import catenary
from ancf.preparation import compiled, prepared
from ancf.results import checkpoints
from ancf.results.store import MemoryStore
from ancf.solvers import stepping
from ancf.solvers.checkpoint import Watched
from ancf.solvers.radau import run as radau_run
from ancf.system.system import System
from motions import pendulum
from overhead_lines import COARSE, STEP, collector, short_line
from runs_to_continue import RUNS, adaptive, rope

#: A contact that rests exchanges nothing but round-off at first, and says so.
pytestmark = pytest.mark.filterwarnings("ignore:energies of the run do not add up")

#: Places at which each run is left, and fewer of them in the short form of the tests.
PLACES, FEW = 20, 2


@pytest.fixture
def often(monkeypatch):
    """Every step is a block, and every block leaves a checkpoint."""
    for where in (stepping, radau_run):
        monkeypatch.setattr(where, "BLOCK_SECONDS", 0.0)
    monkeypatch.setattr(stepping, "WORTH", 0.0)
    for name in ("APART", "SHARE"):
        monkeypatch.setattr(checkpoints, name, 0.0)


def same_bits(one, two):
    for name in ("t", "q", "v"):
        assert np.array_equal(getattr(one, name)[:], getattr(two, name)[:]), name
    for name in ("kinetic", "strain", "dissipated", "supplied"):
        assert np.array_equal(getattr(one.energy, name), getattr(two.energy, name)), name
    for name in ("t", "q", "v"):
        assert np.array_equal(getattr(one.sensors, name)[:], getattr(two.sensors, name)[:]), name
    measured = [r._store.samples["measured"][:] for r in (one, two)]
    assert np.array_equal(*measured)
    counts = [{k: n for k, n in r.stats.as_dict().items() if k != "cpu_seconds"} for r in (one, two)]
    assert counts[0] == counts[1]
    assert one.notes == two.notes
    known, other = (vars(result.state().known) for result in (one, two))
    memory, again = known["memory"], other["memory"]
    assert memory.keys() == again.keys()
    assert all(np.array_equal(x, again[name]) for name, x in memory.items())
    assert {**known, "memory": {}} == {**other, "memory": {}}
    assert one.status == two.status


def settings(name):
    build, method, step, steps, sensors = RUNS[name]
    return build, {"integrator": method, "step": step, "output_step": 3 * step, "sensors": sensors}, steps


def left(folder, name, where, t_end):
    """A run, and copies of its file as it was after some numbers of steps, as if it had been killed there."""
    build, given, _ = settings(name)
    path, copies = folder / "whole.h5", []

    def look(progress):
        while where and progress.step >= where[0]:
            copies.append(folder / f"left{len(copies)}.h5")
            shutil.copy(path, copies[-1])
            where.pop(0)

    return ancf.simulate(build(), t_end=t_end, file=path, progress=look, **given), copies


@pytest.mark.parametrize("name", RUNS)
def test_killed_anywhere(name, tmp_path, often, monkeypatch, request):
    """kill -9 after some numbers of steps; the run that goes on has other blocks."""
    _, given, steps = settings(name)
    rng = np.random.default_rng(len(name))
    places = PLACES if request.config.getoption("--slow") else FEW
    where = sorted(rng.integers(1, steps, places).tolist())
    whole, copies = left(tmp_path, name, where, steps * given["step"])
    assert len(copies) == places
    monkeypatch.undo()
    behind = set()
    for copy in copies:
        killed = ancf.load(copy)
        assert killed.status == "running"
        behind.add(killed._store.checkpoint().snapshot.t)
        same_bits(ancf.resume(copy), whole)
    assert len(behind) > 1 or steps < 10  # the places differ


@pytest.mark.parametrize(
    "name", [name for name in RUNS if name not in ("cable, radau", "hinge, radau", "strip, radau")]
)
@pytest.mark.parametrize("part", [0.31, 0.7104])
def test_later_end(name, part, tmp_path):
    """A run that was complete, in the middle of a step or not, goes on as if it had always been longer."""
    build, given, steps = settings(name)
    end, path = steps * given["step"], tmp_path / "run.h5"
    ancf.simulate(build(), t_end=max(part * end, given["step"]), file=path, **given)
    same_bits(ancf.resume(path, t_end=end), ancf.simulate(build(), t_end=end, **given))


@pytest.mark.parametrize("name", ["cable", "cable, radau", "cable, constant radau", "slack springs", "opens"])
class TestStops:
    def test_stopped_between_two_steps(self, name, tmp_path, often, monkeypatch):
        """Ctrl-C: nothing is computed twice, however seldom checkpoints are."""
        monkeypatch.setattr(checkpoints, "APART", 1e9)
        build, given, steps = settings(name)
        path, at = tmp_path / "run.h5", steps // 2

        def stop(progress):
            if progress.step >= at:
                raise KeyboardInterrupt

        with pytest.raises(ancf.Interrupted) as caught:
            ancf.simulate(build(), t_end=steps * given["step"], file=path, progress=stop, **given)
        found = ancf.load(path)._store.checkpoint()
        assert found.rows == len(caught.value.result.t) > 5
        monkeypatch.undo()
        whole = ancf.simulate(build(), t_end=steps * given["step"], **given)
        same_bits(ancf.resume(path), whole)

    def test_from_memory(self, name, tmp_path):
        """A result that was saved goes on as its run would have."""
        build, given, steps = settings(name)
        end, path = steps * given["step"], tmp_path / "run.h5"
        ancf.simulate(build(), t_end=0.6 * end, **given).save(path)
        found = ancf.load(path)._store.checkpoint()
        assert 0.3 * end < found.snapshot.t <= 0.6 * end
        resumed = ancf.resume(path, t_end=end)
        if not adaptive(given["integrator"]):
            same_bits(resumed, ancf.simulate(build(), t_end=end, **given))

    def test_twice(self, name, tmp_path):
        build, given, steps = settings(name)
        end, path = steps * given["step"], tmp_path / "run.h5"
        for k in (2, 4, 5):
            if k == 2:
                ancf.simulate(build(), t_end=0.2 * k * end, file=path, **given)
            else:
                resumed = ancf.resume(path, t_end=0.2 * k * end)
        assert len(resumed.provenance["resumed"]) == 2
        if not adaptive(given["integrator"]):
            same_bits(resumed, ancf.simulate(build(), t_end=end, **given))


def test_same_failure(tmp_path, often):
    """A run that fails fails again, with the same message, from wherever it goes on."""

    def whip():
        model, beam = pendulum(EI=1e-4, damping=0.0)
        beam.set_motion(angular_velocity=(0, 0, 15.0))
        model.add_force(beam.end, ["1e4*ramp(t, 0.2, 0.4)*sin(60*t)", 0, 0])
        return model

    path, given = tmp_path / "run.h5", {"step": 5e-3, "sensors": ["beam.end"]}
    with pytest.raises(ancf.SolveError) as first:
        ancf.simulate(whip(), t_end=4.0, file=path, **given)
    assert ancf.load(path)._store.checkpoint().snapshot.t > 0
    with pytest.raises(ancf.SolveError) as again:
        ancf.resume(path)
    assert str(again.value) == str(first.value)
    same_bits(again.value.result, first.value.result)


class Worn(NamedTuple):
    """A kind of batch that nobody has heard of, with a history in two of its arrays and an address."""

    base: np.ndarray
    wear: np.ndarray
    state: tuple[np.ndarray, ...]
    address: np.ndarray


def with_worn(address):
    system = System(rope())
    worn = Worn(
        np.arange(4), np.zeros((4, 3)), (np.zeros(2), np.zeros(3, dtype=np.int64)), np.array([address])
    )
    system.parts["worn"] = worn
    return system, worn


def test_history_of_a_new_kind_is_kept():
    """What a batch changes is found; addresses of a process do not change."""
    system, worn = with_worn(1111)
    watched = Watched(system)
    worn.wear[2], worn.state[1][:] = (1.0, np.nan, -0.0), 7
    saved = watched.changed()
    assert set(saved) == {"parts.worn.wear", "parts.worn.state.1"}
    worn.wear[:] = 5.0  # copies were taken
    again, fresh = with_worn(2222)
    Watched(again).restore(saved)
    assert np.array_equal(fresh.wear[2], (1.0, np.nan, 0.0), equal_nan=True)
    assert fresh.state[1].tolist() == [7, 7, 7]
    assert fresh.address == 2222
    assert not fresh.wear[[0, 1, 3]].any()


def test_what_changes_later_is_as_it_was():
    """A run that is put back forgets what it has changed since then, also where nothing was before."""
    system, worn = with_worn(1111)
    watched = Watched(system)
    worn.wear[2] = 1.0
    saved = watched.changed()
    worn.wear[:], worn.state[1][:] = 5.0, 7
    watched.restore(saved)
    assert worn.wear[2].tolist() == [1.0, 1.0, 1.0]
    assert not worn.wear[[0, 1, 3]].any()
    assert not worn.state[1].any()


@pytest.mark.parametrize("name", RUNS)
def test_all_that_changes_is_in_a_snapshot(name, monkeypatch):
    """After some steps a restored run has every array of the run that was left, whatever holds it."""
    build, given, steps = settings(name)
    args = {k: given[k] for k in ("step", "output_step", "sensors")}
    t_end, method = steps * given["step"], given["integrator"]
    made = prepared(build(), method=method, t_end=t_end, start=None, energy=True, **args)
    with pytest.raises(KeyboardInterrupt):
        made.run.go(MemoryStore(made.system), stop_after(steps // 3, monkeypatch))
    other = compiled(
        build(), method, 0.0, t_end, args["step"], args["output_step"], args["sensors"], True, "x"
    )
    other.run.restore(made.run.snapshot())
    mine, theirs = made.run.snapshot(), other.run.snapshot()
    assert mine.values == theirs.values
    assert mine.arrays.keys() == theirs.arrays.keys()
    for place, array in mine.arrays.items():
        assert np.array_equal(array, theirs.arrays[place], equal_nan=True), place


def stop_after(steps, monkeypatch):
    for where in (stepping, radau_run):
        monkeypatch.setattr(where, "BLOCK_SECONDS", 0.0)
    monkeypatch.setattr(stepping, "WORTH", 0.0)

    def stop(progress):
        if progress.step >= steps:
            raise KeyboardInterrupt

    return stop


class TestWithout:
    """A file whose checkpoint is not there, not whole, or of another model."""

    def stored(self, tmp_path, build=rope, **more):
        path = tmp_path / "run.h5"
        ancf.simulate(build(), t_end=0.02, step=1e-3, file=path, sensors=["beam.end"], **more)
        return path

    def anew(self, path):
        with pytest.warns(UserWarning, match="has no checkpoint: the run starts anew from its last state"):
            resumed = ancf.resume(path, t_end=0.04)
        whole = ancf.simulate(rope(), t_end=0.04, step=1e-3)
        assert len(resumed.t) == len(whole.t)
        assert resumed.position("beam.end") == pytest.approx(whole.position("beam.end"), abs=1e-8)

    def test_file_of_an_earlier_version(self, tmp_path):
        path = without_checkpoints(self.stored(tmp_path))
        self.anew(path)

    @pytest.mark.parametrize("at", [0, 9, 20, 300, -1])
    def test_one_whose_bytes_have_changed(self, at, tmp_path):
        """Of both places: no number of a checkpoint is believed that its checksum does not cover."""
        path = self.stored(tmp_path)
        with h5py.File(path, "r+") as file:
            for place in file["checkpoints"].values():
                place[at] ^= 0x10
        self.anew(path)

    def test_the_older_place_stands_in(self, tmp_path, often):
        """Killed while the newer one was written."""
        path = self.stored(tmp_path)
        newest = ancf.load(path)._store.checkpoint()
        with h5py.File(path, "r+") as file:
            file[f"checkpoints/{newest.number % 2}"][100:200] = 0
        older = ancf.load(path)._store.checkpoint()
        assert older.number == newest.number - 1
        given = {"step": 1e-3, "sensors": ["beam.end"]}
        same_bits(ancf.resume(path, t_end=0.04), ancf.simulate(rope(), t_end=0.04, **given))

    def test_checkpoint_of_another_model(self, tmp_path):
        """One array less, another shape: one message, and the file is as it was."""
        path, other = self.stored(tmp_path), tmp_path / "other.h5"
        ancf.simulate(pendulum(6)[0], t_end=0.02, step=1e-3, file=other)
        with h5py.File(path, "r+") as file, h5py.File(other) as source:
            for k in "01":
                data = source[f"checkpoints/{k}"][()]
                file[f"checkpoints/{k}"].resize(len(data), axis=0)
                file[f"checkpoints/{k}"][:] = data
        before = path.read_bytes()
        with pytest.raises(ancf.ModelError, match="has a checkpoint that does not fit its model") as caught:
            ancf.resume(path, t_end=0.04)
        assert caught.value.where == str(path)
        assert path.read_bytes() == before


class TestModelThatIsGiven:
    def build(self, size=0.5):
        def push(t):
            return (0.0, 0.0, size * np.sin(9 * t))

        model, beam = pendulum()
        model.add_force(beam.end, push, name="push")
        return model

    def test_python_functions(self, tmp_path):
        path, given = tmp_path / "run.h5", {"step": 1e-3, "sensors": ["beam.end"]}
        ancf.simulate(self.build(), t_end=0.05, file=path, **given)
        resumed = ancf.resume(path, t_end=0.1, model=self.build())
        same_bits(resumed, ancf.simulate(self.build(), t_end=0.1, **given))

    @pytest.mark.parametrize(
        "other", [lambda: pendulum()[0], lambda: pendulum(5)[0], lambda: pendulum(EA=2.1e3)[0]]
    )
    def test_another_model(self, other, tmp_path):
        path = tmp_path / "run.h5"
        ancf.simulate(self.build(), t_end=0.01, step=1e-3, file=path)
        with pytest.raises(ancf.ModelError, match=r"is not the model that .*run\.h5. describes") as caught:
            ancf.resume(path, t_end=0.02, model=other())
        assert caught.value.where == "resume.model"
        with pytest.raises(ancf.ModelError, match="must be a Model, is 'rope'"):
            ancf.resume(path, t_end=0.02, model="rope")

    def test_state_of_a_file_starts_a_model_made_again(self, tmp_path):
        path = tmp_path / "run.h5"
        first = ancf.simulate(self.build(), t_end=0.05, step=1e-3, file=path)
        loaded = ancf.load(path).state()
        runs = [
            ancf.simulate(self.build(), t_end=0.06, step=1e-3, start=state)
            for state in (loaded, first.state())
        ]
        assert np.array_equal(runs[0].q, runs[1].q)
        with pytest.raises(
            ancf.ModelError, match="is a state of another model: its bodies or their nodes differ"
        ):
            ancf.simulate(pendulum(5)[0], t_end=0.06, step=1e-3, start=loaded)


@pytest.mark.filterwarnings("ignore")  # of the coarse mesh
def test_overhead_line(tmp_path):
    """Wires, droppers that go slack and a pantograph: stopped, and on to the end of the run."""
    path = tmp_path / "line.h5"
    given = {"speed": 40.0, "pantograph": collector(), "mesh": COARSE, "step": STEP, "until": 110.0}
    whole = catenary.run(short_line(), window=(60.0, 100.0), **given).result

    def stop(progress):
        if progress.step > 300:
            raise KeyboardInterrupt

    with pytest.raises(ancf.Interrupted):
        catenary.run(short_line(), window=(60.0, 100.0), file=path, progress=stop, **given)
    resumed = ancf.resume(path)
    assert np.array_equal(resumed.q[:], whole.q)
    for part in ("t", "q", "v"):
        assert np.array_equal(getattr(resumed.sensors, part)[:], getattr(whole.sensors, part)[:])
    droppers = [name for name in whole.springs if "dropper" in name]
    slack = [np.any(whole.sensors.spring_force(name) == 0.0) for name in droppers]
    assert any(slack)
