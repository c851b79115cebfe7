"""Steps that are long for what moves are said, with the period of beam theory; results of long runs, room."""

from typing import NamedTuple

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError
from ancf.results import accuracy, resolution, room
from ancf.results.read_store import Rows
from ancf.results.state import Energy

LENGTH, EI, RHO_A = 0.8, 1.0, 0.6


def cantilever(gravity=0.1):
    """Swings in its first mode, a little."""
    model = ancf.Model(gravity=(0, 0, -gravity))
    section = ancf.Section(EA=1e6, EI=EI, rhoA=RHO_A)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(LENGTH, 0, 0), elements=6, section=section)
    model.clamp(beam.start)
    return model


PERIOD = 2 * np.pi / (1.8751040687**2 * np.sqrt(EI / (RHO_A * LENGTH**4)))


def said(run):
    return [note for note in run.notes if note.startswith("steps of")]


class TestSteps:
    @pytest.mark.parametrize("steps", [7.0, 3.0, 1.0])
    def test_long_ones(self, steps):
        """The trapezoidal rule keeps the energy however long they are: the period is that of beam theory."""
        run = ancf.simulate(cantilever(), t_end=60 * PERIOD / steps, step=PERIOD / steps)
        [note] = said(run)
        words = note.split()
        assert float(words[words.index("about") + 1]) == pytest.approx(PERIOD, rel=0.1)
        assert "are long for what moves" in " ".join(str(run).split())

    @pytest.mark.parametrize("steps", [20.0, 12.0])
    def test_short_ones(self, steps):
        assert said(ancf.simulate(cantilever(), t_end=5 * PERIOD, step=PERIOD / steps)) == []

    def test_what_only_moves_on(self):
        """A fall has no period, however few its steps."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        model.add_beam(
            "beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1e4, EI=1.0, rhoA=1.0)
        )
        assert said(ancf.simulate(model, t_end=1.0, step=0.1)) == []

    def test_states_that_were_left_out_tell_nothing(self):
        run = ancf.simulate(cantilever(), t_end=20 * PERIOD, step=PERIOD / 3, output_step=PERIOD)
        assert said(run) == []

    def test_a_file_says_so_too(self, call, tmp_path):
        """The same in the summary of a run from a file."""
        text = f"""
title = "swings"
gravity = [0, 0, -0.1]
[sections.rod]
EA = 1e6
EI = {EI}
rhoA = {RHO_A}
[[bodies]]
type = "beam"
name = "beam"
section = "rod"
start = [0, 0, 0]
end = [{LENGTH}, 0, 0]
elements = 6
[[supports]]
type = "clamp"
point = "beam.start"
[simulation]
t_end = {20 * PERIOD / 3}
step = {PERIOD / 3}
"""
        (tmp_path / "swings.toml").write_text(text)
        ran = call("run", str(tmp_path / "swings.toml"), "-o", str(tmp_path / "out"))
        assert ran.code == 0
        assert "note: steps of" in ran.out
        assert "at most" in ran.out
        assert "(end " in ran.out

    @pytest.mark.parametrize("steps", [7, 400, 2500])
    def test_a_file_is_read_a_few_times_not_at_each_step(self, steps, tmp_path, monkeypatch):
        """The note costs no more than the run: it took longer than all steps of a small model."""
        read = []
        take = Rows.__getitem__

        def counted(self, key):
            read.append(key)
            return take(self, key)

        run = ancf.simulate(cantilever(), t_end=steps * PERIOD / 3, step=PERIOD / 3, file=tmp_path / "run.h5")
        monkeypatch.setattr(Rows, "__getitem__", counted)
        for _ in range(20):
            assert len(run.t) == steps + 1
        assert len(said(run)) == 1
        assert len(read) < 12


class TestDrift:
    def test_has_one_meaning(self):
        """By size at most, and at the end."""
        run = ancf.simulate(cantilever(9.81), t_end=0.5, step=2e-3)
        drift = run.energy.drift
        shown = f"at most {np.max(np.abs(drift)):.2g} (end {drift[-1]:.2g}) J"
        assert f"drift of the balance {shown}" in str(run)


class Recorded(NamedTuple):
    """A history with these energies, of a model that nobody knows any more."""

    t: np.ndarray
    energy: Energy
    provenance: dict

    @property
    def system(self):
        raise ModelError("file", "is of another version")


@pytest.mark.parametrize("height", [0.0, 1e5, -3e7])
@pytest.mark.parametrize("method", ["trapezoidal", "explicit", "generalized_alpha", "radau"])
@pytest.mark.parametrize("share", [0.1, 0.01, -0.01, -0.1])
def test_energy_that_does_not_add_up(height, method, share):
    """In parts of what is exchanged, wherever the origin is; methods that damp may lose some."""
    t = np.linspace(0.0, 1.0, 21)
    kinetic, none = 20.0 * np.sin(2 * np.pi * t) ** 2, 0.0 * t
    energy = Energy(kinetic, none, height - kinetic + 20.0 * share * t, none, none)
    known = Recorded(t, energy, {"settings": {"integrator": method}})
    exchanged = max(kinetic.max(), np.max(np.abs(energy.potential - height)))
    keeps = method in ("trapezoidal", "explicit")
    wanted = abs(share) > 0.02 and (share > 0.0 or keeps)
    found = accuracy.of_energy(known)
    assert len(found) == wanted
    for text in found:
        how = "came from nowhere" if share > 0.0 else "were lost"
        assert text.startswith(f"2 J {how} until t = 1 s, {100 * 2.0 / exchanged:.2g} % of the energy")


class TestRoom:
    def test_more_states_than_memory(self):
        with pytest.raises(ModelError, match=r"1e\+09 stored states take about 0\.\d+ TB") as caught:
            ancf.simulate(cantilever(), t_end=1e6, step=1e-3)
        assert "output_step=" in caught.value.hint
        assert "file=" in caught.value.hint

    def test_more_samples_than_memory(self, monkeypatch):
        monkeypatch.setattr(room, "memory_there", lambda: 1e5)
        monkeypatch.setattr(room, "ALWAYS", 1e4)
        given = {"t_end": 1.0, "step": 1e-3, "output_step": 0.5}
        with pytest.raises(
            ModelError, match=r"1e\+03 samples of the sensors take about 0\.\d+ MB, the memory has 0\.1 MB"
        ):
            ancf.simulate(cantilever(), **given, sensors=["beam.end"])
        assert ancf.simulate(cantilever(), **given).status == "complete"

    def test_a_file_needs_none(self, monkeypatch, tmp_path):
        monkeypatch.setattr(room, "memory_there", lambda: 1e3)
        run = ancf.simulate(cantilever(), t_end=0.1, step=1e-3, file=tmp_path / "run.h5")
        assert len(run.t) == 101

    def test_limits_of_a_container(self, monkeypatch, tmp_path):
        (tmp_path / "limit").write_text("5000000\n")
        (tmp_path / "none").write_text("max\n")
        monkeypatch.setattr(
            room, "LIMITS", (str(tmp_path / "limit"), str(tmp_path / "none"), str(tmp_path / "gone"))
        )
        assert room.memory_there() == 5e6

    def test_memory_that_is_full_within(self, monkeypatch):
        """What was computed until then goes with the error."""
        from ancf.results.store import MemoryStore

        append, count = MemoryStore.append, []

        def full(self, *arrays):
            if count:
                raise MemoryError
            count.append(1)
            append(self, *arrays)

        monkeypatch.setattr(MemoryStore, "append", full)
        with pytest.raises(ancf.SolveError, match=r"t = .* s: the memory is full") as caught:
            ancf.simulate(cantilever(), t_end=0.1, step=1e-3)
        assert caught.value.result.status == "failed"
        assert len(caught.value.result.t) >= 1


@pytest.mark.parametrize("at_once", [1, 100, 1_000_000])
@pytest.mark.parametrize("most", [4, 1000])
@pytest.mark.parametrize("states", [2, 3, 5, 8, 9, 40])
def test_pairs_of_rates_are_a_step_apart(states, most, at_once, monkeypatch):
    """However many are left out between them, and read at once; the first ones are always among them."""
    monkeypatch.setattr(resolution, "MOST", most)
    monkeypatch.setattr(resolution, "READ", at_once)
    rates = np.arange(3.0 * states).reshape(-1, 3)
    found = [(before[0] / 3, after[0] / 3) for before, after in resolution._pairs(rates, 3)]
    assert found[0] == (0, 1)
    assert all(after - before == 1 for before, after in found)
    firsts = np.array([before for before, _ in found])
    assert len(firsts) == min(states - 1, len(range(0, states - 1, -(-(states - 1) // most))))
    assert (np.diff(firsts) == np.diff(firsts)[:1]).all()
    assert len(firsts) <= most
