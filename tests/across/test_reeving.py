"""``ancf validate contact``: a short form of its cases, its files and what it refuses."""

import functools
import json

import numpy as np
import pytest
from typer.testing import CliRunner

import ancf
from ancf.cli.app import app
from ancf.reeving import belt, cases, validate


def theory(off=1.0):
    """What a belt would give that is off by a factor from creep theory."""
    creep = vars(belt.creep_theory(1.19))
    found = {
        f"{key}{name}": off * value for key, value in creep.items() for name in ("", " driving", " driven")
    }
    return found | {f"theory {key}": value for key, value in creep.items()}


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
    short_hoist = functools.partial(cases.hoist, time=0.8)
    monkeypatch.setattr(cases, "hoist", short_hoist)
    monkeypatch.setattr(belt, "run", theory)  # computed below
    said = []
    groups = validate.compare(lambda done, of: said.append((done, of)))
    assert said == [(k, 7) for k in range(1, 8)]
    assert [len(group.rows) for group in groups] == [1, 1, 1, 2, 3, 1, 9]
    assert all(q.inside for group in groups for q in group.rows)
    assert groups[0].rows[0].value == pytest.approx(np.exp(0.3 * np.pi), rel=1e-3)
    written = validate.write(groups, tmp_path)
    plain = json.loads(written[0].read_text())
    assert plain["case"] == "contact"
    assert plain["all_inside"] is True
    assert set(plain["rows"][0]) == {"quantity", "unit", "value", "low", "high", "inside", "tag", "reference"}
    assert written[1].read_text().count("<table>") == 7


def test_a_number_that_is_off_is_outside(monkeypatch):
    monkeypatch.setattr(cases, "capstan", lambda mu, turns: (1.011 * np.exp(mu), np.exp(mu)))
    monkeypatch.setattr(cases, "line_load", lambda load: (1.0011 * load, load))
    monkeypatch.setattr(cases, "hung_over", lambda low: (0.9988, 1.0))
    off = {"momentum": 1.1e-9, "angular": 1.1e-9, "drift": 1.1e-6, "lost": 0.1}
    monkeypatch.setattr(cases, "thrown", lambda mu: off)
    monkeypatch.setattr(cases, "pulley", lambda inertia: {"speed": 1.006, "drift": 1.1e-6})
    monkeypatch.setattr(cases, "hoist", lambda: 1.1e-6)
    monkeypatch.setattr(belt, "run", lambda: theory(1.011))
    assert not any(q.inside for group in validate.compare() for q in group.rows)


@pytest.mark.parametrize("natural", [1.15, 1.19, 1.21])
@pytest.mark.parametrize(
    ("friction", "speed", "load"), [(0.5, 12.0, 25.0), (0.3, 40.0, 8.0), (0.9, 2.0, 20.0)]
)
def test_creep_theory_fits_its_laws(natural, friction, speed, load, monkeypatch):
    """Mass flow, Euler with centrifugal force, the torque, and the length, from forces along both pulleys."""
    for key, value in (("FRICTION", friction), ("SPEED", speed), ("LOAD", load)):
        monkeypatch.setattr(belt, key, value)
    found, R = belt.creep_theory(natural), belt.RADIUS
    EA, rho = belt.EA * (1 - belt.STRAIN), belt.RHO_A / (1 - belt.STRAIN)
    tight, slack = (1 + force / EA for force in (found.tight, found.slack))  # stretches
    fast, slow = speed * R, found.driven * R
    flow = rho * fast / tight
    assert flow == pytest.approx(rho * slow / slack, rel=1e-9)
    moving = found.tight - flow * fast, found.slack - flow * slow
    assert moving[0] / moving[1] == pytest.approx(np.exp(friction * found.slip), rel=1e-9)
    assert found.torque == pytest.approx(R * (moving[0] - moving[1]), rel=1e-9)
    assert found.torque == pytest.approx(belt.BRAKE * found.driven + load, rel=1e-9)
    assert 0.0 < found.slip == pytest.approx(np.pi - found.stick)
    angle = np.linspace(0.0, found.slip, 2001)
    pressing = moving[1] * np.exp(friction * angle)
    stretch = (1 + pressing / EA) / (1 - flow**2 / (rho * EA))  # from force - flow speed = pressing
    slips = 2 * np.trapezoid(R / stretch, angle)
    rest = belt.APART + R * found.stick
    assert rest / tight + rest / slack + slips == pytest.approx(natural, rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("elements", [120, 240])
def test_belt_drive(elements):
    """Forces, speed, torque and arcs of creep theory."""
    found = belt.run(elements)
    for key, of_theory, _ in validate.BELT:
        assert found[key] == pytest.approx(found[f"theory {of_theory}"], rel=1e-2), key


@pytest.mark.parametrize("elements", [60, 120])
def test_belt_that_speeds_up(elements):
    """What accelerates the driven pulley and its brake is the difference of the belt forces."""
    model = belt.drive(elements)
    start = ancf.equilibrium(model, of=["belt"])
    around = [float(start.tension(f"belt.at({s})")) for s in np.linspace(0.0, 1.1, 12)]
    assert np.array(around) == pytest.approx(
        belt.EA * belt.STRAIN, rel=4e-3
    )  # tensioned by its natural length
    result = ancf.simulate(model, t_end=0.2, step=belt.STEP, output_step=1e-3, start=start)
    omega = -result.angular_velocity("driven")[:, 1]
    length = model.body("belt").length
    slack, tight = (result.tension(f"belt.at({s * length})") for s in (0.125, 0.625))
    torque = (tight - slack) * belt.RADIUS
    work = np.sum(0.5 * (torque[1:] + torque[:-1]) * np.diff(result.t))
    brake = belt.BRAKE * np.sum(0.5 * (omega[1:] + omega[:-1]) * np.diff(result.t))
    assert work == pytest.approx(belt.INERTIA * omega[-1] + brake, rel=0.03)
    assert omega[-1] > 1.0


def test_creep_theory_without_load_and_inertia(monkeypatch):
    """A belt that carries nothing has one force, that of its stretch, and sticks all around."""
    monkeypatch.setattr(belt, "LOAD", 1e-9)
    monkeypatch.setattr(belt, "BRAKE", 0.0)
    monkeypatch.setattr(belt, "RHO_A", 1e-12)
    length = 2 * belt.APART + 2 * np.pi * belt.RADIUS
    creep = belt.creep_theory(length * (1 - belt.STRAIN))
    assert creep.tight == pytest.approx(belt.EA * belt.STRAIN, rel=1e-6)
    assert creep.slack == pytest.approx(creep.tight, rel=1e-6)
    assert creep.stick == pytest.approx(np.pi, abs=1e-5)


@pytest.mark.parametrize("step", [1e-3, 5e-4])
def test_account_of_a_hoist(step):
    """Work in = work out + friction."""
    assert cases.hoist(step, 0.8) < 1e-6


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
