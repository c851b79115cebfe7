"""Pantographs from measured frequency responses, and measuring pantographs, against closed forms."""

import dataclasses
import importlib
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

import catenary_stand_in as stand_in
from ancf import ModelError
from ancf.catenary import (
    MeasuringHead,
    Pantograph,
    dynamic_stiffness,
    find_pantograph,
    identify_pantograph,
    measure,
    pantographs,
    read_measuring_head,
)
from ancf.catenary.vehicles.identify import _slopes
from ancf.catenary.vehicles.response_file import read_response
from ancf.cli.app import app

run_module = importlib.import_module("ancf.catenary.run")
FREQUENCY = np.linspace(0.25, 20.0, 80)  # Hz


def chain(seed, count=3):
    """A chain with values as pantographs have them."""
    rng = np.random.default_rng(seed)
    stiffness = [rng.uniform(50, 400), *rng.uniform(4e3, 2e4, count - 1)]
    return Pantograph(
        masses=tuple(rng.uniform(4, 16, count)),
        stiffness=tuple(stiffness),
        damping=(rng.uniform(50, 150), *rng.uniform(10, 80, count - 1)),
        static_force=70.0,
    )


def by_matrices(unit, frequency):
    """Dynamic stiffness at the head from the matrices of the whole chain."""
    n = len(unit.masses)
    below = np.eye(n) - np.eye(n, k=-1)
    K, C = (below.T @ np.diag(values) @ below for values in (unit.stiffness, unit.damping))
    found = []
    for w in 2 * np.pi * np.asarray(frequency):
        found.append(1.0 / np.linalg.inv(K + 1j * w * C - w**2 * np.diag(unit.masses))[-1, -1])
    return np.array(found)


class TestIdentify:
    @pytest.mark.parametrize("count", [1, 2, 3, 4])
    def test_dynamic_stiffness(self, count):
        unit = chain(count, count)
        assert dynamic_stiffness(unit, FREQUENCY) == pytest.approx(by_matrices(unit, FREQUENCY), rel=1e-9)

    @pytest.mark.parametrize("count", [1, 2, 3, 4])
    def test_slopes_of_the_fit(self, count):
        """By the logarithm of each mass, stiffness and damping, against differences of the matrices."""
        unit, change = chain(count + 10, count), 1e-5
        values = [unit.masses, unit.stiffness, unit.damping]
        found = _slopes(*map(np.array, values), 2 * np.pi * FREQUENCY)

        def answer(k, by):
            moved = np.concatenate(values)
            moved[k] *= np.exp(by)
            names = ("masses", "stiffness", "damping")
            parts = dict(zip(names, map(tuple, moved.reshape(3, count)), strict=True))
            return by_matrices(dataclasses.replace(unit, **parts), FREQUENCY)

        for k in range(3 * count):
            wanted = (answer(k, change) - answer(k, -change)) / (2.0 * change)
            assert np.abs(found[:, k] - wanted).max() < 1e-7 * np.abs(found).max()

    @pytest.mark.parametrize("name", ["en50318-2002", "benchmark-2015", "dsa380"])
    def test_known_pantographs(self, name):
        unit = pantographs()[name]
        found = identify_pantograph(FREQUENCY, by_matrices(unit, FREQUENCY), kind="dynamic_stiffness")
        assert found.largest <= 0.02
        assert found.error == pytest.approx(
            np.sqrt(np.mean(np.abs(by_matrices(found.pantograph, FREQUENCY) / found.measured - 1.0) ** 2))
        )
        exact = identify_pantograph(
            FREQUENCY, found.measured, kind="dynamic_stiffness", masses=len(unit.masses)
        )
        assert exact.error < 1e-3
        assert exact.pantograph.masses == pytest.approx(unit.masses, rel=2e-3)

    @pytest.mark.parametrize("seed", range(4))
    def test_noise(self, seed):
        """Of 1 % noise less than 2 % is left in the whole band, against the chain that was measured."""
        unit, rng = chain(seed), np.random.default_rng(seed + 100)
        true = by_matrices(unit, FREQUENCY)
        noise = rng.normal(size=(2, FREQUENCY.size)) / np.sqrt(2.0)
        found = identify_pantograph(
            FREQUENCY, true * (1.0 + 0.01 * (noise[0] + 1j * noise[1])), kind="dynamic_stiffness", masses=3
        )
        assert np.abs(found.fitted / true - 1.0).max() < 0.02
        assert 0.005 < found.error < 0.013

    @pytest.mark.parametrize("seed", [2, 5, 7])
    def test_noise_makes_no_masses(self, seed):
        """A chain of three measured with 2.5 % noise is one of three, by which it is 2.5 % off."""
        unit, rng = chain(seed), np.random.default_rng(seed)
        true = by_matrices(unit, FREQUENCY) * np.exp(rng.normal(size=FREQUENCY.size) * 0.025)
        found = identify_pantograph(FREQUENCY, true, kind="dynamic_stiffness")
        assert len(found.pantograph.masses) == 3
        assert found.error == pytest.approx(0.025, rel=0.25)
        assert found.pantograph.masses == pytest.approx(unit.masses, rel=0.15)

    def test_another_kind(self):
        """An apparent mass that is read as a receptance: who reads it is told."""
        unit = pantographs()["benchmark-2015"]
        response = by_matrices(unit, FREQUENCY) / (2j * np.pi * FREQUENCY) ** 2
        with pytest.warns(UserWarning, match=r"off in the mean|none of a pantograph") as caught:
            found = identify_pantograph(FREQUENCY, response, kind="accelerance")
        assert found.error > 0.1
        assert any(
            'as kind "apparent_mass"' in str(one.message) and 'is "accelerance"' in str(one.message)
            for one in caught
        )

    @pytest.mark.parametrize(
        ("kind", "power", "inverse"),
        [
            ("apparent_mass", 2, False),
            ("impedance", 1, False),
            ("accelerance", 2, True),
            ("mobility", 1, True),
            ("receptance", 0, True),
        ],
    )
    def test_kinds(self, kind, power, inverse):
        unit = pantographs()["en50318-2002"]
        response = by_matrices(unit, FREQUENCY) / (2j * np.pi * FREQUENCY) ** power
        order = np.random.default_rng(0).permutation(FREQUENCY.size)
        given = (1.0 / response if inverse else response)[order]
        found = identify_pantograph(FREQUENCY[order], given, kind=kind)
        assert found.pantograph.masses == pytest.approx(unit.masses, rel=1e-6)
        assert found.pantograph.damping == pytest.approx(unit.damping, rel=1e-6)

    def test_a_chain_that_is_too_short_says_so(self):
        measured = by_matrices(pantographs()["benchmark-2015"], FREQUENCY)
        with pytest.warns(UserWarning, match="off in the mean, above 10 %"):
            found = identify_pantograph(FREQUENCY, measured, kind="dynamic_stiffness", masses=1)
        assert found.error > 0.1
        assert found.largest >= found.error
        best = identify_pantograph(FREQUENCY, measured, kind="dynamic_stiffness", tolerance=1e-3)
        assert len(best.pantograph.masses) == 3

    @pytest.mark.parametrize(
        ("frequency", "response", "more", "said"),
        [
            ([1.0, 2.0], [1.0], {}, r"response: has the shape \(1,\)"),
            ([0.0, 2.0, 3.0], [1.0, 1.0, 1.0], {}, r"frequency\[0\]: is 0"),
            ([1.0, 2.0, 3.0], [1.0, np.nan, 1.0], {}, r"response\[1\]: is nan"),
            ([1.0, 2.0, 3.0], [1.0, 1.0, 1.0], {"kind": "inertance"}, r"kind"),
            ([1.0, 2.0, 3.0], [1.0, 1.0, 1.0], {"masses": 9}, r"masses"),
            ([1.0, 2.0, 3.0], [1.0, 1.0, 1.0], {"masses": 3}, r"has 3 values, too few"),
        ],
    )
    def test_wrong(self, frequency, response, more, said):
        with pytest.raises(ModelError, match=said):
            identify_pantograph(frequency, response, **more)


#: Height of the made-up strip: 22 mm over 60 m.
AMPLITUDE, SPEED = 0.022, 250 / 3.6
CIRCULAR = 2 * np.pi * SPEED / 60.0


@pytest.fixture(scope="module")
def run():
    """A run with a constant contact force; the strip follows a cosine."""
    made = stand_in.run(step=1e-3)
    steady = dataclasses.replace(made.recordings[0], force=np.full(made.t.size, 120.0))
    return dataclasses.replace(made, recordings=[steady])


class TestMeasure:
    def test_without_errors_it_is_the_true_force(self, run):
        made = stand_in.run(step=1e-3)
        found = measure(made)
        assert found.largest_error < 1e-9
        assert np.ptp(found.true[found.window]) > 50.0

    @pytest.mark.parametrize("mass", [4.0, 7.2])
    @pytest.mark.parametrize("corrected", [0.0, 0.5, 1.2])
    def test_inertia(self, run, mass, corrected):
        """What is not corrected of the inertia of a head that moves as a cosine: m A w^2/sqrt(2)."""
        found = measure(run, head=MeasuringHead(mass=mass, corrected_mass=corrected * mass))
        expected = abs(1.0 - corrected) * mass * AMPLITUDE * CIRCULAR**2 / np.sqrt(2.0)
        assert np.std(found.error) == pytest.approx(expected, rel=5e-3)
        assert found.deviation_error == pytest.approx(expected, rel=5e-3)

    @pytest.mark.parametrize("delay", [0.005, 0.02])
    def test_delay(self, run, delay):
        """cos(wt) less cos(w(t - d)) has the amplitude 2 sin(wd/2)."""
        found = measure(run, head=MeasuringHead(delay=delay))
        amplitude = 7.2 * AMPLITUDE * CIRCULAR**2 * 2.0 * np.sin(0.5 * CIRCULAR * delay)
        assert np.std(found.error) == pytest.approx(amplitude / np.sqrt(2.0), rel=1e-2)

    @pytest.mark.parametrize("rate", [200.0, 500.0, 1000.0])
    def test_noise(self, run, rate):
        """Of white noise a low pass leaves the share of its band."""
        errors = [
            np.std(measure(run, head=MeasuringHead(force_noise=10.0, rate=rate, seed=seed)).error)
            for seed in range(12)
        ]
        assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(10.0 * np.sqrt(40.0 / rate), rel=0.12)

    def test_a_slow_accelerometer(self, run):
        """A low pass of second order at f0 is late by sqrt(2)/w0 far below f0."""
        slow = measure(run, head=MeasuringHead(acceleration_band=40.0))
        late = measure(run, head=MeasuringHead(delay=np.sqrt(2.0) / (2 * np.pi * 40.0)))
        assert np.std(slow.error) == pytest.approx(np.std(late.error), rel=0.05)

    def test_wind_on_the_head(self, run):
        """It is known and corrected, whatever its size."""
        unit = SimpleNamespace(masses=(15.0, 7.2), aerodynamics=(0.0, 0.01))
        assert measure(dataclasses.replace(run, pantographs=[unit])).largest_error < 1e-9

    @pytest.mark.parametrize(
        ("head", "said"),
        [
            ({"rate": 100.0}, r"measuring.rate: .*0.694 m apart, at most 0.4 m"),
            ({"rate": 2000.0}, r"measuring.rate: is 2000 Hz, the run has 1000"),
            ({"force_band": 600.0}, r"measuring.force_band: .*below 500 Hz"),
            ({"mass": -1.0}, r"measuring.mass"),
            ({"force_noise": np.nan}, r"measuring.force_noise"),
            ({"seed": -1}, r"measuring.seed"),
        ],
    )
    def test_wrong(self, run, head, said):
        with pytest.raises(ModelError, match=said):
            measure(run, head=MeasuringHead(**head))


class TestCommand:
    """ancf catenary identify: a table of a response becomes a pantograph file."""

    def given(self, path, polar):
        unit, frequency = pantographs()["benchmark-2015"], np.linspace(0.5, 20.0, 30)
        response = by_matrices(unit, frequency)
        head, columns = "frequency,real,imag", (response.real, response.imag)
        if polar:
            head = "frequency,magnitude,phase_deg"
            columns = (np.abs(response), np.degrees(np.angle(response)))
        rows = (",".join(f"{value:.9g}" for value in row) for row in zip(frequency, *columns, strict=True))
        path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
        return unit

    @pytest.mark.parametrize("polar", [False, True])
    def test_writes_what_was_measured(self, tmp_path, polar):
        unit, file = self.given(tmp_path / "r.csv", polar), tmp_path / "mine.toml"
        options = ["--kind", "dynamic_stiffness", "--static-force", "70", "-o", str(file)]
        done = CliRunner().invoke(app, ["catenary", "identify", str(tmp_path / "r.csv"), *options])
        assert done.exit_code == 0, done.output
        assert "relative error of the response" in done.output
        found = find_pantograph(file)
        assert found.masses == pytest.approx(unit.masses, rel=1e-3)
        assert found.stiffness == pytest.approx(unit.stiffness, rel=1e-3)
        assert found.static_force == 70.0
        assert "force: 70 N at every speed" in done.output
        again = CliRunner().invoke(
            app, ["catenary", "identify", str(tmp_path / "r.csv"), *options, "--aerodynamic", "0.01"]
        )
        assert find_pantograph(file).force(50.0) == pytest.approx(70.0 + 0.01 * 2500.0)
        assert "70 N at standstill, 118.2 N at 250 km/h" in again.output

    @pytest.mark.parametrize(
        ("polar", "head", "scale"),
        [
            (False, "frequency [kHz],real [kN/m],imag [kN/m]", (1e-3, 1e-3, 1e-3)),
            (True, "frequency [Hz],magnitude [N/m],phase [deg]", (1.0, 1.0, 1.0)),
            (True, "frequency (Hz),magnitude (kN/m),phase (rad)", (1.0, 1e-3, np.pi / 180.0)),
        ],
    )
    def test_units_of_heads(self, tmp_path, polar, head, scale):
        self.given(tmp_path / "plain.csv", polar)
        rows = np.loadtxt(tmp_path / "plain.csv", delimiter=",", skiprows=1)
        np.savetxt(tmp_path / "units.csv", rows * scale, delimiter=",", header=head, comments="", fmt="%.12g")
        plain, with_units = (read_response(tmp_path / name) for name in ("plain.csv", "units.csv"))
        for one, other in zip(plain, with_units, strict=True):
            assert other == pytest.approx(one, rel=1e-9)

    def test_one_row(self, tmp_path):
        (tmp_path / "r.csv").write_text("frequency,real,imag\n1,2,3\n", encoding="utf-8")
        done = CliRunner().invoke(app, ["catenary", "identify", str(tmp_path / "r.csv"), "-o", "p.toml"])
        assert done.exit_code == 2
        assert "has one frequency" in done.output

    @pytest.mark.parametrize(
        ("old", "new", "said"),
        [
            ("frequency,real", "frequency [furlong],real", "is 'furlong', known are"),
            ("frequency,", "f,", "column frequency: is missing"),
            ("imag", "im", "column imag: is missing"),
            ("\n0.5,", "\nhalf,", 'row 1, column frequency: is "half", must be a number'),
        ],
    )
    def test_wrong(self, tmp_path, old, new, said):
        path = tmp_path / "r.csv"
        self.given(path, polar=False)
        path.write_text(path.read_text().replace(old, new, 1))
        done = CliRunner().invoke(app, ["catenary", "identify", str(path), "-o", str(tmp_path / "p.toml")])
        assert done.exit_code == 2
        assert said in " ".join(done.output.split())


class TestFile:
    """A measuring pantograph as a file, and ancf catenary run --measure."""

    def test_keys(self, tmp_path):
        file = tmp_path / "head.toml"
        file.write_text("corrected_mass = 5.0\nacceleration_band = 50\nrate = 500.0\nseed = 3\n")
        assert read_measuring_head(file) == MeasuringHead(
            corrected_mass=5.0, acceleration_band=50.0, rate=500.0, seed=3
        )

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("corected_mass = 5.0", "corected_mass"),
            ("force_noise = -1.0", "force_noise"),
            ('rate = "fast"', "rate"),
            ("seed = 5_000_000_000", "seed"),
        ],
    )
    def test_wrong(self, tmp_path, text, said):
        file = tmp_path / "head.toml"
        file.write_text(text)
        with pytest.raises(ModelError, match=rf"head.toml.*{said}"):
            read_measuring_head(file)

    def test_command(self, run, tmp_path, monkeypatch):
        """What is written and shown is what measure says; the true force stands beside it."""
        monkeypatch.setattr(run_module, "run", lambda line, **given: run)
        file = tmp_path / "head.toml"
        file.write_text("corrected_mass = 0.0\n")
        options = ["--speed", "250", "--measure", str(file), "-o", str(tmp_path / "out")]
        done = CliRunner().invoke(
            app, ["catenary", "run", "en50318-2002", *options, "--no-states", "--no-report"]
        )
        assert done.exit_code == 0, done.output
        found = measure(run, head=MeasuringHead(corrected_mass=0.0))
        written = np.loadtxt(tmp_path / "out" / "measured_1.csv", delimiter=",", skiprows=1)
        for column, wanted in zip(written.T, (found.t, found.position, found.force, found.true), strict=True):
            assert column == pytest.approx(wanted, rel=1e-8, abs=1e-8)
        deviation = float(np.std(found.force[found.window]))
        assert f"measured: standard deviation 0-20 Hz {deviation:.1f} N" in done.output

    def test_wrong_rate_is_said_before_the_run(self, tmp_path, monkeypatch):
        monkeypatch.setattr(run_module, "run", None)
        file = tmp_path / "head.toml"
        file.write_text("rate = 2000.0\n")
        options = ["--speed", "250", "--measure", str(file), "-o", str(tmp_path / "out")]
        done = CliRunner().invoke(app, ["catenary", "run", "en50318-2002", *options])
        assert done.exit_code == 2
        assert "measuring.rate: is 2000 Hz, the run has 1000" in " ".join(done.output.split())
