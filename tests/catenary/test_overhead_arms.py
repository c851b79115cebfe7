"""Steady arms that stand at a side, and pull or push: loads, refusals, stiffness, tables of supports."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import ancf
from ancf import ModelError
from ancf.catenary import Conditions, Mesh, Span, SteadyArm, arm_loads, assemble, form, read_line, verify
from ancf.catenary.forms.form import check
from helpers import some
from overhead_lines import COARSE, LENGTHS, STAGGER, TOML, droppers, short_line

G = 9.81
FINE = Mesh(contact=2.0, messenger=2.0, contact_support=0.05, dropper=0.1)


def bent(radius, **changes):
    spans = [Span(length=length, droppers=droppers(length), radius=radius) for length in LENGTHS]
    return short_line(**({"spans": spans, "anchors": "tension", "contact_support": "free"} | changes))


def sided(sides, **given):
    """An arm for each support, of which the inner ones stand at these sides."""
    ends = SteadyArm(length=1.1)
    return [ends, *(SteadyArm(**{"length": 1.1, "side": side} | given) for side in sides), ends]


class TestLoads:
    @pytest.mark.parametrize(
        ("radius", "stagger"), [(None, STAGGER), (700.0, STAGGER), (-1200.0, STAGGER), (-900.0, (0.1,) * 6)]
    )
    def test_closed_form(self, radius, stagger):
        """-T/R over half of both spans and the kink of the staggers; the arm stands where it pulls to."""
        wires = {
            key: replace(getattr(short_line(), key), EI=1.0) for key in ("contact_wire", "messenger_wire")
        }
        line = bent(radius, stagger=stagger, **wires)
        length = np.array(LENGTHS)
        curve = -20e3 * 0.5 * (length[1:] + length[:-1]) / (radius or np.inf)
        kink = -20e3 * np.diff(np.diff(stagger) / length)
        told = arm_loads(form(line, FINE))
        assert [one.support for one in told] == [1, 2, 3, 4, 5, 6]
        assert [one.position for one in told] == pytest.approx(line.supports)
        assert [one.curve for one in told[1:-1]] == pytest.approx(curve)
        assert [one.stagger for one in told[1:-1]] == pytest.approx(kink)
        for one, wanted in zip(told[1:-1], curve + kink, strict=True):
            assert one.sideways == pytest.approx(wanted, rel=1e-3, abs=0.5)
            assert (one.side, one.acts) == ("left" if wanted > 0.0 else "right", "pulls")
        assert [told[k].side for k in (0, -1)] == ["", ""]

    @pytest.mark.parametrize(
        ("anchors", "conditions"),
        some(
            [
                ("fixed", {"temperature": 45.0}),
                ("tension", {"contact_tension": 14e3}),
                ("fixed", {"temperature": -25.0}),
                ("fixed", {"wear": 0.3}),
            ]
        ),
    )
    @pytest.mark.parametrize("stagger", [STAGGER, (0.1,) * 6])
    def test_closed_form_of_a_state(self, anchors, conditions, stagger):
        """By the tension that the wire has there, not by that of the design."""
        arm = SteadyArm(vertical=200.0)
        line = bent(-900.0, stagger=stagger, anchors=anchors, contact_support="held", steady_arm=arm)
        found = form(replace(line, conditions=Conditions(**conditions)), COARSE)
        assert abs(found.pull[0].mean() / 20e3 - 1.0) > 0.15
        for one in arm_loads(found)[1:-1]:
            assert one.sideways == pytest.approx(one.curve + one.stagger, rel=0.015, abs=4.0)


#: Signs of what the arms of STAGGER have to pull at on straight track.
SENSE = np.sign(-np.diff(np.diff(STAGGER) / np.array(LENGTHS)))
RIGHT = tuple("left" if sign > 0 else "right" for sign in SENSE)


class TestSides:
    def test_where_they_pull_to_changes_nothing(self):
        plain = form(short_line(steady_arm=SteadyArm(length=1.1), contact_support="free"), COARSE)
        told = form(short_line(steady_arm=sided(RIGHT), contact_support="free"), COARSE)
        assert told.arm_force == pytest.approx(plain.arm_force, abs=1e-9)

    @pytest.mark.parametrize("k", [1, 3])
    @pytest.mark.parametrize("kind", [{"length": 1.1}, {"length": None, "vertical": 300.0}])
    def test_would_be_pushed(self, k, kind):
        sides = list(RIGHT)
        sides[k - 1] = "right" if RIGHT[k - 1] == "left" else "left"
        line = short_line(steady_arm=sided(sides, **kind), contact_support="free")
        wanted = 20e3 * abs(np.diff(np.diff(STAGGER) / np.array(LENGTHS))[k - 1])
        for find in (check, form):
            with pytest.raises(
                ModelError, match=rf"is pushed with \d+ N at support {k + 1}.* only pull"
            ) as caught:
                find(line)
            assert caught.value.where == f"line.steady_arm[{k}].side"
            assert f"{wanted:.0f} N by the staggers" in caught.value.what

    def test_a_curve_against_its_stagger(self):
        """Both parts are told with their signs: what pushes is positive."""
        with pytest.raises(ModelError, match=r"\d+ N by the curve and -\d+ N by the staggers"):
            check(bent(300.0, stagger=STAGGER, steady_arm=sided(RIGHT)))

    def test_wind_that_pushes_is_a_finding(self):
        wires = {
            key: replace(getattr(short_line(), key), diameter=0.0132)
            for key in ("contact_wire", "messenger_wire")
        }
        line = short_line(
            steady_arm=sided(RIGHT), contact_support="free", stagger=tuple(0.3 * y for y in STAGGER), **wires
        )
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            form(replace(line, conditions=Conditions(wind=5.0)), COARSE)
        said = r"^line\.conditions: with wind -38 m/s at support \d: the arm stands .* can only pull"
        with pytest.warns(UserWarning, match=said):
            form(replace(line, conditions=Conditions(wind=-38.0)), COARSE)


class TestDefaultSide:
    """An arm of which nobody said where it stands keeps the side of the design: masts do not move."""

    def blown(self, **arm):
        wires = {
            key: replace(getattr(short_line(), key), diameter=0.0132)
            for key in ("contact_wire", "messenger_wire")
        }
        stagger, arm = tuple(0.3 * y for y in STAGGER), arm or {"length": 1.1}
        line = short_line(
            contact_support="free", stagger=stagger, steady_arm=SteadyArm(**arm), anchors="tension", **wires
        )
        return line, replace(line, conditions=Conditions(wind=-38.0))

    def test_the_hinge_stays(self):
        line, windy = self.blown()
        with pytest.warns(UserWarning, match=r"support \d: the arm stands to the right .* can only pull"):
            found = form(windy, COARSE)
        rest = form(line, COARSE)
        told, before = arm_loads(found)[1:-1], arm_loads(rest)[1:-1]
        assert [one.side for one in told] == [one.side for one in before] == list(RIGHT)
        assert {(one.side, one.acts) for one in told} == {("left", "pulls"), ("right", "pushes")}
        for here, there in zip(assemble(found).arms[1:-1], assemble(rest).arms[1:-1], strict=True):
            assert np.asarray(here.b)[1:] == pytest.approx(np.asarray(there.b)[1:], abs=1e-3)
        assert verify(assemble(found)).place < 2e-6

    def test_is_the_side_that_could_be_given(self):
        _, windy = self.blown()
        given = replace(windy, steady_arm=tuple(sided(RIGHT)))
        with pytest.warns(UserWarning, match="can only pull"):
            assert form(windy, COARSE).arm_force == pytest.approx(form(given, COARSE).arm_force, abs=1e-6)

    @pytest.mark.parametrize("share", [0.0, 0.5, 0.97, 0.999, 1.0, 1.001, 1.03, 1.5])
    def test_every_wind_is_a_state(self, share):
        """Also that in which an arm carries nothing, 0 N between pull and push: its hinge stays."""
        line, _ = self.blown()
        rest = form(line, COARSE)
        before, after = rest.arm_force[3, 1], form(self.windy(line, 15.0), COARSE).arm_force[3, 1]
        calm = 15.0 * np.sqrt(before / (before - after))  # the load of the wind grows with its square
        speed = calm * np.sqrt(share)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = form(self.windy(line, speed), COARSE)
            checked = verify(assemble(found))
        pull = found.arm_force[1:-1, 1] * SENSE
        loose = np.flatnonzero(pull < 1.0)
        assert (2 in loose) == (share > 0.99)
        assert (abs(pull[2]) < 1.0) == (0.99 < share < 1.01)
        assert len(caught) == len(loose)
        for warning, k in zip(caught, loose, strict=True):
            said = str(warning.message)
            assert said.startswith(f"line.conditions: with wind {-speed:g} m/s at support {k + 2}: ")
            assert ("hangs loose" in said) == (pull[k] > -1.0)
        assert checked.place < 2e-6
        for here, there in zip(assemble(found).arms[1:-1], assemble(rest).arms[1:-1], strict=True):
            assert np.asarray(here.b)[1:] == pytest.approx(np.asarray(there.b)[1:], abs=1e-12)
            assert here.length == there.length

    def windy(self, line, speed):
        return replace(line, conditions=Conditions(wind=-float(speed)))

    def test_springs_may_push(self):
        """They stand for arms of any kind: what they do is told, and is no warning."""
        _, windy = self.blown(vertical=300.0)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            told = arm_loads(form(windy, COARSE))[1:-1]
        assert ("right", "pushes") in {(one.side, one.acts) for one in told}


class TestPush:
    @pytest.mark.parametrize("length", [0.9, 1.6])
    def test_stiffness(self, length):
        """Upwards the force over the length: a bar that is pulled adds it, a strut takes it off."""
        opposite = ["right" if side == "left" else "left" for side in RIGHT]
        found = {}
        for name, arms in (
            ("free", SteadyArm(vertical=0.0)),
            ("pulls", sided(RIGHT, length=length)),
            ("pushes", sided(opposite, length=length, push=True)),
        ):
            made = form(short_line(steady_arm=arms, contact_support="free"), COARSE)
            found[name] = self.stiffness(made, 2)
            assert verify(assemble(made)).place < 1e-6
            if name == "pushes":
                assert {one.acts for one in arm_loads(made)[1:-1]} == {"pushes"}
                spring = assemble(made).arms[2]
                assert spring.length > length
                assert np.sign(np.asarray(spring.b)[1] - spring.a.initial_position[1]) == -SENSE[1]
            pull = abs(made.arm_force[2, 1])
        assert found["pulls"] - found["free"] == pytest.approx(pull / length, rel=0.02)
        assert found["pushes"] - found["free"] == pytest.approx(-pull / length, rel=0.02)

    def stiffness(self, found, support):
        overhead = assemble(found)
        point, rest = overhead.supports[support], ancf.equilibrium(overhead.model)
        overhead.model.add_force(point, (0.0, 0.0, 1.0))
        return 1.0 / (ancf.equilibrium(overhead.model).position(point)[2] - rest.position(point)[2])

    def test_angle(self):
        """A strut that rises to its hinge drives the wire down by its push times the tangent."""
        opposite = ["right" if side == "left" else "left" for side in RIGHT]
        arms = sided(opposite, push=True, angle=0.15, mass=0.8)
        made = form(short_line(steady_arm=arms, contact_support="free", anchors="tension"), COARSE)
        push = np.abs(made.arm_force[1:-1, 1])
        assert made.arm_force[1:-1, 2] == pytest.approx(-push * np.tan(0.15) - 0.4 * G, rel=1e-3)
        checked = verify(assemble(made))
        assert checked.place < 1e-6
        spring = assemble(made).arms[2]
        rise = np.asarray(spring.b) - spring.a.initial_position
        assert rise[2] / abs(rise[1]) == pytest.approx(np.tan(0.15), rel=0.01)

    def test_states(self):
        """In heat it acts about its place in the design."""
        opposite = ["right" if side == "left" else "left" for side in RIGHT]
        line = short_line(steady_arm=sided(opposite, push=True), contact_support="free", anchors="tension")
        hot = form(replace(line, conditions=Conditions(temperature=40.0)), COARSE)
        assert verify(assemble(hot)).place < 2e-6
        wanted = form(line, COARSE).arm_force
        assert hot.arm_force == pytest.approx(wanted, rel=0.02, abs=1.0)
        assert hot.arm_force[1:-1, 1] == pytest.approx(
            wanted[1:-1, 1], rel=1e-3
        )  # the kinks are where they were


def test_command(tmp_path):
    """``ancf catenary form`` prints and writes what each arm pulls, with its sign."""
    from ancf.cli.app import app

    (tmp_path / "line.toml").write_text(TOML)
    done = CliRunner().invoke(
        app, ["catenary", "form", str(tmp_path / "line.toml"), "-o", str(tmp_path / "out")]
    )
    assert done.exit_code == 0, done.output
    assert "by the curve [N]" in done.output
    rows = [row.split(",") for row in (tmp_path / "out" / "arms.csv").read_text().splitlines()]
    assert rows[0][4] == "to_the_left_N"
    wanted = 20e3 * 0.8 / 30.0
    assert [float(row[4]) for row in rows[2:-1]] == pytest.approx([-wanted, wanted] * 2, rel=0.02)
    assert [row[6:] for row in rows[1:]] == [["", ""], *[["right", "pulls"], ["left", "pulls"]] * 2, ["", ""]]


TABLE = """position,stagger,arm_side,arm_push
0,0.2,,
30,-0.2,right,
60,0.2,left,no
90,-0.2,left,yes
120,0.2,,
"""


class TestFile:
    def given(self, tmp_path, text=TABLE):
        head, _, _ = TOML.partition("[[spans]]")
        head = head.replace("stagger = 0.2", 'contact_support = "free"\nsupports = "supports.csv"')
        head = head.replace("vertical = 300.0", "length = 1.2")
        rule = "dropper_rule = {first = 4.0, pitch_max = 8.0}\n"
        (tmp_path / "line.toml").write_text(rule + head)
        (tmp_path / "supports.csv").write_text(text)
        return tmp_path / "line.toml"

    def test_is_the_line_in_python(self, tmp_path):
        line = read_line(self.given(tmp_path))
        assert [arm.side for arm in line.steady_arm] == [None, "right", "left", "left", None]
        assert [arm.push for arm in line.steady_arm] == [False, False, False, True, False]
        told = arm_loads(form(line, COARSE))
        assert [one.acts for one in told] == ["", "pulls", "pulls", "pushes", ""]

    @pytest.mark.parametrize(
        ("old", "new", "said"),
        [
            (
                "30,-0.2,right",
                "30,-0.2,rihgt",
                r'supports\.csv, row 2, column arm_side: is .rihgt., .* mean "right"',
            ),
            ("left,no", "left,maybe", r'row 3, column arm_push: is .maybe., must be one of "yes", "no"'),
            (
                "30,-0.2,right,",
                "30,-0.2,left,",
                r"row 2, column arm_side: the arm stands to the left .* only pull",
            ),
            ("30,-0.2,right,", "30,-0.2,,yes", r"row 2, column arm_push: has no effect without side"),
        ],
    )
    def test_wrong(self, tmp_path, old, new, said):
        assert old in TABLE
        with pytest.raises(ModelError, match=said):
            check(read_line(self.given(tmp_path, TABLE.replace(old, new))))
