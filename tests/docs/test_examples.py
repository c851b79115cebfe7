"""Every example runs, its file and its script describe one model, and every figure is written."""

import csv
import json
import runpy

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError
from ancf.model.file import read_study
from ancf.paper import FIGURES, cantilever, pendulum, reproduce, sliding, spin_up
from example_scripts import script
from places import EXAMPLES

WITH_MAIN = ("cantilever", "pendulum", "spin_up", "coupled_wires", "sliding_beam")
#: Scripts of tests/control/test_control_examples.py.
CONTROLLED = ("active_pantograph", "crane", "crane_env")
#: The script of tests/design/test_calibrate.py.
CALIBRATED = ("calibrate",)
#: Model files; two describe overhead lines, study.toml a study, calibrate.toml a calibration.
OTHERS = {"line.toml", "tension_length.toml", "study.toml", "calibrate.toml"}
FILES = sorted({path.name for path in EXAMPLES.glob("*.toml")} - OTHERS)

JACOBIANS = ["element", "f", "E", "jacobians", "newton_iterations", "steps", "status", "t_reached"]
MESH = ["element", "carrier", "slider"]
COUNTERS = ["steps", "newton_iterations", "jacobians"]
NUMBER = ["name", "element", "value", "reference"]
COLUMNS = {
    "fig1": ["element", "mode", "vector", "component", "meaning", "change", *"xyzXYZ"],
    "fig2": ["element", "elements", "tip_x", "tip_z"],
    "fig3": JACOBIANS,
    "fig4": ["element", "elements", "t", "tip_x", "tip_y", "tip_z", "mid_x", "mid_y", "mid_z"],
    "fig5": ["element", "elements", "t", "tip_x", "tip_y", "tip_z", "mid_x", "mid_y", "mid_z"],
    "fig6": JACOBIANS,
    "fig7": ["element", "elements", "u_transverse", "u_axial"],
    "fig8": ["element", "elements", "t", "u_transverse"],
    "fig9": [*MESH, "t", "body", "arc_length", "x", "y", "z"],
    "fig10": [*MESH, "t", "x", "y", "z", "s"],
    "fig11": [*MESH, "t", "x", "y", "z", "s"],
    "fig12": ["symbol", "meaning", "value", "unit", "tag"],
    "fig13": ["part", "number", "x", "y", "z"],
    "fig14": ["speed", "t", "position", "force_raw", "force_20hz", "penalty_20hz"],
    "table2": [*MESH, "t", *COUNTERS, "cpu_seconds", "paper_seconds", "tip_x", "tip_y", "tip_z"],
    "closed-forms": [*NUMBER, "deviation", "tolerance", "unit", "origin"],
    "orders": ["study", "over", "element", "order", "size", "error", "rate"],
    "en50318": ["case", "speed_kmh", "quantity", "unit", "value", "low", "high", "verdict", "tag"],
}
#: First columns of those figures that do not have all three kinds of elements.
KINDS = {
    "fig1": {"original", "nonlocking"},
    "fig3": {"cable", "nonlocking"},
    "fig9": {"cable"},
    "fig12": {"m_1", "m_2", "k_1", "k_2", "c_1", "c_2", "F_H", "b", "y_max"},
    "fig13": {"contact wire", "carrier", "dropper", "mast", "pantograph"},
    "fig14": {32.0},
    "en50318": {"en50318-2002"},
}


def described(model):
    """Plain description without the texts that may differ."""
    plain = model.to_dict()
    plain.pop("title")
    for body in plain["bodies"]:
        for key in ("shape", "width", "height", "diameter", "E", "nu", "rho"):
            body.get("section", {}).pop(key, None)
    return plain


def start_of(study):
    if study.simulation.start == "reference":
        return None
    return ancf.equilibrium(study.model, of=study.simulation.equilibrium_of)


class TestScripts:
    @pytest.mark.parametrize("name", WITH_MAIN)
    def test_runs(self, name, capsys):
        script(name).main(t_end=0.05)
        assert len(capsys.readouterr().out.splitlines()) >= 3

    def test_the_whole_face_runs(self, capsys):
        runpy.run_path(str(EXAMPLES / "model_face.py"))
        assert "rad/s" in capsys.readouterr().out

    @pytest.mark.filterwarnings("ignore:beam node")  # the pin stops the end that set_motion starts
    def test_everything_on_one_beam(self):
        section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0, nu=0.0)
        model = ancf.Model(gravity=(0.0, 0.0, -9.81))
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section)
        beam.set_motion(velocity=(0, 0, 0), angular_velocity=(0, 0, 4.0), about=(0, 0, 0))
        model.clamp(beam.start, stretch="free")
        model.clamp(beam.start, rotation=lambda t: t**3, axis=(0, 0, 1))
        model.pin(beam.end)
        model.add_force(beam.end, (0.0, 0.0, -1.0))
        model.add_moment(beam.end, (0.0, 0.5, 0.0))
        state = ancf.equilibrium(model)
        result = ancf.simulate(model, t_end=0.1, step=2.5e-4, start=state, integrator=ancf.Trapezoidal())
        assert result.t.shape == (401,)
        assert result.position(beam.end) == pytest.approx(np.tile([1.0, 0.0, 0.0], (401, 1)), abs=1e-12)
        for history in (result.velocity(beam.at(0.5)), result.tension(beam.at(0.5)), result.energy.total):
            assert np.all(np.isfinite(history))
        assert ancf.modes(model, about=state, count=10).frequencies.shape == (10,)

    def test_all_scripts_are_tested(self):
        tested = [*WITH_MAIN, "model_face", *CONTROLLED, *CALIBRATED]
        assert sorted(path.stem for path in EXAMPLES.glob("*.py")) == sorted(tested)


class TestFiles:
    @pytest.mark.parametrize("name", FILES)
    def test_runs(self, name):
        study = read_study(EXAMPLES / name)
        settings = study.simulation
        result = ancf.simulate(
            study.model,
            t_end=20 * settings.step,
            step=settings.step,
            start=start_of(study),
            integrator=settings.integrator,
        )
        assert result.status == "complete"
        assert settings.outputs
        for label in settings.outputs:
            assert np.all(np.isfinite(result.position(label)))

    @pytest.mark.parametrize("name", WITH_MAIN)
    def test_describes_the_model_of_the_script(self, name):
        from_file, from_script = (
            described(m) for m in (read_study(EXAMPLES / f"{name}.toml").model, script(name).build())
        )
        assert from_file == approximately(from_script)

    @pytest.mark.parametrize(
        ("name", "build"),
        [
            ("cantilever", lambda: cantilever.build(16)),
            ("pendulum", pendulum.build),
            ("spin_up", spin_up.build),
            ("sliding_beam", lambda: sliding.build(64, 4)),
        ],
    )
    def test_describes_the_model_of_the_paper(self, name, build):
        from_file, wanted = described(read_study(EXAMPLES / f"{name}.toml").model), described(build())
        assert from_file["bodies"] == approximately(wanted["bodies"])
        assert from_file["gravity"] == wanted["gravity"]


def approximately(value):
    """The same nested description with its numbers compared within 1e-7 relative."""
    if isinstance(value, dict):
        return {key: approximately(part) for key, part in value.items()}
    if isinstance(value, list):
        return [approximately(part) for part in value]
    return pytest.approx(value, rel=1e-7) if isinstance(value, float) else value


@pytest.fixture(scope="module")
def reproduced(tmp_path_factory):
    """Folder with all figures in their short form, and the calls of progress."""
    folder, calls = tmp_path_factory.mktemp("figures") / "new" / "folder", []
    reproduce(["all"], folder, short=True, progress=lambda *call: calls.append(call))
    return folder, calls


class TestReproduce:
    @pytest.mark.parametrize("name", COLUMNS)
    def test_writes_table_and_picture(self, reproduced, name):
        folder, _ = reproduced
        full = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
        assert list(full) == ["name", "columns", "rows", "notes", "checks"]
        assert full["name"] == name
        assert full["columns"] == COLUMNS[name]
        assert full["rows"]
        assert all(len(row) == len(full["columns"]) for row in full["rows"])
        kinds = {"cable", "original", "nonlocking"}
        if name not in ("closed-forms", "orders"):  # many names
            assert {row[0] for row in full["rows"]} == KINDS.get(name, kinds)
        assert len(full["notes"]) >= 4
        assert all(isinstance(note, str) for note in full["notes"])
        assert all(check["passed"] for check in full["checks"])
        with (folder / f"{name}.csv").open(newline="", encoding="utf-8") as file:
            head, *rows = csv.reader(file)
        assert head == full["columns"]
        texts = [["" if value is None else str(value) for value in row] for row in full["rows"]]
        assert texts == rows
        assert (folder / f"{name}.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"

    def test_reports_progress(self, reproduced):
        _, calls = reproduced
        count = len(FIGURES)
        assert [call[1:] for call in calls] == [(i, count) for i in range(count + 1)]
        assert [call[0] for call in calls[:-1]] == list(FIGURES)

    def test_every_figure_is_tested(self):
        assert set(COLUMNS) == set(FIGURES)

    def test_unknown_figure(self, tmp_path):
        with pytest.raises(ModelError, match=r'unknown figure "fig22".*did you mean "fig2"'):
            reproduce(["fig22"], tmp_path)

    def test_no_figure(self, tmp_path):
        with pytest.raises(ModelError, match="no figure named"):
            reproduce([], tmp_path)

    def test_folder_that_cannot_be_written(self, tmp_path):
        (tmp_path / "file").write_text("", encoding="utf-8")
        with pytest.raises(ModelError, match="cannot be written"):
            reproduce(["fig2"], tmp_path / "file" / "out", short=True)

    def test_without_matplotlib(self, tmp_path, monkeypatch):
        monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
        with pytest.raises(ModelError, match=r"ancf\[plot\]"):
            reproduce(["fig2"], tmp_path, short=True)
