"""The script of the measured cable, on a cable of its own making whose numbers are known."""

import numpy as np
import pytest

import ancf
from example_scripts import script

SECONDS = 0.6
#: The ends begin as their grippers move, not as a spline through the speeds of the markers says.
pytestmark = pytest.mark.filterwarnings("ignore:.*the support wins")


@pytest.fixture(scope="module")
def cable():
    made = script("measured_cable")
    made.FITTED = made.FITTED[:2]  # of four
    return made


@pytest.fixture(scope="module")
def truth(cable):
    bends = {f"bend_z{k}": x for k, x in enumerate((1.0, 0.5, 0.0, -0.5, 0.0, 0.5))}
    offsets = {"y5": 4e-3, "z7": -3e-3}
    return cable.START | bends | offsets | {"EI": 2e-3, "GJ": 3e-3, "drag": 0.03, "turned": 0.0, "A_y": 0.1}


def held(phase, count=81):
    """Thirteen markers of a cable whose far end is moved; those between are where they start."""
    t = np.arange(count) / 100.0
    u = np.concatenate([[-0.02], np.linspace(0.0, 1.0, 11), [1.02]])
    x = 0.75 * u + 0.03 * np.sin(2.0 * np.pi * u)
    shape = np.stack([x, 0.02 * np.sin(3.0 * u + phase), 1.1 * u * (u - 1.0)], axis=1)
    swing = np.stack([0.03 * np.sin(5.0 * t + phase), 0.04 * t, 0.03 * np.sin(4.0 * t)], axis=1)
    swing -= swing[0]
    moves = np.concatenate([np.zeros(2), np.linspace(0.0, 1.0, 9), np.ones(2)])
    return shape + moves[:, None] * swing[:, None, :]


@pytest.fixture(scope="module")
def path(cable, truth, tmp_path_factory):
    """A file of three runs that the script's own model made."""
    file = tmp_path_factory.mktemp("cable") / "runs.npz"
    names = (*cable.FITTED, "run200")
    arrays = {name: held(0.7 * k) for k, name in enumerate(names)}
    np.savez(file, **arrays)
    runs, places = cable.read(file)
    for name, run in runs.items():
        values, _ = cable.predicted(run, places, truth, SECONDS)
        arrays[name] = arrays[name][: len(values)]
        arrays[name][:, 2:11] = values
    np.savez(file, **arrays)
    return str(file)


def test_axes_along_a_curve_do_not_turn_about_it(cable):
    """Of a plane curve the normal stays; of a helix they lag by its torsion."""
    s = np.linspace(0.0, 3.0, 400)
    plane = np.stack([np.cos(s), np.sin(s), 0.0 * s], axis=1)
    assert cable.carried(plane, np.array([0.0, 0.0, 1.0]))[-1][:, 1] == pytest.approx([0.0, 0.0, 1.0])
    pitch = 0.6
    helix = np.stack([-np.sin(s), np.cos(s), pitch + 0.0 * s], axis=1) / np.hypot(1.0, pitch)
    normals = np.stack([-np.cos(s), -np.sin(s), 0.0 * s], axis=1)
    last = cable.carried(helix, normals[0])[-1]
    lag = np.arctan2(normals[-1] @ last[:, 2], normals[-1] @ last[:, 1])
    assert lag == pytest.approx(3.0 * pitch / np.hypot(1.0, pitch), rel=1e-4)


def test_natural_shape_of_constant_bend_is_a_circle(cable):
    p = {f"{a}{k}": {"bend_y": 0.0, "bend_z": 2.0}[a] for a in ("bend_y", "bend_z") for k in range(6)}
    points = cable.natural_shape(1.0, p, np.eye(3))
    assert points[-1] == pytest.approx([0.5 * np.sin(2.0), 0.0, 0.5 * (1.0 - np.cos(2.0))], abs=1e-4)


#: Runs that are fitted, and what is found from them.
FITS = {
    "one run": (1, ("EI", "bend_z0", "y5", "z7")),
    "two runs": (2, ("EI", "drag", "bend_z0", "y5", "z7")),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", FITS)
def test_finds_what_made_the_runs(cable, truth, path, case):
    """Stiffness, drag, bends and offsets together, from 2 mm of noise; the run that was not fitted too."""
    count, wanted = FITS[case]
    build = cable.Build(path, cable.FITTED[:count], SECONDS)
    data = build.data()
    draw = np.random.default_rng(3)
    data = {k: x if k == "t" else x + 2e-3 * draw.standard_normal(len(x)) for k, x in data.items()}
    bounds = {name: cable.BOUNDS[name] for name in wanted}
    start = {"EI": 1e-3, "drag": 0.02, "bend_z0": 0.0, "y5": 0.0, "z7": 0.0}
    start = {name: start[name] for name in wanted}

    def some(**p):
        numbers, known = build(**(truth | p))
        return numbers, {name: own for name, own in known.items() if name in wanted}

    found = ancf.calibrate(some, data, bounds, start=start, deviations=2e-3, tolerance=1e-6)
    for name in wanted:
        assert abs(found.values[name] - truth[name]) < 4.0 * found.deviations[name], name
    assert found.deviations["EI"] < 0.2 * truth["EI"]
    told = cable.errors(path, truth | found.values, SECONDS)
    assert told["run200"][0] < 2.0
    assert cable.errors(path, truth | start, SECONDS)["run200"][0] > 2.0 * told["run200"][0]
