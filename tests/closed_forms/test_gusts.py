"""Gusts: spectrum and coherence of the tables, their values between the numbers, forces, refusals."""

import numpy as np
import pytest

import ancf
from ancf.batches import Batches
from ancf.compiled import kernel
from ancf.loads.gusts import gust_at, tables
from ancf.model.surroundings.gusts import spectrum
from ancf.system.core import residual
from ancf.system.system import System
from refusals import refused

WIND = {"speed": 12.0, "deviation": 2.0, "length": 60.0, "extent": [0.0, 40.0], "spacing": 10.0}
G = 9.81


@kernel
def ask(squall, gale, gust, t, x, y, z):
    return gust_at(squall, gale, gust, t, x, y, z)


def asked(gusts, t, r):
    model = ancf.Model()
    given = tables([model.add_fluid("air", 1.2, gusts=gusts)])
    return ask(given["squall"][0], given["gale"][0], given["gust"], t, *map(float, r))


class TestTable:
    @pytest.mark.parametrize(("speed", "length"), [(12.0, 60.0), (25.0, 120.0), (5.0, 20.0)])
    def test_spectrum(self, speed, length):
        """Stations without coherence are as many samples; von Karman's formula in each band."""
        more = {"decay": 1e9, "extent": [0.0, 3000.0], "duration": 400.0, "seed": 7}
        gusts = ancf.Gusts.von_karman(**WIND | {"speed": speed, "length": length} | more)
        n, count = gusts.table.shape
        assert (n, count) == (4000, 301)
        power = np.mean(np.abs(np.fft.rfft(gusts.table, axis=0)) ** 2, axis=1) * 2 * 400.0 / n**2
        f = np.arange(len(power)) / 400.0
        x = f * length / speed
        wanted = 4 * 4.0 * (length / speed) / (1 + 70.8 * x**2) ** (5 / 6)
        for band in np.array_split(np.arange(1, len(f) - 1), 40):
            assert power[band].mean() == pytest.approx(wanted[band].mean(), rel=0.06)
        assert np.allclose(spectrum(f, speed, 2.0, length), wanted)

    def test_the_spectrum_holds_the_deviation(self):
        f = np.geomspace(1e-7, 1e4, 400_001)
        assert np.trapezoid(spectrum(f, 12.0, 2.0, 60.0), f) == pytest.approx(4.0, rel=2e-3)

    @pytest.mark.parametrize("apart", [1, 3])
    def test_coherence(self, apart):
        cross = own = other = 0.0
        for seed in range(60):
            table = np.fft.rfft(ancf.Gusts(WIND | {"duration": 100.0, "seed": seed}).table, axis=0)
            a, b = table[:, 0], table[:, apart]
            cross, own, other = cross + a * b.conj(), own + np.abs(a) ** 2, other + np.abs(b) ** 2
        f = np.arange(len(own)) / 100.0
        for low in range(1, 60, 12):
            band = slice(low, low + 12)
            found = cross[band].sum().real / np.sqrt(own[band].sum() * other[band].sum())
            wanted = np.exp(-10.0 * f[band] * 10.0 * apart / 12.0)
            weight = spectrum(f[band], 12.0, 2.0, 60.0)
            assert found == pytest.approx(np.sum(weight * wanted) / np.sum(weight), abs=0.06)

    def test_seeds_and_no_decay(self):
        one, again, other = (ancf.Gusts(WIND | {"seed": seed}).table for seed in (1, 1, 2))
        assert np.array_equal(one, again)
        assert not np.any(one == other)
        together = ancf.Gusts(WIND | {"decay": 0.0}).table
        assert np.allclose(together, together[:, :1])


class TestValues:
    GUSTS = ancf.Gusts.von_karman(**WIND, line=(0.6, 0.8, 0.0), step=0.5, duration=60.0)

    @pytest.mark.parametrize("j", [0, 1, 57, 119, 120, 241])
    def test_numbers_of_the_table(self, j):
        """At its times and stations, periodic in time."""
        for k, s in enumerate(self.GUSTS.stations):
            value, _ = asked(self.GUSTS, 0.5 * j, (0.6 * s, 0.8 * s, 7.0))
            assert value == pytest.approx(self.GUSTS.table[j % 120, k], abs=1e-12)

    def test_linear_between_stations_and_level_outside(self):
        t = 13.0
        a, b, middle = (asked(self.GUSTS, t, (0.6 * s, 0.8 * s, 0.0))[0] for s in (10.0, 20.0, 13.0))
        assert middle == pytest.approx(0.7 * a + 0.3 * b, abs=1e-12)
        assert asked(self.GUSTS, t, (-60, -80, 0))[0] == asked(self.GUSTS, t, (0, 0, 0))[0]
        last = asked(self.GUSTS, t, (24.0, 32.0, 0))[0]
        assert asked(self.GUSTS, t, (600, 800, 0))[0] == pytest.approx(last, abs=1e-12)

    @pytest.mark.parametrize("ramp", [0.0, 20.0])
    @pytest.mark.parametrize("t", [0.7, 3.21, 11.9, 59.9])
    def test_rate_is_the_derivative(self, ramp, t):
        gusts, e = ancf.Gusts(self.GUSTS.given | {"ramp": ramp}), 1e-5
        r = (3.0, 9.0, 0.0)
        slope = (asked(gusts, t + e, r)[0] - asked(gusts, t - e, r)[0]) / (2 * e)
        assert asked(gusts, t, r)[1] == pytest.approx(slope, abs=1e-6)

    def test_they_grow(self):
        gusts, r = ancf.Gusts(self.GUSTS.given | {"ramp": 10.0}), (3.0, 9.0, 0.0)
        assert asked(gusts, 0.0, r) == (0.0, 0.0)
        assert asked(gusts, 5.0, r)[0] == pytest.approx(0.5 * asked(self.GUSTS, 5.0, r)[0], rel=1e-12)
        assert asked(gusts, 10.0, r)[0] == asked(self.GUSTS, 10.0, r)[0]


class TestForces:
    def test_drag_of_a_wire_in_a_gust(self):
        """Each short rod has the force of the speed at its place, with the mean wind added."""
        section = ancf.Section(
            EA=1e6, EI=1.0, rhoA=1.0, diameter=0.03, drag=(1.1, 0.0), added_mass=(1.0, 0.0)
        )
        gusts, t = ancf.Gusts(WIND | {"direction": 0.5, "duration": 50.0}), 17.3
        wind = 12.0 * np.array([np.cos(0.5), np.sin(0.5), 0.0])
        for y in (2.0, 13.0, 37.0):
            model = ancf.Model()
            model.add_fluid("air", 1.2, velocity=wind.tolist(), gusts=gusts)
            model.add_beam("rod", start=(0, y, 5), end=(0, y + 0.01, 5), elements=1, section=section)
            system = System(model)
            q, v = system.initial_state(t)
            system.place(t, q, np.zeros_like(q), np.zeros_like(q))
            f = np.zeros(system.size)
            residual(Batches((system.parts["fluid"],)), system.core.ws, q, v, v, np.zeros(system.size), f)
            slots = system.slots["rod"][:, 0]
            found = -np.array([f[slots + c].sum() for c in range(3)]) / 0.01
            value, rate = asked(gusts, t, (0, y + 0.005, 5))
            to = np.array([np.cos(0.5), np.sin(0.5), 0.0])
            past, change = wind + value * to, rate * to
            past[1] = change[1] = 0.0  # along the rod
            area = np.pi * 0.03**2 / 4
            wanted = 0.6 * 0.03 * 1.1 * np.linalg.norm(past) * past + 1.2 * area * 2.0 * change
            # Froude and Krylov act along the rod too
            wanted[1] = 1.2 * area * rate * to[1]
            assert np.allclose(found, wanted, rtol=1e-6, atol=1e-9)

    def test_run_is_continued_with_the_same_bits_and_has_order_two(self, tmp_path):
        section = ancf.Section(EA=1e5, EI=1.0, rhoA=0.5, diameter=0.02, drag=(1.1, 0.0))
        model = ancf.Model(gravity=(0, 0, -G))
        gusts = ancf.Gusts(WIND | {"step": 0.5, "duration": 50.0})
        model.add_fluid("air", 1.2, velocity=(12.0, 0, 0), gusts=gusts)
        wire = model.add_beam(
            "wire", start=(0, 0, 10), end=(0, 40, 10), elements=8, length=40.2, section=section
        )
        model.pin(wire.start)
        model.pin(wire.end)
        start, middle = ancf.equilibrium(model), wire.at(20.0)

        def run(step, **more):
            return ancf.simulate(model, t_end=4.0, step=step, start=start, **more)

        ends = [run(step).position(middle)[-1] for step in (0.02, 0.01, 0.005, 0.0025)]
        gaps = np.linalg.norm(np.diff(ends, axis=0), axis=1)
        assert np.log2(gaps[:-1] / gaps[1:]) == pytest.approx([2, 2], abs=0.3)
        ancf.simulate(model, t_end=1.3, step=0.02, start=start, file=tmp_path / "a.h5")
        again = ancf.resume(tmp_path / "a.h5", t_end=4.0)
        assert np.array_equal(again.position(middle), run(0.02).position(middle))


@pytest.mark.parametrize(
    ("change", "where", "what"),
    [
        ({"speed": 0.0}, ".speed", "> 0"),
        ({"deviation": -1.0}, ".deviation", "0"),
        ({"length": "60"}, ".length", "number"),
        ({"extent": [40.0, 0.0]}, ".extent", "must grow"),
        ({"extent": [0.0]}, ".extent", "2"),
        ({"line": [0, 0, 0]}, ".line", ""),
        ({"duration": 0.5}, ".duration", "multiple of step"),
        ({"duration": 60.03}, ".duration", "multiple of step"),
        ({"seed": -1}, ".seed", "0"),
        ({"sped": 1.0}, ".sped", '"speed"'),
        ({"spacing": 1e-3, "duration": 6000.0}, "", "too many"),
    ],
)
def test_refusals(change, where, what):
    refused(f'add_fluid("air").gusts{where}', what, ancf.Model().add_fluid, "air", 1.2, gusts=WIND | change)


def test_what_is_missing_and_what_is_none():
    for key in ("speed", "deviation", "length", "extent"):
        given = {k: x for k, x in WIND.items() if k != key}
        with pytest.raises(ancf.ModelError, match=rf"{key}: is missing"):
            ancf.Gusts(given)
    with pytest.raises(ancf.ModelError, match=r"must be ancf\.Gusts or a table"):
        ancf.Gusts(3.0)


def test_is_kept_by_descriptions():
    model = ancf.Model()
    model.add_fluid("air", 1.2, gusts=ancf.Gusts.von_karman(**WIND, seed=9, line=np.array([0, 1.0, 0])))
    again = ancf.Model.from_dict(model.to_dict())
    assert np.array_equal(again.fluids[0].gusts.table, model.fluids[0].gusts.table)
    assert "gusts of 2 m/s" in str(model)
