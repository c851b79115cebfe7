"""Units that give their state and take it back: to the bits of a unit that just went on."""

import json
import subprocess
import sys

import numpy as np
import pytest

import ancf
from ancf.cosimulation.fmu import export_fmu
from ancf.cosimulation.motion import Kept, Motion
from files_of_units import HOIST, MODEL, TOUCHING

pytest.importorskip("fmpy")

#: Its first length is that of an input.
WOUND = HOIST.replace('length = 3.0\nspeed = "speed"', 'length = "reel"\nspeed = 0.5').replace(
    '"speed"\n', '"reel"\nvalue = 3.0\n'
)
FILES = {"rope": MODEL, "hoist": HOIST, "touching": TOUCHING}
#: A master that takes steps again, in the same instance and in another one, which it brings there from bytes.
MASTER = """
import json, os, sys
import fmpy
from fmpy.simulation import instantiate_fmu

file, pushed = sys.argv[1:3]
folder = fmpy.extract(file)
about = fmpy.read_model_description(folder)
two = about.fmiVersion == "2.0"
inputs = [v.valueReference for v in about.modelVariables if v.causality == "input"]
outputs = [v.valueReference for v in about.modelVariables if v.causality == "output"]
h = 0.01

def begun(t):
    unit = instantiate_fmu(folder, about, "CoSimulation")
    if two:
        unit.setupExperiment(startTime=t)
        unit.enterInitializationMode()
    else:
        unit.enterInitializationMode(startTime=t)
    unit.exitInitializationMode()
    return unit

def give(unit, value):
    if inputs:
        (unit.setReal if two else unit.setFloat64)(inputs, [value] * len(inputs))

def ask(unit):
    return list((unit.getReal if two else unit.getFloat64)(outputs))

def go(unit, first, count, scale=1.0):
    rows = []
    for k in range(first, first + count):
        give(unit, scale * 0.1 * (k % 3 - 1))
        unit.doStep(5.0 + k * h, h)
        rows.append(ask(unit))
    return rows

unit = begun(5.0)
at_start = unit.getFMUState()
go(unit, 0, 4)
here = unit.getFMUState()
kept = bytes(unit.serializeFMUState(here))
wanted = go(unit, 4, 6)
found = {}
unit.setFMUState(here)
found["other inputs"] = go(unit, 4, 5, float(pushed))
unit.setFMUState(here)
found["again"] = go(unit, 4, 6)
unit.setFMUState(at_start)
found["from the start"] = go(unit, 0, 10)[4:]
for name in ("another", "another that has run"):
    other = begun(5.0)
    if name != "another":
        go(other, 0, 7, 2.0)
    state = other.deserializeFMUState(kept)
    other.setFMUState(state)
    other.freeFMUState(state)
    found[name] = go(other, 4, 6)
unit.freeFMUState(here)
print(json.dumps({"wanted": wanted, "bytes": len(kept), **found}))
sys.stdout.flush()
os._exit(0)
"""


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("name", FILES)
def test_a_master_takes_steps_again(name, version, tmp_path):
    (tmp_path / "model.toml").write_text(FILES[name], "utf-8")
    export_fmu(tmp_path / "model.toml", tmp_path / "unit.fmu", f"{version}.0")
    command = [sys.executable, "-c", MASTER, str(tmp_path / "unit.fmu"), "-4.0"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    found = json.loads(done.stdout.splitlines()[-1])
    wanted = np.array(found.pop("wanted"))
    assert 1000 < found.pop("bytes") < 1_000_000
    assert np.ptp(wanted, axis=0).max() > 1e-3
    other = np.array(found.pop("other inputs"))
    if name != "touching":  # which has no inputs
        assert np.abs(other - wanted[:5]).max() > 1e-3
    for way, rows in found.items():
        assert np.array_equal(rows, wanted), way


class TestMotion:
    """Without a library of units."""

    @pytest.fixture
    def folder(self, tmp_path):
        (tmp_path / "model.toml").write_text(MODEL, "utf-8")
        (tmp_path / "outputs.json").write_text("[]", "utf-8")
        return tmp_path

    def test_before_the_first_step(self, folder):
        """Inputs that are put back move the equilibrium from which it starts."""
        motion = Motion(folder)
        kept = Kept.from_bytes(motion.state().to_bytes())
        begin = motion.run.position("rope.end")
        motion.give("thrust", 4.0)
        motion.advance(0.0, 0.01)
        assert abs(motion.run.position("rope.end") - begin).max() > 0.1
        motion.restore(kept)
        assert np.array_equal(motion.run.position("rope.end"), begin)
        motion.advance(0.0, 0.01)

    @pytest.mark.parametrize("text", [MODEL, WOUND], ids=["pulled", "wound"])
    @pytest.mark.parametrize("ran", [False, True])
    def test_of_a_run_that_began_with_other_inputs(self, text, ran, folder):
        """In a unit that began otherwise, or has not begun at all."""
        (folder / "model.toml").write_text(text, "utf-8")
        first, second = Motion(folder), Motion(folder)
        name = next(iter(second.inputs))
        second.give(name, second.inputs[name] - 0.2)
        for motion in (first, second)[0 if ran else 1 :]:
            motion.advance(0.0, 0.06)
        kept = second.state()
        second.advance(0.06, 0.04)
        first.restore(kept)
        first.advance(0.06, 0.04)
        assert np.array_equal(first.run.q, second.run.q)
        assert first.inputs == second.inputs

    @pytest.mark.parametrize(
        ("spoil", "what"),
        [
            (lambda data: data[:-1], "is not whole"),
            (lambda data: b"no state", "none of this package"),
            (lambda data: b"{}", "none of this package"),
            (lambda data: data.replace(b'"lift"', b'"left"', 1), "a unit with the inputs thrust, left"),
        ],
    )
    def test_bytes_of_another_unit(self, folder, spoil, what):
        motion = Motion(folder)
        motion.advance(0.0, 0.01)
        before = motion.run.q
        with pytest.raises(ancf.ModelError, match=what):
            motion.restore(Kept.from_bytes(spoil(motion.state().to_bytes())))
        assert np.array_equal(motion.run.q, before)
