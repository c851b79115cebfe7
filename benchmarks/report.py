"""Tables of the results, for the terminal."""

from __future__ import annotations

from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

Results = dict[str, Any]


def show(results: Results, console: Console) -> None:
    """Print every table for which there are results."""
    console.print(speed(results["cases"]))
    console.print(counters(results["cases"]))
    if any(row["exudyn"] for row in results["cases"]):
        console.print(peers(results["cases"]))
    for row in results["cases"]:
        if "contacts" in row:
            console.print(contacts(row))
    for key, table in (
        ("memory", memory),
        ("elements", elements),
        ("kernels", kernels),
        ("startup_s", startup),
    ):
        if results.get(key):
            console.print(table(results[key]))
    if results.get("growth", {}).get("us_per_step_and_element"):
        console.print(growth(results["growth"]))
    console.print(f"[dim]{footer(results['machine'])}[/]")


def table(title: str, *columns: str) -> Table:
    """Table whose columns after the first are aligned to the right."""
    made = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False, min_width=len(title))
    for k, column in enumerate(columns):
        made.add_column(column, justify="left" if k == 0 else "right", no_wrap=True)
    return made


def number(value: float | None, form: str = ".4g") -> str:
    return "–" if value is None else format(value, form)


def name(row: Results) -> str:
    return f"{row['title']} {row.get('size', row['elements'])}"


def both(row: Results, key: str) -> str:
    """A counter of both sides."""
    peer = row["exudyn"].get(row["best"], {}).get(key)
    return f"{row['ancf'][key]} / {number(peer, '')}"


def speed(rows: list[Results]) -> Table:
    """One line for each case: our solve, the best of the peer's, and their ratio.

    Then the ratio from the empty model to the tip, and the one at equal accuracy.
    """
    columns = "ancf s", "Exudyn s", "ancf µs/step", "Exudyn µs/step", "ratio", "whole", "equal accuracy"
    made = table("CPU time of the solve (ancf, best variant of Exudyn)", "model, elements", *columns)
    for row in rows:
        sides = row["ancf"], row["exudyn"].get(row["best"], {})
        cells = [number(side.get(key)) for key in ("cpu_median", "us_per_step") for side in sides]
        ratios = row["ratio"], sides[1].get("ratio_whole"), row.get("equal_accuracy")
        made.add_row(name(row), *cells, *(number(ratio, ".1f") for ratio in ratios))
    return made


def counters(rows: list[Results]) -> Table:
    """What both sides did for it, and how far their results agree."""
    made = table("Work (ancf / Exudyn) and agreement of the tip in m", "model, elements", "steps", "Newton",
                 "Jacobians", "tips differ", "Newton error")  # fmt: skip
    for row in rows:
        errors = row["tip_difference"], row["ancf"]["newton_error"]
        work = (both(row, key) for key in ("newton_iterations", "jacobians"))
        made.add_row(name(row), str(row["ancf"]["steps"]), *work, *(number(e, ".0e") for e in errors))
    return made


def peers(rows: list[Results]) -> Table:
    """The ratio to each way to run the peer; the best one for the peer is marked."""
    columns = ("standard", "fast", "tuned")
    title = "Ratio by variant of Exudyn (* the best; in brackets: too inaccurate)"
    made = table(title, "model, elements", *columns, "whole", "tuned with")
    for row in rows:
        variants = row["exudyn"]
        whole = number(variants.get(row["best"], {}).get("ratio_whole"), ".1f")
        options = variants.get("tuned", next(iter(variants.values()), {})).get("options", {})
        cells = [variant(variants.get(key), key == row["best"]) for key in columns]
        made.add_row(name(row), *cells, whole, described(options))
    return made


def variant(peer: Results | None, best: bool) -> str:
    """Ratio to one variant."""
    if peer is None:
        return "–"
    text = number(peer["ratio"], ".1f")
    return text + "*" * best if peer["accurate"] else f"({text})"


def described(options: Results) -> str:
    """Options of the peer in a few words."""
    short = {
        "absoluteTolerance": "atol",
        "relativeTolerance": "rtol",
        "modifiedNewtonContractivity": "contr.",
        "maxIterations": "iterations",
    }
    parts = [f"{short[key]} {value:g}" for key, value in options.get("newton", {}).items()]
    radius = [f"rho {options['rho']:g}"] if "rho" in options else []
    pattern = ["pattern kept"] if options.get("pattern") else []
    return ", ".join([options.get("solver", ""), *pattern, *radius, *parts])


def contacts(row: Results) -> Table:
    """Each kind of contact of ours, and the peer's joint, which also pulls."""
    made = table(f"{name(row)}: kinds of contact (force in N between 20 and 220 m)", "contact", "µs/step",
                 "Newton/step", "Jacobians", "whole s", "ratio", "mean", "σ", "least", "largest")  # fmt: skip
    peer = row["exudyn"].get(row["best"])
    sides = [(kind, sample, sample["cpu"], sample["cpu_whole"]) for kind, sample in row["contacts"].items()]
    if peer is not None:
        sides.append(("Exudyn's joint", peer, peer["cpu_median"], peer["cpu_whole_median"]))
    for kind, sample, cpu, whole in sides:
        each, force = 1.0 / sample["steps"], sample["force"]
        ratio = None if peer is None or sample is peer else peer["cpu_median"] / cpu
        work = (number(1e6 * cpu * each), number(sample["newton_iterations"] * each, ".2f"))
        forces = (number(force.get(key), ".1f") for key in ("mean", "deviation", "least", "largest"))
        made.add_row(kind, *work, str(sample["jacobians"]), number(whole), number(ratio, ".1f"), *forces)
    return made


def memory(rows: list[Results]) -> Table:
    made = table("Peak memory, MB (after the import)", "model, elements", "ancf", "Exudyn")
    for row in rows:
        cells = [row[side] for side in ("ancf", "exudyn")]
        made.add_row(
            name(row), *(f"{c['peak_mb']:.0f} ({c['imported_mb']:.0f})" if c else "–" for c in cells)
        )
    return made


def elements(rows: list[Results]) -> Table:
    """Cost of each kind of element."""
    made = table("Our elements: 7.1 with 8 of them", "element", "steps", "Newton", "Jacobians",
                 "CPU s", "µs/step", "to the cable")  # fmt: skip
    for row in rows:
        work = (str(row[key]) for key in ("steps", "newton_iterations", "jacobians"))
        each = 1e6 * row["cpu_median"] / row["steps"]
        made.add_row(
            row["element"], *work, number(row["cpu_median"]), number(each), number(row["ratio"], ".1f")
        )
    return made


def kernels(rows: list[Results]) -> Table:
    names = [key for key in rows[0] if key not in ("element", "elements")]
    made = table("Our kernels, µs per element", "element, elements", *names)
    for row in rows:
        made.add_row(f"{row['element']} {row['elements']}", *(f"{row[key]:.3f}" for key in names))
    return made


def startup(times: dict[str, float]) -> Table:
    texts = {
        "python": "python -c pass",
        "import_ancf": 'python -c "import ancf"',
        "first_run": "ancf run, everything compiled anew",
        "later_run": "ancf run, later",
        "other_kinds": "ancf run of a hoist after it, its kinds compiled",
        "other_kinds_later": "ancf run of the hoist, later",
    }
    made = table("Start, wall time in s", "what", "s")
    for key, value in times.items():
        made.add_row(texts[key], f"{value:.2f}")
    return made


def growth(values: Results) -> Table:
    made = table("µs per step and element", "swinging cable", "ancf", "Exudyn")
    sizes: Results = values["us_per_step_and_element"]
    for size, both in sizes.items():
        made.add_row(size, number(both["ancf"], ".3f"), number(both["exudyn"], ".3f"))
    if values["ancf"] is not None:
        made.add_row("10000 / 100", number(values["ancf"], ".2f"), number(values["exudyn"], ".2f"))
    return made


def footer(machine: Results) -> str:
    versions = ", ".join(f"{key} {value}" for key, value in machine["versions"].items())
    return f"{machine['date']}, {machine['processor']}, {machine['cores']} cores, {versions}"
