"""No command writes over the file that it reads."""

from pathlib import Path

import pytest

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
