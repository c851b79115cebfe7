"""Lines and pantographs for the overhead-line oracle, and the statistics of a run."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.signal import butter, sosfilt, sosfiltfilt

from overhead_oracle import Line, OverheadLine, Wire
from overhead_stepping import Pantograph, Run

#: Reference model of EN 50318:2002.
LINE_2002 = Line(
    span=60.0,
    spans=10,
    droppers=(5.0, 10.5, 17.0, 23.5, 30.0, 36.5, 43.0, 49.5, 55.0),
    contact=Wire(mass=1.35, tension=20e3, EI=195.0, support=300.0),
    messenger=Wire(mass=1.07, tension=16e3, EI=131.7, support=50e3),
    system_height=1.2,
    dropper_stiffness=100e3,
    alpha=0.0125,
    beta=1e-4,
)
PANTOGRAPH_2002 = Pantograph((15.0, 7.2), (50.0, 4200.0), (90.0, 10.0), force=120.0)

DROPPERS_2018 = tuple(4.5 + 5.75 * k for k in range(9))
#: AC simple line of EN 50318:2018 and of the 2015 benchmark; contact wire free at the supports.
LINE_2018 = Line(
    span=55.0,
    spans=10,
    droppers=DROPPERS_2018,
    sag=tuple(55e-3 * (1 - ((x - 27.5) / 23.0) ** 2) for x in DROPPERS_2018),
    contact=Wire(mass=1.35, tension=22e3, EI=195.0, support=267.0),
    messenger=Wire(mass=1.08, tension=16e3, EI=131.7, support=500e3),
    system_height=1.2,
    dropper_EA=200e3,
    dropper_mass=0.117,
    clamps=(0.165, 0.195),
    held=False,
    alpha=0.0125,
    beta=1e-4,
)
PANTOGRAPH_2015 = Pantograph((6.0, 9.0, 7.5), (160.0, 15500.0, 7000.0), (100.0, 0.1, 45.0), force=143.4)

#: The line of the paper's example 7.5 as the catalogue has it, without its zigzag.
LINE_PAPER = Line(
    span=60.0,
    spans=4,
    droppers=tuple(7.5 * k for k in range(1, 8)),
    contact=Wire(mass=0.89, tension=10e3, EI=150.0, support=300.0, viscous=0.03),
    messenger=Wire(mass=0.446, tension=10e3, EI=150.0, support=np.inf, viscous=0.03),
    system_height=1.5,
    dropper_EA=1.342e6,
    dropper_mass=0.089,
    dropper_damping=8.0,
)
PANTOGRAPH_PAPER = replace(PANTOGRAPH_2002, force=100.0, at_start=True)


def filtered(force, step, low=None, high=20.0, order=2, causal=False):
    """Butterworth filter of that order, 0 or low to high; forwards and backwards unless causal."""
    if low is None:
        sos = butter(order, high, fs=1 / step, output="sos")
    else:
        sos = butter(order, (low, high), "bandpass", fs=1 / step, output="sos")
    if causal:
        return sosfilt(sos, force)
    return sosfiltfilt(sos, force)


def statistics(history, step, window, masts=(), **options):
    """Quantities of EN 50317 over the window of the track [m]; forces in N, heights in mm."""
    inside = (history["x"] >= window[0]) & (history["x"] <= window[1])
    raw = history["force"]
    F = filtered(raw, step, **options)[inside]
    bands = {
        "sigma_0_5": filtered(raw, step, high=5.0, **options)[inside].std(),
        "sigma_5_20": filtered(raw, step, low=5.0, **options)[inside].std(),
    }
    mean, sigma = F.mean(), F.std()
    height = 1e3 * history["height"][inside]
    at = [k for k, x in enumerate(masts[1:-1]) if window[0] - 1e-6 <= x <= window[1] + 1e-6]
    uplift = 1e3 * history["uplift"][:, at].max(axis=0) if at else np.array([np.nan])
    return {
        "mean": mean, "sigma": sigma, **bands, "mean_plus": mean + 3 * sigma, "mean_minus": mean - 3 * sigma,
        "max": F.max(), "min": F.min(), "raw_max": raw[inside].max(), "raw_min": raw[inside].min(),
        "height_range": height.max() - height.min(), "uplift": uplift.max(),
        "loss": 100 * (raw[inside] <= 0).mean(),
    }  # fmt: skip


def evaluate(
    line, pantograph, speed, step=1e-3, window=None, start=20.0, mesh=None, scheme=None, after=20.0, **options
):
    """One run and its statistics over the window (default: the two middle spans)."""
    system = OverheadLine(line, **(mesh or {}))
    window = window or (line.span * (line.spans // 2 - 1), line.span * (line.spans // 2 + 1))
    history = Run(system, pantograph, speed, step, **(scheme or {})).run(start, window[1] + after)
    return statistics(history, step, window, system.masts, **options)


#: Filters of the recorded statistics.
FILTERS = {
    "zero_phase_2": {"order": 2},
    "zero_phase_4": {"order": 4},
    "causal_2": {"order": 2, "causal": True},
    "causal_4": {"order": 4, "causal": True},
}


def recorded(line, pantograph, speed, window, start, size, step, mean=None):
    """Statistics with all filters; with `mean` [N] the static force is first set so that this is the mean."""
    system = OverheadLine(line, size)
    for _ in range(3):
        history = Run(system, pantograph, speed, step).run(start, window[1] + 20.0)
        rows = {k: statistics(history, step, window, system.masts, **f) for k, f in FILTERS.items()}
        if mean is None or abs(rows["zero_phase_4"]["mean"] - mean) < 0.02:
            break
        pantograph = replace(pantograph, force=pantograph.force + mean - rows["zero_phase_4"]["mean"])
    rows = {k: {q: round(float(x), 4) for q, x in row.items()} for k, row in rows.items()}
    case = {"window": window, "start": start, "element_length": size, "step": step, "force": pantograph.force}
    return case | rows


def form_of(line, size=0.1):
    """Loads, lengths and heights of the droppers of a span in the middle of the line."""
    form, n = OverheadLine(line, size), len(line.droppers)
    middle = slice(n * (line.spans // 2), n * (line.spans // 2 + 1))
    heights = [wire.node(form.at) for wire in (form.messenger, form.contact)]
    height = form.rest_messenger[heights[0]] - form.rest[heights[1]]
    return {
        "element_length": size,
        "held": line.held,
        "dropper_load": form.load[middle].round(3).tolist(),
        "dropper_length": form.length[middle].round(5).tolist(),
        "dropper_height": height[middle].round(5).tolist(),
    }


def case_2002(kmh, size, step):
    """A speed of the case of 2002."""
    return recorded(LINE_2002, PANTOGRAPH_2002, kmh / 3.6, (240.0, 360.0), 20.0, size, step)


def case_2018(kmh, size, step):
    """A speed of the case of 2018, at the mean force of the standard's law."""
    mean = 0.00097 * kmh**2 + 70
    pantograph = replace(PANTOGRAPH_2015, force=mean)
    return recorded(LINE_2018, pantograph, kmh / 3.6, (220.0, 330.0), 20.0, size, step, mean)


def case_paper(speed, size, step):
    """A speed, m/s, of the paper's example; its line is short: the start is part of the case."""
    return recorded(LINE_PAPER, PANTOGRAPH_PAPER, speed, (60.0, 180.0), 2.0, size, step)


LINES = {"en50318-2002": LINE_2002, "en50318-2018": LINE_2018, "paper": LINE_PAPER}
CASES = {
    "en50318-2002": (case_2002, (250, 300)),
    "en50318-2018": (case_2018, (275, 320)),
    "paper": (case_paper, (32, 45)),
}


#: Trains that are recorded: line, pantograph, number of spans, speed [km/h], distance [m], window [m].
TRAINS = {
    "en50318-2002.250.train-200": (LINE_2002, PANTOGRAPH_2002, 9, 250, 200.0, (240.0, 300.0)),
    "en50318-2018.320.train-90": (
        LINE_2018, replace(PANTOGRAPH_2015, force=0.00097 * 320**2 + 70), 8, 320, 90.0, (220.0, 275.0)
    ),
}  # fmt: skip


def recorded_train(name, size=0.5, messenger=2.0, finest=0.05, step=5e-4, start=20.0):
    """Statistics of both pantographs of a train, on elements that are short beside droppers and supports."""
    line, pantograph, spans, kmh, gap, window = TRAINS[name]
    system = OverheadLine(replace(line, spans=spans), size, messenger, finest)
    history = Run(system, pantograph, kmh / 3.6, step, behind=(0.0, gap)).run(start, window[1] + 20.0)
    keys, case = ("mean", "sigma", "sigma_0_5", "sigma_5_20", "max", "min"), {}
    for k, which in enumerate(("first", "second")):
        own = history | {key: history[key][:, k] for key in ("x", "force", "height")}
        found = statistics(own, step, window, system.masts, **FILTERS["zero_phase_4"])
        case[which] = {key: round(float(found[key]), 4) for key in keys}
    settings = {"element_length": size, "messenger": messenger * size, "finest": finest, "step": step}
    given = {"window": window, "start": start, "spacing": gap, "spans": spans, "force": pantograph.force}
    return given | settings | {"filter": "zero_phase_4"} | case


def record(path, names=tuple(LINES), size=0.25, step=2.5e-4):
    """Write the converged numbers of these lines into a file, all others stay (about ten minutes for all)."""
    numbers = json.loads(Path(path).read_text(encoding="utf-8")) if Path(path).exists() else {}
    mark = "independent linear model, tests/overhead_oracle.py, "
    numbers["origin"] = f"{mark}element length {size} m, step {1e3 * step} ms; N, mm, %"
    for name in names:
        numbers[f"{name}.form"] = form_of(LINES[name])
        make, speeds = CASES[name]
        for speed in speeds:
            numbers[f"{name}.{speed}"] = make(speed, size, step)
        numbers |= {train: recorded_train(train) for train in TRAINS if train.startswith(f"{name}.")}
    write(path, numbers)


def write(path, numbers):
    """Write numbers as JSON."""
    Path(path).write_text(json.dumps(numbers, indent=1) + "\n", encoding="utf-8")


def excerpt(numbers):
    """What the package takes of the recorded numbers for the paper's example."""
    made = numbers["origin"].split(", ", 1)[1].split(";")[0]
    runs = {f"{v}": numbers[f"paper.{v}"]["zero_phase_4"] for v in CASES["paper"][1]}
    return {
        "origin": f"independent plane linear model of the line ({made}, filter of order 4)",
        "heights": numbers["paper.form"]["dropper_height"],
        "runs": {v: {key: row[key] for key in ("mean", "sigma", "max", "min")} for v, row in runs.items()},
    }


if __name__ == "__main__":
    # python tests/overhead_cases.py tests/data/overhead_oracle.json src/ancf/paper/data/plane.json paper
    record(sys.argv[1], sys.argv[3:] or tuple(LINES))
    write(sys.argv[2], excerpt(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))))
