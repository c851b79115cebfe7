"""Units of co-simulation, run by an importer of others (FMPy), against the stepper."""

import json
import subprocess
import sys
import zipfile

import numpy as np
import pytest
from typer.testing import CliRunner

import ancf
from ancf.cli.app import app
from ancf.cosimulation.fmu import export_fmu
from ancf.cosimulation.motion import Motion
from ancf.cosimulation.outputs import structured
from ancf.errors import ModelError
from ancf.model.file import read_study
from files_of_units import HOIST, MODEL, TOUCHING

fmpy = pytest.importorskip("fmpy")
validation = pytest.importorskip("fmpy.validation")

#: What an importer does, in a process of its own: such units may end a Python process badly when it exits.
IMPORTER = """
import json, os, sys
import fmpy, numpy as np
file, begin, first = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
t = begin + np.array([0.0, 0.1, 0.3])
given = np.array(list(zip(t, [first, 3.0, -1.0])), dtype=[("time", float), ("thrust", float)])
found = fmpy.simulate_fmu(file, start_time=begin, stop_time=begin + 0.3, step_size=0.01, output_interval=0.01,
                          input=given, start_values={"lift": 0.25})
print(json.dumps({name: found[name].tolist() for name in found.dtype.names}))
sys.stdout.flush()
os._exit(0)
"""


@pytest.fixture(scope="module")
def units(tmp_path_factory):
    folder = tmp_path_factory.mktemp("fmu")
    file = folder / "pulled rope.toml"
    file.write_text(MODEL, "utf-8")
    for version in ("2.0", "3.0"):
        export_fmu(file, folder / f"unit{version[0]}.fmu", version)
    return folder


#: Speeds that jump, at their times.
TOLD = {0.0: -0.4, 0.2: 0.3, 0.4: 0.0}
LEADER = """
import json, os, sys
import fmpy, numpy as np
t, u = zip(*sorted((float(k), v) for k, v in json.loads(sys.argv[2]).items()))
rows = [row for k in range(len(t)) for row in ([(t[k], u[max(k - 1, 0)])] if k else []) + [(t[k], u[k])]]
given = np.array([*rows, (9.0, u[-1])], dtype=[("time", float), ("speed", float)])
found = fmpy.simulate_fmu(sys.argv[1], stop_time=0.6, step_size=0.02, output_interval=0.02, input=given)
print(json.dumps({name: found[name].tolist() for name in found.dtype.names}))
sys.stdout.flush()
os._exit(0)
"""


@pytest.mark.parametrize("version", [2, 3])
def test_a_winch_that_is_told_its_speed(version, tmp_path):
    """By jumps; the drum has its acceleration, as in the stepper, and the load is where its work lifts it."""
    (tmp_path / "hoist.toml").write_text(HOIST, "utf-8")
    export_fmu(tmp_path / "hoist.toml", tmp_path / "hoist.fmu", f"{version}.0")
    command = [sys.executable, "-c", LEADER, str(tmp_path / "hoist.fmu"), json.dumps(TOLD)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    found = json.loads(done.stdout.splitlines()[-1])
    told = HOIST.replace('name = "speed"', f'name = "speed"\nvalue = {TOLD[0.0]}')  # as the unit begins
    (tmp_path / "told.toml").write_text(told, "utf-8")
    run = ancf.stepper(read_study(tmp_path / "told.toml").model, step=2e-3)
    heights, forces, pulls = [], [], []
    for k in range(31):
        heights.append(run.position("load")[2]), forces.append(run.tension("rope.start"))
        pulls.append(run.reaction("drum")[2])
        run.inputs["speed"] = TOLD[max(t for t in TOLD if t <= 0.02 * k + 1e-9)]
        run.advance(10)
    assert np.allclose(found["load.position.z"], heights, rtol=0, atol=1e-9)
    assert np.allclose(found["rope.start.tension"], forces, rtol=0, atol=1e-6)
    assert np.allclose(found["drum.reaction.z"], pulls, rtol=0, atol=1e-6)
    # in 0.2 s to -0.4 m/s, in 0.35 s to 0.3 m/s, in 0.15 s to rest: what is left of 3 m
    assert run.natural_length("rope") == pytest.approx(3.0 - 0.04 + 0.2 * -0.4 + 0.04, abs=0.06)


def imported(file, begin=0.0, first=0.5):
    command = [sys.executable, "-c", IMPORTER, str(file), str(begin), str(first)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    return {name: np.array(x) for name, x in json.loads(done.stdout.splitlines()[-1]).items()}


#: One file, extracted and run again after its first folder is gone.
TWICE = """
import os, sys
import fmpy
for _ in range(2):
    found = fmpy.simulate_fmu(sys.argv[1], stop_time=0.02, step_size=0.01, output_interval=0.01)
    print(*found["load.position.z"])
sys.stdout.flush()
os._exit(0)
"""


@pytest.mark.parametrize("version", [2, 3])
def test_runs_more_than_once_in_a_process(units, version):
    command = [sys.executable, "-c", TWICE, str(units / f"unit{version}.fmu")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    first, second = done.stdout.splitlines()[-2:]
    assert first == second
    assert len(first.split()) == 3


def by_the_stepper(folder, first=0.5):
    plain = read_study(folder / "pulled rope.toml").model.to_dict()
    plain["inputs"] = [{"name": "thrust", "value": first}, {"name": "lift", "value": 0.25}]
    model = ancf.Model.from_dict(plain)
    run = ancf.stepper(model, step=1e-3, start=ancf.equilibrium(model))
    seen = {
        name: [] for name in ("rope.end.position.x", "load.velocity.z", "tie.force", "hook.joint_force.z")
    }

    def look():
        seen["rope.end.position.x"].append(run.position("rope.end")[0])
        seen["load.velocity.z"].append(run.velocity("load")[2])
        seen["tie.force"].append(run.spring_force("tie"))
        seen["hook.joint_force.z"].append(run.joint_force("hook")[2])

    look()
    for k in range(30):
        run.inputs["thrust"] = float(np.interp(0.01 * k, [0.0, 0.1, 0.3], [first, 3.0, -1.0]))
        run.advance(10)
        look()
    return {name: np.array(x) for name, x in seen.items()}


@pytest.mark.parametrize(
    ("version", "begin", "first"),
    [
        (2, 0.0, 0.5),
        (3, 7.0, -2.0),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in ((3, 0.0, 0.5), (2, 7.0, -2.0))),
    ],
)
def test_moves_as_the_stepper_does(units, version, begin, first):
    found = imported(units / f"unit{version}.fmu", begin, first)
    for name, wanted in by_the_stepper(units, first).items():
        assert np.ptp(wanted) > 1e-3
        assert np.allclose(found[name], wanted, rtol=1e-9, atol=1e-9 * np.max(np.abs(wanted)))


@pytest.mark.parametrize("version", [2, 3])
def test_description_is_valid_and_complete(units, version):
    file = units / f"unit{version}.fmu"
    assert validation.validate_fmu(str(file)) == []
    description = fmpy.read_model_description(str(file), validate=True)
    assert description.fmiVersion == f"{version}.0"
    assert not description.modelExchange
    by_name = {v.name: v for v in description.modelVariables}
    assert {n for n, v in by_name.items() if v.causality == "input"} == {"thrust", "lift"}
    assert float(by_name["thrust"].start) == 0.5
    assert by_name["thrust"].description == "pull of the drive"
    assert by_name["lift"].description == 'input "lift" of the model'
    wanted = {"'rope.at(1)'.position.x", "rope.end.tension", "tie.length", "hook.joint_force.x"}
    assert wanted <= by_name.keys()
    assert "load.tension" not in by_name
    assert by_name["tie.length"].description == 'length of the spring "tie"'


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_contacts_and_torsion_springs_are_outputs(tmp_path, version):
    (tmp_path / "touching.toml").write_text(TOUCHING, "utf-8")
    made = export_fmu(tmp_path / "touching.toml", tmp_path / "touching.fmu", version)
    assert [(o.name, o.unit) for o in made.outputs] == [
        ("rest.force", "N"),
        ("rest.gap", "m"),
        ("rest.friction", "N"),
        ("rest.slipping", "1"),
        ("bump.force", "N"),
        ("bump.gap", "m"),
        ("bump.friction", "N"),
        ("bump.slipping", "1"),
        ("twist.angle", "rad"),
        ("twist.moment", "N m"),
    ]


def test_a_name_that_is_no_unit_spares_the_file(tmp_path):
    """The model file under its own name, above all."""
    file = tmp_path / "hoist.toml"
    file.write_text(HOIST, "utf-8")
    with pytest.raises(ancf.ModelError, match=r"must end in \.fmu"):
        export_fmu(file, file)
    assert file.read_text("utf-8") == HOIST


def test_names_by_the_rules_of_fmi():
    assert structured("rope.end") == "rope.end"
    assert structured("rope.at(1.5)") == "'rope.at(1.5)'"
    assert structured("Joe's \\ rope") == r"'Joe\'s \\ rope'"


class TestMotion:
    def motion(self, units):
        folder = units / "motion"
        if not folder.exists():
            with zipfile.ZipFile(units / "unit3.fmu") as file:
                file.extractall(folder)
        return Motion(folder / "resources")

    def test_an_interval_that_does_not_fit(self, units):
        motion = self.motion(units)
        motion.advance(0.0, 0.004)
        with pytest.raises(ModelError, match=r"do_step.interval: is 0.0025 s, must be a multiple .* 0.001 s"):
            motion.advance(0.004, 0.0025)
        with pytest.raises(ModelError, match=r"do_step.time: is 0.01 s, the run is at 0.004 s"):
            motion.advance(0.01, 0.001)
        motion.advance(0.004, 0.001)
        assert motion.run.t == pytest.approx(0.005)

    @pytest.mark.parametrize("steps", [1, 7])
    @pytest.mark.parametrize("pull", [5.0, -3.0])
    @pytest.mark.parametrize("again", [False, True])
    def test_an_input_after_the_start_moves_on_from_there(self, units, steps, pull, again):
        """Once it has begun, an equilibrium stays as it is: a jump of an input then is one of the motion."""
        motion = self.motion(units)
        motion.give("thrust", -1.0)
        motion.begin()
        kept, before = motion.state(), motion.run.position("load")
        if again:
            motion.give("thrust", 9.0)
            motion.advance(0.0, 0.003)
            motion.restore(type(kept).from_bytes(kept.to_bytes()))
        motion.give("thrust", pull)
        assert np.array_equal(motion.run.position("load"), before)
        motion.advance(0.0, steps * 1e-3)
        plain = read_study(units / "pulled rope.toml").model.to_dict()
        plain["inputs"][0]["value"] = -1.0
        model = ancf.Model.from_dict(plain)
        run = ancf.stepper(model, step=1e-3, start=ancf.equilibrium(model))
        run.inputs["thrust"] = pull
        run.advance(steps)
        assert np.allclose(motion.run.position("load"), run.position("load"), rtol=0, atol=1e-12)
        assert np.linalg.norm(run.position("load") - before) > 1e-8

    def test_a_first_time_that_was_told(self, units):
        motion = self.motion(units)
        motion.place(2.0)
        with pytest.raises(ModelError, match=r"do_step.time: is 0.5 s, the run is at 2 s"):
            motion.advance(0.5, 0.001)
        motion.advance(2.0, 0.001)
        kept, other = motion.state(), self.motion(units)
        other.restore(kept)
        other.advance(2.001, 0.001)

    @pytest.mark.parametrize("bad", [float("nan"), float("inf")])
    def test_what_is_no_number(self, units, bad):
        """The step says so, and goes on with one that is."""
        motion = self.motion(units)
        for time, interval in ((bad, 0.001), (0.0, bad)):
            with pytest.raises(ModelError, match=r"do_step.(time|interval): must be a finite number"):
                motion.advance(time, interval)
        motion.advance(0.0, 0.001)
        motion.give("lift", bad)
        with pytest.raises(ModelError, match='input "lift": must be a finite number'):
            motion.advance(0.001, 0.001)
        motion.give("lift", 0.25)
        motion.advance(0.001, 0.001)
        assert np.all(np.isfinite(motion.run.q))

    def test_an_input_before_the_first_step_moves_the_start(self, units):
        motion, x = self.motion(units), lambda m: m.run.position("rope.end")[0]
        before = x(motion)
        motion.give("thrust", 5.0)
        assert x(motion) > before + 0.01
        motion.advance(0.0, 0.001)
        now = motion.run
        motion.give("thrust", 0.0)
        assert motion.run is now


class TestCommand:
    def test_says_what_goes_in_and_out(self, units, tmp_path):
        (tmp_path / "rope.toml").write_text(MODEL, "utf-8")
        done = CliRunner().invoke(app, ["export-fmu", str(tmp_path / "rope.toml")])
        assert done.exit_code == 0, done.output
        assert "inputs: thrust, lift" in done.output
        assert "'rope.at(1)'.tension [N]" in done.output
        assert (tmp_path / "rope.fmu").stat().st_size > 1e5

    @pytest.mark.parametrize(
        ("change", "where", "what"),
        [
            (("[simulation]", "[equilibrium]\n#"), "simulation", "is missing"),
            (('sensors = ["', '#"'), "simulation.sensors", "is empty"),
            (('"rope.end", "rope', '"rope.ends", "rope'), "sensors", "rope.ends"),
        ],
    )
    def test_models_that_make_no_unit(self, tmp_path, change, where, what):
        text = MODEL.replace(*change)
        if change[0] == "[simulation]":
            text = text[: text.index("[equilibrium]")]
        (tmp_path / "rope.toml").write_text(text, "utf-8")
        with pytest.raises(ModelError) as caught:
            export_fmu(tmp_path / "rope.toml", tmp_path / "rope.fmu")
        assert where in caught.value.where
        assert what in str(caught.value)

    def test_a_version_that_is_none(self, tmp_path):
        with pytest.raises(ModelError, match=r"2.0, 3.0"):
            export_fmu(tmp_path / "rope.toml", tmp_path / "rope.fmu", "1.0")

    def test_two_variables_of_one_name(self, tmp_path):
        (tmp_path / "rope.toml").write_text(MODEL.replace("lift", "time"), "utf-8")
        with pytest.raises(ModelError, match='"time" would be the name of two variables'):
            export_fmu(tmp_path / "rope.toml", tmp_path / "rope.fmu")

    def test_without_the_library_it_says_what_to_install(self, tmp_path, monkeypatch):
        monkeypatch.setitem(sys.modules, "pythonfmu3.builder", None)
        (tmp_path / "rope.toml").write_text(MODEL, "utf-8")
        with pytest.raises(ModelError, match=r"pip install 'ancf\[fmu\]'"):
            export_fmu(tmp_path / "rope.toml", tmp_path / "rope.fmu")
