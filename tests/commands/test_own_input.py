"""No command writes over the file that it reads."""

from pathlib import Path

import pytest

from overhead_lines import TOML

RESPONSE = "frequency,real,imag\n1,1.0,2.0\n2,3.0,4.0\n3,5.0,6.0\n"
MOORED = """--------------------- LINE TYPES ----------------------
TypeName   Diam    Mass/m     EA      BA/-zeta   EI    Cd    Ca    CdAx   CaAx
(name)     (m)     (kg/m)     (N)     (N-s/-)  (N-m^2) (-)   (-)   (-)    (-)
chain 0.1 50.0 2.0e8 0 0.0 1.6 1.0 0.1 0.0
---------------------- POINTS -------------------------
ID   Attachment   X      Y     Z      Mass  Volume  CdA   Ca
(#)  (-)         (m)    (m)   (m)     (kg)  (m^3)   (m^2) (-)
1 Fixed 290.0 0.0 -100.0 0 0 0 0
2 Fixed 0 0 0 0 0 0 0
---------------------- LINES --------------------------
ID   LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
(#)   (name)     (#)      (#)      (m)       (-)      (-)
1 chain 1 2 320.0 20 -
---------------------- OPTIONS ------------------------
9.80665 g
------------------------- need this line -------------------
"""


@pytest.mark.parametrize(
    ("name", "text", "command"),
    [
        ("lines.txt", MOORED, ("import-moordyn", "lines.txt")),
        ("response.csv", RESPONSE, ("catenary", "identify", "response.csv")),
    ],
)
@pytest.mark.parametrize("way", ["", "./", "folder/../"])
def test_the_input_stays(call, name, text, command, way):
    Path("folder").mkdir()
    Path(name).write_text(text, encoding="utf-8")
    ran = call(*command, "-o", way + name)
    assert ran.code == 2
    assert "is the file that is read" in ran.said
    assert Path(name).read_text(encoding="utf-8") == text


#: A line whose droppers are as long as a table says, and a cable that a measured history pulls.
LINE = 'dropper_lengths = "{name}"\n' + TOML
PULLED = """
[[bodies]]
name = "cable"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 2
section = {{ EA = 1e4, EI = 1.0, rhoA = 0.1 }}

[[supports]]
type = "clamp"
point = "cable.start"

[[loads]]
type = "force"
point = "cable.end"
force = [0, 0, {{ csv = "{name}", column = "pull" }}]

[simulation]
t_end = 0.01
step = 0.001
sensors = ["cable.end"]
"""


@pytest.mark.parametrize(
    ("text", "name", "command"),
    [
        (LINE, "schedule.csv", ("catenary", "form")),
        (LINE, "elasticity.csv", ("catenary", "elasticity")),
        (LINE, "force_1.csv", ("catenary", "run", "--speed", "200")),
        (PULLED, "sensors.csv", ("run",)),
    ],
)
def test_a_file_that_the_input_names_stays(call, text, name, command):
    """Found before anything is computed."""
    lengths = "".join(f"{span},{dropper},1000\n" for span in range(1, 6) for dropper in range(1, 5))
    table = "t,pull\n0,0\n1,2\n" if text is PULLED else "span,dropper,natural_length_mm\n" + lengths
    Path("given.toml").write_text(text.format(name=name), encoding="utf-8")
    Path(name).write_text(table, encoding="utf-8")
    ran = call(*command, "given.toml", "-o", ".")
    assert ran.code == 2
    assert f"{name}: is the file that is read" in ran.said
    assert Path(name).read_text(encoding="utf-8") == table


def test_another_folder_takes_what_is_named_as_an_input(call):
    Path("given.toml").write_text(PULLED.format(name="sensors.csv"), encoding="utf-8")
    Path("sensors.csv").write_text("t,pull\n0,0\n1,2\n", encoding="utf-8")
    for _ in range(2):
        assert call("run", "given.toml", "-o", "out").code == 0
    assert Path("out/sensors.csv").is_file()


STUDIED = """
model = "model.toml"
[[parameters]]
path = "bodies.cable.section.EI"
values = [1.0, 2.0]
[sampling]
method = "grid"
[[outputs]]
name = "tip"
formula = "last(position(cable.end)[2])"
"""


@pytest.mark.parametrize("name", ["table.csv", "table.parquet.csv", "pull.csv"])
def test_a_table_of_the_model_of_a_study_stays(call, name):
    """What the model reads is read by the command, though the study looks at it for itself."""
    Path("model.toml").write_text(PULLED.format(name=name), encoding="utf-8")
    Path("study.toml").write_text(STUDIED, encoding="utf-8")
    table = "t,pull\n0,0\n1,2\n"
    Path(name).write_text(table, encoding="utf-8")
    ran = call("study", "study.toml", "-o", ".")
    assert ran.code == (2 if name == "table.csv" else 0), ran.said
    assert (f"{name}: is the file that is read" in ran.said) == (name == "table.csv")
    assert Path(name).read_text(encoding="utf-8") == table
