"""Conductor rails: beams on supports against their closed forms, in Python, in files, in runs."""

from dataclasses import replace

import numpy as np
import pytest

from ancf import ModelError
from ancf.catenary import (
    Conditions,
    Line,
    Mesh,
    Rayleigh,
    Span,
    SteadyArm,
    Wire,
    acceptance,
    elasticity,
    form,
    read_line,
    run,
    statistics,
    wire,
)
from overhead_lines import collector

G = 9.81
#: Aluminium profile with a copper wire: stiffness of its upright axis, N m^2.
EI = 2.3e5
RAIL = Wire(EA=1.5e8, EI=EI, mass=6.9, tension=0.0, expansion=2.3e-5, rail=True)


def rail(length=10.0, spans=8, mesh=1.0, **changes):
    given = {
        "spans": (Span(length=length, droppers=()),) * spans,
        "contact_wire": RAIL,
        "steady_arm": SteadyArm(vertical=1e9),
        "anchors": "tension",
        "damping": Rayleigh(alpha=0.05),
    }
    return Line(**(given | changes)), Mesh(contact=mesh)


class TestAtRest:
    @pytest.mark.parametrize(("length", "stiffness"), [(8.0, EI), (10.0, EI), (12.0, 3.0 * EI)])
    def test_sag(self, length, stiffness):
        """w L^4/(384 EI) in the middle of a span far from the ends, w L on each support."""
        line, mesh = rail(length, spans=15, contact_wire=replace(RAIL, EI=stiffness))
        found = form(line, mesh)
        x, _, z = found.contact.position.T
        middle = np.argmin(np.abs(x - 7.5 * length))
        load = RAIL.mass * G
        assert -z[middle] == pytest.approx(load * length**4 / (384.0 * stiffness), rel=2e-3)
        assert found.arm_force[7, 2] == pytest.approx(load * length, rel=2e-3)

    def test_end_span(self):
        """What each support of a beam on nine carries, by the theorem of three moments."""
        spans, length = 8, 10.0
        line, mesh = rail(length, spans)
        moments = np.zeros(spans + 1)  # M[k-1] + 4 M[k] + M[k+1] = -w L^2/2
        matrix = 4.0 * np.eye(spans - 1) + np.eye(spans - 1, k=1) + np.eye(spans - 1, k=-1)
        moments[1:-1] = np.linalg.solve(matrix, np.full(spans - 1, -0.5 * length**2))
        wanted = length + np.diff(moments)[1:] / length - np.diff(moments)[:-1] / length
        assert form(line, mesh).arm_force[1:-1, 2] == pytest.approx(RAIL.mass * G * wanted, rel=1e-3)

    @pytest.mark.parametrize("length", [8.0, 12.0])
    def test_elasticity(self, length):
        """A load in the middle of a span of an endless beam: (1/192 + 1/(64 (1 + sqrt(3)))) L^3/EI."""
        line, mesh = rail(length)
        found = elasticity(line, (100.0, 400.0), points=2, mesh=mesh)
        wanted = 1e3 * (1.0 / 192.0 + 1.0 / (64.0 * (1.0 + np.sqrt(3.0)))) * length**3 / EI
        assert found.value[:, 1] == pytest.approx(wanted, rel=3e-3)
        assert np.all(np.abs(found.value[:, [0, 2]]) < 1e-5)

    def test_soft_supports(self):
        """A load over a support on springs gives at most 1/k more, and less than alone."""
        stiff, soft = (
            elasticity(rail(steady_arm=SteadyArm(vertical=k))[0], (100.0,), points=2, mesh=rail()[1])
            for k in (1e9, 1e6)
        )
        assert 0.0 < stiff.value[0, 0] < soft.value[0, 0] < 1e3 / 1e6

    def test_travels_when_it_is_hot(self):
        line, mesh = rail()
        hot = form(replace(line, conditions=Conditions(temperature=50.0)), mesh)
        assert hot.contact.position[-1, 0] - 80.0 == pytest.approx(2.3e-5 * 40.0 * 40.0, rel=2e-3)

    def test_critical_speed(self):
        """Waves whose half is a span: pi/L sqrt(EI/rhoA); of a wire sqrt(T/rhoA) at any span."""
        line, mesh = rail(8.0)
        assert line.wave_speed == pytest.approx(np.pi / 8.0 * np.sqrt(EI / RAIL.mass))
        assert form(line, mesh).wave_speed == pytest.approx(line.wave_speed, rel=1e-6)
        cu = wire("Cu AC-120", tension=12e3)
        assert cu.critical_speed(8.0) == cu.wave_speed


class TestRun:
    def test_pantograph_passes(self):
        """Slowly the force is the static one; the deepest uplift of the rail is its elasticity times it."""
        line, mesh = rail(spans=11)
        unit = collector(stiffness=(0.0, 4200.0))
        way = {"start": 5.0, "window": (60.0, 70.0), "until": 72.0}
        done = run(form(line, mesh), speed=10.0, pantograph=unit, step=4e-3, **way)
        found = statistics(done)
        assert found["mean_force"].value == pytest.approx(120.0, rel=0.01)
        assert found["loss"].value == 0.0
        assert found["wave_speed"].value == pytest.approx(3.6 * line.wave_speed, rel=1e-6)
        assert "strip_strain" not in {quantity.key for quantity in acceptance(done)}
        recording = done.recordings[0]
        middle = np.interp(65.0, recording.position, recording.height)
        rest = -RAIL.mass * G * 10.0**4 / (384.0 * EI)
        give = (1.0 / 192.0 + 1.0 / (64.0 * (1.0 + np.sqrt(3.0)))) * 10.0**3 / EI
        force = np.interp(65.0, recording.position, recording.force)
        assert middle - rest == pytest.approx(give * force, rel=0.05)


FILE = """
title = "Tunnel"
stagger = 0.0
anchors = "tension"
[contact_wire]
rail = true
EA = 1.5e8
EI = 2.3e5
mass = 6.9
expansion = 2.3e-5
[steady_arm]
vertical = 1e9
[[spans]]
repeat = 8
length = 10.0
"""


class TestFile:
    def given(self, tmp_path, old="", new=""):
        assert old in FILE
        path = tmp_path / "rail.toml"
        path.write_text(FILE.replace(old, new, 1))
        return path

    def test_is_the_line_in_python(self, tmp_path):
        line = read_line(self.given(tmp_path))
        assert line.contact_wire == RAIL
        assert line.spans == rail()[0].spans

    @pytest.mark.parametrize(
        ("old", "new", "said"),
        [
            ("rail = true\n", "", r"contact_wire\.tension: is missing"),
            ("EI = 2.3e5", "EI = 0.0", r"contact_wire\.EI"),
            ("rail = true", "rail = true\ntension = -5.0", r"contact_wire\.tension"),
            ("rail = true", "rail = 1", r"contact_wire\.rail"),
            (
                "[steady_arm]",
                'system_height = 1.0\n[messenger_wire]\ntype = "BzII 50"\ntension = 10e3\n[steady_arm]',
                r"unknown key|messenger_wire",
            ),
        ],
    )
    def test_wrong(self, tmp_path, old, new, said):
        with pytest.raises(ModelError, match=said):
            read_line(self.given(tmp_path, old, new))

    def test_a_messenger_is_none(self):
        cable = replace(RAIL, tension=1e4)
        with pytest.raises(ModelError, match=r"messenger_wire\.rail"):
            rail(messenger_wire=cable, system_height=1.0)
        with pytest.raises(ModelError, match=r"messenger_wire: is given beside a conductor rail"):
            rail(messenger_wire=replace(cable, rail=False), system_height=1.0)

    @pytest.mark.parametrize("warmer", [0.5, 3.0, 8.0])
    def test_one_that_is_pressed_between_fixed_ends(self, warmer):
        """Between fixed ends heat presses a rail with EA alpha dT, less what its sag takes up."""
        full = RAIL.EA * RAIL.expansion * warmer
        line, mesh = rail(anchors="fixed", conditions=Conditions(temperature=10.0 + warmer))
        with pytest.raises(ModelError, match=r"conditions\.temperature.*the rail is pressed with") as caught:
            form(line, mesh)
        pressed = float(str(caught.value).split("pressed with ")[1].split(" N")[0])
        assert 0.7 * full < pressed < full
        cold, mesh = rail(anchors="fixed", conditions=Conditions(temperature=10.0 - warmer))
        assert pressed < form(cold, mesh).pull[0].min() < full
