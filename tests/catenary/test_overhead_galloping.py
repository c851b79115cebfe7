"""Galloping of wires in wind: Den Hartog's criterion, its growth rate in the motion, tables of lift."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares

import ancf
from ancf import ModelError
from ancf.catenary import (
    Auxiliary,
    Conditions,
    DropperRule,
    Droppers,
    Line,
    Mesh,
    Rayleigh,
    Route,
    Span,
    SteadyArm,
    StitchWire,
    Wire,
    assemble,
    form,
    galloping,
    read_line,
)
from ancf.catenary.lines.galloping import lift_law, said, slope_at
from overhead_lines import TOML, short_line

LENGTH, ALPHA = 40.0, 0.05
STRING = Wire(EA=12e6, EI=1.0, mass=0.95, tension=15e3, diameter=0.0122, drag=1.1)


def table(slope, reach=0.4):
    """Straight lift that is zero ahead."""
    return ((-reach, -slope * reach), (reach, slope * reach))


def string(slope, wind, alpha=ALPHA, **changes):
    """A contact wire alone between two ends."""
    return Line(
        spans=[Span(length=LENGTH, droppers=())],
        contact_wire=replace(STRING, **{"lift": table(slope)} | changes),
        steady_arm=SteadyArm(vertical=0.0),
        damping=Rayleigh(alpha=alpha),
        conditions=Conditions(wind=wind),
    )


class TestCriterion:
    @pytest.mark.parametrize("slope", [-4.0, -2.0, -1.1, -0.5, 3.0])
    @pytest.mark.parametrize("wind", [6.0, -20.0])
    def test_closed_form(self, slope, wind):
        (found,) = galloping(string(slope, wind))
        fed = -0.5 * 1.225 * 0.0122 * (slope + 1.1) / 0.95
        assert found.criterion == pytest.approx(slope + 1.1)
        assert found.frequency == pytest.approx(np.sqrt(15e3 / 0.95) / (2.0 * LENGTH))
        assert found.growth == pytest.approx(0.5 * (fed * abs(wind) - ALPHA), abs=1e-9)
        if slope < -1.1:
            assert found.critical_speed == pytest.approx(ALPHA / fed)
            (at,) = galloping(string(slope, ALPHA / fed))
            assert at.growth == pytest.approx(0.0, abs=1e-9)
        else:
            assert found.critical_speed == np.inf

    def test_ice_and_stiffness_damping(self):
        """More mass and more damping of the stiffness: later."""
        plain = string(-4.0, 10.0)
        iced = replace(plain, conditions=Conditions(wind=10.0, ice=0.95))
        (light,), (heavy,) = galloping(plain), galloping(iced)
        assert heavy.critical_speed == pytest.approx(2.0 * light.critical_speed)
        (damped,) = galloping(replace(plain, damping=Rayleigh(alpha=ALPHA, beta=1e-3)))
        w = 2.0 * np.pi * light.frequency
        assert damped.critical_speed / light.critical_speed == pytest.approx(1.0 + 1e-3 * w**2 / ALPHA)

    @pytest.mark.parametrize("wear", [0.1, 0.3, 0.6])
    @pytest.mark.parametrize("ice", [0.0, 0.4])
    def test_a_worn_wire_is_lighter(self, wear, ice):
        worn = replace(string(-4.0, 10.0), conditions=Conditions(wind=10.0, wear=wear, ice=ice))
        (found,) = galloping(worn)
        mass = 0.95 * (1.0 - wear) + ice
        assert found.growth == pytest.approx(0.5 * (0.5 * 1.225 * 0.0122 * 2.9 * 10.0 / mass - ALPHA))
        assert found.frequency == pytest.approx(np.sqrt(15e3 / mass) / (2.0 * LENGTH))

    @pytest.mark.parametrize("wires", [(0,), (1,), (2,), (0, 2), (0, 1, 2)])
    def test_of_every_wire_that_has_a_table(self, wires):
        """Contact wire, messenger and auxiliary; the lift acts on all of them in the model too."""
        plain = short_line(
            droppers=Droppers(EA=2e5),
            auxiliary=Auxiliary(
                wire=STRING,
                height=0.4,
                droppers=Droppers(EA=2e5),
                places=DropperRule(first=6.0, pitch_max=10.0),
            ),
        )
        given = [
            replace(STRING, tension=tension, lift=table(-4.0) if k in wires else None)
            for k, tension in enumerate((20e3, 16e3, 10e3))
        ]
        line = replace(
            plain,
            contact_wire=given[0],
            messenger_wire=given[1],
            auxiliary=replace(plain.auxiliary, wire=given[2]),
            conditions=Conditions(wind=20.0),
        )
        found = galloping(line)
        assert [one.wire for one in found] == [
            ("contact wire", "messenger wire", "auxiliary")[k] for k in wires
        ]
        longest = max(span.length for span in line.spans)
        for one, k in zip(found, wires, strict=True):
            assert one.frequency == pytest.approx(np.sqrt(given[k].tension / 0.95) / (2.0 * longest))
        assert len(said(line)) == len(wires)

    @pytest.mark.parametrize("sections", [(0,), (1,), (0, 1)])
    def test_of_every_section(self, sections):
        """A section of a route that gallops is named, whatever the first one does."""
        calm = string(-4.0, 20.0, lift=None)
        calm = replace(calm, spans=calm.spans * 3, system_height=0.0, stagger=0.0)
        lines = [
            replace(
                calm, contact_wire=replace(calm.contact_wire, lift=table(-4.0) if k in sections else None)
            )
            for k in (0, 1)
        ]
        told = said(Route(lines=tuple(lines), starts=(0.0, LENGTH)))
        assert [
            f"contact wire of section {k + 1} gallops" in text for k, text in zip(sections, told, strict=True)
        ] == [True] * len(sections)

    def test_slope_at_a_row_is_the_mean(self):
        rows = ((-0.2, 0.4), (0.0, 0.0), (0.1, 0.1))
        assert slope_at(rows) == pytest.approx(0.5 * (-2.0 + 1.0))
        assert slope_at(rows, 0.05) == pytest.approx(1.0)

    def test_who_is_told(self):
        assert said(string(-4.0, 0.5)) == []
        (text,) = said(string(-4.0, 20.0))
        assert "contact wire gallops in wind of 20 m/s: dCL/da + CD = -2.90" in text
        with pytest.raises(ModelError, match="no wire has a table of its lift"):
            galloping(replace(string(-4.0, 20.0), contact_wire=STRING))


class TestLaw:
    @pytest.mark.parametrize("wind", [12.0, -12.0])
    def test_lift_stands_across_the_relative_wind(self, wind):
        """A wire that falls meets the wind from below; its lift has the coefficient at that angle."""
        law = lift_law(table(-2.0), wind, 1.225, 0.0122)
        velocity = np.array([0.0, 0.5, -2.0])
        felt = np.array([wind - 0.5, 2.0])
        force = law(0.0, np.zeros(3), velocity)
        size = 0.5 * 1.225 * 0.0122 * (felt @ felt)
        angle = np.arctan2(2.0, abs(felt[0]))
        assert force[1:] @ felt == pytest.approx(0.0, abs=1e-12)
        assert np.linalg.norm(force) == pytest.approx(size * 2.0 * angle)
        assert force[2] < 0.0  # the lift of a negative coefficient presses down
        assert law(0.0, np.zeros(3), np.array([0.0, wind, 0.0])).tolist() == [0.0, 0.0, 0.0]


class TestMotion:
    @pytest.mark.parametrize(("slope", "wind"), [(-6.0, -12.0), (2.0, 12.0)])
    def test_grows_as_the_closed_form_says(self, slope, wind):
        """Let go from a small antisymmetric swing, which the sag does not stretch, the wire grows or dies."""
        line = string(slope, wind)
        found = form(line, Mesh(contact=2.0))
        model = assemble(found).model
        wire = model.bodies["contact"]
        start = ancf.equilibrium(model)
        quarter = wire.at(0.25 * wire.length)
        pushes = [
            model.add_force(
                wire.at(share * wire.length),
                lambda t, s=sign: (0.0, 0.0, s * np.sin(np.pi * t / 0.4) if t < 0.4 else 0.0),
            )
            for share, sign in ((0.25, 8.0), (0.75, -8.0))
        ]
        assert len(pushes) == 2
        result = ancf.simulate(model, t_end=12.0, step=5e-3, start=start, sensors=[quarter], energy=False)
        t, z = result.sensors.t, result.sensors.position(quarter)[:, 2]
        late = t > 0.6
        t, z = t[late], z[late] - float(start.position(quarter)[2])
        (told,) = galloping(line)

        def wrong(p):
            wave = np.exp(p[0] * t) * (p[1] * np.cos(p[2] * t) + p[3] * np.sin(p[2] * t))
            return (wave + p[4] - z) / np.abs(z).max()

        w = 4.0 * np.pi * told.frequency
        fit = least_squares(wrong, [0.0, 0.5 * np.ptp(z), w, 0.0, 0.0])
        assert fit.cost < 0.02 * 0.5 * t.size
        assert fit.x[2] == pytest.approx(w, rel=0.01)
        assert fit.x[0] == pytest.approx(told.growth, abs=0.02 * abs(told.growth) + 1e-3)


class TestStates:
    def test_steady_lift(self):
        """A coefficient ahead carries part of the weight: w - q D CL."""
        wind = -15.0
        rows = ((-0.3, 0.8), (0.3, 0.8))
        line = replace(string(0.0, wind), contact_wire=replace(STRING, lift=rows))
        made, calm = (
            form(item, Mesh(contact=2.0)) for item in (line, replace(line, conditions=Conditions()))
        )
        sags = [-float(np.interp(20.0, *one.contact.position[:, [0, 2]].T)) for one in (made, calm)]
        lifted = 0.5 * 1.225 * wind**2 * 0.0122 * 0.8
        assert sags[0] / sags[1] == pytest.approx(1.0 - lifted / (0.95 * 9.81), rel=5e-3)

    @pytest.mark.parametrize("wire", ["contact_wire", "messenger_wire", "stitch", "auxiliary"])
    @pytest.mark.parametrize(("wind", "coefficient"), [(25.0, 0.8), (-30.0, -0.5)])
    def test_every_wire_is_lifted(self, wire, wind, coefficient):
        """As by the same forces on it along its length; those of stitch wires were left out."""
        line = replace(of_all(wire == "auxiliary"), conditions=Conditions(wind=wind))
        rows, mesh = ((-0.3, coefficient), (0.3, coefficient)), Mesh(contact=2.0, messenger=3.0)
        plain = assemble(form(line, mesh))
        names = {"contact_wire": ["contact"], "messenger_wire": ["messenger"], "auxiliary": ["auxiliary"]}
        strung = plain.stitches if wire == "stitch" else [getattr(plain, names[wire][0])]
        before = ancf.equilibrium(plain.model)
        for one in strung:
            per_length = 0.5 * line.conditions.air_density * wind**2 * one.shape.wire.diameter * coefficient
            for beam in one.beams:
                plain.model.add_distributed_load(beam, (0.0, 0.0, per_length))
        after = ancf.equilibrium(plain.model)
        lifted = assemble(form(with_lift(line, wire, rows), mesh))
        state = ancf.equilibrium(lifted.model)
        made = lifted.stitches if wire == "stitch" else [getattr(lifted, names[wire][0])]
        for one, other in zip(strung, made, strict=True):
            risen = one.positions(after)[:, 2] - one.positions(before)[:, 2]
            found = other.positions(state)[:, 2] - one.positions(before)[:, 2]
            assert np.abs(risen).max() > 1e-4
            np.testing.assert_allclose(found, risen, atol=2e-2 * np.abs(risen).max())


def of_all(compound):
    """A line with an auxiliary, or with stitch wires."""
    thin = Wire(EA=3e6, EI=10.0, mass=0.3, tension=2.5e3, diameter=0.0075)
    held = DropperRule(first=6.0, pitch_max=10.0)
    droppers = Droppers(EA=2e5)
    given = {"stitch": StitchWire(wire=thin, reach=6.0)}
    if compound:
        given = {"auxiliary": Auxiliary(wire=STRING, height=0.4, droppers=droppers, places=held)}
    wires = {"contact_wire": replace(STRING, tension=20e3), "messenger_wire": replace(STRING, tension=16e3)}
    return short_line(droppers=droppers, **given, **wires)


def with_lift(line, wire, rows):
    """The line with a table of lift for one of its wires."""
    part = getattr(line, wire)
    if isinstance(part, Wire):
        return replace(line, **{wire: replace(part, lift=rows)})
    return replace(line, **{wire: replace(part, wire=replace(part.wire, lift=rows))})


@pytest.mark.parametrize("reach", [5.0, 7.0])
def test_a_stitch_wire_gallops_between_its_ends(reach):
    plain = replace(of_all(False), conditions=Conditions(wind=20.0))
    plain = replace(plain, stitch=replace(plain.stitch, reach=reach))
    (found,) = galloping(with_lift(plain, "stitch", table(-4.0)))
    assert found.wire == "stitch wire"
    assert found.frequency == pytest.approx(np.sqrt(2.5e3 / 0.3) / (4.0 * reach))
    assert "the stitch wire gallops" in said(with_lift(plain, "stitch", table(-4.0)))[0]


ROWS = "angle_deg,lift\n-20,0.6\n0,0\n20,-0.6\n"


class TestFile:
    def given(self, tmp_path, lift='"lift.csv"', rows=ROWS, wire="contact_wire"):
        (tmp_path / "lift.csv").write_text(rows)
        text = TOML.replace(f"[{wire}]", f"[{wire}]\nlift = {lift}\ndiameter = 0.0132", 1)
        (tmp_path / "line.toml").write_text(text)
        return tmp_path / "line.toml"

    def test_table(self, tmp_path):
        line = read_line(self.given(tmp_path))
        assert line.contact_wire.lift == pytest.approx(
            np.array([[-np.pi / 9, 0.6], [0, 0], [np.pi / 9, -0.6]])
        )
        (found,) = galloping(line)
        assert found.slope == pytest.approx(-0.6 / (np.pi / 9))
        inline = read_line(self.given(tmp_path, "[[-0.3, 0.6], [0.3, -0.6]]", wire="messenger_wire"))
        assert inline.messenger_wire.lift == ((-0.3, 0.6), (0.3, -0.6))
        assert galloping(inline)[0].wire == "messenger wire"

    @pytest.mark.parametrize("wire", ["stitch", "auxiliary_wire"])
    def test_of_other_wires(self, tmp_path, wire):
        (tmp_path / "lift.csv").write_text(ROWS)
        added = f"[{wire}]\nEA = 3e6\nEI = 10.0\nmass = 0.3\ntension = 2.5e3\ndiameter = 0.0075\n"
        added += 'lift = "lift.csv"\n'
        if wire == "stitch":
            added += "reach = 6.0\n"
        else:
            added += "height = 0.4\nplaces = { first = 6.0, pitch_max = 10.0 }\n[long_droppers]\nEA = 2e5\n"
        (tmp_path / "line.toml").write_text(f"{TOML}\n{added}")
        (found,) = galloping(read_line(tmp_path / "line.toml"))
        assert found.wire == ("stitch wire" if wire == "stitch" else "auxiliary")
        assert found.slope == pytest.approx(-0.6 / (np.pi / 9))

    @pytest.mark.parametrize(
        ("lift", "rows", "said"),
        [
            ('"lift.csv"', ROWS.replace("angle_deg", "angle"), r"lift\.csv, column angle_deg: is missing"),
            (
                '"lift.csv"',
                ROWS.replace("20,-0.6", "-30,-0.6"),
                r"lift\.csv, row 3, column angle_deg: is -30 after 0",
            ),
            ('"lift.csv"', ROWS.replace("-0.6", "low"), r"row 3, column lift: is .low."),
            ('"lift.csv"', ROWS.replace("\n20", "\n400"), r"row 3, column angle_deg: is 400 degrees"),
            ('"lift.csv"', ROWS.replace("-20,0.6\n", ""), r"contact_wire\.lift: reaches from 0 to"),
            ('"none.csv"', ROWS, r"none\.csv: no such file"),
            ("[[-20.0, 0.6], [20.0, -0.6]]", ROWS, r"contact_wire\.lift\[0\]\[0\]: is -20 rad"),
            ("[[-0.3, 0.6], [0.3, -60.0]]", ROWS, r"contact_wire\.lift\[1\]\[1\]: is -60, at most 10"),
            ("[[0.3, 0.6], [-0.3, 0.6]]", ROWS, r"contact_wire\.lift\[1\]\[0\]: is -0\.3 after 0\.3"),
        ],
    )
    def test_wrong(self, tmp_path, lift, rows, said):
        with pytest.raises(ModelError, match=said):
            read_line(self.given(tmp_path, lift, rows))

    def test_needs_a_diameter(self):
        with pytest.raises(ModelError, match=r"contact_wire\.diameter: is missing, the lift"):
            string(-4.0, 5.0, diameter=None)
