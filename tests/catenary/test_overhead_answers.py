"""What is read off a run beyond statistics: cycles, strain at clamps, acceptance, times above a force."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve

import catenary_stand_in as stand_in
from ancf import ModelError
from ancf.catenary import FatigueLine, Quantity, acceptance, clamp_strains, rainflow, time_above
from ancf.catenary.answers.acceptance import ARC, footnote, verdict
from ancf.catenary.answers.clamp_strain import edge, strain_below_strip, strain_of_force
from ancf.catenary.answers.statistics import statistics
from ancf.catenary.answers.write import write_cycles


@pytest.fixture(scope="module")
def run():
    return stand_in.run()


def of(run, **forces):
    """The run with other histories of its first pantograph."""
    return dataclasses.replace(run, recordings=[dataclasses.replace(run.recordings[0], **forces)])


def by_key(found):
    return {q.key: q for q in found}


class TestRainflow:
    def test_example_of_the_standard(self):
        """ASTM E1049-85, figure 6: what its table counts."""
        found = rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2])
        counted = {r: float(found.count[found.range == r].sum()) for r in np.unique(found.range)}
        assert counted == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}

    @pytest.mark.parametrize("number", [1, 3, 20])
    def test_a_sine(self, number):
        t = np.linspace(0.0, number, 200 * number + 1)
        found = rainflow(5.0 + 2.0 * np.cos(2 * np.pi * t))
        assert found.number(0.99 * 4.0) == pytest.approx(number)
        assert found.mean == pytest.approx(5.0)

    @pytest.mark.parametrize("seed", range(4))
    @pytest.mark.parametrize("size", [3, 30, 1000])
    def test_every_reversal_counts_once(self, seed, size):
        x = np.random.default_rng(seed).normal(size=size)
        found, other = rainflow(x), rainflow(-x)
        inner = np.diff(np.sign(np.diff(x))) != 0.0
        assert found.count.sum() == pytest.approx(0.5 * (inner.sum() + 1))
        assert found.largest == pytest.approx(np.ptp(x))
        assert np.sort(found.range) == pytest.approx(np.sort(other.range))
        assert sum(found.count * found.range) == pytest.approx(0.5 * np.abs(np.diff(x)).sum())

    def test_more_samples_between_reversals_change_nothing(self):
        x = np.array([0.0, 3.0, 1.0, 2.0, -1.0])
        fine = np.interp(np.linspace(0, 4, 401), np.arange(5.0), x)
        assert rainflow(fine).range == pytest.approx(rainflow(x).range)

    def test_constant(self):
        assert rainflow([2.0, 2.0]).largest == 0.0
        assert rainflow([2.0]).number() == 0.0

    @pytest.mark.parametrize("history", [[], [1.0, np.nan], [[1.0, 2.0]]])
    def test_wrong(self, history):
        with pytest.raises(ModelError, match=r"rainflow.history: must be a list of finite numbers"):
            rainflow(history)

    @pytest.mark.parametrize("slope", [3.0, 5.0])
    def test_damage(self, slope):
        """A million of the ranges that are borne a million times take the life; twice the range 2^m of it."""
        line = FatigueLine(range=100.0, cycles=1e6, slope=slope)
        block = np.tile([0.0, 100.0], 50)
        assert line.damage(rainflow(block)) == pytest.approx(49.5e-6)
        assert line.damage(rainflow(2.0 * block)) == pytest.approx(2.0**slope * 49.5e-6)
        with pytest.raises(ModelError, match=r"fatigue.slope: must be > 0"):
            FatigueLine(range=1.0, cycles=1.0, slope=0.0)


def bent(EI, pull, force):
    """Curvature below a force of a long beam under tension, by finite differences."""
    half, n = 60.0 * np.sqrt(EI / pull), 4001
    h = 2.0 * half / (n - 1)
    second = sparse.diags([1.0, -2.0, 1.0], [-1, 0, 1], shape=(n, n)) / h**2
    load = np.zeros(n)
    load[n // 2] = force / h
    w = spsolve((EI * second @ second - pull * second).tocsc(), load)
    return float(-(second @ w)[n // 2])


class TestClampStrain:
    @pytest.mark.parametrize(("EI", "tension"), [(195.0, 20e3), (60.0, 12e3), (300.0, 31e3)])
    @pytest.mark.parametrize("speed", [0.0, 60.0, 85.0])
    def test_of_a_force(self, EI, tension, speed):
        wire = SimpleNamespace(EA=15e6, EI=EI, mass=1.35, tension=tension, diameter=0.0148)
        found = bent(EI, tension - 1.35 * speed**2, 100.0)
        assert 100.0 * strain_of_force(wire, speed) == pytest.approx(0.0074 * found, rel=2e-3)

    def test_edge_of_a_round_bar(self):
        """EA = E pi r^2, EI = E pi r^4/4."""
        wire = stand_in.line().contact_wire
        wire.EA, wire.EI = 1e11 * np.pi * 0.007**2, 1e11 * np.pi * 0.007**4 / 4.0
        assert edge(wire) == pytest.approx(0.007)

    def test_a_filter_that_overshoots(self, run):
        """Behind a loss of contact the filtered force is below 0, which no strip does: a note says so."""
        position = run.recordings[0].position
        lost = of(run, force=np.where((position > 280.0) & (position < 300.0), 0.0, 200.0))
        found = statistics(lost)
        assert found["minimum"].value < 0.0
        assert "unfiltered smallest force is 0.0 N" in footnote(found)
        assert footnote(statistics(of(run, force=np.full(run.t.size, 100.0)))) == ""

    def test_above_the_wave_speed_it_is_endless(self):
        assert strain_of_force(stand_in.line().contact_wire, 130.0) == np.inf

    def test_history(self, run):
        """At rest and beside the strip the dropper alone, at the passing the contact force too."""
        found = clamp_strains(run)
        low, high = run.window
        assert [c.position for c in found] == [x for x in run.form.line.dropper_x if low <= x <= high]
        one, line = found[4], run.form.line
        wire = line.contact_wire
        j = int(np.flatnonzero(line.dropper_x == one.position)[0])
        assert one.rest == pytest.approx(run.form.dropper_load[j] * strain_of_force(wire))
        recording = run.recordings[0]
        at = np.interp(one.position, recording.position, run.t)
        dropper = np.interp(at, run.t, run.dropper_force[:, j]) * strain_of_force(wire)
        strip = np.interp(at, run.t, statistics(run).force) * strain_of_force(wire, run.speed)
        assert one.largest >= dropper + strip - 1e-12
        assert one.smallest == pytest.approx(0.0, abs=1e-9)  # slack, the strip far away
        assert one.cycles.largest == pytest.approx(one.largest - one.smallest)

    def test_the_strip_lasts_a_decimetre(self, run):
        """Without forces of droppers what is left is the strip at its passing, not where the samples are."""
        still = dataclasses.replace(run, dropper_force=np.zeros_like(run.dropper_force))
        steady = of(still, force=np.full(run.t.size, 100.0))
        for one in clamp_strains(steady):
            assert one.largest == pytest.approx(
                100.0 * strain_of_force(run.form.line.contact_wire, run.speed), rel=1e-9
            )
            assert one.cycles.number(0.5 * one.largest) == 1.0

    def test_two_wires_share_the_force(self, run):
        """At an overlap each wire is bent by what it gets."""
        n, split = run.t.size, np.array([80.0, 20.0])
        made = of(run, force=np.full(n, 100.0), by_wire=np.tile(split, (n, 1)))
        alone = run.form.shifted
        run.form.shifted = (*alone, *alone)
        try:
            found = strain_below_strip(made, 0)
        finally:
            run.form.shifted = alone
        assert found == pytest.approx(80.0 * strain_of_force(run.form.line.contact_wire, run.speed))

    def test_weight_of_the_clamp(self, run):
        still = of(run, force=np.zeros(run.t.size))
        droppers = run.form.line.droppers
        droppers.clamp_contact, droppers.mass = 0.2, 0.1
        try:
            heavy = clamp_strains(still)[0]
        finally:
            droppers.clamp_contact = droppers.mass = 0.0
        weight = 9.81 * (0.2 + 0.05 * 0.998)
        light = clamp_strains(still)[0]
        assert light.rest - heavy.rest == pytest.approx(weight * strain_of_force(run.form.line.contact_wire))

    def test_file(self, run, tmp_path):
        rows = write_cycles(run, tmp_path / "cycles.csv").read_text().splitlines()
        assert rows[0] == "quantity,span,dropper,position_m,range,mean,count"
        assert {row.split(",")[0] for row in rows[1:]} == {"force_N", "strain"}


class TestAcceptance:
    @pytest.mark.parametrize(
        ("kmh", "supply", "low", "high", "largest"),
        [
            (160.0, "AC", 72.0, 102.1, 300.0),  # 72.03, 102.03
            (250.0, "AC", 89.3, 130.7, 350.0),  # 89.4, 130.6
            (300.0, "AC", 102.3, 157.3, 350.0),  # 102.3, 157.3
            (199.0, "DC 3 kV", 128.0, 148.5, 300.0),  # 128.0, 148.4
            (220.0, "DC 3 kV", 136.4, 157.0, 400.0),  # 136.5, 156.9
            (199.0, "DC 1.5 kV", 114.3, 178.5, 300.0),  # 114.4, 178.4
        ],
    )
    def test_mean_force(self, kmh, supply, low, high, largest):
        """a v^2 + b of each supply by hand, to the next tenth of a newton outwards."""
        found = by_key(acceptance(stand_in.run(speed=kmh / 3.6), supply=supply))
        assert (found["mean_force"].low, found["mean_force"].high) == (low, high)
        assert found["maximum"].high == largest
        assert found["deviation"].high == pytest.approx(0.3 * found["mean_force"].value, abs=0.05)
        assert all(q.tag for q in found.values() if q.inside is not None)

    @pytest.mark.parametrize("off", [-1e-3, -1e-9, 0.0, 1e-12, 1e-9, 1e-3])
    def test_a_limit_of_speed_belongs_to_the_slower(self, off):
        """At 200 and 250 km/h, whatever the round-off of positions; 0.1 km/h more is of the faster."""
        for kmh, key, limits in ((200.0, "maximum", (300.0, 350.0)), (250.0, "arcing", (0.1, 0.2))):
            for more, limit in zip((0.0, 0.1), limits, strict=True):
                run = stand_in.run(speed=(kmh + more + off) / 3.6, count=2, spacing=100.0)
                assert [by_key(acceptance(run, k))[key].high for k in (0, 1)] == [limit, limit]

    def test_statistics_are_a_mapping(self, run):
        """Of quantities by their keys, in the order of the table."""
        found = statistics(run)
        assert list(found) == [q.key for q in found.quantities]
        assert tuple(found.values()) == found.quantities
        assert len(found) == len(found.quantities)
        assert all(key in found and found.get(key) is found[key] for key in found)
        assert all(key not in found for key in ("speeds", 0, None))
        with pytest.raises(KeyError, match="speeds"):
            found["speeds"]

    def test_verdict(self, run):
        """One sentence with value and limit of what is outside, also where they differ by little."""
        assert verdict([q for q in acceptance(run) if q.inside is not False]) == "inside all limits"
        near = Quantity("mean_force", "mean force Fm, AC", "N", 130.74, high=130.7)
        assert verdict([near]) == "outside: mean force Fm (130.74 > 130.7 N)"
        rows = [
            Quantity("mean_force", "mean force Fm, AC", "N", 70.0, low=78.8, high=108.8),
            Quantity("deviation", "standard deviation, at most 0.3 Fm", "N", 34.2, high=32.3),
            Quantity("minimum", "smallest force, below 20 Hz", "N", 1.0, low=0.0),
            Quantity("speed_ratio", "speed / wave speed", "", 0.9, high=0.7),
        ]
        wanted = "outside: mean force Fm (70.0 < 78.8 N), standard deviation (34.2 > 32.3 N)"
        assert verdict(rows) == f"{wanted}, speed / wave speed (0.900 > 0.700)"

    def test_verdict_names_each_row_that_misses(self, run):
        """Strains too, whose numbers are numpy's."""
        for row in acceptance(run):
            name = row.name.partition(",")[0]
            assert verdict([dataclasses.replace(row, high=0.99 * row.value - 0.1)]).startswith(
                f"outside: {name}"
            )
            assert verdict([dataclasses.replace(row, low=1.01 * row.value + 0.1)]).startswith(
                f"outside: {name}"
            )

    @pytest.mark.parametrize("mean", [80.03, 99.98, 114.16, 120.0, 131.149])
    @pytest.mark.parametrize("share", [0.2985, 0.29985, 0.29999, 0.3001, 0.302])
    def test_deviation_is_judged_once(self, run, mean, share):
        """The limit is 0.3 Fm, as that of sigma / Fm: no rounding turns one of both verdicts."""
        found = statistics(run)
        forces = {"mean_force": mean, "deviation": share * mean, "relative_deviation": share}
        rows = [dataclasses.replace(q, value=forces.get(q.key, q.value)) for q in found.quantities]
        given = dataclasses.replace(found, quantities=tuple(rows))
        inside = by_key(acceptance(run, found=given))["deviation"].inside
        assert inside == given["relative_deviation"].inside == (share <= 0.3)

    def test_above_the_wave_speed(self, tmp_path):
        """The closed form of the strain ends there: nothing is said of it, and all else is as it was."""
        fast = stand_in.run(speed=1.1 * np.sqrt(20e3 / 1.35), step=1e-3)
        keys = by_key(acceptance(fast)).keys()
        assert {"mean_force", "speed_ratio"} <= keys
        assert not {"strip_strain", "clamp_strain"} & keys
        assert clamp_strains(fast) == []
        rows = write_cycles(fast, tmp_path / "cycles.csv").read_text().splitlines()
        assert {row.split(",")[0] for row in rows[1:]} == {"force_N"}

    @pytest.mark.parametrize(("samples", "counted"), [(2, False), (3, True), (10, True)])
    def test_arcs_last_5_ms(self, run, samples, counted):
        """Steps of 2 ms: a loss of 4 ms is none."""
        force = np.full(run.t.size, 100.0)
        window = np.flatnonzero(
            (run.recordings[0].position > run.window[0]) & (run.recordings[0].position < run.window[1])
        )
        force[window[50] : window[50] + samples] = 0.0
        share = by_key(acceptance(of(run, force=force)))["arcing"].value
        assert share == pytest.approx(100.0 * samples / len(window) if counted else 0.0, rel=0.02)
        assert 2 * stand_in.STEP < ARC < 3 * stand_in.STEP

    def test_space_for_uplift(self, run):
        free = by_key(acceptance(run))
        assert free["uplift_space"].value == pytest.approx(2.0 * free["uplift"].value)
        assert free["uplift_space"].inside is None
        arm = run.form.line.steady_arm
        arm.uplift_stop = 0.07
        try:
            stopped = by_key(acceptance(run))["uplift_space"]
        finally:
            del arm.uplift_stop
        assert stopped.value == pytest.approx(1.5 * free["uplift"].value)
        assert (stopped.high, stopped.inside) == (70.0, False)

    def test_strain_below_the_strip(self, run):
        steady = by_key(acceptance(of(run, force=np.full(run.t.size, 120.0))))["strip_strain"]
        assert steady.value == pytest.approx(
            120e6 * strain_of_force(run.form.line.contact_wire, run.speed), rel=1e-6
        )
        assert steady.high == pytest.approx(500.0)

    def test_wrong_supply(self, run):
        with pytest.raises(ModelError, match=r"acceptance.supply"):
            acceptance(run, supply="AC 25 kV")


class TestTimeAbove:
    def test_of_a_sine(self, run):
        """A sine is above its mean plus a part r of its amplitude for acos(r)/pi of the time."""
        position = run.recordings[0].position
        force = 120.0 + 40.0 * np.sin(2 * np.pi * position / 60.0)
        found = time_above(of(run, force=force), (100.0, 120.0, 140.0, 170.0))
        expected = [100.0 * np.arccos(r) / np.pi for r in (-0.5, 0.0, 0.5, 1.0)]
        assert found == pytest.approx(expected, abs=0.3)

    @pytest.mark.parametrize("levels", [(), (np.nan,)])
    def test_wrong(self, run, levels):
        with pytest.raises(ModelError, match=r"time_above.levels"):
            time_above(run, levels)
