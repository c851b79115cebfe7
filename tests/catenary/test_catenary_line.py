"""Overhead lines as they are described: Python, line files, catalogue, and what is wrong with them."""

import json
from dataclasses import replace

import numpy as np
import pytest

from ancf.catenary import (
    Droppers,
    Line,
    Mesh,
    Rayleigh,
    Span,
    SteadyArm,
    Wire,
    line_file,
    line_names,
    read_line,
)
from ancf.catenary.forms.mesh import divided
from ancf.catenary.lines.line_parts import MAY_LACK, PARTS
from ancf.errors import ModelError
from places import DATA, EXAMPLES

GIVEN = json.loads((DATA / "catenary.json").read_text(encoding="utf-8"))
EXAMPLE = EXAMPLES / "line.toml"
WIRE = Wire(EA=1e7, EI=100.0, mass=1.0, tension=1e4)


def line(**changes):
    given = {
        "spans": [Span(length=50.0, droppers=(10.0, 25.0, 40.0))] * 3,
        "contact_wire": WIRE,
        "messenger_wire": WIRE,
        "droppers": Droppers(stiffness=1e5),
        "steady_arm": SteadyArm(vertical=300.0),
        "system_height": 1.2,
    }
    return Line(**(given | changes))


class TestLine:
    def test_places(self):
        spans = [Span(length=50.0, droppers=(10.0, 40.0)), Span(length=60.0, droppers=(5.0, 30.0, 55.0))]
        made = line(spans=spans)
        assert made.supports.tolist() == [0.0, 50.0, 110.0]
        assert made.length == 110.0
        assert made.dropper_x.tolist() == [10.0, 40.0, 55.0, 80.0, 105.0]
        assert made.dropper_span.tolist() == [0, 0, 1, 1, 1]
        assert made.dropper_number.tolist() == [0, 1, 0, 1, 2]
        assert made.dropper_label(3) == "line.spans[1].droppers[1]"

    def test_wave_speed(self):
        assert line().wave_speed == pytest.approx(100.0)  # sqrt(1e4/1)

    def test_stagger(self):
        assert line(stagger=0.2).stagger == (0.2, -0.2, 0.2, -0.2)
        assert line(stagger=(0.1, 0.0, -0.3, 0.2)).stagger == (0.1, 0.0, -0.3, 0.2)
        assert line(stagger=0.2).messenger_y == (0.2, -0.2, 0.2, -0.2)
        assert line(stagger=0.2, messenger_stagger=0.0).messenger_y == (0.0, 0.0, 0.0, 0.0)
        assert replace(line(stagger=0.2), stagger=0.1).messenger_y == (0.1, -0.1, 0.1, -0.1)

    def test_excerpt(self):
        spans = [Span(length=float(n), droppers=(10.0, 30.0)) for n in (40, 50, 60, 70)]
        cut = line(spans=spans, stagger=0.2, system_height=(1.0, 1.1, 1.2, 1.3, 1.4)).excerpt(1, 2)
        assert cut.supports.tolist() == [0.0, 50.0, 110.0]
        assert cut.stagger == (-0.2, 0.2, -0.2)
        assert cut.system_height == (1.1, 1.2, 1.3)

    @pytest.mark.parametrize("first", range(-1, 5))
    @pytest.mark.parametrize("count", range(6))
    def test_excerpt_of_spans_that_are_there(self, first, count):
        whole = line(spans=[Span(length=50.0, droppers=(10.0, 25.0))] * 4)
        if first >= 0 and count >= 1 and first + count <= 4:
            assert len(whole.excerpt(first, count).spans) == count
            return
        with pytest.raises(ModelError, match=r"excerpt\.(first|count)"):
            whole.excerpt(first, count)

    @pytest.mark.parametrize("depth", [0.0, 0.055, 0.1])
    def test_pre_sag_is_a_parabola(self, depth):
        x = np.array([5.0, 12.0, 20.0, 35.0])
        sag = Span(length=40.0, droppers=tuple(x), pre_sag=depth).pre_sag
        assert sag == pytest.approx(depth * (1 - ((x - 20.0) / 15.0) ** 2))

    def test_section_has_the_mass_of_the_unstretched_wire(self):
        """A metre of the wire as it hangs was 1/(1 + T/EA) m long."""
        wire = Wire(EA=1e6, EI=1.0, mass=1.0, tension=1e4, damping=0.5)
        section = wire.section(Rayleigh(alpha=0.1, beta=1e-3))
        assert section.rhoA == pytest.approx(1.01)
        assert section.damping == pytest.approx(1.01 * 0.6)
        assert section.axial_damping == pytest.approx(1e3)
        assert section.bending_damping == pytest.approx(1e-3)
        assert wire.section().damping == 0.0


class TestCatalogue:
    @pytest.mark.parametrize("given", [5, None, 1.5, ["line.toml"], b"line.toml"])
    def test_neither_name_nor_path(self, given):
        with pytest.raises(ModelError, match="must be a name of the catalogue or a path"):
            read_line(given)

    def test_names(self):
        assert set(line_names()) >= {"paper-7.5", "en50318-2002", "en50318-2018-ac-simple"}

    @pytest.mark.parametrize("name", ["en50318-2002", "en50318-2018-ac-simple", "paper-7.5"])
    def test_tags_are_of_fields(self, name):
        made = read_line(name)
        assert made.title
        assert made.source
        for key, tag in made.tags.items():
            first, _, second = key.partition(".")
            target = made.spans[0] if first == "spans" else getattr(made, first)
            assert not second or second == "repeat" or hasattr(target, second), key
            assert tag.partition(":")[0] in {"V", "V2", "U", "C"}

    def test_reference_of_2002(self):
        made = read_line("en50318-2002")
        assert len(made.spans) == 10
        assert made.dropper_x[9:18] - 60.0 == pytest.approx(GIVEN["en50318-2002"]["x"])
        assert made.wave_speed == pytest.approx(np.sqrt(20e3 / 1.35))
        assert not any(made.stagger)

    def test_sag_of_the_benchmark(self):
        """The table is rounded to mm."""
        made = read_line("en50318-2018-ac-simple")
        assert made.spans[0].droppers == pytest.approx(GIVEN["en50318-2018-ac-simple"]["x"])
        assert made.spans[0].pre_sag == pytest.approx(GIVEN["en50318-2018-ac-simple"]["sag"], abs=0.5e-3)

    def test_path_and_name(self, tmp_path):
        copy = tmp_path / "own.toml"
        copy.write_text(line_file("paper-7.5").read_text(encoding="utf-8"), encoding="utf-8")
        assert read_line(copy) == read_line("paper-7.5")

    def test_example(self):
        made = read_line(EXAMPLE)
        assert len({span.length for span in made.spans}) >= 4
        assert made.steady_arm.hinged
        assert 280 / 3.6 / made.wave_speed < 0.7

    def test_unknown_name(self):
        with pytest.raises(ModelError, match=r'no line of the catalogue.*did you mean "en50318-2002"'):
            read_line("en50318-2003")
        with pytest.raises(ModelError, match=r'did you mean "paper-7.5"'):
            line_file("paper7.5")

    def test_missing_file(self, tmp_path):
        with pytest.raises(ModelError, match="no such file"):
            read_line(tmp_path / "no.toml")
        with pytest.raises(ModelError, match="is a folder, not a line file"):
            read_line(tmp_path)


def spans_with(**changes):
    return Span(**({"length": 50.0, "droppers": (10.0, 25.0, 40.0)} | changes))


class TestParts:
    @pytest.mark.parametrize("key", [key for key in PARTS if key not in MAY_LACK])
    def test_that_no_line_may_lack(self, key):
        with pytest.raises(ModelError) as caught:
            line(**{key: None})
        assert caught.value.where == f"line.{key}"
        assert f"must be a {PARTS[key].__name__}, is None" in caught.value.what

    @pytest.mark.parametrize("key", PARTS)
    def test_of_another_kind(self, key):
        with pytest.raises(ModelError) as caught:
            line(**{key: WIRE if PARTS[key] is not Wire else Droppers(EA=1e5)})
        assert caught.value.where == f"line.{key}"

    @pytest.mark.parametrize("count", [2, 3])
    def test_spans_may_come_in_any_form(self, count):
        """What can be gone through is as good as a tuple, and may be used up by it."""
        spans = [spans_with() for _ in range(count)]
        wanted = line(spans=tuple(spans), stagger=0.2)
        for given in (spans, iter(spans), (one for one in spans)):
            found = line(spans=given, stagger=0.2)
            assert found.spans == wanted.spans
            assert hash(found.spans) == hash(wanted.spans)


class TestWrongInPython:
    @pytest.mark.parametrize(
        ("make", "where", "what"),
        [
            (lambda: spans_with(droppers=0), "span.droppers", "must be"),
            (lambda: spans_with(droppers="rule"), "span.droppers", "must be"),
            (lambda: spans_with(droppers=np.array(5.0)), "span.droppers", "shape"),
            (lambda: spans_with(droppers=[[5.0], [5.0, 6.0]]), "span.droppers[0]", ""),
            (lambda: spans_with(droppers=(10.0, 55.0)), "span.droppers[1]", "outside its span of 50 m"),
            (lambda: spans_with(droppers=(0.0, 5.0)), "span.droppers[0]", "outside its span"),
            (lambda: spans_with(droppers=(20.0, 10.0)), "span.droppers[1]", "is at 10 m after one at 20 m"),
            (lambda: spans_with(droppers=(20.0, 20.0)), "span.droppers[1]", "after one at 20 m"),
            (lambda: spans_with(droppers=(20.0, 20.01)), "span.droppers[1]", "closer than 0.05 m"),
            (lambda: spans_with(droppers=(20.0, 49.99)), "span.droppers[1]", "closer than 0.05 m"),
            (lambda: spans_with(length=-1.0), "span.length", "must be > 0"),
            (lambda: spans_with(pre_sag=-0.1), "span.pre_sag", "must be >= 0"),
            (lambda: spans_with(pre_sag=(0.1, 0.2)), "span.pre_sag", "has shape (2,), wanted (3,)"),
            (lambda: line(spans=[]), "line.spans", "has no span"),
            (lambda: line(contact_wire=replace(WIRE, tension=0.0)), "line.contact_wire.tension", "> 0"),
            (lambda: line(contact_wire=replace(WIRE, tension=1e6)), "line.contact_wire.tension", "5 %"),
            (lambda: line(messenger_wire=replace(WIRE, mass=-1.0)), "line.messenger_wire.mass", "> 0"),
            (lambda: line(damping=Rayleigh(beta=-1e-4)), "line.damping.beta", ">= 0"),
            (lambda: line(droppers=Droppers()), "line.droppers.stiffness", "give stiffness or EA"),
            (lambda: line(droppers=Droppers(EA=1.0, stiffness=1.0)), "line.droppers.stiffness", "not both"),
            (lambda: line(steady_arm=SteadyArm()), "line.steady_arm.vertical", "is missing"),
            (
                lambda: line(steady_arm=SteadyArm(vertical=1.0, length=1.0)),
                "line.steady_arm.vertical",
                "not both",
            ),
            (
                lambda: line(steady_arm=SteadyArm(length=1.0, lateral=5.0)),
                "line.steady_arm.lateral",
                "no effect",
            ),
            (lambda: line(stagger=(0.1, 0.2)), "line.stagger", "has 2 values, the line has 4 supports"),
            (lambda: line(system_height=0.0), "line.system_height[0]", "must be > 0"),
            (lambda: line(contact_support="loose"), "line.contact_support", "must be one of"),
            (lambda: line(anchors="weights"), "line.anchors", "must be one of"),
            (lambda: line(gravity=float("nan")), "line.gravity", "must be a finite number"),
            (lambda: Mesh(contact=0.0), "mesh.contact", "must be > 0"),
        ],
    )
    def test_is_named(self, make, where, what):
        with pytest.raises(ModelError) as caught:
            make()
        assert caught.value.where == where
        assert what in caught.value.what


def changed(old, new):
    text = line_file("en50318-2018-ac-simple").read_text(encoding="utf-8")
    assert text.count(old) >= 1
    return text.replace(old, new, 1)


class TestWrongInFile:
    """A file from the catalogue with one field wrong."""

    @pytest.mark.parametrize(
        ("old", "new", "where", "what"),
        [
            ("tension = 22e3", "tension = 0.0", "contact_wire.tension", "must be > 0, is 0"),
            ("tension = 22e3", 'tension = "22 kN"', "contact_wire.tension", "must be a number"),
            ("tension = 22e3", "", "contact_wire.tension", "is missing"),
            ("tension = 22e3", "tensoin = 22e3", None, 'did you mean "tension"?'),
            ("system_height = 1.2", "sytem_height = 1.2", None, 'did you mean "system_height"?'),
            (
                "system_height = 1.2",
                "system_height = [1.2, 1.3]",
                "system_height",
                "has 2 values, the line has 11 supports",
            ),
            ("stagger = 0.2", "stagger = [0.2]", "stagger", "has 1 values, the line has 11 supports"),
            ("4.5, 10.25", "10.25, 4.5", "spans[0].droppers[1]", "is at 4.5 m after one at 10.25 m"),
            ("50.5]", "55.5]", "spans[0].droppers[8]", "outside its span of 55 m"),
            ("pre_sag = 0.055", "pre_sag = [0.055]", "spans[0].pre_sag", "wanted (9,)"),
            ("repeat = 10", "repeat = 0", "spans[0].repeat", "must be >= 1"),
            ("EA = 200e3", "EA = 200e3\nstiffness = 1e5", "droppers.stiffness", "not both"),
            ("vertical = 267.0", "height = 267.0", None, "unknown key"),
            ("vertical = 267.0", "mass = 1.0", "steady_arm.vertical", "is missing"),
            (
                'contact_support = "free"',
                'contact_support = "fre"',
                "contact_support",
                'must be one of "held"',
            ),
            ("[droppers]", "[droppers", None, "TOML syntax"),
        ],
    )
    def test_is_named(self, tmp_path, old, new, where, what):
        path = tmp_path / "own.toml"
        path.write_text(changed(old, new), encoding="utf-8")
        with pytest.raises(ModelError) as caught:
            read_line(path)
        assert where is None or caught.value.where == where
        assert what in str(caught.value)

    def test_all_problems_at_once(self, tmp_path):
        path = tmp_path / "own.toml"
        path.write_text(changed("mass = 1.35", "mass = -1.35").replace("beta", "betta"), encoding="utf-8")
        with pytest.raises(ModelError, match="2 problems") as caught:
            read_line(path)
        assert "contact_wire.mass: must be > 0" in caught.value.what
        assert "damping.betta: unknown key" in caught.value.what
        assert 'tags."damping.betta"' not in caught.value.what


class TestMesh:
    @pytest.mark.parametrize(("at_a", "at_b"), [(1.0, 1.0), (0.1, 1.0), (0.1, 0.05)])
    def test_divided(self, at_a, at_b):
        places = divided(3.0, 10.5, at_a, at_b, 1.0)
        size = np.diff(places)
        assert (places[0], places[-1]) == (3.0, 10.5)
        assert size.max() <= 1.0 + 1e-9
        assert size[0] <= 1.4 * at_a  # it grows within the first element
        assert size[-1] <= 1.4 * at_b
        assert np.all(size[1:] / size[:-1] < 2.2)
        assert np.all(size[1:] / size[:-1] > 1 / 2.2)

    def test_nodes_at_all_marks(self):
        made = line()
        for wire in ("contact", "messenger"):
            nodes = Mesh(contact=0.7, messenger=3.0, dropper=0.3).nodes(made, wire)
            assert nodes.x[nodes.support] == pytest.approx(made.supports)
            assert nodes.x[nodes.dropper] == pytest.approx(made.dropper_x)
            assert np.all(np.diff(nodes.x) > 0.0)
            assert np.diff(nodes.x).max() <= getattr(Mesh(contact=0.7, messenger=3.0), wire) + 1e-9


def test_rayleigh_damping_of_a_wire_reaches_its_section():
    """alpha rhoA, beta EA, beta EI and, for the stiffness from the tension, beta T."""
    wire = Wire(EA=15e6, EI=195.0, mass=1.35, tension=20e3, damping=0.03)
    section = wire.section(Rayleigh(alpha=0.0125, beta=1e-4))
    assert section.slope_damping == pytest.approx(1e-4 * 20e3)
    assert section.axial_damping == pytest.approx(1e-4 * 15e6)
    assert section.bending_damping == pytest.approx(1e-4 * 195.0)
    assert section.damping == pytest.approx((0.03 + 0.0125 * 1.35) * (1 + 20e3 / 15e6))
