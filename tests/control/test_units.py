"""Units of other programs as controllers: built by PythonFMU, run by FMPy, beside a frame in Python."""

import json
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import ancf
from ancf import ModelError

pytest.importorskip("fmpy")

FRAME = '''
from {library} import {words}, Fmi{n}Slave, Fmi{n}Causality
from {library}.enums import *


class Frame(Fmi{n}Slave):
    """The lower mass of a pantograph below a head whose motion it is given."""

    def __init__(self, **given):
        super().__init__(**given)
        self.time, self.head, self.rate, self.force = 0.0, 0.0, 0.0, 0.0
        self.mass, self.stiffness, self.damping = 15.0, 4200.0, 10.0
        self.z, self.v, self.start = 0.0, 0.0, None
{independent}        for name in ("head", "rate"):
            self.register_variable({number}(name, causality=Fmi{n}Causality.input))
        for name in ("mass", "stiffness", "damping"):
            self.register_variable({number}(
                name, causality=Fmi{n}Causality.parameter, variability=Fmi{n}Variability.tunable))
        self.register_variable({number}("force", causality=Fmi{n}Causality.output))

    def do_step(self, current_time, step_size):
        self.start = self.head if self.start is None else self.start
        if current_time > 0.5 and self.mass > 100.0:
            return {failed}
        head, part = self.head - self.start, step_size / 10
        for _ in range(10):
            pull = self.stiffness * (self.z - head) + self.damping * (self.v - self.rate)
            self.v += part * (-50.0 * self.z - 90.0 * self.v - pull) / self.mass
            self.z += part * self.v
            head += part * self.rate
        self.force = self.stiffness * (self.z - head) + self.damping * (self.v - self.rate)
        return {done}
'''
WORDS = {
    "2": {"library": "pythonfmu", "words": "Real, Fmi2Variability", "number": "Real", "independent": "",
          "done": "True", "failed": "False"},
    "3": {"library": "pythonfmu3", "words": "Float64, Fmi3Variability, Fmi3StepResult", "number": "Float64",
          "independent": (
              '        self.register_variable(Float64("time", causality=Fmi3Causality.independent,'
              " variability=Fmi3Variability.continuous))\n"
          ),
          "done": "Fmi3StepResult(status=Fmi3Status.ok)",
          "failed": "Fmi3StepResult(status=Fmi3Status.error)"},
}  # fmt: skip
#: A frame under a head along a line, in a process of its own: such units may end one badly when it exits.
RUN = """
import json, os, sys
sys.path[:0] = sys.argv[2:]
import ancf, numpy as np
from ancf.catenary import Pantograph, form, run
from overhead_lines import COARSE, short_line
from test_overhead_bodies import FORCE, HEAD, STEP, WAY, Frame

unit = ancf.FmuController(
    sys.argv[1], step=STEP, parameters={"mass": 15.0}, outputs={"pantograph_force": "force"},
    inputs={"head": lambda run: run.position("pantograph mass 1")[2],
            "rate": lambda run: run.velocity("pantograph mass 1")[2]},
)
found = form(short_line(), COARSE)
head = Pantograph(masses=(HEAD,), stiffness=(0.0,), damping=(1e-6,), static_force=FORCE)
forces = [
    run(found, pantograph=head, controller=controller, control_step=STEP, **WAY).recordings[0].force
    for controller in (unit, Frame(), unit)
]
print(json.dumps({"deviation": float(np.std(forces[1])), "apart": float(np.abs(forces[0] - forces[1]).max()),
                  "again": float(np.abs(forces[0] - forces[2]).max())}))
sys.stdout.flush()
os._exit(0)
"""
FAILS = """
import os, sys
import ancf
model = ancf.Model(gravity=(0, 0, -9.81))
mass = model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
model.add_force(mass, (0, 0, model.add_input("lift", 9.81)))
asks = {"head": lambda run: run.position("mass")[2], "rate": lambda run: 0.0}
outputs, parameters = {"lift": "force"}, {"mass": 200.0}
unit = ancf.FmuController(sys.argv[1], step=0.01, inputs=asks, outputs=outputs, parameters=parameters)
for every in (0.02, 0.01):
    try:
        ancf.simulate(model, t_end=1.0, step=0.01, controller=unit, control_step=every)
    except ancf.ModelError as error:
        print(error)
sys.stdout.flush()
os._exit(0)
"""


def call(script, *arguments):
    ran = subprocess.run(
        [sys.executable, "-c", script, *map(str, arguments)], capture_output=True, text=True, timeout=900
    )
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


@pytest.fixture(scope="module")
def frames(tmp_path_factory):
    """The unit of each version of FMI, as its library builds it."""
    folder = tmp_path_factory.mktemp("units")
    for n, words in WORDS.items():
        pytest.importorskip(words["library"])
        script = folder / f"frame{n}.py"
        script.write_text(FRAME.format(n=n, **words), "utf-8")
        command = [sys.executable, "-m", words["library"], "build", "-f", str(script), "-d", str(folder / n)]
        subprocess.run(command, check=True, capture_output=True, timeout=300)
    return {n: next((folder / n).glob("*.fmu")) for n in WORDS}


@pytest.mark.parametrize("version", ["2", "3"])
def test_a_frame_leads_the_head_of_a_pantograph(frames, version):
    """The numbers are those of the same frame in Python, also in a second run with the same unit."""
    tests = Path(__file__).parent.parent
    found = json.loads(call(RUN, frames[version], tests, tests / "catenary").splitlines()[-1])
    assert found["deviation"] > 10.0
    assert found["apart"] == pytest.approx(0.0, abs=1e-9)
    assert found["again"] == 0.0


@pytest.mark.parametrize("version", ["2", "3"])
def test_a_step_that_is_refused_and_one_of_another_length(frames, version):
    other, refused = [
        line for line in call(FAILS, frames[version]).splitlines() if "FmuC" in line or "t =" in line
    ]
    assert "FmuController.step: is 0.01 s, but the run asks at t = 0.02 s" in other
    assert "control_step" in other
    assert "refuses a step at t = 0.51 s" in refused


class TestBadInput:
    @pytest.mark.parametrize(
        ("change", "where", "what"),
        [
            ({"inputs": {"hed": float}}, "FmuController.inputs", 'did you mean "head"'),
            ({"inputs": {"force": float}}, "FmuController.inputs", 'must be one of "head", "rate"'),
            ({"inputs": {"head": 3.0}}, "FmuController.inputs['head']", "must be a function of the run"),
            ({"inputs": {"head": float}}, "FmuController.inputs['head']", "is the class float"),
            ({"outputs": {"lift": "mass"}}, "FmuController.outputs", 'must be one of "force"'),
            ({"parameters": {"mass": "heavy"}}, "FmuController.parameters['mass']", "must be a number"),
            ({"step": 0.0}, "FmuController.step", "must be > 0"),
        ],
    )
    def test_names_and_numbers(self, frames, change, where, what):
        given = {"step": 0.01, "inputs": {"head": abs}, "outputs": {"lift": "force"}} | change
        with pytest.raises(ModelError) as error:
            ancf.FmuController(frames["2"], **given)
        assert error.value.where == where
        assert what in str(error.value)

    def test_files(self, frames, tmp_path):
        with zipfile.ZipFile(tmp_path / "empty.fmu", "w") as archive:
            archive.writestr("readme.txt", "nothing")
        (tmp_path / "text.fmu").write_text("no archive", "utf-8")
        for name, what in (
            ("none.fmu", "no such file"),
            ("text.fmu", "is no unit"),
            ("empty.fmu", "is no unit"),
        ):
            with pytest.raises(ModelError, match=what):
                ancf.FmuController(tmp_path / name, step=0.01, inputs={}, outputs={})
