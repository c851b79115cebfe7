"""Runs that a unit of another program leads, cut and resumed: what the unit remembers goes on with them."""

import json
import subprocess
import sys

import pytest

from helpers import some

pytest.importorskip("fmpy")

LAG = '''
from {library} import {words}, Fmi{n}Slave, Fmi{n}Causality
from {library}.enums import *


class Lag(Fmi{n}Slave):
    """A force that follows the place of a mass with two lags, and counts its steps."""

    def __init__(self, **given):
        super().__init__(**given)
        self.time, self.place, self.force, self.gain = 0.0, 0.0, 0.0, 1.0
        self.first, self.second, self.steps = 0.0, 0.0, 0
{independent}        self.register_variable({number}("place", causality=Fmi{n}Causality.input))
        self.register_variable({number}(
            "gain", causality=Fmi{n}Causality.parameter, variability=Fmi{n}Variability.tunable))
        self.register_variable({number}("force", causality=Fmi{n}Causality.output))

    def _get_fmu_state(self):
        names = ("place", "force", "gain", "first", "second", "steps")
        return {{name: getattr(self, name) for name in names}}

    def _set_fmu_state(self, state):
        for name, value in state.items():
            setattr(self, name, value)

    def do_step(self, current_time, step_size):
        self.steps += 1
        self.first += step_size / 0.07 * (self.place - self.first)
        self.second += step_size / 0.11 * (self.first - self.second)
        self.force = -self.gain * self.second + 1e-3 * self.steps
        return {done}
'''
WORDS = {
    "2": {"library": "pythonfmu", "words": "Real, Fmi2Variability", "number": "Real", "independent": "",
          "done": "True"},
    "3": {"library": "pythonfmu3", "words": "Float64, Fmi3Variability, Fmi3StepResult", "number": "Float64",
          "independent": (
              '        self.register_variable(Float64("time", causality=Fmi3Causality.independent,'
              " variability=Fmi3Variability.continuous))\n"
          ),
          "done": "Fmi3StepResult(status=Fmi3Status.ok)"},
}  # fmt: skip
#: The whole run, and one that is cut and goes on with the same controller, with another one, or late.
RUN = """
import json, os, sys, warnings
import numpy as np
import ancf
from ancf.control.delay import Delayed

path, folder, how = sys.argv[1:]
model = ancf.Model(gravity=(0, 0, -9.81))
rope = model.add_beam("rope", start=(0, 0, 0), end=(0.3, 0, -1), elements=2,
                      section=ancf.Section(EA=1e3, EI=0.1, rhoA=0.5))
model.pin(rope.start)
model.add_force(rope.end, (model.add_input("push", 0.0), 0, 0))

def unit(**more):
    return ancf.FmuController(path, step=0.004, parameters={"gain": 7.0}, outputs={"push": "force"},
                              inputs={"place": lambda run: run.position("rope.end")[0]}, **more)

def lead(controller):
    return Delayed(controller, 0.01) if how == "delayed" else controller

given = {"step": 2e-3, "control_step": 4e-3}
whole = ancf.simulate(model, t_end=0.4, controller=lead(unit()), **given)
first = lead(unit())
ancf.simulate(model, t_end=0.2, controller=first, file=f"{folder}/cut.h5", **given)
said = ""
second = first if how == "same" else lead(unit(restart=how == "restart"))
try:
    resumed = ancf.resume(f"{folder}/cut.h5", t_end=0.4, controller=second)
    apart = float(np.abs(np.asarray(whole.q) - np.asarray(resumed.q)).max())
    pushed = float(np.abs(whole.input("push") - resumed.input("push")).max())
    largest = float(np.abs(whole.input("push")).max())
except ancf.ModelError as error:
    apart = pushed = largest = -1.0
    said = str(error)
print(json.dumps({"apart": apart, "pushed": pushed, "largest": largest, "said": said}))
sys.stdout.flush()
os._exit(0)
"""


@pytest.fixture(scope="module")
def lags(tmp_path_factory):
    """By the version of FMI, and whether it gives its state: the unit as its library builds it."""
    folder, built = tmp_path_factory.mktemp("units"), {}
    for n, words in WORDS.items():
        pytest.importorskip(words["library"])
        script = folder / f"lag{n}.py"
        script.write_text(LAG.format(n=n, **words), "utf-8")
        for keeps in (True, False):
            into = folder / f"{n}{keeps}"
            options = ["--handle-state", "--serialize-state"] if keeps else []
            command = [sys.executable, "-m", words["library"], "build", "-f", script, "-d", into, *options]
            subprocess.run(list(map(str, command)), check=True, capture_output=True, timeout=300)
            built[n, keeps] = next(into.glob("*.fmu"))
    return built


def cut_and_resumed(path, folder, how):
    ran = subprocess.run(
        [sys.executable, "-c", RUN, str(path), str(folder), how], capture_output=True, text=True, timeout=900
    )
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout.splitlines()[-1])


@pytest.mark.parametrize("version", ["2", "3"])
@pytest.mark.parametrize("how", some(["another", "same", "delayed"]))
def test_the_run_is_that_which_was_not_cut(lags, tmp_path, version, how):
    found = cut_and_resumed(lags[version, True], tmp_path, how)
    assert found["said"] == ""
    assert found["largest"] > 0.5
    assert (found["apart"], found["pushed"]) == (0.0, 0.0)


@pytest.mark.parametrize("version", ["2", "3"])
def test_a_unit_that_cannot_give_its_state(lags, tmp_path, version):
    """Is refused; where it may start anew, the run is another one."""
    refused = cut_and_resumed(lags[version, False], tmp_path, "another")["said"]
    assert ".fmu: cannot give its state" in refused
    assert "restart=True" in refused
    anew = cut_and_resumed(lags[version, False], tmp_path, "restart")
    assert anew["said"] == ""
    assert anew["apart"] > 1e-6
