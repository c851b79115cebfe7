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
