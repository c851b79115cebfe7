"""Make the tables of README.md from the numbers stored in the repository.

Run from the repository root: python docs/readme_figures.py

===============  ============================================================================
table            from
===============  ============================================================================
speed, cost      benchmarks/results.json, of a run of ``python benchmarks/run.py``
accuracy         docs/verification/checks.json, of a run of ``ancf reproduce all``
en50318          docs/verification/en50318.json, of the same run
===============  ============================================================================
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from verification_tables import table

ROOT = Path(__file__).resolve().parents[1]
README = ROOT / "README.md"
PLACE = re.compile(r"(<!-- made: (\w+) -->\n).*?(\n<!-- end -->)", re.DOTALL)
BUSY = 1.5  # load above which a row says so
#: Rows of the table of accuracy: what, names of the checks, whether the origin is the same discretisation.
SAME = "independent implementation of the same discretisation"
ACCURACY = (
    ("7.1, tip at 0.4 s, cable", r"7\.1 cable, \d+ elements?: tip"),
    ("7.1, tip at 0.4 s, both beams", r"7\.1 (original|nonlocking), \d+ elements?: tip"),
    ("7.2, tip and midpoint up to 2 s, cable", r"7\.2 cable"),
    ("7.2, tip and midpoint up to 2 s, both beams", r"7\.2 (original|nonlocking)"),
    ("7.3, lag of the tip at 7 s and 20 s and its largest, cable", r"7\.3 cable"),
    ("7.3, the same, both beams", r"7\.3 (original|nonlocking)"),
    ("7.4, mass and arc length up to 1 s, 6+2 cable elements", r"7\.4 cable"),
    # at 1 s the locking-free beam has made millimetres of round-off: the reference says so of itself
    ("7.4, the same up to 0.75 s, both beams", r"7\.4 (original|nonlocking), 6\+2, 0\."),
)


def main() -> None:
    """Write README.md."""
    README.write_text(page(README.read_text(encoding="utf-8")), encoding="utf-8")


def page(text: str) -> str:
    """A page with its tables made anew."""
    return PLACE.sub(lambda found: found[1] + TABLES[found[2]]() + found[3], text)


def read(*parts: str) -> dict[str, Any]:
    """A stored file."""
    found: dict[str, Any] = json.loads(ROOT.joinpath(*parts).read_text(encoding="utf-8"))
    return found


def speed() -> str:
    """Our solve against the best of the peer's that is as accurate, and whole processes' times."""
    rows: list[tuple[str, ...]] = []
    stored = read("benchmarks", "results.json")
    for case in stored["cases"]:
        peer, own = case["exudyn"][case["best"]], case["ancf"]
        default = next(iter(case["exudyn"].values()))
        name = f"{case['title']}, {case['size']}, {own['steps']}"
        beside = stored.get("measured", {}).get(case["name"], {}).get("load_before") or 0.0
        if beside > BUSY:
            name += f" (beside a load of {beside:.0f})"
        rows.append(
            (
                name,
                each(own["cpu_median"], own["steps"]),
                each(peer["cpu_median"], peer["steps"]),
                short(peer["ratio"]),
                short(default["ratio"]),
                short(peer["ratio_whole"]),
            )
        )
        if "contacts" in case:
            penalty = case["contacts"]["penalty"]
            ratios = [
                peer["cpu_median"] / penalty["cpu"],
                default["cpu_median"] / penalty["cpu"],
                peer["cpu_whole_median"] / penalty["cpu_whole"],
            ]
            own_step = each(penalty["cpu"], penalty["steps"])
            rows.append(("the same with our penalty contact", own_step, rows[-1][2], *map(short, ratios)))
    head = ("model, elements, steps", "ancf", "Exudyn, best", "ratio", "to its defaults", "whole")
    return table(head, rows)


def each(seconds: float, steps: int) -> str:
    """Time of a step."""
    micro = 1e6 * seconds / steps
    if steps == 1:
        return f"{short(1e-3 * micro)} ms"
    if micro < 200:
        return f"{short(micro)} µs/step"
    return f"{micro / 1e3:.2g} ms/step" if micro < 99.5e3 else f"{micro / 1e6:.2g} s/step"


def short(value: float) -> str:
    """Two digits, three above a hundred."""
    return f"{value:.2g}" if value < 99.5 else f"{value:.0f}"


def cost() -> str:
    """Start, memory, elements, growth."""
    stored, checks = read("benchmarks", "results.json"), read("docs", "verification", "checks.json")
    start, kinds = stored["startup_s"], {row["element"]: row["ratio"] for row in stored["elements"]}
    memory = max(stored["memory"], key=lambda row: row["elements"])
    rows = [
        ("`import ancf`", f"{start['import_ancf']:.2f} s"),
        ("first run after installation, compiling included", f"{start['first_run']:.0f} s"),
        ("later runs of `ancf run examples/cantilever.toml`", f"{start['later_run']:.1f} s"),
        (
            f"`ancf reproduce all`, {len(checks['checks'])} checks, {checks['jobs']} processes",
            f"{checks['seconds'] / 60:.1f} min",
        ),
        ("a step of 7.1 with 8 elements, original beam against cable", f"{kinds['original']:.1f} times"),
        ("the same, locking-free beam", f"{kinds['nonlocking']:.1f} times"),
        ("time per step and element, 10,000 elements against 100", f"{stored['growth']['ancf']:.1f} times"),
        (f"peak memory with {memory['elements']:,} elements", f"{memory['ancf']['peak_mb']:.0f} MB"),
    ]
    return table(("what", "measured"), rows)


def accuracy() -> str:
    """Largest differences from an independent program."""
    checks = read("docs", "verification", "checks.json")["checks"]
    rows = []
    for what, names in ACCURACY:
        found = [c for c in checks if re.match(names, c["name"]) and c["origin"].startswith(SAME)]
        metres = [c for c in found if c["unit"] == "m" and "timed" not in c["name"]]
        rows.append((what, str(len(metres)), f"{largest(metres):.0e} m"))
    return table(("what", "numbers", "largest difference"), rows)


#: Rows of a case that the README shows: name in the file, text, digits behind the point.
SHOWN = (
    ("mean force Fm", "Fm {} N", 1),
    ("standard deviation 0-20 Hz", "sigma {} N", 1),
    ("actual minimum", "{} N", 0),
    ("actual maximum", "to {} N", 0),
    ("uplift at support", "uplift {} mm", 1),
)


def en50318() -> str:
    """How many rows of each reference case are inside, which are not, and what was measured."""
    stored = read("docs", "verification", "en50318.json")
    cases: dict[tuple[str, float], list[dict[str, Any]]] = {}
    for row in stored["rows"]:
        named = dict(zip(stored["columns"], row, strict=True))
        cases.setdefault((named["case"], named["speed_kmh"]), []).append(named)
    lines = []
    for (case, speed), rows in cases.items():
        outside = [row for row in rows if row["verdict"] != "inside"]
        told = "".join(f"; {off_range(row)}" for row in outside)
        found = {row["quantity"]: row["value"] for row in rows}
        parts = [text.format(f"{found[key]:.{digits}f}") for key, text, digits in SHOWN]
        measured = ", ".join([*parts[:2], f"{parts[2].removesuffix(' N')} {parts[3]}", parts[4]])
        name = case.removeprefix("en50318-").replace("-ac-simple", " AC simple")
        lines.append(
            (f"{name}, {speed:g} km/h", f"{len(rows) - len(outside)} of {len(rows)}{told}", measured)
        )
    return table(("reference case", "rows inside the published ranges", "measured"), lines)


def off_range(row: dict[str, Any]) -> str:
    """A row that is outside, with its range."""
    return f"{row['quantity']} {row['value']:.4g} {row['unit']} ({row['low']:g} to {row['high']:g})"


def largest(found: Iterable[dict[str, Any]]) -> float:
    """Largest deviation of some checks."""
    return max(abs(c["value"] - c["reference"]) for c in found)


TABLES: dict[str, Callable[[], str]] = {
    "en50318": en50318,
    "speed": speed,
    "cost": cost,
    "accuracy": accuracy,
}

if __name__ == "__main__":
    main()
