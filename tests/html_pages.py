"""One page of each kind that the package writes, small: reports, comparisons, verdicts, the reproduction."""

import warnings
from pathlib import Path

import numpy as np

import ancf
import catenary_stand_in as stand_in
import fake_exhibits
from ancf.catenary import MeasuringHead, measure, write_run
from ancf.catenary.answers.kept import read_runs
from ancf.catenary.answers.quantity import Quantity
from ancf.catenary.answers.references import reference_case
from ancf.catenary.report import write_report
from ancf.catenary.report.comparison import write_comparison
from ancf.catenary.report.sweep import Sweep, write_sweep
from ancf.design.report.calibration import write_calibration
from ancf.design.sweep import SPACING, SPEED
from ancf.paper import verify
from ancf.validation import Group, write
from ancf.viz import style

T = np.linspace(0.0, 2.0, 41)


def line(folder):
    """A run against the ranges of a standard, with elasticity and a measuring pantograph."""
    run = stand_in.run()
    measured = [measure(run, head=MeasuringHead(corrected_mass=0.0))]
    given = {"reference": reference_case("en50318-2002"), "elasticity": stand_in.elasticity()}
    return write_report(run, folder / "report.html", measured=measured, **given)


def train(folder):
    """A run of two pantographs with its acceptance."""
    return write_report(stand_in.run(count=2, spacing=100.0), folder / "report.html")


def comparison(folder):
    for speed in (200, 270):
        write_run(stand_in.run(speed=speed / 3.6), folder / f"{speed}")
    return write_comparison(read_runs([folder / "200", folder / "270"]), folder, ["html"])[0]


def sweep(folder):
    rows = []
    for speed in (160.0, 200.0, 250.0):
        row = {SPEED: speed, SPACING: 100.0, "status": "ok", "message": ""}
        for k in (1, 2):
            row |= {f"mean_force_{k}": 100.0 + speed / 10, f"deviation_{k}": 10.0 * k + speed / 20}
            row |= {f"mean_force_low_{k}": 80.0, f"mean_force_high_{k}": 150.0, f"accepted_{k}": 2.0 - k}
            row |= {f"minimum_{k}": 30.0, f"maximum_{k}": 200.0, f"arcing_{k}": 0.0, f"uplift_{k}": 40.0}
        rows.append(row)
    rows[1] = {SPEED: 200.0, SPACING: 100.0, "status": "failed", "message": "run.start: outside"}
    told = Sweep("A line", rows, SPEED, SPACING, ["unit 1", "unit 2"], [("Pantographs", "unit 1, unit 2")])
    return write_sweep(told, folder, ["html"])[0]


def _ishigami(a, b, c):
    if a > 3.0:
        raise ancf.SolveError("t = 1 s", "diverged")
    return {"value": np.sin(a) + 7 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a), "level": 1.0}


def _study(folder, **sampling):
    angles = {name: ancf.Uniform(-np.pi, np.pi) for name in "abc"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of cases that fail and indices that few cases tell
        ancf.study(
            _ishigami, ancf.sample(angles, **sampling), folder=folder, workers=0, title="Ishigami's function"
        )
    return folder / "report.html"


def study(folder):
    """With percentiles and cases that failed."""
    return _study(folder, method="latin-hypercube", count=60, seed=1)


def indices(folder):
    """With Sobol' indices."""
    return _study(folder, method="saltelli", count=8, seed=1)


def long_names(folder):
    """With many outputs whose names are long, and numbers with many digits."""
    names = [f"largest_tension_of_the_{k}_th_stay_cable_in_newton" for k in range(9)]

    def case(a, b):
        return {name: -1.2345e-7 * (a + k * b) for k, name in enumerate(names)}

    varied = {name: ancf.Uniform(0.0, 1.0) for name in "ab"}
    samples = ancf.sample(varied, method="latin-hypercube", count=200, seed=1)
    ancf.study(case, samples, folder=folder, workers=0)
    return folder / "report.html"


def calibration(folder):
    draw = np.random.default_rng(1)
    data = {"t": T, "y [m]": 1.0 - 2.0 * T + 0.1 * draw.standard_normal(len(T))}
    fit = ancf.calibrate(lambda a, b: {"y [m]": a + b * T}, data, {"a": (-5.0, 5.0), "b": (-5.0, 5.0)})
    return write_calibration(folder / "report.html", fit, "A straight line")


def _curve():
    with style.new_figure(100.0, 60.0) as figure:
        figure.subplots().plot(T, T**2, color=style.BLUE)
        drawn = style.svg(figure)
    return drawn


def verdicts(folder):
    rows = [
        Quantity("a", "ratio of forces", "-", 6.58, 6.4, 6.7, "closed form"),
        Quantity("b", "peak", "N", -12345.6, -12000.0, -11000.0, "program"),
        Quantity("c", "drift", "1e-6", 0.2, None, None, "invariant"),
    ]
    groups = [Group("Capstan & rope", "Euler", rows), Group("Chain", "measured", rows[:2], picture=_curve)]
    return write("contact", "Contact", groups, folder)[1]


def reproduction(folder):
    """With an exhibit that passes, ones that fail and ones that could not be computed."""
    from ancf.paper import FIGURES

    kept = dict(FIGURES)
    try:
        FIGURES.clear()
        FIGURES.update({fake.name: fake for fake in fake_exhibits.FAKES})
        return verify(["all"], folder, short=True).page
    finally:
        FIGURES.clear()
        FIGURES.update(kept)


#: By what is shown; each writes its page into a folder and returns the file.
PAGES = {
    write.__name__: write
    for write in (
        *(line, train, comparison, sweep, study, indices, long_names),
        *(calibration, verdicts, reproduction),
    )
}


def written(name, folder):
    """The page of that name."""
    return Path(PAGES[name](folder))
