"""The tables of the README are what the command makes from the stored runs."""

import importlib.util
import sys

import pytest

from places import DOCS


@pytest.fixture
def figures(monkeypatch):
    """The module docs/readme_figures.py, which is no part of a package."""
    monkeypatch.syspath_prepend(str(DOCS))
    spec = importlib.util.spec_from_file_location("readme_figures", DOCS / "readme_figures.py")
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, spec.name, module)
    spec.loader.exec_module(module)
    return module


def test_readme_is_what_the_command_makes(figures):
    text = figures.README.read_text(encoding="utf-8")
    assert figures.page(text) == text, "run python docs/readme_figures.py"
    assert [found[1] for found in figures.PLACE.findall(text)] == list(figures.TABLES)


def test_a_number_that_changes_changes_the_table(figures, monkeypatch):
    stored = figures.read("benchmarks", "results.json")
    monkeypatch.setattr(figures, "read", lambda *parts: stored)
    before = figures.speed().splitlines()
    best = stored["cases"][0]["best"]
    stored["cases"][0]["exudyn"][best]["ratio"] = 77.0
    after = figures.speed().splitlines()
    assert [k for k, (a, b) in enumerate(zip(before, after, strict=True)) if a != b] == [2]
    assert "| 77 |" in after[2]


def test_best_is_a_variant_that_is_accurate(figures):
    """The ratio is that to the fastest of the peer's variants that end where its defaults do."""
    for case in figures.read("benchmarks", "results.json")["cases"]:
        fit = {name: peer for name, peer in case["exudyn"].items() if peer["accurate"]}
        assert case["best"] == min(fit, key=lambda name: fit[name]["cpu_median"]), case["name"]
        assert case["ratio"] == fit[case["best"]]["ratio"]


def test_differences_are_of_the_same_discretisation(figures):
    rows = figures.accuracy().splitlines()[2:]
    assert len(rows) == len(figures.ACCURACY)
    for row in rows:
        count, largest = (cell.strip() for cell in row.split("|")[2:4])
        assert int(count) >= 4
        assert float(largest.removesuffix(" m")) < 1e-4


def test_cases_of_the_standard_are_the_stored_rows(figures, monkeypatch):
    """Counts, what is outside and the numbers follow the file; a row that turns is told with its range."""
    stored = figures.read("docs", "verification", "en50318.json")
    monkeypatch.setattr(figures, "read", lambda *parts: stored)
    lines = figures.en50318().splitlines()[2:]
    assert len(lines) == len({(row[0], row[1]) for row in stored["rows"]}) == 4
    for line in lines:
        inside, _, rest = line.split("|")[2].partition(" of ")
        assert int(inside) == int(rest.split(";")[0]) - rest.count(";")
    value, verdict = (stored["columns"].index(key) for key in ("value", "verdict"))
    mean = next(row for row in stored["rows"] if row[2] == "mean force Fm")
    mean[value], mean[verdict] = 131.26, "outside"
    changed = figures.en50318().splitlines()[2]
    assert "| 7 of 8; mean force Fm 131.3 N (110 to 120) | Fm 131.3 N, " in changed
    assert figures.en50318().splitlines()[3:] == lines[1:]
