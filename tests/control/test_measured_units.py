"""Units of co-simulation whose model names CSV files, against an equation that scipy solves."""

import json
import shutil
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import ancf
from ancf.cosimulation.fmu import export_fmu
from helpers import some

pytest.importorskip("fmpy")

#: A mass on a spring and a damper, of which a measurement moves the other end, and that is pushed.
MODEL = """
[[inputs]]
name = "push"

[[bodies]]
type = "point_mass"
name = "mass"
at = [1, 0, 0]
mass = 2.0

[[bodies]]
type = "point_mass"
name = "hand"
at = [0, 0, 0]
mass = 1.0

[[supports]]
type = "hold"
point = "hand"
position = "xyz"
displacement = [{ csv = "lab/day.csv", column = "x", relative = true }, 0, 0]

[[supports]]
type = "hold"
point = "mass"
position = "yz"

[[connections]]
type = "spring"
name = "tie"
a = "hand"
b = "mass"
stiffness = 80.0
damping = 1.0
length = 1.0

[[loads]]
type = "force"
point = "mass"
force = [{ csv = "lab/day.csv", column = "F" }, 0, 0]

[[loads]]
type = "force"
point = "mass"
force = ["push", 0, 0]

[simulation]
t_end = 1.0
step = 1e-3
sensors = ["mass", "tie"]
"""
STEP, PUSH, PUSHED = 1e-3, 3.0, 0.2
#: What an importer does, in a process of its own.
IMPORTER = """
import json, os, sys
import fmpy, numpy as np
file, begin, push, pushed = sys.argv[1], *map(float, sys.argv[2:])
given = [(begin, 0.0), (begin + pushed, 0.0), (begin + pushed, push), (begin + 9.0, push)]
given = np.array(given, dtype=[("time", float), ("push", float)])
found = fmpy.simulate_fmu(file, start_time=begin, stop_time=begin + 1.0, step_size=0.01,
                          output_interval=0.01, input=given)
print(json.dumps({name: found[name].tolist() for name in found.dtype.names}))
sys.stdout.flush()
os._exit(0)
"""
#: First and last time of what was measured, s.
SPANS = [(-0.2, 1.5), (-0.2, 0.7), (0.0, 0.395), (0.1, 0.8)]


def measured(first, last):
    t = np.linspace(first, last, 300)
    return t, 0.02 * np.sin(9 * t), np.cos(5 * t)


def exported(folder, first, last, version):
    """A unit whose files are gone when it runs."""
    (folder / "lab").mkdir(parents=True)
    rows = [
        f"{1e3 * t!r};{1e3 * x!r};{1e-3 * f!r}" for t, x, f in np.transpose(measured(first, last)).tolist()
    ]
    text = "t [ms];x [mm];F [kN]\n" + "\n".join(rows).replace(".", ",")
    (folder / "lab" / "day.csv").write_text(text, "utf-8")
    (folder / "model.toml").write_text(MODEL, "utf-8")
    export_fmu(folder / "model.toml", folder.parent / "unit.fmu", version)
    shutil.rmtree(folder)
    return folder.parent / "unit.fmu"


def solved(first, last, at):
    """Place and velocity of the mass; a push that is told acts from the middle of a step on."""
    t, x, f = measured(first, last)
    place, force = CubicSpline(t, x), CubicSpline(t, f)
    acts = PUSHED + 0.5 * STEP

    def rates(s, y, push):
        held = np.clip(s, first, last)
        moves = place(s, 1) if first < s < last else 0.0
        pull = 80.0 * (y[0] - place(held) + x[0]) + y[1] - moves
        return y[1], (force(held) + push - pull) / 2.0

    y, times, found = np.zeros(2), sorted({0.0, acts, 1.0, *(s for s in (first, last) if 0 < s < 1)}), []
    for begin, end in pairwise(times):
        told = at[(at >= begin) & ((at < end) | (end == 1.0))]
        how = {"rtol": 1e-10, "atol": 1e-12, "dense_output": True}
        run = solve_ivp(rates, (begin, end - 1e-12), y, args=(PUSH if begin >= acts else 0.0,), **how)
        found.append(run.sol(np.minimum(told, end - 1e-12)))
        y = run.y[:, -1]
    return np.concatenate(found, axis=1)


@pytest.mark.filterwarnings("ignore:.*its rate jumps:UserWarning")
@pytest.mark.parametrize("begin", [0.0, 5.0])
@pytest.mark.parametrize(("first", "last"), some(SPANS))
def test_moves_as_its_equation_does(first, last, begin, tmp_path):
    """Whenever the importer begins: what was measured counts from there, and stays outside of its times."""
    file = exported(tmp_path / "made", first, last, "2.0" if begin else "3.0")
    command = [sys.executable, "-c", IMPORTER, str(file), str(begin), str(PUSH), str(PUSHED)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    found = {name: np.array(x) for name, x in json.loads(done.stdout.splitlines()[-1]).items()}
    place, velocity = solved(first, last, found["time"] - begin)
    assert np.ptp(place) > 1e-2
    assert np.abs(found["mass.position.x"] - 1.0 - place).max() < 5e-6
    assert np.abs(found["mass.velocity.x"] - velocity).max() < 5e-5


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("lab/day.csv", "lab/night.csv", "no such file"),
        ('column = "F"', 'column = "G"', 'the file has the columns "t'),
        ('column = "F"', 'column = "x"', "m"),
    ],
)
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_what_is_wrong_is_said_before_a_unit_is_written(old, new, says, version, tmp_path, monkeypatch):
    monkeypatch.setitem(globals(), "MODEL", MODEL.replace(old, new))
    with pytest.raises(ancf.ModelError) as caught:
        exported(tmp_path / "made", 0.0, 1.0, version)
    assert says in str(caught.value)
    assert not list(tmp_path.glob("*.fmu"))
