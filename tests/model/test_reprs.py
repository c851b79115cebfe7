"""What print and notebooks show of models, sections, results, states and modes."""

import html.parser
import re

import numpy as np
import pytest

import ancf
from ancf.model.tables import Sheet, Table, counted, numbers


@pytest.fixture(scope="module")
def model():
    """One of everything that has a row of its own, and 30 droppers."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="Demo <1>")
    solid = ancf.Section.rectangle(0.02, 0.01, E=1e8, rho=500, nu=0.3)
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=solid, element="nonlocking"
    )
    thin = ancf.Section(EA=1e5, EI=1.0, rhoA=0.3)
    wire = model.add_beam("wire", start=(2, 0, 0), end=(40, 0, 0), elements=8, section=thin)
    tip = model.add_point_mass("tip", at=(1, 0, 0), mass=2.0)
    hub = model.add_rigid_body("hub", at=(5, 1, 1), mass=3.0, inertia=(1, 1, 1))
    model.connect(tip, beam.end)
    model.hinge(hub, (5, 1, 1), axis=(0, 1, 0))
    model.clamp(beam.start, rotation="sin(t)", axis=(0, 1, 0))
    model.pin(wire.start)
    model.hold(wire.end, position="xz")
    model.add_force(wire.at(3), (0, 0, "sin(3*t)"))
    model.add_distributed_load(wire, (0, 0, -1), between=(1, 3))
    model.add_moment(hub, lambda t: (0, t, 0))
    for k in range(30):
        model.add_spring(wire.at(1 + k), (3 + k, 0, 1.2), stiffness=1e4, slack=True, name=f"dropper {k + 1}")
    return model


@pytest.fixture(scope="module")
def result():
    model = ancf.Model(gravity=(0, 0, -9.81), title="Cantilever")
    section = ancf.Section(EA=1e4, EI=1.0, rhoA=0.5)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.clamp(beam.start)
    return ancf.simulate(model, t_end=0.02, step=1e-3, sensors=[beam.end])


class Cells(html.parser.HTMLParser):
    """Texts of the cells of a table, and whether every element is closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.cells = [], []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attrs):
        if tag != "br":
            self.open.append(tag)
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] in ("td", "th"):
            self.cells[-1] += data


class TestTable:
    def test_numbers_stand_under_each_other(self):
        text = Table(("name", "value [m]"), [("a", "1.5"), ("long name", "-20")]).text()
        assert text.splitlines() == [
            "name       value [m]",
            "---------  ---------",
            "a                1.5",
            "long name        -20",
        ]

    def test_empty_columns_are_left_out(self):
        table = Table(("a", "b", "c"), [("1", "", "x")])
        assert "b" not in table.text()
        assert Cells(table.html()).cells == ["a", "c", "1", "x"]

    @pytest.mark.parametrize("count", [12, 13, 500])
    def test_long_tables_are_shortened(self, count):
        table = Table(("k",), [(str(k),) for k in range(count)])
        lines = table.text().splitlines()[2:]
        if count == 12:
            assert lines == [f"{k:>2}" for k in range(12)]
        else:
            assert len(lines) == 11
            assert f"... {count - 10} more ..." in table.text()
            assert lines[-1].strip() == str(count - 1)
            assert f"... {count - 10} more ..." in table.html()

    def test_sheet(self):
        sheet = Sheet("Title", [("fact", "1 m"), ("none", "")], [Table(("x",), [])])
        assert sheet.text() == "Title\n  fact  1 m"
        assert "none" not in sheet.html()

    def test_small_helpers(self):
        assert counted(["spring", "point mass", "spring", "point mass"]) == "2 springs, 2 point masses"
        assert numbers([1.0, -1e-17, 2.5]) == "(1, 0, 2.5)"


class TestModel:
    def test_repr_is_one_line(self, model):
        assert repr(model) == "Model('Demo <1>', 4 bodies, 3 supports, 3 loads, 32 connections)"

    def test_print(self, model):
        text = str(model)
        assert text.startswith('Model "Demo <1>"\n')
        assert re.search(r"gravity +\(0, 0, -9.81\) m/s\^2", text)
        assert "1 beam, 1 cable, 1 point mass, 1 rigid body; 11 elements, 16.5 kg" in text
        assert "1 spherical joint, 1 hinge, 30 springs" in text

    def test_bodies(self, model):
        rows = {line.split()[0]: line for line in str(model).splitlines() if line.strip()}
        assert re.search(r"beam +nonlocking beam +3 +1 +0\.1 +20000 +0\.166667, 0\.666667", rows["beam"])
        assert re.search(r"wire +cable +8 +38 +11\.4 +100000 +1 +\(2, 0, 0\) +\(40, 0, 0\)", rows["wire"])
        assert re.search(r"tip +point mass +2 +\(1, 0, 0\)$", rows["tip"])

    def test_supports_and_loads(self, model):
        text = str(model)
        assert "turns by sin(t) [rad] about (0, 1, 0)" in text
        assert re.search(r"hold at wire.end +wire.end +position x, z", text)
        assert re.search(r"force at wire.at\(3\) +wire.at\(3\) +\(0, 0, sin\(3\*t\)\) \[N\]", text)
        assert re.search(r"load on wire +wire, 1 to 3 m +\(0, 0, -1\) N/m", text)
        assert "<function <lambda>> [N m]" in text

    def test_many_droppers_are_shortened(self, model):
        text = str(model)
        assert "dropper 1 " in text
        assert "dropper 30 " in text
        assert "dropper 15" not in text
        assert "... 22 more ..." in text
        assert "k = 10000 N/m, length = 1.2 m, slack" in text
        assert max(map(len, text.splitlines())) < 150

    def test_html(self, model):
        page = model._repr_html_()
        cells = Cells(page).cells
        assert "Demo &lt;1&gt;" in page
        assert "<1>" not in page
        assert {"nonlocking beam", "length [m]", "dropper 1"} <= set(cells)

    def test_empty(self):
        assert str(ancf.Model()) == "Model\n  gravity  (0, 0, 0) m/s^2"
        assert Cells(ancf.Model()._repr_html_()).cells == []


class TestSection:
    def test_of_a_material(self):
        text = str(ancf.Section.rectangle(0.02, 0.01, E=1e8, rho=500, nu=0.3, damping=0.1))
        assert "rectangle, 0.02 x 0.01 m" in text
        assert "E = 1e+08 N/m^2, nu = 0.3, rho = 500 kg/m^3" in text
        assert "EA = 20000 N, EI_y = 0.166667 N m^2, EI_z = 0.666667 N m^2" in text
        assert "damping = 0.1 N s/m^2" in text

    def test_of_stiffnesses(self):
        text = str(ancf.Section(EA=5.0, EI=2.0, rhoA=0.25))
        assert text == "Section\n  stiffness  EA = 5 N, EI = 2 N m^2\n  mass       rhoA = 0.25 kg/m"

    def test_repr_is_one_line(self):
        assert "\n" not in repr(ancf.Section.circle(0.1, E=1e9, rho=1e3))


class TestResult:
    def test_print(self, result):
        text = str(result)
        assert text.startswith('Result "Cantilever"\n  status   complete\n')
        assert "21 states, t = 0 to 0.02 s" in text
        assert "20 of 0.001 s, trapezoidal" in text
        assert f"{result.stats.newton_iterations} Newton iterations" in text
        assert re.search(r"sensors +beam.end", text)
        assert re.search(r"beam +cable +2 +1 +0\.5", text)

    def test_drift_is_that_of_the_energies(self, result):
        balance = result.energy.balance - result.energy.balance[0]
        found = re.search(r"drift of the balance at most (\S+) \(end (\S+)\) J", str(result))
        wanted = [np.max(np.abs(balance)), balance[-1]]
        assert [float(x) for x in found.groups()] == pytest.approx(wanted, rel=0.05, abs=1e-18)

    def test_loaded_says_the_same(self, result, tmp_path):
        result.save(tmp_path / "run.h5")
        assert str(ancf.load(tmp_path / "run.h5")) == str(result)

    def test_repr_is_one_line(self, result):
        assert repr(result) == "Result('Cantilever', 21 states, t = 0 to 0.02 s, complete)"
        assert {"beam", "cable"} <= set(Cells(result._repr_html_()).cells)

    def test_a_failed_one_says_how_far(self):
        model = ancf.Model()
        mass = model.add_point_mass("ball", at=(0, 0, 0), mass=1.0)

        def force(t):
            if t > 0.05:
                raise RuntimeError("no more")
            return 0.0, 0.0, 1.0

        model.add_force(mass, force)
        with pytest.raises(ancf.ModelError) as caught:
            ancf.simulate(model, t_end=0.1, step=0.01, energy=False)
        text = str(caught.value.result)
        assert re.search(r"status +failed at t = 0.0\d s of 0.1 s", text)
        assert "energy" not in text


class TestState:
    def test_print(self, result):
        state = result.state()
        text = str(state)
        x, _, z = state.position("beam.end")
        assert text.startswith('State "Cantilever"\n  time    0.02 s')
        assert re.search(rf"beam.end +{x:.6g} +0 +{z:.6g} ", text)
        assert f"kinetic {state.energy.kinetic:.6g} J" in text
        assert repr(state) == "State(t = 0.02 s, 1 cable; 2 elements, 0.5 kg)"
        assert "beam.end" in Cells(state._repr_html_()).cells


class TestModes:
    def test_print(self, result):
        modes = ancf.modes(result.model, about=ancf.equilibrium(result.model), count=3)
        rows = [line.split() for line in str(modes).splitlines()[-3:]]
        assert [row[0] for row in rows] == ["1", "2", "3"]
        printed = np.array([[float(x) for x in row[1:]] for row in rows])
        expected = np.column_stack([modes.frequencies_hz, modes.frequencies, 1 / modes.frequencies_hz])
        assert printed == pytest.approx(expected, rel=1e-5)
        assert repr(modes).startswith("Modes(3 modes, ")
        assert "frequency [Hz]" in Cells(modes._repr_html_()).cells
