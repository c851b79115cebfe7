"""``ancf validate contact``: a short form of its cases, its files and what it refuses."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from ancf.cli.app import app
from ancf.reeving import cases, validate


def test_short_form(monkeypatch, tmp_path):
    """One of each kind, computed and inside; the file has what a line's has."""
    short = {
        "FRICTIONS": (0.3,),
        "TURNS": (0.5,),
        "LOADS": (1000.0,),
        "LOWER_ENDS": (0.2,),
        "INERTIAS": (0.05,),
        "THROWN": (0.3,),
    }
    for name, values in short.items():
        monkeypatch.setattr(validate, name, values)
    said = []
    groups = validate.compare(lambda done, of: said.append((done, of)))
    assert said == [(k, 5) for k in range(1, 6)]
    assert [len(group.rows) for group in groups] == [1, 1, 1, 2, 3]
    assert all(q.inside for group in groups for q in group.rows)
    assert groups[0].rows[0].value == pytest.approx(np.exp(0.3 * np.pi), rel=1e-3)
    written = validate.write(groups, tmp_path)
    plain = json.loads(written[0].read_text())
    assert plain["case"] == "contact"
    assert plain["all_inside"] is True
    assert set(plain["rows"][0]) == {"quantity", "unit", "value", "low", "high", "inside", "tag"}
    assert written[1].read_text().count("<table>") == 5


def test_a_number_that_is_off_is_outside(monkeypatch):
    monkeypatch.setattr(cases, "capstan", lambda mu, turns: (1.011 * np.exp(mu), np.exp(mu)))
    monkeypatch.setattr(cases, "line_load", lambda load: (1.0011 * load, load))
    monkeypatch.setattr(cases, "hung_over", lambda low: (0.9988, 1.0))
    off = {"momentum": 1.1e-9, "angular": 1.1e-9, "drift": 1.1e-6, "lost": 0.1}
    monkeypatch.setattr(cases, "thrown", lambda mu: off)
    monkeypatch.setattr(cases, "pulley", lambda inertia: {"speed": 1.006, "drift": 1.1e-6})
    assert not any(q.inside for group in validate.compare() for q in group.rows)


def test_helix_turns_less_than_it_winds():
    """By the angles between successive tangents."""
    pitch = 0.05 / (2 * np.pi)
    a = np.linspace(0.0, 4 * np.pi, 4001)
    t = np.stack([-cases.AXIS * np.sin(a), np.full_like(a, pitch), cases.AXIS * np.cos(a)], axis=1)
    t /= np.linalg.norm(t, axis=1)[:, None]
    turned = np.linalg.norm(np.diff(t, axis=0), axis=1).sum()
    _, _, way, phi = cases.wound(4 * np.pi, 0.05, 1e5)
    assert phi == pytest.approx(turned, rel=1e-6)
    assert np.allclose(way, t[-1])


def test_no_speed(tmp_path):
    done = CliRunner().invoke(app, ["validate", "contact", "--speed", "100", "-o", str(tmp_path)])
    assert done.exit_code == 2
    assert 'the case "contact" has none' in done.output
