"""Figures of a study's report: of one parameter a curve, of several what may be compared."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import ancf


def swing(**given: float) -> dict[str, float]:
    """A function that falls and rises again: its lowest and highest values of x tell little of it."""
    x, y = given["x"], given.get("y", 0.0)
    return {"swing": (x - 2.0) ** 2 + 0.1 * y}


def captions(folder: Path, samples: object) -> list[str]:
    ancf.study(swing, samples, workers=0, folder=folder)
    page = (folder / "report.html").read_text(encoding="utf-8")
    return re.findall(r"<figcaption><strong>([^<]*?)\. </strong>", page)


@pytest.mark.parametrize("count", [5, 50])
def test_of_one_parameter_there_is_its_curve_alone(tmp_path: Path, count: int) -> None:
    values = [0.1 * k for k in range(count)]
    assert captions(tmp_path / "out", ancf.sample({"x": values}, method="grid")) == [
        "Cases over the parameters"
    ]


@pytest.mark.parametrize("method", ["grid", "sobol"])
def test_of_several_effects_are_compared(tmp_path: Path, method: str) -> None:
    grid = {"x": [0.0, 1.0, 2.0, 3.0], "y": [0.0, 1.0]}
    own = grid if method == "grid" else {"x": ancf.Uniform(0, 4), "y": ancf.Uniform(0, 1)}
    more = {} if method == "grid" else {"count": 16, "seed": 1}
    found = captions(tmp_path / "out", ancf.sample(own, method=method, **more))
    assert {"Tornado", "Main effects", "Cases over the parameters"} <= set(found)


def test_of_one_with_repeated_values_means_are_shown(tmp_path: Path) -> None:
    values = ancf.Discrete([0.0, 1.0, 4.0])
    found = captions(tmp_path / "out", ancf.sample({"x": values}, method="random", count=30, seed=2))
    assert "Main effects" in found
    assert "Tornado" not in found
