"""Files of lines and their tables: separators, names and paths, commands of models, pictures."""

import numpy as np
import pytest
from typer.testing import CliRunner

import ancf
from ancf import ModelError
from ancf.catenary import Mesh, elasticity, form, read_line, run, statistics
from ancf.catenary.report import write_report
from ancf.cli.app import app
from ancf.design.lines import LineCase
from ancf.model.file import read_toml
from overhead_lines import COARSE, STEP, TOML, collector, short_line

TABLE = """position,stagger,droppers,arm_side
0,0.2,4;12.5;26,
30,-0.2,4;12.5;26,right
60.5,0.2,4;12.5;26,
"""


def call(*arguments):
    done = CliRunner().invoke(app, list(map(str, arguments)))
    return done.exit_code, " ".join(done.output.split())


@pytest.fixture
def path(tmp_path):
    (tmp_path / "line.toml").write_text(TOML)
    return tmp_path / "line.toml"


class TestTables:
    def given(self, tmp_path, text):
        head, _, _ = TOML.partition("[[spans]]")
        head = head.replace("stagger = 0.2", 'supports = "supports.csv"').replace(
            "vertical = 300.0", "length = 1.2"
        )
        (tmp_path / "line.toml").write_text(head)
        (tmp_path / "supports.csv").write_text(text)
        return tmp_path / "line.toml"

    @pytest.mark.parametrize("separator", [";", "\t"])
    def test_of_spreadsheets(self, tmp_path, separator):
        """Columns parted by semicolons or tabs, with decimal commas: the same line."""
        wanted = read_line(self.given(tmp_path, TABLE))
        rows = [line.split(",") for line in TABLE.splitlines()]
        rows = [[f'"{cell}"' if ";" in cell else cell for cell in row] for row in rows]
        text = "\r\n".join(separator.join(row) for row in rows).replace(".", ",") + "\r\n"
        assert "60,5" in text
        found = read_line(self.given(tmp_path, "\ufeff" + text))
        assert found.spans == wanted.spans
        assert found.stagger == wanted.stagger == (0.2, -0.2, 0.2)
        assert found.spans[1].droppers == (4.0, 12.5, 26.0)

    def test_decimal_commas_between_commas(self, tmp_path):
        with pytest.raises(ModelError, match=r"row 3: has 5 cells, the head has 4") as caught:
            read_line(self.given(tmp_path, TABLE.replace("60.5", "60,5")))
        assert caught.value.hint == "decimal commas need semicolons or tabs between columns"


class TestNames:
    def test_form_and_elasticity_take_them(self, path):
        wanted = form(read_line(path), COARSE)
        for given in (path, str(path)):
            assert form(given, COARSE).dropper_natural == pytest.approx(wanted.dropper_natural, rel=1e-12)
        lifts = [
            elasticity(line, [50.0], points=2, mesh=COARSE).lift for line in (str(path), read_line(path))
        ]
        assert lifts[0] == pytest.approx(lifts[1])
        assert form("paper-7.5", Mesh(contact=5.0, messenger=10.0)).line.title

    @pytest.mark.parametrize("ask", [form, elasticity])
    def test_wrong(self, ask):
        with pytest.raises(ModelError, match="no line of the catalogue and no file"):
            ask("en50318-2003")
        with pytest.raises(
            ModelError, match=r"catenary\.line: must be a Line, a Route, a name or a path, is 3"
        ):
            ask(3)


class TestOtherCommands:
    def test_a_line_is_no_model(self, path):
        code, said = call("run", path)
        assert code == 2
        assert "is the file of an overhead line, not a model file" in said
        assert "ancf catenary run" in said

    def test_view(self, path, tmp_path):
        code, said = call("view", path, "-o", tmp_path / "line.html")
        assert code == 0, said
        assert "plotly" in (tmp_path / "line.html").read_text()
        (tmp_path / "model.toml").write_text('title = "model"\n')
        code, said = call("view", tmp_path / "model.toml")
        assert code == 2
        assert "is a model file, which has no results yet" in said


class TestMessages:
    """Numbers by what they mean: no names of types, and a hint where the unit is another one."""

    @pytest.mark.parametrize(
        ("given", "said"),
        [
            ("spans[0].pre_sag=-0.03", "error: spans[0].pre_sag: must be >= 0, is -0.03"),
            (
                "system_height=[1.4,1.4]",
                "system_height: has 2 values, the line has 6 supports give one, or one",
            ),
            ("system_height=-1", "error: system_height: must be > 0, is -1"),
            ("system_height=1400", "is 1400 m, at most 100 m either way units are m: 1.4"),
            ("conditions.wear=20", "must be between 0 and 0.6, is 20 a share of the section: 0.2 for 20 %"),
        ],
    )
    def test_of_values(self, path, given, said):
        code, told = call("check", path, "--set", given)
        assert code == 2
        assert said in told
        assert "float" not in told

    def test_decimal_comma(self, path):
        text = path.read_text()
        assert "length = 30.0" in text
        path.write_text(text.replace("length = 30.0", "length = 54,0"))
        code, told = call("check", path)
        assert code == 2
        assert "TOML syntax" in told
        assert "a point for decimals: 54.0" in told


def test_who_and_what_for(path, tmp_path, undrawn):
    """[report] stands at the beginning of the report of a run."""
    path.write_text(path.read_text() + '\n[report]\nproject = "Branch <3>"\nauthor = "A. Example"\n')
    line = read_line(path)
    assert line.report == {"project": "Branch <3>", "author": "A. Example"}
    done = run(
        line, speed=40.0, pantograph=collector(), step=STEP, mesh=COARSE, window=(90.0, 95.0), until=96.0
    )
    text = write_report(done, tmp_path / "report.html").read_text()
    assert "Project: Branch &lt;3&gt;. Author: A. Example." in text


def test_settings_of_studies(path):
    """[run] of a study takes what the command takes: the numbers of such a run."""
    settings = {"speed": 144.0, "mesh": [2.5, 5.0], "window": [90.0, 95.0], "until": 96.0, "reduce": True}
    settings |= {"step": STEP, "contact_stiffness": 6e4, "pantograph": "en50318-2002"}
    case = LineCase(read_toml(path, "line file"), (("sigma", "sigma"),), settings, source=str(path))
    given = {"window": (90.0, 95.0), "until": 96.0, "reduce": True, "step": STEP, "contact_stiffness": 6e4}
    done = run(path, speed=40.0, pantograph="en50318-2002", mesh=Mesh(contact=2.5, messenger=5.0), **given)
    assert case()["sigma"] == pytest.approx(statistics(done)["deviation"].value, rel=1e-9)


class TestPicture:
    def test_draws_the_wires(self):
        found = form(short_line(), COARSE)
        side, sag, plan = found.plot().axes
        x, z = side.lines[0].get_data()
        assert z == pytest.approx(found.contact.position[:, 2])
        assert x == pytest.approx(found.contact.position[:, 0])
        depth = sag.lines[0].get_ydata()
        assert depth == pytest.approx(1e3 * found.contact.position[:, 2])
        assert np.max(plan.lines[0].get_ydata()) == pytest.approx(250.0)

    def test_command(self, path, tmp_path):
        code, said = call("catenary", "form", path, "-o", tmp_path / "out")
        assert code == 0
        assert (tmp_path / "out" / "form.png").read_bytes().startswith(b"\x89PNG")
        assert "form.png" in said


def test_broken_droppers_are_none():
    overhead = ancf.catenary.assemble(form(short_line(), COARSE))
    overhead.break_dropper(2, 1)
    assert overhead.droppers[5] is None
    assert "None" in ancf.catenary.Overhead.break_dropper.__doc__
