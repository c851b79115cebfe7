"""Exhibits that cost nothing: one that passes, one that fails, one without checks, two with errors."""

import json
import math
from dataclasses import dataclass, replace

from ancf.errors import SolveError
from ancf.paper import FIGURES
from ancf.paper.check import Check
from ancf.paper.table import Table

GOOD = Check("tip: z", -0.72764, -0.72760, 1e-4, "m", "an independent code")
BAD = Check("tip: <x> & y", 0.5, 0.4, 1e-3, "m", 'a "closed form" <script>alert(1)</script>')
LOST = replace(GOOD, name="tip: lost", value=math.nan)


@dataclass
class Fake:
    """An exhibit that costs nothing."""

    name: str
    judged: tuple[Check, ...] = (GOOD,)
    error: BaseException | None = None
    SIZE = (60.0, 40.0)
    EXAMPLE = "7.1"

    @property
    def TITLE(self):
        return f"Title of {self.name} <b>"

    @property
    def CLAIM(self):
        return f"What is said of {self.name} & shown."

    def data(self, short=False):
        if self.error is not None:
            raise self.error
        notes = ["Assumed: a & b.", "Measured: 1 m.", "Very long: " + "words and " * 40 + "the end."]
        return Table(self.name, ("x", "y"), [(0.0, 1.0), (1.0, 3.0)], notes)

    def draw(self, table, figure):
        figure.subplots().plot(table.values("x"), table.values("y"))

    def checks(self, table):
        return list(self.judged)


FAKES = (
    Fake("figgood"),
    Fake("figbad", (GOOD, BAD, LOST)),
    Fake("fignone", ()),
    Fake("figsolve", error=SolveError("t = 0.1 s", "no convergence <here>", "smaller steps")),
    Fake("figfault", error=RuntimeError("wheel off")),
    Fake("figlast"),
)


def install(monkeypatch):
    """Leave the fakes alone in the registry."""
    for name in list(FIGURES):
        monkeypatch.delitem(FIGURES, name)
    for fake in FAKES:
        monkeypatch.setitem(FIGURES, fake.name, fake)


def load(path):
    """JSON without NaN or infinity."""

    def refuse(text):
        raise AssertionError(f"{text} in {path}")

    return json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse)
