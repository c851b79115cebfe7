"""The stored benchmarks: pieces are put into their places, and both sides have every case."""

import importlib
import json
import sys
import time

import pytest

from places import ROOT

FOLDER = ROOT / "benchmarks"


@pytest.fixture
def benchmarks(monkeypatch):
    """Modules of the folder by name."""
    monkeypatch.syspath_prepend(str(FOLDER))
    names = {file.stem for file in FOLDER.glob("*.py")}
    before = {name: sys.modules.pop(name, None) for name in names}
    yield importlib.import_module
    for name in names:
        sys.modules.pop(name, None)
        if before[name] is not None:
            sys.modules[name] = before[name]


def row(name, elements, ours, peer):
    sides = {"us_per_step": ours}, {"fast": {"us_per_step": peer, "ratio_whole": 2.0}}
    return {"name": name, "elements": elements, "ancf": sides[0], "exudyn": sides[1], "best": "fast"}


def test_pieces_replace_their_own_and_leave_the_others(benchmarks, tmp_path):
    """Rows are in the order of the cases, whatever the order of the runs; growth follows them."""
    store = benchmarks("store")
    file = tmp_path / "results.json"
    first = store.Store(file, commit="a1")
    first.take("cable-10000", row("cable-10000", 10_000, 8000.0, 90e3), time.perf_counter(), 0.3)
    first.take("memory", [{"name": "cable-100"}], time.perf_counter(), 0.3)
    first.take("cable-100", row("cable-100", 100, 50.0, 900.0), time.perf_counter(), 0.3)
    second = store.Store(file, commit="b2")
    assert second.results["growth"]["ancf"] == pytest.approx(1.6)
    second.take("cable-100", row("cable-100", 100, 40.0, 600.0), time.perf_counter(), 7.0)
    second.remember()
    stored = json.loads(file.read_text(encoding="utf-8"))
    assert [case["name"] for case in stored["cases"]] == ["cable-100", "cable-10000"]
    assert stored["growth"]["ancf"] == pytest.approx(2.0)
    assert stored["growth"]["exudyn"] == pytest.approx(1.5)
    assert stored["memory"] == [{"name": "cable-100"}]
    told = {name: (piece["commit"], piece["load_before"]) for name, piece in stored["measured"].items()}
    assert told == {"cable-100": ("b2", 7.0), "cable-10000": ("a1", 0.3), "memory": ("a1", 0.3)}
    assert [second.has(name) for name in ("cable-100", "cable-10000", "kernels")] == [True, False, False]
    lines = file.with_name("history.jsonl").read_text(encoding="utf-8").splitlines()
    assert [(json.loads(line)["commit"], list(json.loads(line)["cases"])) for line in lines] == [
        ("b2", ["cable-100"])
    ]


def test_our_side_solves_each_new_kind_of_case(benchmarks):
    """A few elements and steps of each: beams fall by g t^2/2 at their free end, a hung cable sags."""
    cases, ours = benchmarks("cases").CASES, benchmarks("ours")
    for name in ("original-50", "nonlocking-50"):
        case = cases[name]
        tip = ours.solve(case.first(20), {})["tip"]
        assert tip[2] == pytest.approx(-0.5 * 9.81 * 0.02**2, rel=2e-2), name
    hung = cases["static-carrier-64"]
    x, _, z = ours.solve(hung, {})["tip"]
    # parabola whose tension stretches it: w L^2 / (8 H) = sag, H = EA 8/3 (sag/L)^2
    w, length = hung.rhoA * 9.81, hung.length
    sag = (3.0 * w * length**4 / (64.0 * hung.EA)) ** (1.0 / 3.0)
    assert x == pytest.approx(0.5 * length, abs=1e-9)
    assert -z == pytest.approx(sag, rel=0.02)
