"""Input files of MoorDyn as models: what is taken, what is said of the rest, and what is refused."""

import math

import numpy as np
import pytest

import ancf
from ancf.model.file import parse_study, read_study
from ancf.mooring.moordyn_file import read_moordyn
from ancf.mooring.moordyn_model import import_moordyn

TYPES = """--------------------- LINE TYPES ----------------------
TypeName   Diam    Mass/m     EA      BA/-zeta   EI    Cd    Ca    CdAx   CaAx
(name)     (m)     (kg/m)     (N)     (N-s/-)  (N-m^2) (-)   (-)   (-)    (-)
{types}
"""
POINTS = """---------------------- POINTS -------------------------
ID   Attachment   X      Y     Z      Mass  Volume  CdA   Ca
(#)  (-)         (m)    (m)   (m)     (kg)  (m^3)   (m^2) (-)
{points}
"""
LINES = """---------------------- LINES --------------------------
ID   LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
(#)   (name)     (#)      (#)      (m)       (-)      (-)
{lines}
"""
OPTIONS = """---------------------- SOLVER OPTIONS -----------------
{options}
---------------------- OUTPUTS ------------------------
{outputs}
------------------------- need this line -------------------
"""
CHAIN = "chain 0.1 50.0 2.0e8 {BA} 0.0 1.6 1.0 0.1 0.0"
UNDAMPED = CHAIN.format(BA=0)
TWO = "1 Fixed 290.0 0.0 -100.0 0 0 0 0\n2 Vessel 0 0 0 0 0 0 0"
ONE = "1 chain 1 2 320.0 20 p"
DEEP = "0.001 dtM time step\n9.80665 g\n1025 WtrDnsty\n3.0D6 kBot\n3.0e5 cBot\n100 WtrDpth depth of the water"


def text(types=UNDAMPED, points=TWO, lines=ONE, options=DEEP, outputs=""):
    parts = (TYPES, POINTS, LINES, OPTIONS)
    return "MoorDyn input file\n\n" + "".join(parts).format(
        types=types, points=points, lines=lines, options=options, outputs=outputs
    )


@pytest.fixture
def write(tmp_path):
    def written(**changes):
        path = tmp_path / "lines.txt"
        path.write_text(text(**changes), encoding="utf-8")
        return path

    return written


class TestWhatIsTaken:
    def test_forces_at_rest_are_moordyns(self, write):
        """Its own for this chain, refined until they stand (references of ``ancf validate mooring``)."""
        model = parse_study(import_moordyn(write()).tables).model
        state = ancf.equilibrium(model)
        found = {s.name: np.linalg.norm(state.reaction(s.name)) for s in model.supports}
        assert found["pin at line1.end"] == pytest.approx(129463, rel=5e-4)
        assert found["pin at line1.start"] == pytest.approx(88347, rel=5e-4)

    def test_numbers_of_line_types_and_options(self, write):
        made = import_moordyn(write(types="chain 0.2 60 1e8 3e5 7.0 1.5 0.9 0.2 0.3"))
        model = parse_study(made.tables).model
        section = model.beams["line1"].section
        assert (section.EA, section.EI, section.rhoA, section.axial_damping) == (1e8, 7.0, 60.0, 3e5)
        assert (section.diameter, section.drag, section.added_mass) == (0.2, (1.5, 0.2), (0.9, 0.3))
        beam = model.beams["line1"]
        assert (beam.length, beam.elements) == (320.0, 20)
        assert model.gravity.tolist() == [0, 0, -9.80665]
        fluid, ground = model.fluids[0], model.grounds[0]
        assert (fluid.density, fluid.below) == (1025.0, 0.0)
        assert (ground.height, ground.stiffness, ground.damping, ground.friction) == (-100.0, 3e6, 3e5, 0.0)
        assert made.left_out == []

    @pytest.mark.parametrize(("share", "segments"), [(0.8, 20), (0.1, 7), (1.0, 1)])
    def test_share_of_critical_damping(self, write, share, segments):
        made = import_moordyn(write(types=CHAIN.format(BA=-share), lines=f"1 chain 1 2 320 {segments} p"))
        section = parse_study(made.tables).model.beams["line1"].section
        assert section.axial_damping == pytest.approx(share * math.sqrt(2e8 * 50.0) * 320 / segments)

    def test_free_point_with_a_mass_hangs_on_its_lines(self, write):
        """Two equal lines carry half of the weight in water each: of a clump and of themselves."""
        points = "1 Fixed -40 0 -5\n2 Fixed 40 0 -5\n3 Free 0 0 -35 500 0.1 0.5 1.0"
        made = import_moordyn(
            write(
                types="wire 0.01 0.5 1e7 0 0 1.2 1 0 0",
                points=points,
                lines="1 wire 1 3 50 10 p\n2 wire Point2 P3 50 10 p",
                options="9.81 gravity\n1000 rho",
            )
        )
        model = parse_study(made.tables).model
        mass = model.bodies["point3"]
        assert (mass.mass, mass.volume, mass.drag_area, mass.added_mass) == (500.0, 0.1, 0.5, 1.0)
        state = ancf.equilibrium(model)
        up = [state.reaction(s.name)[2] for s in model.supports]
        wet = 9.81 * (500 - 1000 * 0.1 + 2 * 50 * (0.5 - 1000 * math.pi * 0.01**2 / 4))
        assert sum(up) == pytest.approx(wet, rel=1e-6)
        assert up[0] == pytest.approx(up[1], rel=1e-6)
        assert "No depth is given: there is no seabed." in made.notes

    @pytest.mark.parametrize("count", [2, 3])
    def test_free_point_without_a_mass_is_a_joint(self, write, count):
        points = "\n".join([*(f"{k} Fixed {20 * k} 0 0" for k in range(1, count + 1)), "9 Connect 30 0 -20"])
        lines = "\n".join(f"{k} chain {k} 9 40 4 p" for k in range(1, count + 1))
        tables = import_moordyn(write(points=points, lines=lines)).tables
        joints = [(c["a"], c["b"]) for c in tables["connections"]]
        assert joints == [("line1.end", f"line{k}.end") for k in range(2, count + 1)]
        parse_study(tables)

    @pytest.mark.parametrize(
        ("given", "wanted"),
        [
            ({}, (9.80665, 1025.0, 3e6, 3e5, 0.0)),
            ({"gravity": 1.62}, (1.62, 1025.0, 3e6, 3e5, 0.0)),
            ({"rho": 998.0, "kb": 2e5}, (9.80665, 998.0, 2e5, 3e5, 0.0)),
            ({"cb": 7e4, "mu": 0.3}, (9.80665, 1025.0, 3e6, 7e4, 0.3)),
            ({"g": 9.81, "FrictionCoefficient": 0.6}, (9.81, 1025.0, 3e6, 3e5, 0.6)),
        ],
    )
    def test_what_is_not_given_is_as_in_the_program(self, write, given, wanted):
        """Its documentation has: g 9.80665, WtrDnsty 1025, kBot 3.0e6, cBot 3.0e5, FrictionCoefficient 0."""
        options = "\n".join(["80 depth", *(f"{value} {name}" for name, value in given.items())])
        model = parse_study(import_moordyn(write(options=options)).tables).model
        ground = model.grounds[0]
        found = -model.gravity[2], model.fluids[0].density, ground.stiffness, ground.damping, ground.friction
        assert found == wanted
        assert ground.height == -80.0

    def test_names_of_sections_and_of_points(self, tmp_path):
        other = text().replace("LINE TYPES", "LINE DICTIONARY").replace(" POINTS ", " POINT PROPERTIES ")
        path = tmp_path / "other.dat"
        path.write_text(other.replace(" LINES -", " LINE PROPERTIES -"), encoding="latin-1")
        assert {name: len(rows) for name, rows in read_moordyn(path).tables.items()} == {
            "line types": 1,
            "points": 2,
            "lines": 1,
        }


class TestWhatIsSaid:
    def test_what_has_no_counterpart_is_listed(self, write):
        bodies = "---- BODIES ----\nID Attach X0\n(#) (-) (m)\n1 free 0 0 0\n2 free 0 0 0\n"
        path = write(
            options=DEEP + "\n1 WaveKin\n0 Currents\n0.0 dtWave\n0.5 dtOut\n",
            outputs="FairTen1 AnchTen1\nEND\n",
            points=TWO + "\n7 Fixed 1 1 1",
        )
        path.write_text(
            path.read_text(encoding="utf-8").replace(
                "---------------------- LINES", bodies + "---- LINES", 1
            ),
            encoding="utf-8",
        )
        made = import_moordyn(path)
        assert made.left_out == [
            "point 7, where no line ends",
            "2 of bodies",
            "option wavekin = 1",
            "outputs FairTen1 AnchTen1: ask results, or give sensors",
        ]
        assert made.notes == ["Coupled points stand still: line1.end. Give their supports a displacement."]

    def test_what_is_assumed_is_said(self, write):
        made = import_moordyn(write(options="50 WtrDpth"))
        for name in ("g", "WtrDnsty", "kBot", "cBot"):
            assert any(note.startswith(f"{name} is not given") for note in made.notes)

    def test_of_a_viscoelastic_line_the_static_stiffness_is_taken(self, write):
        made = import_moordyn(write(types="rope 0.1 5 1e6|2e6 10|20 0 1 1 0 0", lines="1 rope 1 2 320 20 p"))
        assert made.tables["sections"]["rope"]["EA"] == 1e6
        assert made.left_out == ["BA of rope: 20 behind 10", "EA of rope: 2e6 behind 1e6"]


class TestWhatIsRefused:
    @pytest.mark.parametrize(
        ("changes", "where", "what"),
        [
            ({"types": "chain 0.1 50 table.txt 0 0 1 1 0 0"}, "line 6, EA", "table in another file"),
            ({"types": "chain 0.1 50 2e8 0 0 1 1"}, "line 6", "has 8 columns"),
            ({"types": UNDAMPED + "\n" + UNDAMPED}, "line 7", "two line types"),
            ({"lines": "1 rope 1 2 320 20 p"}, "line 15, type", 'no line type "rope"'),
            ({"lines": "1 chain 1 Body1 320 20 p"}, "line 15", "no point of the file"),
            ({"lines": "1 chain 1 2 320 2.5 p"}, "line 15, segments", "is 2.5"),
            ({"lines": "1 chain 1 2 320 nan p"}, "line 15, segments", 'is "nan"'),
            ({"lines": "1 chain 1 2 320 inf p"}, "line 15, segments", 'is "inf"'),
            ({"types": "chain 0.1 -50 2e8 -1 0 1 1 0 0"}, "line 6, mass", "is -50, must be > 0"),
            ({"types": "chain 0.1 50 0 -1 0 1 1 0 0"}, "line 6, EA", "is 0, must be > 0"),
            ({"types": "chain 0.1 50 -2e8|9 0 0 1 1 0 0"}, "line 6, EA", "is -2e+08, must be > 0"),
            ({"types": "chain 0.1 50 2e8 0 -1 1 1 0 0"}, "line 6, EI", "is -1, must be >= 0"),
            ({"types": "chain -0.1 50 2e8 0 0 1 1 0 0"}, "line 6, diameter", "is -0.1, must be > 0"),
            ({"types": "chain 0.1 50 2e8 0 0 1 -1 0 0"}, "line 6, Ca", "is -1, must be >= 0"),
            ({"lines": "1 chain 1 2 -250 20 p"}, "line 15, length", "is -250, must be > 0"),
            (
                {"lines": "1 chain 1 2 -250 20 p", "types": CHAIN.format(BA=-0.8)},
                "line 15, length",
                "is -250, must be > 0",
            ),
            ({"points": TWO.replace("Vessel 0 0 0 0 0", "Free 0 0 0 -3 0")}, "line 11, mass", "is -3"),
            ({"options": "-100 WtrDpth"}, "line 17, wtrdpth", "is -100, must be >= 0"),
            ({"options": "100 WtrDpth\n-3e6 kBot"}, "line 18, kbot", "is -3e+06, must be > 0"),
            ({"options": "-1025 rhow"}, "line 17, rhow", "is -1025, must be > 0"),
            ({"points": TWO + "\n2 Fixed 1 1 1"}, "line 12", 'two points "2"'),
            ({"lines": "1 chain 1 2 long 20 p"}, "line 15, length", 'is "long"'),
            ({"points": TWO.replace("Vessel", "Turbine1")}, "line 11", 'attached to "Turbine1"'),
            ({"points": TWO.replace("Vessel 0 0 0 0 0", "Free 0 0 0 0 0.5")}, "line 11", "no mass"),
            ({"options": "deep WtrDpth"}, "line 17, wtrdpth", 'is "deep"'),
            ({"points": TWO.replace("Vessel 0 0 0 0 0 0", "Free 0 0 0 0 0 1.5")}, "line 11", "no mass"),
            ({"lines": ""}, "lines.txt", "has no section with lines"),
        ],
    )
    def test_with_its_place(self, write, changes, where, what):
        with pytest.raises(ancf.ModelError) as error:
            import_moordyn(write(**changes))
        assert error.value.where.endswith(where)
        assert what in error.value.what

    def test_a_file_that_is_not_there(self, tmp_path):
        with pytest.raises(ancf.ModelError, match="cannot be read"):
            import_moordyn(tmp_path / "none.txt")


class TestCommand:
    def test_writes_a_model_file_that_is_right(self, call, write):
        ran = call("import-moordyn", write(outputs="FairTen1"), "-o", "sub/chain.toml")
        assert ran.code == 0
        assert "left out: outputs FairTen1" in ran.out
        assert "written: sub/chain.toml (1 line, 2 supports)" in ran.out
        assert call("check", "sub/chain.toml").code == 0
        study = read_study("sub/chain.toml")
        assert study.source_text.startswith("# Made from lines.txt, an input file of MoorDyn.\n# Coupled")
        assert study.model.title == "lines"

    def test_what_no_comment_may_hold_is_spelt_out(self, call, write):
        assert call("import-moordyn", write(outputs="Fair\x01Ten1 \x1b[31m"), "-o", "m.toml").code == 0
        assert call("check", "m.toml").code == 0

    def test_beside_the_file_without_a_name(self, call, write):
        path = write()
        assert call("import-moordyn", path).code == 0
        assert path.with_suffix(".toml").exists()

    @pytest.mark.parametrize("content", ["", "MoorDyn\n", "\x00\x01", "--- LINES ---\n"])
    def test_what_is_no_input_file(self, call, tmp_path, content):
        path = tmp_path / "a.txt"
        path.write_text(content, encoding="utf-8")
        ran = call("import-moordyn", path)
        assert ran.code == 2
        assert "is it an input file of MoorDyn" in ran.err
        assert not path.with_suffix(".toml").exists()
