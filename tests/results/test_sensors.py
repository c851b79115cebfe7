"""Sensors: what is recorded at every step is what full states would say there."""

import contextlib
import csv
import json
import subprocess
import sys
import tomllib
from pathlib import Path

import h5py
import numpy as np
import pytest

import ancf
from ancf.cli.app import app
from ancf.model.file import parse_study, schema
from ancf.system.sensors import Listing, listing
from ancf.system.system import System

G = 9.81
#: Values that are sums in an order of their own are equal up to round-off, all others to the last bit.
ROUND_OFF = 1e-12
IMPLICIT = {
    "trapezoidal": ancf.Trapezoidal(),
    "generalized-alpha": ancf.GeneralizedAlpha(rho_inf=0.8),
    "radau": ancf.Radau(tolerance=1e-4),
    "radau constant": ancf.Radau(adaptive=False),
}
METHODS = {**IMPLICIT, "explicit": ancf.Explicit()}


def line(end=(4, 0, 0)):
    """A wire with two loads that hang on droppers, at a node and between nodes."""
    model = ancf.Model(gravity=(0, 0, -G))
    section = ancf.Section(EA=1e4, EI=2.0, rhoA=1.0, damping=0.1, axial_damping=0.5, bending_damping=0.01)
    wire = model.add_beam("wire", start=(0, 0, 0), end=end, elements=8, section=section)
    model.pin(wire.start, displacement=(0, 0, "0.05*sin(30*t)"))
    model.clamp(wire.end)
    bob = model.add_point_mass("bob", at=(1.0, 0, -0.5), mass=2.0)
    dropper = model.add_spring(bob, wire.at(1.0), stiffness=2e3, damping=3.0, name="dropper")
    model.add_spring(bob, wire.at(1.3), stiffness=1e3, damping=1.0, length=0.5, name="stay")
    model.add_spring(bob, (1, 1, -0.5), stiffness=50.0, name="ground")
    model.connect(wire.at(2.0), model.add_point_mass("clamp", at=(2, 0, 0), mass=0.3), name="tied")
    return model, wire, bob, dropper


LINE = ["wire.at(3)", "wire.at(2.1)", "wire.end", "bob", "dropper", "stay", "ground"]
POINTS, SPRINGS = LINE[:4], LINE[4:]


def ball():
    """A pan under a rigid wire, which it may only push: it leaves and comes back with an impact."""
    model = ancf.Model(gravity=(0, 0, -G))
    wire = model.add_rigid_body("wire", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
    model.clamp(wire)
    pan = model.add_point_mass("pan", at=(1.0, 0, 0), mass=2.0)
    pan.set_motion(velocity=(1.0, 0, 0))
    model.add_force(pan, (0, 0, f"{2 * G} + 30*sin(20*t)"))
    model.slide(pan, along=wire, line=((0, 0, 0), (4, 0, 0)), unilateral=(0, 0, 1), name="contact")
    hub = model.add_rigid_body("hub", at=(0, 0, 1), mass=1.0, inertia=(0.1, 0.2, 0.3))
    hub.set_motion(angular_velocity=(0.3, 5.0, 0))
    model.connect(hub.at(0, 0, 0.5), (0, 0, 1.5), name="ball")
    return model, pan, hub


def rows(part, whole):
    """Rows of a finer history at the times of a coarser one."""
    found = np.searchsorted(whole.t, part.t - 1e-9)
    assert np.array_equal(whole.t[found], part.t)
    return found


def assert_same_line(sensors, result, at, exact=True):
    """Sensors at some rows say what the full states say."""
    for point in POINTS:
        for name in ("position", "velocity"):
            got, wanted = getattr(sensors, name)(point)[at], getattr(result, name)(point)
            assert np.array_equal(got, wanted) if exact else got == pytest.approx(wanted, rel=1e-9, abs=1e-12)
    for point in POINTS[:3]:
        for name in ("slope", "strain", "tension", "curvature", "bending_moment"):
            got, wanted = getattr(sensors, name)(point)[at], getattr(result, name)(point)
            assert got == pytest.approx(wanted, rel=1e-9, abs=ROUND_OFF * np.abs(wanted).max()), name
    for spring in SPRINGS:
        for name in ("spring_force", "spring_length"):
            got, wanted = getattr(sensors, name)(spring)[at], getattr(result, name)(spring)
            assert np.ptp(wanted) > 0
            assert got == pytest.approx(wanted, rel=1e-9, abs=ROUND_OFF * np.abs(wanted).max()), name


class TestLine:
    @pytest.mark.parametrize("name", METHODS)
    def test_equal_full_states(self, name):
        """Also where the last step is shorter and no output; nothing else changes."""
        step = 2e-4 if name == "explicit" else 1e-3
        given = {"t_end": 105.5 * step, "step": step, "integrator": METHODS[name]}
        model = line()[0]
        result = ancf.simulate(model, **given, output_step=20 * step, sensors=LINE)
        sensors = result.sensors
        assert sensors.t == pytest.approx(np.append(step * np.arange(106), 105.5 * step), rel=1e-12)
        assert len(result.t) == 7
        assert_same_line(sensors, result, rows(result, sensors))
        whole = ancf.simulate(model, **given)
        assert np.array_equal(whole.t, sensors.t)
        assert_same_line(sensors, whole, slice(None), exact="radau" not in name)
        plain = ancf.simulate(model, **given, output_step=20 * step)
        assert np.array_equal(plain.q, result.q)
        assert np.array_equal(plain.v, result.v)
        assert plain.stats.newton_iterations == result.stats.newton_iterations

    def test_objects_or_names(self):
        model, wire, bob, dropper = line()
        given = {"t_end": 0.01, "step": 1e-3}
        objects = [wire.at(3), model.point("wire.at(2.1)"), wire.end, bob, dropper, "stay", "ground", bob]
        one = ancf.simulate(model, **given, sensors=objects).sensors
        two = ancf.simulate(model, **given, sensors=LINE).sensors
        assert np.array_equal(one.q, two.q)
        assert one.names == two.names == LINE
        for a, b in ((wire.at(3), "wire.at(3)"), (bob.point, "bob"), (wire.end, "wire.at(4)")):
            assert np.array_equal(one.position(a), two.position(b))
        assert np.array_equal(one.spring_force(dropper), two.spring_force("dropper"))

    def test_only_what_is_needed_is_recorded(self):
        """An element's 12 unknowns at a point; of a spring 2 numbers, or where derivatives are wanted 3
        unknowns at a node and of a mass, 12 between nodes.
        """
        model = line()[0]
        sizes = {"wire.at(2.1)": 12, "wire.at(3)": 12, "bob": 3, "dropper": 6, "stay": 15, "ground": 3}
        system = System(model)
        for name, size in sizes.items():
            own = listing(system, [model.sensor(name)], True)
            assert (len(own.index), len(own.entries)) == ((0, 2) if name in SPRINGS else (size, 0)), name
            own = listing(system, [model.sensor(name)], True, ends=True)
            assert (len(own.index), len(own.entries)) == (size, 0), name
        items = [model.sensor(name) for name in ("dropper", "bob", "ground")]
        assert len(listing(system, items, True).index) == 3
        assert len(listing(system, items, True, ends=True).index) == 6

    def test_oscillator(self):
        """A mass on a spring: the force at every step is that of the closed form, states are four."""
        model = ancf.Model(gravity=(0, 0, -G))
        mass = model.add_point_mass("mass", at=(0, 0, -1), mass=2.0)
        spring = model.add_spring(mass, (0, 0, 0), stiffness=800.0)
        result = ancf.simulate(
            model, t_end=0.9, step=1e-4, output_step=0.3, sensors=[spring], integrator=ancf.GeneralizedAlpha()
        )
        t, force = result.sensors.t, result.sensors.spring_force(spring)
        assert (len(result.t), len(t)) == (4, 9001)
        assert force == pytest.approx(2 * G * (1 - np.cos(20 * t)), abs=1e-3)

    def test_bridged_steps(self):
        """A rope that jerks tight, with hardly enough iterations: halved steps are recorded as well."""
        model = ancf.Model()
        section = ancf.Section(EA=2e3, EI=0.1, rhoA=0.4)
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
        beam.set_motion(velocity=(10.0, 0, 0), angular_velocity=(0, 0, 3.0))
        rope = model.add_spring(beam.end, (1.5, 0.5, 0), stiffness=2e6, length=0.9, slack=True)
        given = {"t_end": 0.3, "step": 2e-3, "sensors": [beam.end, rope]}
        for max_iterations in range(4, 9):
            method = ancf.Trapezoidal(newton=ancf.Newton(max_iterations=max_iterations))
            with contextlib.suppress(ancf.SolveError):
                result = ancf.simulate(model, **given, integrator=method)
                if result.stats.retries:
                    break
        assert result.stats.retries > 0
        sensors = result.sensors
        assert np.array_equal(sensors.t, result.t)
        assert np.array_equal(sensors.position(beam.end), result.position(beam.end))
        assert np.array_equal(sensors.velocity(beam.end), result.velocity(beam.end))
        assert np.max(sensors.spring_force(rope)) > 100.0
        wanted = result.spring_force(rope)
        assert sensors.spring_force(rope) == pytest.approx(wanted, rel=1e-9, abs=ROUND_OFF * np.max(wanted))


class TestJoints:
    LISTED = ("pan", "hub.at(0.1, 0.2, 0.3)", "wire", "contact", "ball")

    @pytest.mark.parametrize("name", IMPLICIT)
    def test_events(self, name):
        """The contact opens and closes: each of these steps is recorded after it, as states are."""
        model, pan, hub = ball()
        given = {"t_end": 0.6, "step": 1e-3, "integrator": IMPLICIT[name], "sensors": self.LISTED}
        result = ancf.simulate(model, **given)
        sensors = result.sensors
        push = sensors.multiplier("contact")[:, 2]
        assert np.array_equal(sensors.t, result.t)
        assert push.max() > 1.0
        assert result.position(pan)[:, 2].min() < -0.1  # it has left
        if "radau" not in name:  # which looks at the ends of its own steps alone
            assert np.min(push) == 0.0
            assert np.sum(push == 0.0) > 20
        for point in (pan, hub.at(0.1, 0.2, 0.3), "wire"):
            for field in ("position", "velocity"):
                assert np.array_equal(getattr(sensors, field)(point), getattr(result, field)(point))
        assert np.array_equal(sensors.section_rotation(hub.at(0.1, 0.2, 0.3)), result.section_rotation(hub))
        for joint in ("contact", "ball"):
            assert np.array_equal(sensors.multiplier(joint), result.multiplier(joint))
        assert np.array_equal(sensors.arc_length("contact"), result.arc_length("contact"))
        assert np.array_equal(sensors.arc_rate("contact"), result.arc_rate("contact"))
        coarse = ancf.simulate(model, **given, output_step=0.02)
        at = rows(coarse, coarse.sensors)
        assert np.array_equal(coarse.sensors.multiplier("contact")[at], coarse.multiplier("contact"))

    def bead(self):
        """A bead that runs off its wire after 0.37 s."""
        model = ancf.Model(gravity=(0, 0, -G))
        wire = model.add_rigid_body("wire", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
        model.clamp(wire)
        bead = model.add_point_mass("bead", at=(0.5, 0, 0), mass=1.0)
        bead.set_motion(velocity=(4.0, 0, 0))
        model.slide(bead, along=wire, line=((0, 0, 0), (2, 0, 0)), name="joint")
        return model

    @pytest.mark.parametrize("in_file", [False, True])
    def test_failed_run_keeps_what_it_has(self, in_file, tmp_path):
        """Up to the step before the one that failed, and not only to the last output."""
        given = {"file": tmp_path / "run.h5"} if in_file else {}
        with pytest.raises(ancf.SolveError, match="has reached the end") as caught:
            ancf.simulate(
                self.bead(), t_end=1.0, step=1e-3, output_step=0.1, sensors=["bead", "joint"], **given
            )
        result = caught.value.result
        assert result.status == "failed"
        assert result.t[-1] == pytest.approx(0.3)
        sensors = result.sensors
        assert sensors.t[-1] == pytest.approx(0.375, abs=1.5e-3)
        assert sensors.position("bead")[:, 0] == pytest.approx(0.5 + 4 * sensors.t, abs=1e-9)
        assert sensors.arc_length("joint") == pytest.approx(0.5 + 4 * sensors.t, abs=1e-9)
        assert np.array_equal(sensors.position("bead")[rows(result, sensors)], result.position("bead"))
        if in_file:
            again = ancf.load(tmp_path / "run.h5").sensors
            assert np.array_equal(again.position("bead"), sensors.position("bead"))

    def test_interrupted_run(self):
        def stop(progress):
            if progress.step > 20:
                raise KeyboardInterrupt

        with pytest.raises(ancf.Interrupted) as caught:
            ancf.simulate(ball()[0], t_end=50.0, step=1e-3, output_step=5.0, sensors=["pan"], progress=stop)
        result = caught.value.result
        assert result.status == "interrupted"
        assert len(result.sensors.t) > 20
        assert np.all(np.isfinite(result.sensors.position("pan")))


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """The same run in memory and in a file."""
    path = tmp_path_factory.mktemp("sensors") / "run.h5"
    given = {"t_end": 0.7, "step": 1e-3, "output_step": 0.1, "sensors": LINE}
    memory = ancf.simulate(line()[0], **given)
    return memory, ancf.simulate(line()[0], file=path, **given), path


class TestFile:
    @staticmethod
    def same(result, wanted):
        got = result.sensors
        assert np.array_equal(got.t, wanted.sensors.t)
        assert np.array_equal(got.q[:], wanted.sensors.q)
        assert got.names == wanted.sensors.names
        assert_same_line(got, wanted.sensors, slice(None))
        assert_same_line(got, result, rows(result, got))

    def test_memory_file_and_loaded(self, stored):
        memory, file, path = stored
        self.same(file, memory)
        self.same(ancf.load(path), memory)
        assert memory.provenance["settings"]["sensors"] == LINE

    @pytest.mark.parametrize("source", [0, 1])
    def test_saved(self, stored, source, tmp_path):
        stored[source].save(tmp_path / "copy.h5")
        self.same(ancf.load(tmp_path / "copy.h5"), stored[0])

    def test_plain_data_sets(self, stored):
        """Whoever has no ancf finds a point's column through ``index`` and the body's slots."""
        with h5py.File(stored[2]) as file:
            group = file["sensors"]
            slot = file["bodies/bob/slots"][0, 0]
            column = int(np.flatnonzero(group["index"][:] == slot)[0])
            assert np.array_equal(group["q"][:, column : column + 3], stored[0].sensors.position("bob"))
            assert len(group["time"]) == 701
            assert json.loads(group.attrs["listed"])["connections"] == SPRINGS

    def test_block_that_was_torn(self, stored, tmp_path):
        """A kill between the arrays of a block: rows without their time do not count."""
        stored[1].save(tmp_path / "torn.h5")
        with h5py.File(tmp_path / "torn.h5", "r+") as file:
            file["sensors/q"].resize(705, axis=0)
        self.same(ancf.load(tmp_path / "torn.h5"), stored[0])

    def test_file_without_sensors(self, tmp_path):
        model = line()[0]
        result = ancf.simulate(model, t_end=0.01, step=1e-3, file=tmp_path / "run.h5", sensors=[])
        for source in (result, ancf.load(tmp_path / "run.h5"), ancf.simulate(model, t_end=0.01, step=1e-3)):
            with pytest.raises(ancf.ModelError, match="had no sensors") as caught:
                _ = source.sensors
            assert "sensors=[" in caught.value.hint
        with h5py.File(tmp_path / "run.h5") as file:
            assert "sensors" not in file


class TestMeasured:
    """What batches leave beside the state is copied in the step in which it holds."""

    @pytest.mark.parametrize("method", [ancf.Trapezoidal(), ancf.Explicit()], ids=["implicit", "explicit"])
    def test_shared_memory(self, monkeypatch, method, tmp_path):
        """The moments now stand for what a contact finds: they are refreshed in every step."""
        model = ancf.Model()
        section = ancf.Section(EA=1e3, EI=1.0, rhoA=1.0)
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
        model.add_moment(beam.end, (0, "0.1*sin(9*t)", "0.2*cos(5*t)"))
        model.pin(model.add_point_mass("pan", at=(0.5, 0, 0), mass=0.1), name="contact")

        def system(model):
            made = System(model)
            made.measured = made.core.loads.value.reshape(-1)
            made.measures = {"contact": np.array([1, 2, 0, 0])}
            return made

        monkeypatch.setattr("ancf.preparation.independent", system)
        result = ancf.simulate(
            model, t_end=0.2, step=1e-3, sensors=["contact", beam.end], integrator=method, output_step=0.1
        )
        result.save(tmp_path / "run.h5")
        for sensors in (result.sensors, ancf.load(tmp_path / "run.h5").sensors):
            t = sensors.t
            assert sensors.contact_force("contact") == pytest.approx(0.1 * np.sin(9 * t), abs=1e-15)
            assert sensors.contact_gap("contact") == pytest.approx(-0.2 * np.cos(5 * t), abs=1e-15)
            assert np.all(sensors.arc_length("contact") == 0.0)
            with pytest.raises(ancf.ModelError, match="no contact that the sensors have recorded"):
                sensors.contact_force("other")


class TestBadInput:
    @pytest.mark.parametrize(
        ("given", "place", "what"),
        [
            ("wire.at(3)", "simulate.sensors", "must be a list"),
            (7, "simulate.sensors", "must be a list"),
            (["bob", 7], "simulate.sensors[1]", "must be a point, spring, joint or support"),
            (["bob", None], "simulate.sensors[1]", "must be a point, spring, joint or support"),
            (["bob", "droper"], "simulate.sensors[1]", 'did you mean "dropper"'),
            (["wier.at(3)"], "simulate.sensors[0]", 'did you mean "wire"'),
            (["wire.at(5)"], "simulate.sensors[0]", "outside the beam"),
            (["wire.at(x)"], "simulate.sensors[0]", "no arc length"),
            (["wire"], "simulate.sensors[0]", "is no point"),
            (["tied"], "simulate.sensors[0]", "share their unknowns"),
        ],
    )
    def test_list(self, given, place, what):
        with pytest.raises(ancf.ModelError) as caught:
            ancf.simulate(line()[0], t_end=0.01, step=1e-3, sensors=given)
        assert caught.value.where == place
        assert what in str(caught.value)

    def test_of_another_model(self):
        _, wire, bob, dropper = line()
        for k, item in enumerate((wire.at(3), bob, dropper)):
            with pytest.raises(ancf.ModelError, match=r"another model|of this model") as caught:
                ancf.simulate(line()[0], t_end=0.01, step=1e-3, sensors=["bob", *[item] * (k + 1)])
            assert caught.value.where == "simulate.sensors[1]"

    def test_not_recorded(self, stored):
        """The error lists what was; a spring's end has a place, but no strains."""
        for result in (stored[0], ancf.load(stored[2])):
            sensors = result.sensors
            for ask in (
                lambda s=sensors: s.position("wire.at(0.2)"),
                lambda s=sensors: s.tension("wire.at(0.2)"),
                lambda s=sensors: s.position("clamp"),
                lambda s=sensors: s.tension("wire.at(1.3)"),
            ):
                with pytest.raises(ancf.ModelError, match="was not recorded by the sensors") as caught:
                    ask()
                assert "recorded are: wire.at(3), wire.at(2.1), wire.end, bob, dropper" in caught.value.hint
            with pytest.raises(ancf.ModelError, match="unknown spring"):
                sensors.spring_force("other")
            with pytest.raises(ancf.ModelError, match="no joint of this kind"):
                sensors.multiplier("dropper")
            with pytest.raises(ancf.ModelError, match="unknown body"):
                sensors.position("wier.at(3)")

    def test_places(self):
        """Entries that are not recorded are told from those that are."""
        found = Listing(index=np.array([3, 4, 9])).places(np.array([[9, 10], [4, 0]]))
        assert found.tolist() == [[2, -1], [1, -1]]
        assert Listing().places(np.array([0, 1])).tolist() == [-1, -1]


STUDY = """
gravity = [0, 0, -9.81]
[[bodies]]
name = "wire"
start = [0, 0, 0]
end = [4, 0, 0]
elements = 8
section = { EA = 1e4, EI = 2.0, rhoA = 1.0 }
[[bodies]]
type = "point_mass"
name = "bob"
at = [1, 0, -0.5]
mass = 2.0
[[supports]]
type = "pin"
point = "wire.start"
[[supports]]
type = "pin"
point = "wire.end"
[[connections]]
type = "spring"
name = "dropper, left"
a = "bob"
b = "wire.at(1)"
stiffness = 2e3
[simulation]
t_end = 0.1
step = 1e-3
output_step = 0.02
"""
SENSORS = 'sensors = ["wire.at(3)", "bob", "dropper, left"]\n'
FAILS = '[[loads]]\ntype = "force"\npoint = "bob"\nforce = [0, 0, "where(t < 0.05, 0, 1e300)"]\n'


def table(path):
    with Path(path).open(newline="", encoding="utf-8") as file:
        head, *body = csv.reader(file)
    return head, np.array(body, dtype=float)


class TestCommandLine:
    @staticmethod
    def run(text):
        Path("model.toml").write_text(text, encoding="utf-8")
        with pytest.raises(SystemExit) as stop:
            app(["run", "model.toml", "-o", "out"], prog_name="ancf")
        return int(stop.value.code or 0)

    def test_table(self, tmp_path, monkeypatch, capsys):
        monkeypatch.chdir(tmp_path)
        assert self.run(STUDY + SENSORS) == 0
        assert "out/sensors.csv" in capsys.readouterr().out
        head, values = table("out/sensors.csv")
        assert head[:5] == ["t [s]", *(f"wire.at(3) position {c} [m]" for c in "xyz"), head[4]]
        assert head[4] == "wire.at(3) velocity x [m/s]"
        assert head[-2:] == ["dropper, left force [N]", "dropper, left length [m]"]
        sensors = ancf.load("out/results.h5").sensors
        assert head[7:9] == ["wire.at(3) tension [N]", "wire.at(3) curvature [1/m]"]
        assert values.shape == (101, 17)
        assert np.array_equal(values[:, 0], sensors.t)
        assert np.array_equal(values[:, 1:4], sensors.position("wire.at(3)"))
        assert np.array_equal(values[:, 7], sensors.tension("wire.at(3)"))
        assert np.array_equal(values[:, 15], sensors.spring_force("dropper, left"))
        assert self.run(STUDY) == 0
        assert not Path("out/sensors.csv").exists()  # that of the earlier run

    def test_failed_run(self, tmp_path, monkeypatch, capsys):
        monkeypatch.chdir(tmp_path)
        assert self.run(FAILS + STUDY[: STUDY.index("[simulation]")]) == 2  # nothing to compute
        assert self.run(STUDY.replace("[simulation]", FAILS + "[simulation]") + SENSORS) == 1
        assert "results up to t = 0.04 s kept" in capsys.readouterr().err
        _, values = table("out/sensors.csv")
        assert values[-1, 0] == pytest.approx(0.049, abs=1.5e-3)

    def test_places_in_the_file(self):
        for bad, what in (
            ("droper", "unknown point"),
            ("wire.at(9)", "outside"),
            ("wire", "is no point"),
            ("wire.mid", '"wire.mid" is no point, a point is written like'),
            ("wire.end.tension", r'the point is "wire.end", of which tension\(wire.end\) may be asked'),
            ("wire.at(0.5).z", r'"wire.at\(0.5\)", of which position\(wire.at\(0.5\)\)\[2\] may be asked'),
        ):
            data = tomllib.loads(STUDY + f'sensors = ["bob", "{bad}"]\n')
            with pytest.raises(ancf.ModelError, match=what) as caught:
                parse_study(data)
            assert caught.value.where == "simulation.sensors[1]"
        with pytest.raises(ancf.ModelError) as caught:
            parse_study(tomllib.loads(STUDY + "sensors = 3\n"))
        assert caught.value.where == "simulation.sensors"

    def test_schema(self):
        assert "sensors" in schema()["$defs"]["SimulationEntry"]["properties"]


GOES_ON = """
import sys, ancf
model = ancf.Model(gravity=(0, 0, -9.81))
mass = model.add_point_mass("mass", at=(0, 0, -1), mass=2.0)
model.add_spring(mass, (0, 0, 0), stiffness=800.0, name="spring")
tell = lambda p: print(p.step, flush=True)
ancf.simulate(
    model, t_end=1e5, step=1e-3, output_step=1.0, file=sys.argv[1], progress=tell, sensors=["mass", "spring"]
)
"""


def test_killed_run(tmp_path):
    """A file is read while it grows, twice, and after a kill: up to the last block that was reported."""
    path, reported = tmp_path / "run.h5", 0
    with subprocess.Popen(
        [sys.executable, "-c", GOES_ON, str(path)], stdout=subprocess.PIPE, text=True
    ) as child:
        seen = []
        for _ in range(2):
            while reported < 3000 + sum(map(len, seen)):
                reported = int(child.stdout.readline())
            sensors = ancf.load(path).sensors
            seen.append(sensors.position("mass"))
            assert len(sensors.t) == len(sensors.spring_force("spring")) == len(seen[-1]) >= reported + 1
        child.kill()
    result = ancf.load(path)
    assert result.status == "running"
    force = result.sensors.spring_force("spring")
    assert len(force) >= len(seen[1]) > len(seen[0])
    assert force[:3000] == pytest.approx(2 * G * (1 - np.cos(20 * result.sensors.t[:3000])), abs=0.1)


@pytest.mark.parametrize("element", ["cable", "nonlocking"])
@pytest.mark.parametrize("share", [1 / 3, np.sqrt(2) / 2, np.pi / 7, 0.123456789012345678])
def test_labels_with_fewer_digits_than_the_place(tmp_path, element, share):
    """A point that was recorded answers to the name under which it is listed, in tables and files as well."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section.rectangle(width=0.02, height=0.02, E=1e8, rho=1000.0, nu=0.3)
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(3, 0, 0), elements=3, section=section, element=element
    )
    model.clamp(beam.start)
    off = (0.01 / 3, 0.01 / 7) if element == "nonlocking" else ()
    point = beam.at(3 * share, *off)
    path = tmp_path / "run.h5"
    run = ancf.simulate(model, t_end=0.02, step=1e-3, sensors=[point, beam.end], file=path)
    for sensors in (run.sensors, ancf.load(path).sensors):
        label = sensors.names[0]
        for question in ("position", "velocity", "tension", "curvature"):
            asked = getattr(sensors, question)
            assert np.array_equal(asked(label), asked(point))
        assert np.array_equal(sensors.to_pandas()[f"{label} position z [m]"], sensors.position(point)[:, 2])
        assert set(sensors.to_xarray().point.values) == set(sensors.names)
        with pytest.raises(ancf.ModelError, match="was not recorded"):
            sensors.position("beam.at(0.4)")
    assert (tmp_path / "sensors.csv") in ancf.load(path).to_csv(tmp_path)
