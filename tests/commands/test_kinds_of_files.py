"""Files of every kind are told by their keys: checked, described, and refused by commands for other kinds."""

import tomllib

import pytest

from ancf.catenary.answers.measuring_file import MeasuringEntry
from ancf.catenary.lines.entries import LineEntry, PantographEntry
from ancf.design.calibration_file import CalibrationEntry
from ancf.design.file import StudyEntry
from ancf.design.optimisation_file import OptimisationEntry
from ancf.model.file import kinds, read_toml
from ancf.model.file.entries import FileEntry
from ancf.model.file.kinds import READ_BY, kind_of
from commands import MODEL
from overhead_lines import TOML
from places import EXAMPLES

PANTOGRAPH = """
masses = [5.8, 9.0, 7.0]
stiffness = [100.0, 10000.0, 6000.0]
damping = [70.0, 70.0, 70.0]
static_force = 60.0
aerodynamic = 0.01
"""
HEAD = "corrected_mass = 5.0\nacceleration_band = 50.0\nforce_noise = 2.0\nrate = 500.0\n"
STUDY = """
line = "line.toml"
[[parameters]]
path = "contact_wire.tension"
values = [20e3, 21e3]
[sampling]
method = "grid"
[[outputs]]
name = "longest"
formula = "max(dropper_length)"
"""
FILES = {
    "model": MODEL,
    "line": TOML,
    "pantograph": PANTOGRAPH,
    "measuring pantograph": HEAD,
    "study": STUDY,
}
ENTRIES = {
    "model": FileEntry,
    "line": LineEntry,
    "pantograph": PantographEntry,
    "measuring pantograph": MeasuringEntry,
    "study": StudyEntry,
    "calibration": CalibrationEntry,
    "optimisation": OptimisationEntry,
}
#: What ``ancf check`` says of those that it does not compute.
SAID = {
    "pantograph": "3 masses, 21.8 kg, 60 N at standstill, 90.86 N at 200 km/h",  # 60 + 0.01 (200/3.6)^2
    "measuring pantograph": "samples 500 in a second, corrected for the inertia of 5 kg",
    "study": "2 cases, 1 parameter, 1 output",
}


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for kind, text in FILES.items():
        (tmp_path / f"{kind.split()[0]}.toml").write_text(text)
    return {kind: f"{kind.split()[0]}.toml" for kind in FILES}


class TestKinds:
    @pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
    def test_of_examples(self, path):
        kinds_by_name = {
            "calibrate": "calibration",
            "droppers": "optimisation",
            "droppers_13": "optimisation",
            "study": "study",
            "tolerances": "study",
            "line": "line",
            "tension_length": "line",
            "droppers_line": "line",
            "droppers_13_line": "line",
        }
        assert kind_of(read_toml(path, "file")) == kinds_by_name.get(path.stem, "model")

    @pytest.mark.parametrize("kind", ENTRIES)
    def test_keys_that_tell_are_of_one_kind(self, kind):
        """Or every key of another kind would be misread with them."""
        own = {
            "model": kinds.OF_A_MODEL,
            "line": kinds.OF_A_LINE,
            "pantograph": kinds.OF_A_PANTOGRAPH,
            "measuring pantograph": kinds.OF_A_HEAD,
            "study": kinds.OF_A_STUDY,
            "calibration": kinds.OF_A_CALIBRATION,
            "optimisation": kinds.OF_AN_OPTIMISATION,
        }
        assert own.get(kind, set()) <= set(ENTRIES[kind].model_fields)
        for other, keys in own.items():
            if other != kind:
                assert not keys & set(ENTRIES[kind].model_fields), other

    @pytest.mark.parametrize(
        ("text", "kind"),
        [
            ('[[bodies]]\nname = "rope"\n[[sections]]\nEA = 1.0\n', "model"),  # of one bracket too much
            ('[[bodies]]\nname = "rope"\n[[parameters]]\nd = 1.0\n', "model"),
            ("mass = 5.0\n", "measuring pantograph"),
            ("delay = 0.002\nseed = 3\n", "measuring pantograph"),
            ('line = "x.toml"\n[run]\n[[parameters]]\nname = "a"\ndroppers = ["1-1"]\n', "optimisation"),
            ('model = "x.toml"\n[[parameters]]\npath = "gravity[2]"\nlow = 1.0\nhigh = 2.0\n', "calibration"),
            ('[[parameters]]\npath = "gravity[2]"\ngrid = {low = 1.0, high = 2.0, count = 3}\n', "study"),
        ],
    )
    def test_without_the_keys_that_may_be_left_out(self, text, kind):
        assert kind_of(tomllib.loads(text)) == kind

    @pytest.mark.parametrize("kind", FILES)
    def test_one_wrong_key_does_not_hide_it(self, kind, files, call):
        text = FILES[kind] + ("\n[bodis]\n" if "[" in FILES[kind] else "\nrtae = 3.0\n")
        with open(files[kind], "w", encoding="utf-8") as file:
            file.write(text)
        ran = call("check", files[kind])
        assert ran.code == 2
        assert ran.said.count("unknown key") == 1, ran.said


class TestCommands:
    @pytest.mark.parametrize("kind", SAID)
    @pytest.mark.parametrize("command", ["check", "info"])
    def test_says_what_is_in_it(self, kind, command, files, call):
        ran = call(command, files[kind])
        assert ran.code == 0, ran.said
        said = " ".join(ran.out.split())
        assert SAID[kind] in said
        assert READ_BY[kind][1].replace("FILE", files[kind]) in said

    def test_values_in_place_of_others(self, files, call):
        ran = call("check", files["pantograph"], "--set", "static_force=70")
        assert ran.code == 2
        assert "--set: changes model files and line files" in ran.said

    @pytest.mark.parametrize("kind", FILES)
    @pytest.mark.parametrize(
        ("wanted", "command"),
        [
            ("model", ("run",)),
            ("line", ("catenary", "run", "--speed", "100")),
            ("line", ("catenary", "form")),
            ("pantograph", ("catenary", "run", "line.toml", "--speed", "100", "--pantograph")),
            ("measuring pantograph", ("catenary", "run", "line.toml", "--speed", "100", "--measure")),
            ("study", ("study",)),
            ("calibration", ("calibrate",)),
            ("optimisation", ("optimise",)),
        ],
    )
    def test_refuses_other_kinds(self, wanted, command, kind, files, call):
        if kind == wanted:
            return
        ran = call(*command, files[kind])
        assert ran.code == 2
        name, reads = READ_BY[kind]
        assert f"{files[kind]}: is {name}, not {READ_BY[wanted][0]}" in ran.said
        assert reads.split(" LINE")[0].split(" FILE")[0] in ran.said


@pytest.mark.parametrize("name", ["data.csv", "DATA.TXT", "data.json"])
@pytest.mark.parametrize("command", ["check", "run", "study"])
def test_a_table_where_a_file_of_toml_is_wanted(call, tmp_path, monkeypatch, name, command):
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_text("t,x\n0,1.5\n1,2.5\n", encoding="utf-8")
    ran = call(command, name)
    assert ran.code == 2
    assert "TOML syntax" in ran.said
    assert "files of TOML are read here" in ran.said
