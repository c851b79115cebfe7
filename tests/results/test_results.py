"""Results: memory, file and loaded file answer alike; a killed run leaves a readable file."""

import json
import os
import signal

import h5py
import numpy as np
import pytest

import ancf
from ancf.elements.registry import ELEMENTS
from ancf.model.elements import KINDS
from ancf.results.store import FileStore
from helpers import SOLIDS, arc, square
from long_run import reported_by, started


def model_of_two(element="cable"):
    """Two different bodies, joined, damped, loaded and driven: everything that a file must keep."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="two cables")
    damping = {"damping": 0.1, "axial_damping": 0.3, "bending_damping": 0.01}
    damped = square(element, EA=2e3, EI=0.1, rhoA=0.4, **damping)
    given = {"poisson": "full"} if element in SOLIDS else {"strain": KINDS[element].strains[-1]}
    one = model.add_beam("one", path=arc, elements=4, section=damped, element=element, gauss=(4, 3), **given)
    plain = ancf.Section.circle(diameter=0.01, E=1e7, rho=3000.0)
    more = {"elements": 3, "length": 2.2, "element": element, "y_axis": (0, 0.3, 1)}
    two = model.add_beam("two", start=arc(1.0), end=(3, 0, 0), section=plain, **more)
    model.clamp(one.start, rotation="0.2*sin(3*t)", axis=(0, 1, 0))
    model.connect(one.end, two.start)
    model.pin(two.end)
    model.add_force(one.at(0.5), lambda t: (0, np.sin(4 * t), 0), name="gust")
    two.set_motion(angular_velocity=(0, 0, 1e-3))
    return model


@pytest.fixture(scope="module", params=ELEMENTS)
def run(request, tmp_path_factory):
    """The same run in memory and in a file."""
    given = {"t_end": 0.1, "step": 1e-3, "output_step": 2e-3}
    path = tmp_path_factory.mktemp("run") / "run.h5"
    with pytest.warns(UserWarning, match="the support wins"):
        memory = ancf.simulate(model_of_two(request.param), **given)
    with pytest.warns(UserWarning, match="the support wins"):
        file = ancf.simulate(model_of_two(request.param), file=path, **given)
    return memory, file, path


FIELDS = ("position", "velocity", "slope", "strain", "tension", "curvature", "bending_moment")
POINTS = ("one.start", "one.at(0.5)", "one.end", "two.start", "two.at(1.1)", "two.end")
#: What beams with a cross-section have beyond that.
OF_SECTIONS = ("section_moment", "torque", "twist", "section_rotation", "strain_tensor", "stress_tensor")
IN_SECTIONS = ("one.at(0.5, 0.01, -0.012)", "two.at(1.1, 0.003, 0.002)")


def asked(result):
    """Fields and points that the bodies of a result have."""
    solid = result.bodies["one"].element in SOLIDS
    return (*FIELDS, *OF_SECTIONS * solid), (*POINTS, *IN_SECTIONS * solid)


def assert_same(a, b):
    assert np.array_equal(a.t, b.t)
    fields, points = asked(a)
    for field in fields:
        for point in points:
            assert np.array_equal(getattr(a, field)(point), getattr(b, field)(point)), (field, point)
    for part in ("kinetic", "strain", "potential", "dissipated", "supplied", "total", "balance", "drift"):
        assert getattr(a.energy, part) == pytest.approx(getattr(b.energy, part), rel=1e-14), part
    assert a.status == b.status == "complete"
    assert (a.stats.steps, a.stats.newton_iterations) == (b.stats.steps, b.stats.newton_iterations)


class TestStores:
    def test_memory_and_file(self, run):
        assert_same(run[0], run[1])

    def test_loaded_file(self, run):
        assert_same(run[0], ancf.load(run[2]))

    def test_text_path(self, run):
        assert_same(run[0], ancf.load(str(run[2])))

    @pytest.mark.parametrize("source", [0, 1])
    def test_saved_and_loaded(self, run, source, tmp_path):
        run[source].save(tmp_path / "copy.h5")
        assert_same(run[0], ancf.load(tmp_path / "copy.h5"))

    def test_save_into_a_new_folder(self, run, tmp_path):
        for source in (0, 1):
            path = tmp_path / f"new{source}" / "copy.h5"
            run[source].save(path)
            assert_same(run[0], ancf.load(path))

    def test_same_file_again(self, tmp_path):
        """A run that is repeated replaces its file, also when the earlier result is still at hand."""
        model = ancf.Model()
        section = ancf.Section(EA=1e3, EI=0.1, rhoA=0.4)
        model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=1, section=section)
        path = tmp_path / "run.h5"
        first = ancf.simulate(model, t_end=0.01, step=1e-3, file=path)
        second = ancf.simulate(model, t_end=0.02, step=1e-3, file=path)
        assert len(first.t) in (11, 21)
        assert len(second.t) == 21

    def test_shapes(self, run):
        for result in run[:2]:
            n = len(result.t)
            assert n == 51
            for field in FIELDS[:3]:
                assert getattr(result, field)("one.at(0.3)").shape == (n, 3)
            for field in FIELDS[3:]:
                assert getattr(result, field)("one.at(0.3)").shape == (n,)
            assert result.energy.total.shape == (n,)

    def test_energy_adds_up(self, run):
        e = run[1].energy
        assert np.array_equal(e.total, e.kinetic + e.strain + e.potential)
        assert np.array_equal(e.balance, e.total + e.dissipated - e.supplied)
        assert np.array_equal(e.drift, e.balance - e.balance[0])
        assert np.ptp(e.balance) < 0.1 * np.ptp(e.total)  # waves that the step hardly resolves

    def test_unknown_points(self, run):
        for result in run[:2]:
            for bad in ("three.end", "one.middle", "one.at(99)", "one"):
                with pytest.raises(ancf.ModelError):
                    result.position(bad)


class TestStates:
    def test_answers_like_the_result(self, run):
        for result in run[:2]:
            for index in (0, 17, -1):
                state = result.state(index)
                assert state.t == result.t[index]
                for field in asked(result)[0]:
                    got, wanted = (
                        getattr(state, field)("one.at(0.7)"),
                        getattr(result, field)("one.at(0.7)")[index],
                    )
                    assert got == pytest.approx(wanted, rel=1e-6, abs=1e-12), field
                assert state.energy.total == pytest.approx(result.energy.total[index], rel=1e-12)

    def test_is_a_copy(self, run):
        """Writing into a state must not change the result it came from."""
        state = run[0].state(10)
        before = run[0].position("one.end")[10].copy()
        state.q[:] = 0.0
        assert np.array_equal(run[0].position("one.end")[10], before)

    def test_does_not_keep_the_history_alive(self):
        model = ancf.Model()
        section = ancf.Section(EA=1e3, EI=0.1, rhoA=0.4)
        model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=100, section=section)
        result = ancf.simulate(model, t_end=1.0, step=1e-3, output_step=1e-3)
        state = result.state()
        owner = state.q if state.q.base is None else state.q.base
        assert owner.nbytes == 8 * 606  # not the 4.9 MB of all states
        assert np.all(np.isfinite(state.position("beam.end")))

    def test_wrong_index(self, run):
        with pytest.raises((IndexError, ancf.ModelError)):
            run[0].state(1000)

    def test_loaded_result_has_the_states(self, run):
        for index in (0, 17, -1):
            mine, loaded = run[0].state(index), ancf.load(run[2]).state(index)
            assert (loaded.t, loaded.energy.total) == (mine.t, mine.energy.total)
            assert np.array_equal(loaded.q, mine.q)
            assert np.array_equal(loaded.v, mine.v)


class TestProvenance:
    def test_what_made_it(self, run):
        for result in (*run[:2], ancf.load(run[2])):
            header = result.provenance
            assert header["title"] == "two cables"
            assert [b["name"] for b in header["model"]["bodies"]] == ["one", "two"]
            assert header["model"]["loads"][0]["name"] == "gust"
            assert header["settings"]["t_end"] == 0.1
            assert header["settings"]["step"] == 1e-3
            assert header["settings"]["output_step"] == 2e-3
            assert header["settings"]["integrator"] == "trapezoidal"
            assert header["settings"]["newton"]["tolerance"] == ancf.Newton().tolerance
            assert header["versions"]["numpy"] == np.__version__
            assert json.loads(json.dumps(header)) == header


class TestFile:
    def test_names_and_units_are_found_by_others(self, run):
        """The file is plain HDF5: whoever has no ancf reads it too."""
        with h5py.File(run[2]) as file:
            assert {"time", "q", "v", "energy", "bodies"} <= set(file)
            assert set(file["bodies"]) == {"one", "two"}
            n = len(file["time"])
            assert len(file["q"]) == len(file["v"]) == len(file["energy"]) == n == 51
            slots = file["bodies/two/slots"][:, 0]
            assert np.array_equal(file["q"][-1, slots[-1] : slots[-1] + 3], run[0].position("two.end")[-1])

    def test_block_that_was_torn(self, run, tmp_path):
        """A kill between the arrays of a block: rows without their time do not count."""
        path = tmp_path / "torn.h5"
        run[1].save(path)
        with h5py.File(path, "r+") as file:
            for name in ("q", "v", "work", "energy"):
                file[name].resize(len(file[name]) + 3, axis=0)
        assert_same(run[0], ancf.load(path))

    def test_time_is_written_last(self, run, tmp_path, monkeypatch):
        """Otherwise the torn block above would have a time and no values."""
        system, memory = run[0].state().system, run[0]
        header = {"settings": {}, "model": system.model.to_dict()}
        store = FileStore(tmp_path / "half.h5", system, header)
        monkeypatch.setattr("ancf.results.store.energies", lambda *_: np.zeros((7, 7)))
        with pytest.raises((TypeError, ValueError)):
            store.append(memory.t, memory.q, memory.v, np.zeros((len(memory.t), 2)))
        store.close()
        assert len(ancf.load(tmp_path / "half.h5").t) == 0

    def test_not_a_results_file(self, tmp_path):
        text, other = tmp_path / "text.h5", tmp_path / "other.h5"
        text.write_text("no")
        with h5py.File(other, "w") as file:
            file["x"] = 1.0
        for path in (text, other):
            with pytest.raises(ancf.ModelError, match="is not a results file of ancf"):
                ancf.load(path)
        with pytest.raises(ancf.ModelError, match="there is no such file"):
            ancf.load(tmp_path / "nothing.h5")
        with pytest.raises(
            ancf.ModelError, match=r"is a folder without results\.h5 \(name the file: other\.h5, text\.h5\)"
        ):
            ancf.load(tmp_path)
        (tmp_path / "results.h5").write_text("no")
        with pytest.raises(ancf.ModelError, match=r"results\.h5: is not a results file of ancf"):
            ancf.load(tmp_path)

    def test_a_folder_of_model_files_names_them(self, tmp_path):
        for name in ("line", "crane"):
            (tmp_path / f"{name}.toml").write_text("")
        with pytest.raises(
            ancf.ModelError, match=r"results\.h5 \(it has model files: crane\.toml, line\.toml\)"
        ):
            ancf.load(tmp_path)


def test_run_that_goes_on(tmp_path):
    """A file is read while it grows: each load sees what is there then, and keeps seeing that."""
    child, reported = started(tmp_path / "run.h5", 1000)
    with child:
        first = ancf.load(tmp_path / "run.h5")
        before = len(first.t)
        assert before >= reported + 1
        later = reported_by(child, before + 1000)
        second = ancf.load(tmp_path / "run.h5")
        assert len(second.t) >= later + 1
        for result, rows in ((first, before), (second, len(second.t))):
            assert result.status == "running"
            assert len(result.t) == len(result.position("beam.end")) == len(result.energy.total) == rows
        child.kill()


def test_killed_run_is_readable(tmp_path):
    """kill -9 in the middle: every block that was reported is in the file and right."""
    path = tmp_path / "run.h5"
    child, reported = started(path, 3000)
    with child:
        os.kill(child.pid, signal.SIGKILL)
    result = ancf.load(path)
    assert result.status == "running"
    assert len(result.t) >= reported + 1
    assert result.stats.steps >= reported
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=2e3, EI=0.1, rhoA=0.4)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section)
    model.pin(beam.start)
    wanted = ancf.simulate(model, t_end=0.1, step=1e-3)
    # two processes may compile differently, to round-off; that grows with the time
    assert result.position("beam.end")[:101] == pytest.approx(wanted.position(beam.end)[:101], abs=1e-9)
    assert result.energy.total[:101] == pytest.approx(wanted.energy.total[:101], abs=1e-8)
    result.save(tmp_path / "copy.h5")
    assert len(ancf.load(tmp_path / "copy.h5").t) == len(result.t)
