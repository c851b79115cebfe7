"""Geometry of a line: heights, curves, arms of their own, masses, trams, tables of supports."""

from dataclasses import replace

import numpy as np
import pytest

import ancf
from ancf import ModelError
from ancf.catenary import (
    DropperRule,
    Line,
    Load,
    Mesh,
    Span,
    SteadyArm,
    Wire,
    assemble,
    form,
    read_line,
    run,
    statistics,
    verify,
)
from ancf.catenary.forms.form import check
from ancf.catenary.lines.fittings import DropperErrors
from overhead_lines import COARSE, LENGTHS, STAGGER, STEP, collector, droppers, short_line

G = 9.81


def curved(radius, **changes):
    spans = [Span(length=length, droppers=droppers(length), radius=radius) for length in LENGTHS]
    return short_line(**({"spans": spans, "anchors": "tension"} | changes))


#: Wires that bend within a centimetre, and elements that follow.
STRINGS = {
    "contact_wire": replace(short_line().contact_wire, EI=1.0),
    "messenger_wire": replace(short_line().messenger_wire, EI=1.0),
}
FINE = Mesh(contact=2.0, messenger=2.0, contact_support=0.05, dropper=0.1)


class TestCurve:
    @pytest.mark.parametrize("radius", [600.0, -1500.0])
    @pytest.mark.parametrize("stagger", [0.0, STAGGER])
    def test_radial_load(self, radius, stagger):
        """T/R over half of both spans at each support, and the kink of the stagger."""
        found = form(curved(radius, stagger=stagger, **STRINGS), FINE)
        length = np.array(LENGTHS)
        kink = np.diff(np.diff(found.line.stagger) / length)
        wanted = -(0.5 * (length[1:] + length[:-1]) / radius + kink)
        exact = 1e-3 * length.min() / abs(radius)  # where both parts nearly cancel, of the radial one
        assert found.arm_force[1:-1, 1] == pytest.approx(20e3 * wanted, rel=1e-3, abs=20e3 * exact)
        assert found.support_side[1:-1] == pytest.approx(16e3 * wanted, rel=1e-3, abs=16e3 * exact)

    @pytest.mark.parametrize("radius", [500.0, -900.0])
    def test_offset_in_a_span(self, radius):
        """l^2/8R to the inside of the curve, for both wires: the droppers hang upright."""
        found = form(curved(radius, stagger=0.0, **STRINGS), FINE)
        for shape in (found.contact, found.messenger):
            for k, length in enumerate(LENGTHS):
                x, y = shape.position[:, 0], shape.position[:, 1]
                middle = found.line.supports[k] + 0.5 * length
                assert np.interp(middle, x, y) == pytest.approx(length**2 / 8 / radius, rel=2e-3)

    def test_rests_as_found_and_runs(self):
        line = curved(900.0, steady_arm=SteadyArm(length=1.2, mass=1.0), contact_support="free", stagger=-0.2)
        line = replace(line, stagger=(-0.2,) * 6)  # at the outside of the curve
        found = form(line, COARSE)
        checked = verify(assemble(found))
        assert checked.place < 1e-6
        done = run(found, speed=40.0, pantograph=collector(), step=STEP)
        inside = (done.recordings[0].position > 30.0) & (done.recordings[0].position < 66.0)
        swept = done.recordings[0].stagger[inside]
        assert swept.max() == pytest.approx(-0.2 + 36**2 / 8 / 900, abs=0.01)

    def test_beyond_the_strip(self):
        found = form(curved(200.0, stagger=0.0), COARSE)
        with pytest.raises(ModelError, match="beside the track") as caught:
            run(found, speed=40.0, pantograph=collector(), step=STEP)
        assert caught.value.where == "line.contact_wire"

    @pytest.mark.parametrize("sign", [1.0, -1.0])
    @pytest.mark.parametrize(("share", "said"), [(1.02, "refused"), (0.98, "warned"), (0.73, "warned")])
    def test_versine_beside_the_heads(self, share, said, sign):
        """L^2/8R of the longest span beyond 0.975 m, half of the widest head, and beyond strips of 1.45 m."""
        radius = sign * 38.0**2 / 8.0 / (0.975 * share)
        line = curved(radius, stagger=0.0)
        if said == "refused":
            for find in (check, form):
                with pytest.raises(ModelError, match=r"has a versine of 0\.99 m over 38 m") as caught:
                    find(line)
                assert caught.value.where == "line.spans[3].radius"
                assert "spans of at most 45 m" in caught.value.hint
        else:
            told = check(line)
            over = [k for k, length in enumerate(LENGTHS) if length**2 / 8.0 / abs(radius) > 0.725]
            assert [text.partition(":")[0] for text in told] == [f"line.spans[{k}].radius" for k in over]

    def test_staggers_to_the_outside_bring_it_back(self):
        """A wire of one sign of the curve: half of the versine to either side; anchors may be aside."""
        assert check(curved(150.0, stagger=0.0 * np.array(STAGGER) - 0.55)) == []
        aside = (2.5, -0.2, 0.2, -0.2, 0.2, 2.5)
        assert check(short_line(stagger=aside)) == []

    @pytest.mark.parametrize("radius", [0.0, 3.0, float("nan")])
    def test_wrong(self, radius):
        with pytest.raises(ModelError, match=r"span\.radius"):
            Span(length=50.0, droppers=(), radius=radius)


class TestHeights:
    HEIGHTS = (5.3, 5.3, 5.25, 5.2, 5.2, 5.2)

    @pytest.mark.parametrize("support", ["held", "free"])
    def test_gradient(self, support):
        """Clamps lie on the straights between the supports' heights, 0.5 mm; the messenger above."""
        line = short_line(height=self.HEIGHTS, anchors="tension", contact_support=support)
        found = form(line, COARSE)
        wanted = np.interp(line.dropper_x, line.supports, self.HEIGHTS)
        assert found.contact_height == pytest.approx(wanted, abs=5e-4)
        assert verify(assemble(found)).height < 5e-4
        held = found.messenger.position[found.messenger.nodes.support, 2]
        assert held == pytest.approx(np.add(self.HEIGHTS, 1.2), abs=1e-6)

    @pytest.mark.parametrize("step", [0.03, -0.05])
    def test_kink_loads_its_support(self, step):
        """A change of slope by d pulls with T d at the support, where the wire is held."""
        level, bent = (
            form(short_line(height=height, anchors="tension"), COARSE)
            for height in (0.0, (0.0, 0.0, 0.0, step, 2 * step, 3 * step))
        )
        more = (bent.arm_force - level.arm_force)[2, 2] + (bent.dropper_load - level.dropper_load)[5:15].sum()
        assert more == pytest.approx(-20e3 * step / 32.0, rel=0.05)
        uphill = (bent.arm_force - level.arm_force)[3:5, 2] + 0.0
        slopes = np.diff((0.0, 0.0, 0.0, step, 2 * step, 3 * step)) / LENGTHS
        assert uphill == pytest.approx(-20e3 * np.diff(slopes)[2:], rel=0.05, abs=1.0)

    def test_a_constant_height_changes_nothing(self):
        level, high = (form(short_line(height=h), COARSE) for h in (0.0, 5.5))
        assert high.dropper_natural == pytest.approx(level.dropper_natural, abs=1e-9)
        given = {"speed": 40.0, "pantograph": collector(relaxed_at="nominal"), "step": STEP}
        forces = [run(made, **given).recordings[0].force for made in (level, high)]
        assert forces[1] == pytest.approx(forces[0], abs=0.02)

    def test_pantograph_follows_a_gradient(self):
        """Its lowest spring does not work against the climb: the mean force stays that of level wire."""
        unit = collector(stiffness=(2000.0, 4200.0), damping=(0.0, 10.0))
        heights = tuple(0.004 * np.concatenate([[0.0], np.cumsum(LENGTHS)]))
        means = []
        for height in (0.0, heights):
            done = run(form(short_line(height=height), COARSE), speed=40.0, pantograph=unit, step=STEP)
            means.append(statistics(done)["mean_force"].value)
        assert means[1] == pytest.approx(means[0], abs=1.5)  # 2000 N/m over 0.3 m would be 600 N

    @pytest.mark.parametrize("height", [(0.0, 1.0), 4e3, (0.0,) * 5 + (5000.0,)])
    def test_wrong(self, height):
        with pytest.raises(ModelError, match=r"line\.height"):
            short_line(height=height)


class TestArms:
    def test_each_its_own(self):
        arms = [SteadyArm(vertical=300.0)] * 6
        arms[2] = SteadyArm(length=1.0, mass=2.0, angle=0.2)
        line = short_line(steady_arm=arms, anchors="tension", contact_support="free")
        found = form(line, COARSE)
        pull = abs(found.arm_force[2, 1])
        assert found.arm_force[2, 2] == pytest.approx(pull * np.tan(0.2) - 0.5 * 2.0 * G, rel=1e-4)
        assert verify(assemble(found)).place < 1e-6
        spring = assemble(found).arms[2]
        rise = np.asarray(spring.b) - spring.a.initial_position
        assert rise[2] / abs(rise[1]) == pytest.approx(np.tan(0.2), rel=1e-4)

    def test_uplift_stop(self):
        """A force that would lift the wire further is carried by the stop."""
        heights = []
        for stop in (None, 0.03):
            overhead = assemble(
                form(short_line(steady_arm=SteadyArm(vertical=300.0, uplift_stop=stop)), COARSE)
            )
            overhead.model.add_force(overhead.supports[2], (0.0, 0.0, 400.0))
            heights.append(ancf.equilibrium(overhead.model).position(overhead.supports[2])[2])
        assert heights[0] > 0.05
        assert heights[1] == pytest.approx(0.03, abs=0.004)

    def test_cantilever_mass_moves_with_the_messenger(self):
        line = short_line(messenger_support=50e3, messenger_support_mass=12.0)
        found = form(line, COARSE)
        assert found.dropper_natural == pytest.approx(form(short_line(), COARSE).dropper_natural, abs=1e-8)
        overhead = assemble(found)
        assert verify(overhead).place < 1e-6
        assert sum(body.mass for name, body in overhead.model.bodies.items() if "cantilever" in name) == 48.0

    def test_wrong(self):
        with pytest.raises(ModelError, match=r"line\.steady_arm: are 2 for 6 supports"):
            short_line(steady_arm=[SteadyArm(vertical=1.0)] * 2)
        with pytest.raises(ModelError, match=r"line\.steady_arm\[1\]\.vertical"):
            short_line(steady_arm=[SteadyArm(vertical=1.0), SteadyArm()] + [SteadyArm(vertical=1.0)] * 4)
        with pytest.raises(ModelError, match=r"steady_arm\.angle: has no effect"):
            short_line(steady_arm=SteadyArm(vertical=1.0, angle=0.1))


class TestLoads:
    @pytest.mark.parametrize("wire", ["contact", "messenger"])
    def test_are_carried(self, wire):
        """Weights of all that hangs are what the supports and ends carry."""
        load = Load(position=77.7, mass=11.0, wire=wire)
        plain, loaded = (form(short_line(loads=loads), COARSE) for loads in ((), (load,)))
        assert loaded.contact_height == pytest.approx(plain.contact_height, abs=1e-9)
        assert verify(assemble(loaded)).place < 1e-6
        grown = [made.support_load.sum() + made.arm_force[:, 2].sum() for made in (plain, loaded)]
        assert grown[1] - grown[0] == pytest.approx(11.0 * G, rel=0.02)

    def test_wrong(self):
        with pytest.raises(ModelError, match=r"line\.loads\[0\]\.position"):
            short_line(loads=[Load(position=170.0, mass=1.0)])


class TestTram:
    WIRE = Wire(EA=12e6, EI=100.0, mass=0.95, tension=10e3)

    @pytest.mark.parametrize("length", [30.0, 45.0])
    def test_sag(self, length):
        """Of a beam under tension that does not turn at its supports: w l^2/8T less w l lambda/2T."""
        arm = SteadyArm(vertical=1e8)
        line = Line(spans=[Span(length=length, droppers=())] * 5, contact_wire=self.WIRE, steady_arm=arm)
        found = form(line, Mesh(contact_support=0.05))
        weight, layer = 0.95 * G, np.sqrt(100.0 / 10e3)
        depth = weight * length**2 / 8e4 - weight * length * layer / 2e4
        z = found.contact.position
        assert -np.interp(2.5 * length, z[:, 0], z[:, 2]) == pytest.approx(depth, rel=2e-3)
        assert found.arm_force[2, 2] == pytest.approx(weight * length, rel=1e-3)
        assert found.messenger is None
        assert found.dropper_load.size == 0

    def test_runs(self):
        arm = SteadyArm(vertical=5e3)
        line = Line(
            spans=[Span(length=30.0, droppers=())] * 6,
            contact_wire=self.WIRE,
            steady_arm=arm,
            anchors="tension",
        )
        done = run(
            form(line, Mesh(contact=1.5, contact_support=0.3)), speed=12.0, pantograph=collector(), step=STEP
        )
        found = statistics(done)
        assert found["mean_force"].value == pytest.approx(120.0, rel=0.1)
        assert done.dropper_force.shape == (done.t.size, 0)

    def test_wrong(self):
        spans = [Span(length=30.0, droppers=()), Span(length=30.0, droppers=(15.0,))]
        with pytest.raises(ModelError, match="messenger_wire: is missing, span 2 has droppers"):
            Line(spans=spans, contact_wire=self.WIRE, steady_arm=SteadyArm(vertical=1.0))


class TestDropperRule:
    @pytest.mark.parametrize(
        ("length", "first", "pitch"), [(60.0, 5.0, 7.0), (50.0, 4.5, 8.2), (27.0, 6.0, 20.0)]
    )
    def test_places(self, length, first, pitch):
        places = Span(length=length, droppers=DropperRule(first=first, pitch_max=pitch)).droppers
        assert (places[0], places[-1]) == (first, pytest.approx(length - first))
        gaps = np.diff(places)
        assert np.ptp(gaps) < 2e-6
        assert gaps.max() <= pitch + 1e-6
        assert len(places) == 2 or (length - 2 * first) / (len(places) - 2) > pitch  # one less is too few

    @pytest.mark.parametrize(
        ("rule", "said"), [((30.0, 5.0), "first"), ((5.0, 0.0), "pitch_max"), ((5.0, 0.001), "pitch_max")]
    )
    def test_wrong(self, rule, said):
        with pytest.raises(ModelError, match=f"droppers.{said}"):
            Span(length=50.0, droppers=DropperRule(first=rule[0], pitch_max=rule[1]))


HEAD = """
title = "From a table"
system_height = 1.3
anchors = "tension"
supports = "supports.csv"
dropper_rule = {first = 5.0, pitch_max = 8.0}
[contact_wire]
type = "CuAg AC-100"
tension = 12e3
[messenger_wire]
type = "BzII 50"
tension = 10e3
[droppers]
EA = 0.3e6
[steady_arm]
vertical = 200.0
"""
TABLE = """position,height,stagger,radius,pre_sag,arm_vertical
0,5.3,0.2,,0.02,
50,5.3,-0.2,1200,0.02,
105,5.28,0.2,1200,0,350
150,5.26,-0.2,,0,
"""


def table(tmp_path, text=TABLE, head=HEAD):
    (tmp_path / "supports.csv").write_text(text)
    path = tmp_path / "line.toml"
    path.write_text(head)
    return path


class TestTable:
    def test_is_the_line_in_python(self, tmp_path):
        line = read_line(table(tmp_path))
        assert line.supports.tolist() == [0.0, 50.0, 105.0, 150.0]
        assert line.heights == (5.3, 5.3, 5.28, 5.26)
        assert line.stagger == (0.2, -0.2, 0.2, -0.2)
        assert [span.radius for span in line.spans] == [None, 1200.0, 1200.0]
        assert [arm.vertical for arm in line.steady_arm] == [200.0, 200.0, 350.0, 200.0]
        assert (
            line.spans[1].droppers
            == Span(length=55.0, droppers=DropperRule(first=5.0, pitch_max=8.0)).droppers
        )
        assert max(line.spans[0].pre_sag) == pytest.approx(0.02, rel=0.05)

    @pytest.mark.parametrize(("radius", "row"), [("100", 2), ("-95", 1)])
    def test_beside_the_track(self, tmp_path, radius, row):
        rows = TABLE.splitlines()
        cells = rows[row].split(",")
        rows[row] = ",".join([*cells[:3], radius, *cells[4:]])
        line = read_line(table(tmp_path, "\n".join(rows)))
        with pytest.raises(ModelError, match=rf"supports.csv, row {row}, column radius: .* versine of"):
            check(line)

    def test_rows_in_the_file(self, tmp_path):
        rows = (
            "\n".join(
                f"[[supports]]\nposition = {p}\nheight = {h}\nstagger = {s}"
                for p, h, s in ((0, 5.3, 0.2), (50, 5.2, 0.1))
            )
            .replace("position = 0", "position = 0.0")
            .replace("position = 50", "position = 50.0")
        )
        head = HEAD.replace('supports = "supports.csv"\n', "") + rows
        line = read_line(table(tmp_path, head=head))
        assert (line.heights, line.stagger) == ((5.3, 5.2), (0.2, 0.1))

    @pytest.mark.parametrize(
        ("old", "new", "said"),
        [
            ("position,", "place,", "column position: is missing"),
            ("position,height", "height,height", "column position: is missing"),
            ("105,5.28", "fifty,5.28", 'row 3, column position: is "fifty"'),
            ("105,5.28", "105,", "row 3, column height: is empty"),
            ("105,5.28", "45,5.28", "row 3, column position: is 45 m, behind one at 50 m"),
            ("105,5.28", "60000,5.28", "row 3, column position: must be at most 1000 m"),
            ("50,5.3,-0.2,1200", "50,5.3,-0.2,2", "row 2, column radius: is 2 m"),
            ("0,350", "0,-350", "row 3, column arm_vertical"),
            ("50,5.3,-0.2,1200,0.02,", "50,5.3,-0.2,1200,0.02", "row 2: has 5 cells"),
            ("0,5.3,0.2,,0.02,", "0,inf,0.2,,0.02,", "row 1, column height: is inf"),
            ("105,5.28", "105,5280", "row 3, column height: is 5280 m, at most 100 m either way"),
            ("5.28,0.2,", "5.28,200,", "row 3, column stagger: is 200 m, at most 20 m either way"),
            ("1200,0.02,", "1200,20,", "row 2, column pre_sag: is 20 m, at most 5 m"),
        ],
    )
    def test_wrong(self, tmp_path, old, new, said):
        assert old in TABLE
        with pytest.raises(ModelError) as caught:
            read_line(table(tmp_path, TABLE.replace(old, new, 1)))
        assert said.removeprefix("line.") in str(caught.value)

    def test_twin_wires(self, tmp_path):
        """Two wires carry twice as much, and their waves run as in one."""
        one, two = (
            read_line(table(tmp_path, head=HEAD.replace("[contact_wire]", f"[contact_wire]\ncount = {n}")))
            for n in (1, 2)
        )
        assert two.wave_speed == pytest.approx(one.wave_speed)
        wires = one.contact_wire, two.contact_wire
        assert wires[1].EA == 2 * wires[0].EA
        forms = [form(line, COARSE) for line in (one, two)]
        assert forms[1].dropper_load == pytest.approx(2 * forms[0].dropper_load, rel=1e-3)

    def test_messenger_too_low(self, tmp_path):
        """The dropper that cannot reach is named by its row."""
        path = table(tmp_path, head=HEAD.replace("system_height = 1.3", "system_height = 0.2"))
        with pytest.raises(ModelError, match=r"supports.csv, row 2, dropper 4 of its span: .* hangs"):
            form(read_line(path), COARSE)

    @pytest.mark.parametrize("deviation", [None, 0.0, 1e-3])
    @pytest.mark.parametrize("factor", [1e-3, 1e3])
    def test_lengths_in_other_units(self, factor, deviation):
        """Droppers a thousand times too short or too long are refused, in the check and in form finding."""
        errors = None if deviation is None else DropperErrors(deviation=deviation)
        line = short_line(dropper_errors=errors)
        wrong = tuple(0.9 * factor if j == 7 else 0.9 for j in range(line.dropper_x.size))
        if factor > 1.0:
            wrong = tuple(min(length, 99.0) for length in wrong)
        for ask in (check, form):
            with pytest.raises(
                ModelError, match=r"dropper_lengths\[7\]: is .* mm, of line.spans\[1\].droppers\[2\]"
            ):
                ask(replace(line, dropper_lengths=wrong), COARSE)

    def test_missing_file(self, tmp_path):
        path = table(tmp_path)
        (tmp_path / "supports.csv").unlink()
        with pytest.raises(ModelError, match=r"supports\.csv: no such file"):
            read_line(path)

    def test_spans_and_supports(self, tmp_path):
        with pytest.raises(ModelError, match="given both"):
            read_line(table(tmp_path, head=HEAD + "[[spans]]\nlength = 50.0\n"))

    def test_measured_lengths(self, tmp_path):
        """A schedule that was written is read again; its lengths are rounded to 0.1 mm."""
        path = table(tmp_path)
        plain = form(read_line(path), COARSE)
        plain.save_schedule(tmp_path / "measured.csv")
        own = HEAD.replace("[contact_wire]", 'dropper_lengths = "measured.csv"\n[contact_wire]', 1)
        path.write_text(own)
        line = read_line(path)
        assert line.dropper_lengths == pytest.approx(plain.dropper_natural, abs=5.1e-5)
        text = (tmp_path / "measured.csv").read_text().splitlines()
        cells = text[3].split(",")
        cells[5] = "-812.0"
        (tmp_path / "measured.csv").write_text("\n".join([*text[:3], ",".join(cells), *text[4:]]))
        with pytest.raises(ModelError, match="row 3, column natural_length_mm: is -812 mm"):
            read_line(path)
        (tmp_path / "measured.csv").write_text("\n".join(text[:-2]))
        with pytest.raises(
            ModelError, match=f"has {len(text) - 3} rows, the line has {len(text) - 1} droppers"
        ):
            read_line(path)


class TestCant:
    """Coordinates lie across the canted track: weights pull aside, what hangs plumb leans."""

    @pytest.mark.parametrize("cant", [0.15, -0.08])
    @pytest.mark.parametrize("length", [30.0, 45.0])
    def test_one_wire(self, cant, length):
        """It sags plumb: w sin(phi) l^2/8T aside."""
        wire = Wire(EA=12e6, EI=1.0, mass=0.95, tension=10e3)
        line = Line(
            spans=[Span(length=length, droppers=())] * 3,
            contact_wire=wire,
            steady_arm=SteadyArm(vertical=1e8),
            anchors="tension",
            cant=cant,
        )
        place = form(line, Mesh(contact_support=0.05)).contact.position
        wanted = 0.95 * G * cant / 1.5 * length**2 / 8e4
        assert np.interp(1.5 * length, place[:, 0], place[:, 1]) == pytest.approx(wanted, rel=0.01)

    @pytest.mark.parametrize("cant", [0.16, -0.1])
    def test_droppers_hang_plumb(self, cant):
        found = form(short_line(cant=cant, stagger=0.0, anchors="tension"), COARSE)
        places = [shape.position[shape.nodes.dropper] for shape in (found.messenger, found.contact)]
        up = places[0] - places[1]
        assert up[:, 1] / up[:, 2] == pytest.approx(-np.tan(np.arcsin(cant / 1.5)), rel=2e-3)
        assert verify(assemble(found)).place < 1e-6

    def test_transition(self):
        """Cant that grows from support to support: the wire on its arm carries the weight of both halves."""
        cant = (0.0, 0.0, 0.06, 0.12, 0.12, 0.12)
        line = short_line(cant=cant, stagger=0.0, anchors="tension", **STRINGS)
        found = form(line, FINE)
        x = np.linspace(0.0, 166.0, 16601)
        lean = 1.35 * G * np.interp(x, line.supports, cant) / 1.5
        share = np.interp(x, line.supports, np.arange(6) == 3)
        side = found.arm_force[3, 1] + found.support_side[3]
        messenger = 1.07 / 1.35
        kink = np.diff(np.diff(-1.2 * np.tan(np.arcsin(np.array(cant) / 1.5))) / LENGTHS)[2]
        assert side == pytest.approx(-0.01 * np.sum(lean * share) * (1 + messenger) - 16e3 * kink, rel=0.02)

    def test_in_files(self, tmp_path):
        head = (
            TABLE.replace("arm_vertical", "cant", 1)
            .replace(",\n50", ",0\n50")
            .replace("1200,0.02,\n", "1200,0.02,0.05\n")
        )
        text = head.replace(",350\n", ",0.1\n").replace("-0.2,,0,\n", "-0.2,,0,0\n")
        assert read_line(table(tmp_path, text)).cant == (0.0, 0.05, 0.1, 0.0)
        with pytest.raises(ModelError, match="row 3, column cant: must be between"):
            read_line(table(tmp_path, text.replace(",0.1\n", ",100\n")))
