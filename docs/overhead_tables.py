"""Compute the tables of docs/theory/overhead_line.md about the line of EN 50318:2018 anew.

Run from the repository root: python docs/overhead_tables.py [TABLE ...]

Prints their rows; all of them take some fifteen minutes of processor time.

===========  ===============================================================================
table        what
===========  ===============================================================================
ranges       the case as it is, and with the lowest spring relaxed where it stands at the start
changed      what is open in the data and what it does; fixed anchors
supports     uplift one support after the other, on twenty spans
trains       both lines, two pantographs: default mesh beside elements of 0.25 and 0.5 m
===========  ===============================================================================
"""

from __future__ import annotations

import sys
import warnings
from dataclasses import replace
from typing import Any

import numpy as np

from ancf import catenary
from ancf.catenary.answers.references import reference_case

NAME = "en50318-2018-ac-simple"
SPEEDS = (275, 320)
#: The two spans in the middle of ten, which the case evaluates, m.
MIDDLE = (220.0, 330.0)
FINE = catenary.Mesh(contact=0.25, messenger=0.5)
QUANTITIES = (
    "mean_force",
    "deviation",
    "deviation_0_5",
    "deviation_5_20",
    "maximum",
    "minimum",
    "height_range",
    "uplift",
    "loss",
)


def line(spans: int = 10, name: str = NAME) -> catenary.Line:
    """The line, of any number of its spans, which are all alike."""
    given = catenary.read_line(name)
    one = given.spans[0]
    return replace(
        given,
        spans=(one,) * spans,
        system_height=float(given.system_height[0]),
        stagger=float(given.stagger[0]),
    )


def unit(name: str = NAME, **changes: Any) -> catenary.Pantograph:
    """Its pantograph."""
    return replace(catenary.find_pantograph(reference_case(name).pantograph), **changes)


def numbers(run: catenary.Run, which: int = 0) -> dict[str, float]:
    """Quantities of one pantograph: N, mm, %."""
    found = catenary.statistics(run, which)
    return {k: found[k].value for k in QUANTITIES}


def row(*cells: Any) -> None:
    """Print a row of a table."""
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def ranges() -> None:
    """The case of the catalogue beside one relaxed at the start."""
    columns = []
    for kmh in SPEEDS:
        for place in ("mean", "start"):
            columns.append(
                numbers(
                    catenary.run(line(), speed=kmh / 3.6, pantograph=unit(relaxed_at=place), window=MIDDLE)
                )
            )
    for quantity in QUANTITIES:
        row(quantity, *(f"{column[quantity]:.4g}" for column in columns))


def changed() -> None:
    """What is open, with fixed anchors and the mean force of the law."""
    base, pan = replace(line(), anchors="fixed"), unit()

    def lower(c: float) -> dict[str, Any]:
        return {"pantograph": replace(pan, damping=(c, *pan.damping[1:]))}

    arm, drop = base.steady_arm, base.droppers
    cases: dict[str, dict[str, Any]] = {
        "base": {},
        "damping below the lowest mass 50 instead of 100 N s/m (U)": lower(50.0),
        "the same 150 N s/m": lower(150.0),
        "damping of the head 0 instead of 45 N s/m (U)": {
            "pantograph": replace(pan, damping=(*pan.damping[:2], 0.0))
        },
        "contact 25 kN/m": {"contact_stiffness": 25e3},
        "contact 100 kN/m": {"contact_stiffness": 100e3},
        "wire held at the supports in form finding": {"line": replace(base, contact_support="held")},
        "no clamps, droppers without mass": {
            "line": replace(base, droppers=replace(drop, mass=0.0, clamp_contact=0.0, clamp_messenger=0.0))
        },
        "hinged arm of 1.2 m and 1 kg": {
            "line": replace(base, steady_arm=catenary.SteadyArm(length=1.2, mass=1.0))
        },
        "no β": {"line": replace(base, damping=replace(base.damping, beta=0.0))},
        "droppers that can push": {"line": replace(base, droppers=replace(drop, slack=False))},
        "no stagger": {"line": replace(base, stagger=0.0)},
        "arm of 400 N/m": {"line": replace(base, steady_arm=replace(arm, vertical=400.0))},
        "no α": {"line": replace(base, damping=replace(base.damping, alpha=0.0))},
    }
    for name, change in cases.items():
        settings: dict[str, Any] = {"line": base, "pantograph": pan, "window": MIDDLE, **change}
        found = [numbers(catenary.run(speed=kmh / 3.6, **settings)) for kmh in SPEEDS]
        formats = ("deviation", ".1f"), ("minimum", ".0f"), ("uplift", ".1f")
        row(name, *(r" \| ".join(f"{one[key]:{form}}" for one in found) for key, form in formats))


def supports() -> None:
    """Uplift one support after the other, and the quantities of spans 10 and 11 of twenty."""
    for kmh in SPEEDS:
        run = catenary.run(line(20), speed=kmh / 3.6, pantograph=unit(), window=(495.0, 605.0))
        row(f"{kmh} km/h, mm", *(f"{1e3 * peak:.1f}" for peak in run.uplift.max(axis=0)))
        found = numbers(run)
        row("spans 10 and 11", *(f"{found[k]:.1f}" for k in ("deviation", "height_range", "uplift")))


def trains() -> None:
    """The largest change of any pantograph's σ and Fm between the default mesh and a fine one."""
    for name, spans in (("en50318-2002", 10), (NAME, 16)):
        for spacing in (200.0, 90.0):
            for kmh in (250, 275, 300, 320):
                found = []
                for mesh in (None, FINE):
                    run = catenary.run(
                        line(spans, name), speed=kmh / 3.6, pantograph=unit(name), spacing=spacing, mesh=mesh
                    )
                    found.append([numbers(run, which) for which in (0, 1)])
                cells = [" / ".join(f"{m[which]['deviation']:.1f}" for m in found) for which in (0, 1)]
                ratios = np.array(
                    [[m[which][k] for which in (0, 1) for k in ("deviation", "mean_force")] for m in found]
                )
                row(name, spacing, kmh, *cells, f"{100 * np.abs(ratios[0] / ratios[1] - 1).max():.1f} %")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    tables = {"ranges": ranges, "changed": changed, "supports": supports, "trains": trains}
    for wanted in sys.argv[1:] or tables:
        print(f"\n{wanted}\n", flush=True)
        tables[wanted]()
