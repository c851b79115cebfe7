"""Pantographs with curves, friction, stops, two strips, a moving roof under a rigid wire, against scipy."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ancf
from ancf import catenary
from ancf.catenary.collectors import Touch, put_pantograph
from ancf.catenary.underside import checked_underside, profiles, read_underside
from ancf.catenary.vehicles.roof import Track, roofs
from ancf.catenary.vehicles.travel import make_travel
from ancf.errors import ModelError

SPEED, SECONDS, STIFF = 20.0, 0.5, 50e3  # m/s, s, N/m
BEFORE = -1e-9  # s, the roof rests
PLAIN = catenary.Pantograph(
    masses=(15.0, 7.2), stiffness=(400.0, 4200.0), damping=(90.0, 10.0), static_force=100.0, name="plain"
)
#: Waves of the underside as a strip meets them: depth in m, wave number in 1/m.
DEPTH, WAVE = 4e-4, 2.0 * np.pi / 2.5
ROOF = (0.01, 2.0 * np.pi * 2.2)  # m, rad/s


def wavy(x):
    """Height of the underside above that of a new wire, m."""
    return DEPTH * (1.0 - np.cos(WAVE * x))


UNDERSIDE = np.column_stack([np.linspace(0.0, 14.0, 5601), wavy(np.linspace(0.0, 14.0, 5601))])


def computed(unit, roof=None, underside=False, seconds=SECONDS):
    """Contact forces (n, strips) over times (n,) under a wire that does not give way."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e10, EI=1e10, rhoA=1.0)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(14, 0, 0), elements=7, section=section)
    for x in np.linspace(0.0, 14.0, 8):
        model.pin(wire.at(x))
    rows = [np.column_stack([UNDERSIDE[:, 0], -UNDERSIDE[:, 1]])] if underside else None
    made = put_pantograph(
        model,
        [wire],
        unit,
        make_travel(SPEED),
        label="pantograph",
        start=1.0,
        height=unit.static_force / STIFF,
        raised=0.0,
        touch=Touch(stiffness=STIFF),
        roof=roofs(roof, 1)[0],
        profiles=rows,
    )
    start = ancf.equilibrium(model)
    result = ancf.simulate(model, t_end=seconds, step=1e-4, start=start, sensors=made.meters, energy=False)
    sensors = result.sensors
    return sensors.t, np.stack([sensors.contact_force(meter) for meter in made.meters], axis=1)


def curve(given, x):
    """A number times x, or a curve that goes straight on."""
    if not isinstance(given, tuple):
        return given * x
    place, force = np.array(given).T
    k = int(np.clip(np.searchsorted(place, x, side="right") - 1, 0, len(place) - 2))
    return force[k] + (force[k + 1] - force[k]) / (place[k + 1] - place[k]) * (x - place[k])


def expected(unit, t, roof=(0.0, 0.0), waves=0.0):
    """The same by an independent program; places count upwards from the state with relaxed springs."""
    half = 0.5 * unit.strip_distance
    strips = (half, -half) if half else (0.0,)
    low, share = len(unit.masses) - 1, 1.0 / len(strips)
    mass = np.array([*unit.masses[:-1], *[share * unit.masses[-1]] * len(strips)])
    friction = unit.friction or (0.0,) * len(unit.masses)
    stops = unit.stops or (None,) * len(unit.masses)

    def between(k, elongation, rate, part):
        force = curve(unit.stiffness[k], elongation) + curve(unit.damping[k], rate)
        force += friction[k] * np.tanh(rate / 0.01)
        if stops[k]:
            short, far = stops[k]
            force += unit.stop_stiffness * (min(elongation - short, 0.0) + max(elongation - far, 0.0))
        return part * force

    def forces(t, y):
        z, v = y[: len(mass)], y[len(mass) :]
        size, rate = roof
        floor = size * np.sin(rate * max(t, 0.0)), size * rate * np.cos(rate * t) * (t >= 0.0)
        total = np.zeros(len(mass))
        total[0] += unit.static_force * (1.0 if low else share)
        for k in range(len(unit.masses)):
            tops = [k] if k < low else range(low, len(mass))
            below = floor if k == 0 else (z[k - 1], v[k - 1])
            for i in tops:
                part = 1.0 if k < low else share
                force = between(k, z[i] - below[0], v[i] - below[1], part)
                total[i] -= force
                if k:
                    total[k - 1] += force
        touch = []
        for i, s in enumerate(strips):
            x = 1.0 + s + SPEED * t
            under = waves * DEPTH * (1.0 - np.cos(WAVE * x))
            touch.append(max(STIFF * (z[low + i] - gap - under), 0.0))
            total[low + i] -= touch[-1]
        return total / mass, touch

    gap = 0.0
    carried = unit.static_force  # where the spring of the head has to push with the static force
    elongation = 0.0
    if low:
        for _ in range(200):
            elongation -= (between(1, elongation, 0.0, 1.0) + carried) / 8000.0
    # at the start the lowest spring is relaxed with the strip on the new wire
    first = np.zeros(len(mass))
    if low:
        first[low:] = elongation
        gap = elongation - carried / STIFF
    else:
        gap = -carried / STIFF
    settled = solve_ivp(
        lambda _, y: np.concatenate([y[len(mass) :], forces(BEFORE, y)[0] - 60.0 * y[len(mass) :]]),
        (0.0, 8.0),
        np.concatenate([first, 0.0 * mass]),
        method="Radau",
        rtol=1e-9,
        atol=1e-11,
    ).y[: len(mass), -1]
    begun = np.concatenate([settled, 0.0 * mass])
    found = solve_ivp(
        lambda t, y: np.concatenate([y[len(mass) :], forces(t, y)[0]]),
        (0.0, t[-1]),
        begun,
        t_eval=t,
        rtol=1e-9,
        atol=1e-11,
        max_step=2e-4,
    )
    return np.array([forces(time, y)[1] for time, y in zip(found.t, found.y.T, strict=True)])


SOFT_THEN_HARD = ((-0.06, -500.0), (-0.02, -60.0), (0.0, 0.0), (0.05, 300.0))
ONE_WAY = ((-0.5, -2.0), (0.0, 0.0), (0.5, 80.0))
CASES = {
    "curve of the head": replace(PLAIN, stiffness=(400.0, SOFT_THEN_HARD)),
    "damper of one direction": replace(PLAIN, damping=(90.0, ONE_WAY)),
    "friction": replace(PLAIN, friction=(4.0, 1.0)),
    "stops": replace(PLAIN, stops=(None, (-0.0245, 0.01)), stop_stiffness=4e4),
    "stops beside a curve": replace(
        PLAIN, stiffness=(400.0, SOFT_THEN_HARD), stops=(None, (-0.026, 0.01)), stop_stiffness=4e4
    ),
    "two strips": replace(PLAIN, strip_distance=0.6),
    "two strips on curves": replace(
        PLAIN, strip_distance=0.6, stiffness=(400.0, SOFT_THEN_HARD), friction=(0.0, 2.0)
    ),
    "one mass": replace(PLAIN, masses=(9.0,), stiffness=(400.0,), damping=(60.0,)),
}


class TestAgainstScipy:
    @pytest.mark.parametrize("name", CASES)
    def test_waves_of_the_underside(self, name):
        unit = CASES[name]
        t, force = computed(unit, underside=True)
        told = expected(unit, t, waves=1.0)
        assert np.ptp(told) > 10.0
        assert force == pytest.approx(told, abs=0.01 * np.ptp(told))

    def test_each_case_is_another_one(self):
        """The features matter at the size of these waves."""
        t = np.linspace(0.0, 0.5 * SECONDS, 150)
        plain = expected(PLAIN, t, waves=1.0).sum(axis=1)
        for name, unit in CASES.items():
            differs = np.abs(expected(unit, t, waves=1.0).sum(axis=1) - plain).max()
            assert differs > 0.03 * np.ptp(plain), name

    @pytest.mark.parametrize("given", ["0.01*sin(2*pi*2.2*t)", lambda t: 0.01 * np.sin(2 * np.pi * 2.2 * t)])
    def test_roof(self, given):
        t, force = computed(PLAIN, roof=given, seconds=0.3)
        told = expected(PLAIN, t, roof=ROOF)
        assert np.ptp(told) > 5.0
        assert force == pytest.approx(told, abs=0.01 * np.ptp(told))

    def test_roof_of_a_file(self, tmp_path):
        """Millimetres by the head, and a sway, which does not change the force of a straight wire."""
        t = np.linspace(0.0, 0.5, 251)
        rows = np.column_stack([t, 1e3 * ROOF[0] * np.sin(ROOF[1] * t), 20.0 * np.sin(3.0 * t)])
        path = tmp_path / "roof.csv"
        np.savetxt(path, rows, delimiter=",", header="t [s],up [mm],side [mm]", comments="", fmt="%.9g")
        _, of_file = computed(PLAIN, roof=path, seconds=0.1)
        _, of_formula = computed(PLAIN, roof="0.01*sin(2*pi*2.2*t)", seconds=0.1)
        assert of_file == pytest.approx(of_formula, abs=0.05)


class TestAtRest:
    """What a pantograph carries, by hand."""

    CURVE = ((-0.2, -900.0), (-0.1, -160.0), (-0.03, -60.0), (0.0, 0.0), (0.1, 30.0))

    @pytest.mark.parametrize("speed", [0.0, 20.0, 45.0])
    @pytest.mark.parametrize("shares", [0.03, (0.01, 0.05, -0.004), (0.0, 0.002, 0.03)])
    def test_springs_have_the_slope_at_what_lifts_the_masses_below(self, shares, speed):
        unit = replace(
            PLAIN,
            masses=(15.0, 7.2, 3.0),
            stiffness=(40.0, self.CURVE, self.CURVE),
            damping=(90.0, 10.0, 0.0),
            aerodynamic=shares,
        )
        k = (shares, 0.0, 0.0) if isinstance(shares, float) else shares
        lift = 100.0 + np.cumsum(k) * speed**2
        assert unit.force(speed) == pytest.approx(lift[2], rel=1e-14)
        rows = np.array(self.CURVE)
        slopes = np.diff(rows[:, 1]) / np.diff(rows[:, 0])
        wanted = [slopes[np.searchsorted(rows[:, 1], -load) - 1] for load in lift[:2]]
        assert unit.slopes(speed) == pytest.approx((40.0, *wanted), rel=1e-6)

    @pytest.mark.parametrize("stiffness", [(0.0, 5.0), (50.0, 0.0), (0.0, 0.0)])
    @pytest.mark.parametrize("damping", [(0.0, 0.0), (9.0, 9.0)])
    def test_something_carries_each_mass(self, stiffness, damping):
        """The lowest may stand on a damper alone, which its lift needs."""
        if stiffness[1] > 0.0 and damping[0] > 0.0:
            assert replace(PLAIN, stiffness=stiffness, damping=damping).stiffness == stiffness
        else:
            with pytest.raises(ModelError, match="nothing carries"):
                replace(PLAIN, stiffness=stiffness, damping=damping)


class TestRoof:
    UP, SIDE = "0.02*sin(5*t + 1)", "0.1*cos(3*t) - 0.1"

    @pytest.mark.parametrize("speed", [30.0, [(0.0, 30.0), (2.0, 50.0)]], ids=["steady", "faster"])
    def test_moves_along_aside_and_up(self, speed):
        """The masses that it carries go along and aside with it, and not up."""
        [roof] = roofs({"up": self.UP, "side": self.SIDE}, 1)
        track = Track(make_travel(speed), roof)
        for t in (0.0, 0.3, 1.7):
            x = 30.0 * t + (5.0 * t**2 if isinstance(speed, list) else 0.0)
            y, z = 0.1 * np.cos(3 * t) - 0.1, 0.02 * np.sin(5 * t + 1)
            assert track.above(t) == pytest.approx((x, y, z), rel=1e-12, abs=1e-12)
            assert track.along(t) == pytest.approx((x, y, 0.0), rel=1e-12, abs=1e-12)
        for upwards in (0.0, 1.0):
            wanted = 30.0, 0.0, upwards * 0.1 * np.cos(1.0)
            assert track.velocity(upwards) == pytest.approx(wanted, abs=2e-6)

    @pytest.mark.parametrize("way", ["up", "side"])
    @pytest.mark.parametrize("far", [0.49, -0.49, 0.51, -0.51])
    def test_half_a_metre_at_most(self, way, far):
        if abs(far) < 0.5:
            [roof] = roofs({way: far}, 1)
            assert roof.at(0.3) == ((far, 0.0) if way == "side" else (0.0, far))
        else:
            with pytest.raises(ModelError, match=f"roof.{way}: is"):
                roofs({way: far}, 1)

    @pytest.mark.parametrize("count", [1, 3])
    def test_one_for_each(self, count):
        assert len(roofs([0.01, None], 2)) == 2
        with pytest.raises(ModelError, match=f"has 2 motions for {count} pantographs"):
            roofs([0.01, None], count)


class TestUnderside:
    #: Track positions of the nodes of a wire and its lengths without tension, shorter by a thousandth or two.
    X = np.array([60.0, 65.0, 72.0, 90.0])
    ARC = np.array([0.0, 4.995, 11.981, 29.963])

    @pytest.mark.parametrize("ends", [(0.0, 200.0), (60.0, 90.0), (66.0, 80.0), (40.0, 70.0), (75.0, 120.0)])
    def test_lies_on_the_wire_from_end_to_end(self, ends):
        """Wear is up; beyond the rows, and beyond the wire, it is as at their ends."""
        x = np.linspace(*ends, 41)
        rows = np.column_stack([x, 1e-3 * np.sin(x) + 2e-3])
        shape = SimpleNamespace(position=np.column_stack([self.X, 0 * self.X, 0 * self.X]), arc=self.ARC)
        overhead = SimpleNamespace(strung_contacts=[SimpleNamespace(shape=shape)] * 2)
        first, second = profiles(overhead, rows)
        assert np.array_equal(first, second)
        assert np.all(np.diff(first[:, 0]) > 0.0)
        places = np.concatenate([self.X, x[(x > 60.0) & (x < 90.0)]])
        found = np.interp(np.interp(places, self.X, self.ARC), first[:, 0], first[:, 1])
        inside = np.isin(places, x) | (places < x[0]) | (places > x[-1])
        assert found[inside] == pytest.approx(-np.interp(places, *rows.T)[inside], abs=1e-12)
        beyond = x[(x < 60.0) | (x > 90.0)]
        arcs = np.where(beyond < 60.0, beyond - 60.0, self.ARC[-1] + beyond - 90.0)
        assert np.interp(arcs, *first.T) == pytest.approx(-np.interp(beyond, *rows.T), abs=1e-12)
        assert first[0, 0] < 0.0
        assert first[-1, 0] > self.ARC[-1]

    def test_file_in_millimetres(self, tmp_path):
        path = tmp_path / "worn.csv"
        path.write_text("position,height_mm\n10,0.5\n11.5,-1.25\n20,19\n")
        wanted = [[10.0, 5e-4], [11.5, -1.25e-3], [20.0, 0.019]]
        assert read_underside(path) == pytest.approx(np.array(wanted))
        assert checked_underside(path) == pytest.approx(np.array(wanted))

    @pytest.mark.parametrize("late", [10.0, 9.0])
    def test_rows_in_their_order(self, late, tmp_path):
        path = tmp_path / "worn.csv"
        path.write_text(f"position,height_mm\n10,0.5\n{late},1\n")
        with pytest.raises(ModelError, match=r"row 2, column position: is .* behind one at 10 m"):
            read_underside(path)

    @pytest.mark.parametrize("high", [0.021, -0.021, 0.5, -0.5])
    def test_no_deeper_than_a_wire(self, high):
        assert checked_underside([[0.0, 0.0], [5.0, np.sign(high) * 0.019]])[1, 1] == np.sign(high) * 0.019
        with pytest.raises(ModelError, match="more than a wire is thick"):
            checked_underside([[0.0, 0.0], [5.0, high]])


class TestPitch:
    def test_strips_part_and_meet(self):
        """Half a wave apart the strips swing against each other, a whole wave apart together."""
        apart = replace(PLAIN, strip_distance=1.25)
        with_pitch = computed(apart, underside=True)[1]
        assert np.corrcoef(with_pitch[2000:].T)[0, 1] < -0.5


class TestRefused:
    @pytest.mark.parametrize(
        ("changes", "where"),
        [
            ({"stiffness": (400.0, ((0.0, 0.0), (0.1, -5.0)))}, "pantograph.plain.stiffness[1][1][1]"),
            ({"stiffness": (400.0, ((0.1, 0.0), (0.0, 5.0)))}, "pantograph.plain.stiffness[1][1][0]"),
            ({"stops": (None, (0.02, 0.01))}, "pantograph.plain.stops[1]"),
            ({"stops": (None,)}, "pantograph.plain.stops"),
            ({"friction": (1.0, -1.0)}, "pantograph.plain.friction[1]"),
            ({"strip_distance": 580.0}, "pantograph.plain.strip_distance"),
        ],
    )
    def test_pantographs(self, changes, where):
        with pytest.raises(ModelError) as caught:
            replace(PLAIN, **changes)
        assert caught.value.where == where

    def test_file(self, tmp_path):
        text = "masses = [15, 7.2]\nstiffness = [50, [[-0.1, -500], [0, 0], [0.1, 90]]]\ndamping = [90, 10]\n"
        text += "static_force = 120\nfriction = [2, 0]\nstops = [[], [-0.05, 0.05]]\nstrip_distance = 0.5\n"
        path = tmp_path / "mine.toml"
        path.write_text(text)
        unit = catenary.read_pantograph(path)
        assert unit.stiffness[1] == ((-0.1, -500.0), (0.0, 0.0), (0.1, 90.0))
        assert (unit.friction, unit.stops) == ((2.0, 0.0), (None, (-0.05, 0.05)))
        assert unit.slopes() == pytest.approx((50.0, 5000.0))
        path.write_text(text.replace("[0.1, 90]", "[0.1]"))
        with pytest.raises(ModelError, match=r"stiffness\[1\]\[2\]: has 1 entries"):
            catenary.read_pantograph(path)


@pytest.mark.parametrize(
    ("key", "value", "unit"),
    [
        ("strip_length", 1450.0, "m"),
        ("strip_length", 0.00145, "m"),
        ("static_force", 60e3, "N"),
        ("static_force", 1e30, "N"),
        ("aerodynamic", 1e30, "N s^2/m^2"),
        ("aerodynamic", (1e6, 1e6), "N s^2/m^2"),
        ("stops", (None, (-30.0, 30.0)), "m"),
    ],
)
def test_numbers_that_are_slips_of_units(key, value, unit):
    with pytest.raises(ModelError, match=f"units are {re.escape(unit)}") as caught:
        replace(PLAIN, **{key: value})
    assert caught.value.where.startswith(f"pantograph.plain.{key}")


@pytest.mark.parametrize("stops", [(0.01, 0.02), (-0.03, -0.01), (1.0, 2.0)])
def test_stops_on_one_side(stops):
    with pytest.raises(ModelError, match="beyond both"):
        replace(PLAIN, stops=(None, stops))


@pytest.mark.parametrize("slip", [1000.0, 1e-3])
def test_masses_of_files_in_other_units(tmp_path, slip):
    """Those that a fit finds may be anything."""
    path = tmp_path / "own.toml"
    rest = "stiffness = [50, 4200]\ndamping = [90, 10]\nstatic_force = 60\n"
    path.write_text(f"masses = [{15 * slip}, {7.2 * slip}]\n{rest}")
    with pytest.raises(ModelError, match="units are kg") as caught:
        catenary.find_pantograph(str(path))
    assert caught.value.where.startswith(f"{path}: masses[")
    replace(PLAIN, masses=(15 * slip, 7.2 * slip))
