"""Make the pages in docs/verification from the numbers stored there.

Run from the repository root: python docs/verification_book.py, or with the folder of an ``ancf reproduce``
whose numbers are to be stored first.

========================  ==================================================================
docs/verification/...     from
========================  ==================================================================
checks.json               a run of ``ancf reproduce all``: its checks.json
en50318.json              the same run: all rows of the standards' cases
across.toml               what two ways of computing must agree in, written by hand
benchmarks/results.json   a run of ``python benchmarks/run.py``
========================  ==================================================================
"""

from __future__ import annotations

import json
import shutil
import sys
import tomllib
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from verification_tables import Check, check_table, most_used, percent, range_table, table, toctree

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "verification"

#: Chapters of the checks, in their order: page, title, names of exhibits; the rest belongs to "paper".
CHAPTERS = {
    "closed_forms": ("Closed forms", ("closed-forms", "connections", "overhead")),
    "orders": ("Convergence orders", ("orders",)),
    "derivatives": ("Derivatives", ("derivatives",)),
    "methods": ("Agreement across methods", ()),
    "peers": ("Independent programs", ()),
    "paper": ("The paper, figure by figure", ()),
    "en50318": ("EN 50318", ("en50318",)),
}
#: Chapters that each check belongs to one of.
JUDGED = ("closed_forms", "orders", "derivatives", "paper", "en50318")
#: Test files that assert the numbers of an exhibit too, beside tests/paper/test_paper_checks.py.
TESTS = {
    "fig1": "kernels/test_elements.py",
    "table2": "paper/test_paper_sliding.py",
    "closed-forms": "closed_forms/test_closed_forms.py closed_forms/test_rigid_bodies.py",
    "connections": "closed_forms/test_rigid_joints.py closed_forms/test_guides.py "
    "closed_forms/test_rotary_inertia.py closed_forms/test_torsion_springs.py "
    "closed_forms/test_redundant_joints.py closed_forms/test_damped_modes.py closed_forms/test_followers.py "
    "closed_forms/test_initial_velocities.py orders/test_auto_elements.py",
    "orders": "orders/test_orders.py orders/test_radau.py orders/test_explicit.py",
    "derivatives": "design/test_sensitivities.py design/test_taylor.py design/test_gradient.py",
    "overhead": "catenary/test_overhead_states.py catenary/test_overhead_layout.py "
    "catenary/test_overhead_route.py catenary/test_overhead_measured.py catenary/test_overhead_rail.py "
    "catenary/test_overhead_bodies.py catenary/test_overhead_twin.py catenary/test_overhead_arms.py "
    "catenary/test_overhead_galloping.py "
    "catenary/test_catenary_run.py",
    "en50318": "catenary/test_catenary_run.py catenary/test_catenary_references.py",
    **{f"fig{n}": "paper/test_paper.py" for n in range(2, 9)},
    **{f"fig{n}": "paper/test_paper_sliding.py" for n in range(9, 12)},
    **{f"fig{n}": "paper/test_paper_overhead.py" for n in range(12, 15)},
}
EVERY = "paper/test_paper_checks.py"
#: Checks that do not pass and why that is accepted, by name.
OPEN: dict[str, str] = {}
#: Words in an origin: the reference is another run of this package, or another program.
OWN, OTHER = ("the same run",), ("independent",)


def main(folder: str | None = None) -> None:
    """Write all pages; first take over what ``ancf reproduce`` has written into a folder."""
    if folder is not None:
        take(Path(folder))
    for name, text in pages().items():
        (FOLDER / name).write_text(text, encoding="utf-8")


def pages() -> dict[str, str]:
    """Text of each page by its file name."""
    made = read("checks.json")
    bodies = {
        "closed_forms": exhibits(made, CLOSED, of("closed_forms", made)),
        "orders": exhibits(made, ORDERS, of("orders", made)),
        "derivatives": exhibits(made, DERIVATIVES, of("derivatives", made)),
        "methods": methods(made),
        "peers": peers(made),
        "paper": exhibits(made, PAPER, of("paper", made)),
        "en50318": standard(made),
    }
    found = {f"{name}.md": page(CHAPTERS[name][0], body) for name, body in bodies.items()}
    return {"index.md": page("Verification book", index(made)), **found}


def take(folder: Path) -> None:
    """Put the exhibits of a reproduction, all or some, in the place of the stored ones."""
    new = json.loads((folder / "checks.json").read_text(encoding="utf-8"))
    if new["quick"]:
        raise SystemExit(f"{folder}: a short form is no verification")
    merged = merge(read("checks.json"), new)
    (FOLDER / "checks.json").write_text(json.dumps(merged, indent=1) + "\n", encoding="utf-8")
    if "en50318" in (e["name"] for e in new["exhibits"]):
        shutil.copy(folder / "en50318.json", FOLDER)


def merge(old: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    """The new reproduction, with what it does not have of the old one; each in the order of the old one."""
    fresh = {e["name"]: e for e in new["exhibits"]}
    names = list(dict.fromkeys([e["name"] for e in old["exhibits"]] + list(fresh)))
    kept = {e["name"]: e for e in old["exhibits"]} | fresh
    checks = [c for name in names for c in checks_of(new if name in fresh else old, [name])]
    passed = all(c["passed"] for c in checks) and not any(e["error"] for e in kept.values())
    last = new if set(fresh) == set(names) else old  # a part says nothing of how long all of them take
    took = {key: last[key] for key in ("jobs", "seconds")}
    return {**new, **took, "passed": passed, "checks": checks, "exhibits": [kept[name] for name in names]}


def read(name: str) -> dict[str, Any]:
    """A JSON file of the folder."""
    found: dict[str, Any] = json.loads((FOLDER / name).read_text(encoding="utf-8"))
    return found


def page(title: str, body: Iterable[str]) -> str:
    """A page that says where it comes from."""
    note = "% Written by docs/verification_book.py from the JSON files beside it: edit those, not this."
    return "\n\n".join([note, f"# {title}", *body]).rstrip() + "\n"


def of(chapter: str, made: dict[str, Any]) -> list[dict[str, Any]]:
    """Exhibits of a chapter."""
    taken = {name for _, names in CHAPTERS.values() for name in names}
    own = CHAPTERS[chapter][1]
    return [e for e in made["exhibits"] if e["name"] in own or (not own and e["name"] not in taken)]


def checks_of(made: dict[str, Any], names: Iterable[str]) -> list[Check]:
    """Checks of some exhibits."""
    wanted = set(names)
    return [check for check in made["checks"] if check["figure"] in wanted]


def said_by(made: dict[str, Any], words: Sequence[str]) -> list[Check]:
    """Checks whose reference comes from something that has one of these words."""
    return [check for check in made["checks"] if any(word in check["origin"] for word in words)]


# the pages -------------------------------------------------------------------------------------------

INTRO = """Every number of this package that is compared with another one, in one place: value, reference,
deviation, what was accepted, and where the reference comes from. Tests assert the same numbers, so that a
change that spoils one is seen. The numbers that are stored here were computed by the commit that is named."""

KINDS = """| a reference is | it shows |
|---|---|
| a closed form, an order of theory, an identity | that the result is right |
| an independent program for the same equations | that the equations are programmed right |
| another method or formulation of this package | that the numerics do not decide the result |
| the paper | that its examples are reproduced; its curves are printed, so that often only trends compare |
| a standard | that the model is taken for good by its field |"""

CLOSED = [
    """Statics, frequencies and motions that have a formula. What is left is the error of the mesh or
of the step."""
]
ORDERS = [
    """Errors fall with a power of the element length or of the step. The power is measured from
successive refinements, `rate`, and compared with theory: a wrong term in an element or a method shows
here before it shows anywhere else."""
]
DERIVATIVES = [
    """Exact derivatives by numbers of a model ([](../howto/sensitivities.md)), of all entries of an answer
over all stored times, beside central differences of whole computations that are extrapolated; and what is
left of a change of the number when the derivative is taken away, which falls with its square. A derivative
that leaves something out fails both."""
]
PAPER = [
    """Figures 1 to 14 and table 2 of Gerstmayr and Shabana (2006), recomputed by `ancf reproduce
all`. What is misprinted or missing there: [](../theory/paper_errata.md)."""
]


def index(made: dict[str, Any]) -> list[str]:
    """The summary."""
    rows = [chapter_row(name, made) for name in JUDGED]
    total, passed = len(made["checks"]), sum(c["passed"] for c in made["checks"])
    form = "short form" if made["quick"] else "full form"
    commits = sorted({str(e["commit"]) for e in made["exhibits"] if e.get("commit")})
    said = ", commit " + ", ".join(f"`{text}`" for text in commits) if commits else ""
    which = f"version {made['version']}{said}, {made['date'][:10]}"
    last = f"| all | {total} | {passed} | {total - passed} |"
    return [
        INTRO,
        KINDS,
        f"## Summary\n\nNumbers of `ancf reproduce all`, {which}, {form}: "
        f"**{passed} of {total} checks passed.**",
        "\n".join(["| chapter | checks | passed | open |", "|---|---|---|---|", *rows, last]),
        open_points(made),
        "Beside them stand [agreement across methods](methods.md) and [independent programs](peers.md), "
        "which sort some of these checks differently and add comparisons of their own.",
        f"## Exhibits\n\nThe short form of each is computed and judged by `tests/{EVERY}`.\n\n"
        + exhibit_table(made),
        HOW,
        toctree(CHAPTERS),
    ]


HOW = """*Use of the tolerance* is the deviation as a share of what is accepted: 100 % would be the limit.

## Make it again

```console
ancf reproduce all -o out
python docs/verification_book.py out
```

Some exhibits alone can be made again: `ancf reproduce fig13 en50318 -o out`. Each carries the commit that
computed it."""


def chapter_row(name: str, made: dict[str, Any]) -> str:
    """A row of the summary."""
    found = checks_of(made, (e["name"] for e in of(name, made)))
    passed = sum(c["passed"] for c in found)
    return f"| [{CHAPTERS[name][0]}]({name}.md) | {len(found)} | {passed} | {len(found) - passed} |"


def open_points(made: dict[str, Any]) -> str:
    """What did not pass, with its reason."""
    failed = [c for c in made["checks"] if not c["passed"]]
    if not failed:
        return "Nothing is open."
    lines = [f"- {c['name']}: {OPEN.get(c['name'], '**failed**')}" for c in failed]
    return "Open:\n\n" + "\n".join(lines)


def exhibit_table(made: dict[str, Any]) -> str:
    """Each exhibit with its verdict and its tests."""
    rows = []
    for e in made["exhibits"]:
        found = checks_of(made, [e["name"]])
        verdict = f"{sum(c['passed'] for c in found)} of {len(found)}" if found else "shows what was given"
        tests = ", ".join(f"`{name}`" for name in tests_of(e["name"]))
        rows.append((f"`{e['name']}`", e["title"], verdict, percent(most_used(found)), tests))
    return table(("exhibit", "shows", "passed", "largest use of a tolerance", "also asserted by"), rows)


def tests_of(name: str) -> list[str]:
    """Test files that assert the numbers of an exhibit, beside the one of all exhibits."""
    return TESTS.get(name, "").split()


def exhibits(made: dict[str, Any], intro: list[str], which: list[dict[str, Any]]) -> list[str]:
    """Each exhibit with its checks."""
    return [*intro, *(text for e in which for text in exhibit(made, e))]


def exhibit(made: dict[str, Any], e: dict[str, Any]) -> list[str]:
    """One exhibit."""
    found = checks_of(made, [e["name"]])
    tests = ", ".join(f"`tests/{name}`" for name in tests_of(e["name"]))
    head = f"## {e['title']}\n\n`ancf reproduce {e['name']} -o out`. Tests that assert it too: {tests}."
    if e["error"]:
        return [head, f"It could not be computed: {e['error']}"]
    return [head, check_table(found) if found else "It shows what was given, and is not judged."]


def methods(made: dict[str, Any]) -> list[str]:
    """Two ways of computing the same thing."""
    given = tomllib.loads((FOLDER / "across.toml").read_text(encoding="utf-8"))["agreement"]
    rows = [(a["what"], a["bound"], places(a["test"])) for a in given]
    return [
        "Elements, integrators, formulations of the constraints and solvers that have to agree. If they "
        "did not, a result would depend on the numerics.",
        "## What the tests assert\n\n" + table(("the two", "agree within", "test"), rows),
        "## In the exhibits\n\n" + check_table(said_by(made, OWN), figure=True),
    ]


def places(test: str) -> str:
    """File, class and function of a test, with spaces at which the line may break."""
    return " ".join(f"`{part}`" for part in test.split("::"))


def peers(made: dict[str, Any]) -> list[str]:
    """Other programs."""
    bench = json.loads((ROOT / "benchmarks" / "results.json").read_text(encoding="utf-8"))
    machine = bench["machine"]
    return [
        "## Exudyn\n\nA multibody code in C++ with the same cable element. Same models, same steps, one "
        f"thread, in turn in one run ({machine['processor']}, {machine['cores']} cores, {machine['date']}, "
        f"Exudyn {machine['versions']['exudyn']}). The last two columns are ratios of processor times.",
        peer_table(bench["cases"]),
        "The tips differ by what Newton's tolerances leave, ours being the second column. With a sliding "
        "joint they differ by more: Exudyn's is of first order in the step, ours of second. Its beam "
        "with a cross-section is another element than ours. "
        "[](../howto/benchmarks.md) tells how it is measured.",
        "## Independent implementations\n\nSeparate programs, written from the equations and not from this "
        "package: one of the elements and their time integration, one of a plane linear overhead line. "
        "Their checks are listed in the chapters of the exhibits.",
        summary_by_exhibit(said_by(made, OTHER)),
    ]


def summary_by_exhibit(found: list[Check]) -> str:
    """How many checks of each exhibit, and the largest use of a tolerance."""
    rows = []
    for name in dict.fromkeys(c["figure"] for c in found):
        own = [c for c in found if c["figure"] == name]
        passed = f"{sum(c['passed'] for c in own)} of {len(own)}"
        rows.append((f"`{name}`", passed, percent(most_used(own))))
    return table(("exhibit", "passed", "largest use of a tolerance"), rows)


def peer_table(cases: list[dict[str, Any]]) -> str:
    """Agreement with and speed beside Exudyn."""
    head = ("model", "elements", "tips differ by, m", "our Newton error, m", "to its best", "to its default")
    rows = []
    for case in cases:
        ours = case["ancf"].get("newton_error")
        gap, own = f"{case['tip_difference']:.0e}", "" if ours is None else f"{ours:.0e}"
        ratios = (f"{x:.2g}" for x in (case["ratio"], case["exudyn"]["standard"]["ratio"]))
        rows.append((case["title"], case["size"], gap, own, *ratios))
    return table(head, rows)


def standard(made: dict[str, Any]) -> list[str]:
    """The cases of the standard, row by row."""
    stored = read("en50318.json")
    rows, notes = stored["rows"], [n for n in stored["notes"] if n.startswith("Measured")]
    cases: dict[tuple[str, float], list[list[Any]]] = {}
    for row in rows:
        cases.setdefault((row[0], row[1]), []).append(row)
    parts = [
        f"### `{case}`, {speed:g} km/h\n\n{range_table(found)}" for (case, speed), found in cases.items()
    ]
    return [
        "Reference models for programs that simulate pantograph and overhead line. The ranges of 2002 are "
        "judged. Those of 2018 are shown and not judged: they carry the tag U, not yet checked against a "
        "copy of the standard. [](../theory/overhead_line.md) discusses each row that is outside.",
        "What was measured:\n\n" + "\n".join(f"- {note.removeprefix('Measured, ')}" for note in notes),
        *exhibits(made, [], of("en50318", made)),
        "## All rows\n\nTags: V read in a public source, V2 in two, U not yet checked.",
        *parts,
    ]


if __name__ == "__main__":
    main(*sys.argv[1:2])
