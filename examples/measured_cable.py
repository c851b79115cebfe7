"""Fits a cable that two grippers moved, seen by motion capture, and predicts runs that were not fitted.

``python measured_cable.py cable.npz -o out`` takes arrays (n, 13, 3) in m at 100 Hz, one for each run: 13
markers along the cable, of which two at each end are held. Four runs are fitted, the others predicted from
the held markers alone. ``out`` gets the parameters with their intervals, the errors run by run and a picture.
"""

import argparse
import itertools
import json
import time
import warnings
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

import ancf

RATE, STEP, EVERY = 100.0, 0.01, 10  # samples/s; s; every tenth sample is fitted
DENSITY = 0.05  # kg/m, assumed: motions tell stiffness and drag per mass only
RADIUS = 6e-3  # m, of the section that stands for the cable
KNOTS = 6  # of the natural curvature
FREE = range(2, 11)  # markers between the grippers
FITTED = ("run101", "run105", "run109", "run113")
#: Size of what the model does not follow, m, as noise that is independent from one fitted sample to the next.
NOISE = 0.022
NEWTON = ancf.GeneralizedAlpha(rho_inf=0.5, newton=ancf.Newton(tolerance=1e-9))

#: Guesses of EI in N m^2: a soft cord of PVC with 6 mm (15 MPa), one with stiff insulation (100 MPa).
GUESSES = (9.5e-4, 6.4e-3)

BOUNDS = {"EI": (1e-5, 1e-1), "GJ": (1e-4, 1e-1), "retardation": (1e-3, 1.0), "drag": (1e-3, 0.3)}
PRIORS = {"length": (1.0, 0.01), "roll": (0.0, 1.0), "turned": (1.0, 0.5)}  # -, rad, -
PRIORS |= dict.fromkeys(("A_y", "A_z", "B_y", "B_z"), (0.0, 0.3))  # rad, of the clamps
PRIORS |= dict.fromkeys(("A_side", "A_up", "B_side", "B_up"), (0.0, 0.005))  # m
PRIORS |= {f"{axis}{k}": (0.0, 2.0) for axis in ("bend_y", "bend_z") for k in range(KNOTS)}  # 1/m
PRIORS |= {f"{axis}{k + 1}": (0.0, 0.005) for k in FREE for axis in ("y", "z")}  # m, marker off the axis
BOUNDS |= {name: (mean - 8.0 * size, mean + 8.0 * size) for name, (mean, size) in PRIORS.items()}
START = {name: mean for name, (mean, _) in PRIORS.items()}
START |= {"EI": 1e-3, "GJ": 2e-3, "retardation": 0.05, "drag": 0.02}


def unit(vector):
    return vector / np.linalg.norm(vector, axis=-1, keepdims=True)


def swung(directions, nominal):
    """Axes (n, 3, 3) of a gripper along directions (n, 3), turned from nominal ones on the shortest way."""
    side = unit(np.cross([0.0, 0.0, 1.0], nominal))
    first = np.stack([nominal, side, np.cross(nominal, side)], axis=1)
    across = np.cross(nominal, directions)
    sines = np.linalg.norm(across, axis=1, keepdims=True)
    angles = np.arctan2(sines, directions @ nominal[:, None])
    return Rotation.from_rotvec(across / np.maximum(sines, 1e-12) * angles).as_matrix() @ first


def carried(tangents, axis):
    """Axes (n, 3, 3) along tangents that do not turn about them; the second lies near an axis."""
    found = [np.stack([tangents[0], axis, np.cross(tangents[0], axis)], axis=1)]
    for here, there in itertools.pairwise(tangents):
        across = np.cross(here, there)
        sine = np.linalg.norm(across)
        angle = np.arctan2(sine, here @ there)
        turn = Rotation.from_rotvec(across / max(sine, 1e-12) * angle).as_matrix()
        found.append(turn @ found[-1])
    return np.array(found)


class Measured:
    """One run: its grippers, and how it starts."""

    def __init__(self, markers, nominal):
        self.markers = markers
        self.t = np.arange(len(markers)) / RATE
        self.ends = self.smooth(markers[:, 1], 8.0), self.smooth(markers[:, 11], 8.0)
        pairs = (markers[:, 1] - markers[:, 0], markers[:, 12] - markers[:, 11])
        directions = [unit(self.smooth(pair, 4.0)) for pair in pairs]
        self.axes = [swung(d, n) for d, n in zip(directions, nominal, strict=True)]
        powers = np.polynomial.polynomial.polyfit(self.t[:12], markers[:12].reshape(12, -1), 2)
        self.place, self.speed = powers[0].reshape(13, 3), powers[1].reshape(13, 3)

    def smooth(self, values, cutoff):
        return ancf.Series(self.t, values, cutoff=cutoff)(self.t)


def read(path):
    """Runs by name, and arc lengths (11,) of the markers from the first held one to the last, m.

    Lengths and mean directions of the grippers are those of the fitted runs.
    """
    with np.load(path) as file:
        arrays = {name: np.asarray(file[name], dtype=float) for name in file.files}
    fitted = np.concatenate([arrays[name] for name in FITTED])
    gaps = np.linalg.norm(np.diff(fitted, axis=1), axis=2)
    places = np.concatenate([[0.0], np.cumsum(np.median(gaps, axis=0)[1:11])])
    nominal = [unit(np.mean(unit(fitted[:, b] - fitted[:, a]), axis=0)) for a, b in ((0, 1), (11, 12))]
    return {name: Measured(x, nominal) for name, x in arrays.items()}, places


def natural_shape(length, p, axes, count=121):
    """Points of the curve with the natural bends, which begins along axes (3, 3)."""
    s, knots = np.linspace(0.0, length, count), np.linspace(0.0, length, KNOTS)
    y, z = (np.interp(s, knots, [p[f"{a}{k}"] for k in range(KNOTS)]) for a in ("bend_y", "bend_z"))
    turns = np.stack([0.0 * s, -z, y], axis=1)
    h, points = s[1], [np.zeros(3)]
    for before, after in itertools.pairwise(turns):
        middle = axes @ Rotation.from_rotvec(0.25 * h * (before + after)).as_matrix()
        points.append(points[-1] + h * middle[:, 0])
        axes = axes @ Rotation.from_rotvec(0.5 * h * (before + after)).as_matrix()
    return np.array(points)


def gripped(run, p):
    """Directions of both clamps at the start, and positions (n, 3) of both held ends."""
    directions, ends = [], []
    for end, axes, held in zip("AB", run.axes, run.ends, strict=True):
        one, two, three = axes[0].T
        directions.append(unit(one + np.tan(p[f"{end}_y"]) * two + np.tan(p[f"{end}_z"]) * three))
        ends.append(held + axes[:, :, 1] * p[f"{end}_side"] + axes[:, :, 2] * p[f"{end}_up"])
    return directions, ends


def start_shape(run, p, places, directions, ends, across):
    """Spline through the axis of the cable: the markers less their offsets."""
    points = run.place[1:12].copy()
    points[0], points[-1] = ends[0][0], ends[1][0]
    clamped = ((1, directions[0]), (1, directions[1]))
    spline = CubicSpline(places, points, bc_type=clamped)
    fine = np.linspace(0.0, places[-1], 101)
    axes = carried(unit(spline(fine, 1)), across)
    at = np.round(places[1:-1] / places[-1] * 100).astype(int)
    for k, marker in enumerate(FREE):
        own = axes[at[k]]
        points[1 + k] -= own[:, 1] * p[f"y{marker + 1}"] + own[:, 2] * p[f"z{marker + 1}"]
    return CubicSpline(places, points, bc_type=clamped)


def vectors(matrices):
    """Rotation vectors (n, 3) that go on past half a turn."""
    found = Rotation.from_matrix(matrices).as_rotvec()
    for before, here in itertools.pairwise(found):
        if before @ here < 0.0 and np.linalg.norm(here) > 2.0:
            here *= 1.0 - 2.0 * np.pi / np.linalg.norm(here)
    return found


def build(run, places, p):
    """Model of one run, its cable and the arc lengths of the markers."""
    along = places * p["length"]
    length = along[-1]
    directions, ends = gripped(run, p)
    across = run.axes[0][0][:, 1]
    across = unit(across - (across @ directions[0]) * directions[0])
    shape = start_shape(run, p, along, directions, ends, across)
    begun = np.stack([directions[0], across, np.cross(directions[0], across)], axis=1)
    area, inertia = np.pi * RADIUS**2, np.pi * RADIUS**4 / 4
    E = p["EI"] / inertia
    section = ancf.Section.circle(
        2.0 * RADIUS,
        E,
        DENSITY / area,
        J=2.0 * p["GJ"] / E,
        damping=p["drag"],
        axial_damping=0.5,
        bending_damping=p["retardation"] * p["EI"],
    )
    model = ancf.Model(gravity=(0.0, 0.0, -9.81), title="A measured cable")
    cable = model.add_beam(
        "cable",
        path=shape(np.linspace(0.0, length, 49)),
        elements=12,
        section=section,
        element="nonlocking",
        length=length,
        natural_shape=natural_shape(length, p, begun),
        y_axis=across,
    )
    cable.set_motion(along=along / length * cable.length, velocities=run.speed[1:12])
    held = carried(unit(shape(np.linspace(0.0, length, 400), 1)), across)[-1]
    turns = [axes @ axes[0].T for axes in run.axes]
    turns[1] = turns[1] @ twist(run, p, held, directions[1])
    for point, end, turn in zip((cable.start, cable.end), ends, turns, strict=True):
        model.clamp(
            point,
            displacement=ancf.Series(run.t, end - end[0]),
            rotation_vector=ancf.Series(run.t, vectors(turn)),
        )
    return model, cable, along


def twist(run, p, held, direction):
    """Turn of the far clamp about the cable (n, 3, 3) to the roll of its gripper, within 0.15 s."""
    mark = run.axes[1][0][:, 1]
    mark = unit(mark - (mark @ direction) * direction)
    roll = np.arctan2(mark @ held[:, 2], mark @ held[:, 1]) + p["roll"]
    roll = p["turned"] * ((roll + np.pi) % (2.0 * np.pi) - np.pi)
    x = np.clip(run.t / 0.15, 0.0, 1.0)
    return Rotation.from_rotvec((roll * x**2 * (3.0 - 2.0 * x))[:, None] * direction).as_matrix()


def axis_of(run, places, p, seconds):
    """Axis of the cable at the free markers (n, 9, 3), and both directions across it, at the samples."""
    model, cable, along = build(run, places, p)
    off, points = 2e-3, []
    for x in along[1:-1]:
        points += [cable.at(x), cable.at(x, off, 0.0), cable.at(x, 0.0, off)]
    result = ancf.simulate(
        model, t_end=seconds, step=STEP, integrator=NEWTON, sensors=points, output_step=seconds
    )
    found = np.stack([result.sensors.position(point) for point in points], axis=1)
    found = found.reshape(len(found), len(FREE), 3, 3)
    return found[:, :, 0], (found[:, :, 1:] - found[:, :, :1]) / off


def predicted(run, places, p, seconds):
    """Free markers (n, 9, 3), and their derivatives by their offsets, (n, 9, 2, 3)."""
    axis, across = axis_of(run, places, p, seconds)
    offsets = np.array([[p[f"y{k + 1}"], p[f"z{k + 1}"]] for k in FREE])
    return axis + np.einsum("tkoc,ko->tkc", across, offsets), across


def columns(name, values):
    """Histories by column, every tenth sample."""
    return {
        f"{name} {k + 1} {c}": values[::EVERY, i, j] for i, k in enumerate(FREE) for j, c in enumerate("xyz")
    }


class Build:
    """What is fitted: all columns of some runs, with the derivatives by the offsets of the markers."""

    def __init__(self, path, names, seconds):
        self.runs, self.places = read(path)
        self.names, self.seconds = names, seconds

    def __call__(self, **p):
        numbers, known = {}, {f"{a}{k + 1}": {} for k in FREE for a in "yz"}
        for name in self.names:
            values, across = predicted(self.runs[name], self.places, p, self.seconds)
            numbers |= columns(name, values)
            for i, k in enumerate(FREE):
                for o, a in enumerate("yz"):
                    own = {f"{name} {k + 1} {c}": across[::EVERY, i, o, j] for j, c in enumerate("xyz")}
                    known[f"{a}{k + 1}"] |= own
        return numbers, known

    def data(self):
        count = round(self.seconds * RATE) + 1
        measured = {"t": self.runs[self.names[0]].t[:count:EVERY]}
        for name in self.names:
            measured |= columns(name, self.runs[name].markers[:count, list(FREE)])
        return measured


def fit(path, names, seconds, start, workers, tolerance):
    """Fit some runs from their start to a time."""
    build_all = Build(path, names, seconds)
    more = {"priors": PRIORS, "deviations": NOISE, "workers": workers, "tolerance": tolerance}
    return ancf.calibrate(build_all, build_all.data(), BOUNDS, start=start, **more)


def errors(path, p, seconds=4.99):
    """By run: mean distance of the free markers from the measured ones, of its components, mm; seconds."""
    runs, places = read(path)
    found = {}
    for name, run in runs.items():
        began = time.perf_counter()
        values, _ = predicted(run, places, p, seconds)
        took = time.perf_counter() - began
        apart = 1e3 * (values - run.markers[: len(values), list(FREE)])
        found[name] = float(np.mean(np.linalg.norm(apart, axis=2))), float(np.mean(np.abs(apart))), took
    return found


def guessed(EI):
    """A straight cable that leaves the grippers along their markers, with a stiffness from a table."""
    plain = dict.fromkeys(PRIORS, 0.0) | {"length": 1.0}
    return plain | {"EI": EI, "GJ": EI / 1.3, "retardation": 0.05, "drag": 0.01}


def table(found):
    """Rows of errors by run, and the mean of the runs that were not fitted."""
    rows = ["run       fitted  mean, mm  components, mm  s"]
    rows += [
        f"{name:<10}{'yes' if name in FITTED else 'no':<8}{mean:8.1f}{part:16.1f}{took:6.2f}"
        for name, (mean, part, took) in found.items()
    ]
    others = [mean for name, (mean, *_) in found.items() if name not in FITTED]
    return "\n".join([*rows, f"mean of those that were not fitted: {np.mean(others):.1f} mm"])


def picture(path, p, name, file):
    """Cable and markers of a run at four times, from the side."""
    import matplotlib.pyplot as plt

    runs, places = read(path)
    values, _ = predicted(runs[name], places, p, 4.99)
    figure, panels = plt.subplots(1, 4, figsize=(10.0, 3.8), sharex=True, sharey=True, layout="constrained")
    for panel, at in zip(panels, (100, 230, 360, 499), strict=True):
        there = runs[name].markers[at]
        panel.plot(there[:, 0], there[:, 2], "o", color="0.5", ms=4, label="measured")
        line = np.concatenate([there[:2], values[at], there[11:]])
        panel.plot(line[:, 0], line[:, 2], "-", color="tab:blue", label="predicted")
        panel.set(title=f"{at / RATE:.1f} s", xlabel="x, m", aspect="equal")
    panels[0].set_ylabel("z, m")
    panels[0].legend(frameon=False)
    figure.savefig(file, dpi=150, bbox_inches="tight")


def main():
    """Fit, predict, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path", help="npz file with arrays (n, 13, 3) by run")
    parser.add_argument("-o", "--out", type=Path, default=Path("out"))
    parser.add_argument("--seconds", type=float, default=2.5, help="part of each run that is fitted")
    parser.add_argument("--start", type=Path, help="JSON file with parameters to begin from")
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    warnings.filterwarnings("ignore", message=".*the support wins")  # ends begin as the grippers move
    given.out.mkdir(parents=True, exist_ok=True)
    start = START | (json.loads(given.start.read_text()) if given.start else {})
    found = fit(given.path, FITTED, given.seconds, start, given.workers, 3e-3)
    (given.out / "fit.json").write_text(json.dumps(found.as_dict(), indent=1))
    (given.out / "values.json").write_text(json.dumps(found.values, indent=1))
    for name, (low, high) in found.confidence().items():
        print(f"{name:<12}{found.values[name]:12.5g}   {low:.4g} to {high:.4g}")
    print(table(errors(given.path, found.values)))
    for EI in GUESSES:
        print(f"guess: straight, EI = {EI:g} N m2")
        print(table(errors(given.path, guessed(EI))))
    picture(given.path, found.values, "run111", given.out / "run111.png")


if __name__ == "__main__":
    main()
