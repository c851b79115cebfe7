"""Parameters of model and line files: names in formulas, values by path."""

import copy
import tomllib

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.catenary.lines.file import parse_line
from ancf.model.file import parse_study, read_study, schema
from ancf.model.file.paths import assignments, changed, found

TEXT = """
gravity = [0, 0, "-g"]
[parameters]
g = 9.81
d = 0.01
A = "pi*d**2/4"
E = 2e9
F = 3
n = 8
[sections.rope]
EA = "E*A"
EI = "E*pi*d**4/64"
rhoA = "1200*A"
[[bodies]]
name = "wire"
start = [0, 0, 0]
end = ["100*d", 0, 0]
elements = "n"
section = "rope"
[[bodies]]
type = "point_mass"
name = "tip mass"
at = ["100*d", 0, 0]
mass = "F/g"
[[supports]]
type = "clamp"
point = "wire.start"
[[loads]]
type = "force"
name = "push"
point = "wire.end"
force = [0, 0, "F*sin(2*pi*t) - 1e1*u"]
[[connections]]
type = "spring"
name = "dropper 5.0"
a = "wire.end"
b = ["2*d", 0, 0]
stiffness = "100*F"
[[connections]]
type = "spherical"
a = "tip mass"
b = "wire.end"
[[inputs]]
name = "u"
value = "F"
[simulation]
t_end = 1
step = "0.1/n"
integrator = { type = "generalized_alpha", rho_inf = "d*50" }
"""
#: The same with numbers that Python has computed.
A = np.pi * 0.01**2 / 4
NUMBERS = {
    '"-g"': "-9.81",
    '"100*d"': repr(100 * 0.01),
    '"n"': "8",
    '"F/g"': repr(3 / 9.81),
    '"E*A"': repr(2e9 * A),
    '"E*pi*d**4/64"': repr(2e9 * np.pi * 0.01**4 / 64),
    '"1200*A"': repr(1200 * A),
    '"2*d"': "0.02",
    '"100*F"': "300.0",
    '"F*sin(2*pi*t) - 1e1*u"': '"(3.0)*sin(2*pi*t) - 1e1*u"',
    '"F"': "3.0",
    '"0.1/n"': "0.0125",
    '"d*50"': "0.5",
}


def tables(text=TEXT):
    return tomllib.loads(text)


def plain():
    text = TEXT[: TEXT.index("[parameters]")] + TEXT[TEXT.index("[sections.rope]") :]
    for formula, number in NUMBERS.items():
        assert formula in text
        text = text.replace(formula, number)
    return text


def study(**values):
    return parse_study(changed(tables(), values))


class TestFormulas:
    def test_stand_for_numbers_everywhere(self):
        one, other = parse_study(tables()), parse_study(tables(plain()))
        assert one.model.to_dict() == other.model.to_dict()
        assert one.simulation == other.simulation
        assert one.model.inputs["u"].value == 3.0

    def test_the_model_knows_no_parameters(self):
        """Its description can be read where the parameters are not known."""
        model = parse_study(tables()).model
        assert ancf.Model.from_dict(model.to_dict()).to_dict() == model.to_dict()

    @pytest.mark.parametrize("d", [0.005, 0.012, 0.02])
    def test_follow_what_they_depend_on(self, d):
        section = study(d=d).model.beams["wire"].section
        assert pytest.approx(2e9 * np.pi * d**2 / 4, rel=1e-15) == section.EA
        assert pytest.approx(2e9 * np.pi * d**4 / 64, rel=1e-15) == section.EI

    def test_names_that_only_look_alike_stay(self):
        """The e of 1e1 is no parameter e, and a name inside another one is none."""
        text = TEXT.replace("[parameters]", "[parameters]\ne1 = 7\nsi = 2")
        force = parse_study(tables(text)).model.loads[0].force
        assert force(0.3)[2] == pytest.approx(3 * np.sin(0.6 * np.pi) - 10 * 3, rel=1e-14)

    def test_labels_are_no_formulas(self):
        """A body may have the name of a parameter: points and names stay names."""
        text = TEXT.replace('"wire', '"d').replace('name = "wire"', 'name = "d"')
        assert str(parse_study(tables(text)).model.connections[0].a) == "d.end"

    @pytest.mark.parametrize(
        ("old", "new", "where", "phrase"),
        [
            (
                'EA = "E*A"',
                'EA = "E*B"',
                "sections.rope.EA",
                'unknown name "B", known are g, d, A, E, F, n, pi',
            ),
            ('EA = "E*A"', 'EA = "-E"', "sections.rope.EA", "must be > 0"),
            ('EA = "E*A"', 'EA = "E*"', "sections.rope.EA", "is no formula"),
            ('EA = "E*A"', 'EA = "E/(A-A)"', "sections.rope.EA", "must be a finite number"),
            ('EA = "E*A"', 'EA = "E*t"', "sections.rope.EA", 'unknown name "t"'),
            ('"100*d", 0, 0]\nelements', '"100*D", 0, 0]\nelements', "bodies[0].end[0]", 'unknown name "D"'),
            ("n = 8", "n = 8.5", "bodies[0].elements", "must be a whole number, is 8.5"),
            ("g = 9.81", 'g = "h"', "parameters.g", 'unknown name "h", known are pi'),
            ("g = 9.81", 'g = "d"', "parameters.g", 'unknown name "d"'),
            ("g = 9.81", "g = true", "parameters.g", "must be a number"),
            ("g = 9.81", "g = nan", "parameters.g", "must be a finite number"),
            ("g = 9.81", "sin = 1", "parameters.sin", "cannot stand in a formula"),
            ("g = 9.81", "u = 1", "parameters.u", "is the name of an input too"),
            ("sin(2*pi*t) - 1e1", "sin(2*pi*t) - G*1e1", "loads[0].force[2]", 'unknown name "G"'),
            ('"d*50"', '"d*5000"', "simulation.integrator.rho_inf", "must be between"),
        ],
    )
    def test_bad(self, old, new, where, phrase):
        assert old in TEXT
        with pytest.raises(ancf.ModelError) as caught:
            parse_study(tables(TEXT.replace(old, new)))
        assert where in str(caught.value)
        assert phrase in str(caught.value)

    def test_a_unit_behind_a_number_is_named_where_formulas_may_stand(self):
        with pytest.raises(ancf.ModelError, match=r"step: is '20 ms', must be a number in s"):
            parse_study(
                tables(plain().replace("step = 0.0125", 'step = "20 ms"') + "\n[parameters]\nA = 1.0\n")
            )

    def test_a_parameter_behind_a_number_is_no_unit(self):
        with pytest.raises(ancf.ModelError, match=r"step: .* \(write \* for a product: 2\*ms\)"):
            parse_study(
                tables(plain().replace("step = 0.0125", 'step = "2 ms"') + "\n[parameters]\nms = 1e-3\n")
            )

    def test_without_parameters_a_text_is_no_number(self):
        with pytest.raises(ancf.ModelError, match=r"step: must be a number, is '2\*3' \(str\)"):
            parse_study(tables(plain().replace("step = 0.0125", 'step = "2*3"')))

    def test_no_table(self):
        with pytest.raises(ancf.ModelError, match="parameters: must be a table, is 3"):
            parse_study(tables(plain()) | {"parameters": 3})

    def test_lines(self):
        """A line file has them too."""
        file = catenary.line_file("en50318-2002")
        with file.open("rb") as opened:
            given = tomllib.load(opened)
        tension = given["contact_wire"]["tension"]
        given["parameters"] = {"T": 1.1 * tension, "first": 6.0}
        given["contact_wire"]["tension"] = "T"
        given["spans"][0]["droppers"][0] = "first"
        line = parse_line(given)
        assert line.contact_wire.tension == 1.1 * tension
        assert line.spans[0].droppers[0] == 6.0
        given["spans"][0]["droppers"][0] = "frist"
        with pytest.raises(ancf.ModelError, match=r'spans\[0\]\.droppers\[0\]: .*did you mean "first"'):
            parse_line(given)
        given["spans"][0] |= {"droppers": {"first": "first", "pitch_max": "first + 2"}, "pre_sag": 0.0}
        assert parse_line(given).spans[0].droppers == (6.0, 14.0, 22.0, 30.0, 38.0, 46.0, 54.0)
        for key, place in (("pich_max", "pitch_max: is missing"), ("more", "more: unknown key")):
            given["spans"][0]["droppers"] = {"first": 6.0, key: 8.0}
            with pytest.raises(ancf.ModelError, match=rf"spans\[0\]\.droppers\.{place}"):
                parse_line(given)

    def test_schema_takes_formulas(self):
        field = schema()["$defs"]["SectionEntry"]["properties"]["EA"]
        assert {"type": "string"} in field["anyOf"]
        assert "[N]" in field["description"]
        assert "parameters" in schema()["properties"]


class TestPaths:
    @pytest.mark.parametrize(
        ("path", "value", "seen"),
        [
            ("sections.rope.EA", 5.0, lambda s: s.model.beams["wire"].section.EA),
            ("sections.rope.damping", 0.25, lambda s: s.model.beams["wire"].section.damping),
            ("bodies.wire.elements", 3, lambda s: s.model.beams["wire"].elements),
            ("bodies[0].elements", 5, lambda s: s.model.beams["wire"].elements),
            ('bodies."tip mass".mass', 2.5, lambda s: s.model.masses["tip mass"].mass),
            ("bodies.tip mass.mass", 3.5, lambda s: s.model.masses["tip mass"].mass),
            ('connections."dropper 5.0".stiffness', 7.0, lambda s: s.model.connections[0].stiffness),
            ("connections[0].stiffness", 8.0, lambda s: s.model.connections[0].stiffness),
            ("loads.push.force[1]", 2.0, lambda s: s.model.loads[0].force(0.0)[1]),
            ("gravity[2]", -1.5, lambda s: s.model.gravity[2]),
            ("simulation.step", 0.01, lambda s: s.simulation.step),
            ("simulation.integrator.rho_inf", 0.75, lambda s: s.simulation.integrator.rho_inf),
            ("parameters.n", 6, lambda s: s.model.beams["wire"].elements),
            ("n", 7, lambda s: s.model.beams["wire"].elements),
        ],
    )
    def test_values(self, path, value, seen):
        before = tables()
        kept = copy.deepcopy(before)
        made = changed(before, {path: value})
        assert seen(parse_study(made)) == value
        assert found(made, path) == value
        assert before == kept

    def test_several(self):
        made = parse_study(changed(tables(), {"d": 0.02, "sections.rope.EA": 1.0}))
        section = made.model.beams["wire"].section
        assert section.EA == 1.0
        assert pytest.approx(2e9 * np.pi * 0.02**4 / 64) == section.EI

    @pytest.mark.parametrize(
        ("path", "phrase"),
        [
            ("sections.rop.EA", '"sections" has no "rop", there are: "rope" (did you mean "rope"?)'),
            ("sections.rope.EAA", 'sections.rope.EAA: unknown key, allowed: "EA", "EI"'),
            ("section.rope.EA", 'the file has no "section"'),
            (
                "bodies.wir.elements",
                '"bodies" has no entry "wir", there are: "wire", "tip mass" (did you mean',
            ),
            ("bodies[2].elements", '"bodies" has 2 entries, [0] to [1]'),
            ("supports.x.point", '"supports" has no entry "x", its entries have no names: 1 entry, [0]'),
            ("sections.rope.EA.b", "\"sections.rope.EA\" is 'E*A', there is nothing inside"),
            ("sections[0].EA", "there is nothing inside"),
            ("gravity", "is no number but a table or a list"),
            ("sections.rope", "in it are: "),
            ("gravity[3]", '"gravity" has 3 entries, [0] to [2]'),
            ("nn", 'the file has no "nn"'),
            ("parameters.nn", '"parameters" has no "nn", there are: "g", "d", "A", "E", "F", "n" (did you'),
            ("titel", 'titel: unknown key, allowed: "title"'),
            ("", "is no path"),
            ("a..b", "is no path"),
            (".a", "is no path"),
            ("a[x]", "is no path"),
            ("a=b", "is no path"),
        ],
    )
    def test_unknown(self, path, phrase):
        with pytest.raises(ancf.ModelError) as caught:
            parse_study(changed(tables(), {path: 1.0}))
        assert phrase in str(caught.value)

    def test_lines(self):
        line = catenary.read_line("en50318-2002", {"spans[0].length": 58.0, "contact_wire.tension": 21e3})
        assert line.spans[0].length == 58.0
        assert line.contact_wire.tension == 21e3
        with pytest.raises(ancf.ModelError, match=r'has no "contact_wir".*did you mean "contact_wire"'):
            catenary.read_line("en50318-2002", {"contact_wir.tension": 1.0})

    def test_reading_says_what_was_given(self, tmp_path):
        (tmp_path / "m.toml").write_text(TEXT, encoding="utf-8")
        made = read_study(tmp_path / "m.toml", {"d": 0.02})
        assert made.values == {"d": 0.02}
        assert made.source_text == TEXT


class TestAssignments:
    def test_values_are_those_of_toml(self):
        given = ["a.b=2e4", " c = 3 ", 'd="x"', "e=radau", "f=[1, 2]", "g=true", "h=-1_000"]
        assert assignments(given) == {
            "a.b": 2e4,
            "c": 3,
            "d": "x",
            "e": "radau",
            "f": [1, 2],
            "g": True,
            "h": -1000,
        }
        assert assignments(None) == {}

    @pytest.mark.parametrize("text", ["a", "=3", "a=", ""])
    def test_bad(self, text):
        with pytest.raises(ancf.ModelError, match="must be PATH=VALUE"):
            assignments([text])

    def test_twice(self):
        with pytest.raises(ancf.ModelError, match="--set: gives a twice"):
            assignments(["a=1", "a=2"])
