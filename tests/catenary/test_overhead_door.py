"""The model of a line, open to change: masses, springs, broken droppers, pantographs of one's own."""

from functools import cache

import numpy as np
import pytest
from typer.testing import CliRunner

import ancf
from ancf import ModelError, catenary
from ancf.catenary import Mesh, assemble, form, run
from ancf.cli.app import app
from overhead_lines import COARSE, STEP, collector, short_line

GIVEN = {"speed": 40.0, "pantograph": collector(), "step": STEP}


@cache
def found():
    return form(short_line(), COARSE)


@cache
def plain():
    return run(found(), **GIVEN)


def same(one, other):
    for key in ("force", "height", "stagger"):
        assert np.array_equal(getattr(one.recordings[0], key), getattr(other.recordings[0], key))
    assert np.array_equal(one.dropper_force, other.dropper_force)


class TestRun:
    def test_of_an_unchanged_model_is_that_of_its_form(self):
        overhead = assemble(found())
        done = overhead.run(**GIVEN)
        same(done, plain())
        assert done.uplift == pytest.approx(plain().uplift, abs=1e-7)
        same(overhead.run(**GIVEN), done)  # the model is as it was
        assert not overhead.model.bodies.keys() & {"pantograph roof"}

    def test_modify_does_what_changing_the_model_does(self):
        def heavier(overhead):
            overhead.add_mass("insulator", overhead.supports[2], 8.0)

        overhead = assemble(found())
        heavier(overhead)
        same(run(found(), modify=heavier, **GIVEN), overhead.run(**GIVEN))

    def test_trial_run_for_a_mean_height_is_changed_too(self):
        seen = []
        unit = collector(relaxed_at="mean")
        run(
            found(), modify=lambda o: seen.append(o.form.mesh.contact), speed=40.0, pantograph=unit, step=STEP
        )
        assert set(seen) == {2.0}
        assert len(seen) >= 4

    @pytest.mark.parametrize("mass", [2.0, 9.0])
    def test_mass_weighs_on_the_droppers(self, mass):
        """All forces that hold the contact wire grow by the weight of what hangs on it."""
        overhead = assemble(found())
        before = ancf.equilibrium(overhead.model)
        overhead.add_mass("insulator", overhead.contact_at(80.0), mass)
        after = ancf.equilibrium(overhead.model)
        held = [*overhead.droppers, *(arm for arm in overhead.arms if arm is not None)]
        grown = sum(vertical(after, s) - vertical(before, s) for s in held)
        grown += ends(overhead, after) - ends(overhead, before)
        assert grown == pytest.approx(9.81 * mass, rel=2e-5)

    def test_broken_dropper(self):
        overhead = assemble(found())
        overhead.break_dropper(3, 3)
        assert overhead.dropper(3, 3) is None
        done = overhead.run(**GIVEN)
        j = 5 * 2 + 2
        assert not np.any(done.dropper_force[:, j])
        assert done.form.dropper_load[j] == 0.0
        assert done.form.dropper_load[j - 1] > plain().form.dropper_load[j - 1] + 10.0
        settled = found().contact.position[found().contact.nodes.dropper[j], 2]
        state = ancf.equilibrium(overhead.model)
        assert state.position(overhead.contact.point(found().contact.nodes.dropper[j]))[2] < settled - 5e-3
        assert np.all(np.abs(done.uplift[0]) < 0.05)  # measured from where it rests without the dropper

    def test_spring_and_load(self):
        """A spring to the ground and a constant force do the same at rest."""

        def tied(overhead):
            point = overhead.supports[3]
            overhead.model.add_spring(
                point, point.initial_position - [0, 0, 20.0], stiffness=2e3, length=19.9
            )

        overhead = assemble(found())
        tied(overhead)
        spring = overhead.model.connections[-1]
        pull = float(ancf.equilibrium(overhead.model).spring_force(spring))
        other = assemble(found())
        other.model.add_force(other.supports[3], (0.0, 0.0, -pull))
        states = ancf.equilibrium(overhead.model), ancf.equilibrium(other.model)
        heights = [s.position(o.supports[3])[2] for s, o in zip(states, (overhead, other), strict=True)]
        assert heights[0] == pytest.approx(heights[1], abs=1e-6)
        assert pull == pytest.approx(
            2e3 * (0.1 + heights[0] - found().contact.position[found().contact.nodes.support[3], 2]), rel=1e-6
        )


def vertical(state, spring):
    a = state.position(spring.a)
    b = state.position(spring.b) if isinstance(spring.b, ancf.model.Point) else np.asarray(spring.b)
    return float(state.spring_force(spring)) * (b - a)[2] / np.linalg.norm(b - a)


def ends(overhead, state):
    return sum(
        float(state.reaction(s)[2])
        for s in overhead.model.supports
        if s.point in (overhead.contact.start, overhead.contact.end)
    )


class TestPantograph:
    def test_of_ones_own_simulation_is_that_of_the_run(self):
        overhead = assemble(found())
        start = plain().recordings[0].position[0]
        one = overhead.add_pantograph(collector(), 40.0, start=start)
        result = ancf.simulate(
            overhead.model,
            t_end=1.0,
            step=STEP,
            start=ancf.equilibrium(overhead.model),
            integrator=ancf.GeneralizedAlpha(0.9, newton=ancf.Newton(tolerance=4e-8, corotate=False)),
            sensors=one.sensors(),
            energy=False,
        )
        force = result.sensors.contact_force(one.meter)
        assert force == pytest.approx(plain().recordings[0].force[: force.size], abs=1e-3)

    def test_file(self, tmp_path):
        path = tmp_path / "mine.toml"
        path.write_text(
            "masses = [15.0, 7.2]\nstiffness = [50.0, 4200.0]\ndamping = [90.0, 10.0]\nstatic_force = 120.0\n"
        )
        unit = catenary.read_pantograph(path)
        assert (unit.name, unit.masses, unit.static_force) == ("mine", (15.0, 7.2), 120.0)
        assert catenary.find_pantograph(str(path)) == unit

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("masses = [15.0]\nstiffness = [50.0]\ndamping = [1.0]\n", "static_force: is missing"),
            ("mases = [15.0]\n", 'did you mean "masses"'),
            (
                "masses = [15.0]\nstiffness = [50.0, 2.0]\ndamping = [1.0]\nstatic_force = 1.0\n",
                "2 values for 1 masses",
            ),
            (
                "masses = [15.0]\nstiffness = [50.0]\ndamping = [1.0]\nstatic_force = -1.0\n",
                "static_force: must be > 0",
            ),
        ],
    )
    def test_wrong_file(self, tmp_path, text, said):
        path = tmp_path / "mine.toml"
        path.write_text(text)
        with pytest.raises(ModelError, match=r"mine\.toml|static_force") as caught:
            catenary.find_pantograph(path)
        assert said in str(caught.value)

    def test_unknown(self):
        with pytest.raises(ModelError, match='did you mean "dsa380"'):
            catenary.find_pantograph("dsa38")

    @pytest.mark.parametrize("start", [-1.0, 500.0, float("nan")])
    def test_outside_the_line(self, start):
        with pytest.raises(ModelError, match=r"add_pantograph\.start"):
            assemble(found()).add_pantograph(collector(), 40.0, start=start)


class TestWrong:
    @pytest.mark.parametrize(("span", "number"), [(0, 1), (6, 1), (2, 6), (2, 0)])
    def test_no_such_dropper(self, span, number):
        with pytest.raises(ModelError, match=f"no dropper {number} in span {span}"):
            assemble(found()).break_dropper(span, number)

    def test_twice(self):
        overhead = assemble(found())
        overhead.break_dropper(1, 1)
        with pytest.raises(ModelError, match="broken already"):
            overhead.break_dropper(1, 1)

    @pytest.mark.parametrize("mass", [0.0, -1.0, float("nan")])
    def test_mass(self, mass):
        overhead = assemble(found())
        with pytest.raises(ModelError, match=r"insulator\.mass"):
            overhead.add_mass("insulator", overhead.supports[1], mass)

    def test_mesh_of_a_model(self):
        with pytest.raises(ModelError, match=r"run\.mesh"):
            assemble(found()).run(mesh=Mesh(), **GIVEN)


class TestWires:
    @pytest.mark.parametrize("name", ["CuAg AC-100", "CuMg AC-150", "BzII 70"])
    def test_numbers_fit_each_other(self, name):
        """Mass and stiffness are those of its area; the lay of a rope adds some percent."""
        data = catenary.wires()[name]
        modulus = 120e9 if "AC" in name else 113e9
        area = data.EA / modulus
        assert data.mass == pytest.approx(8900.0 * area, rel=0.03)
        assert pytest.approx(modulus * area**2 / (4 * np.pi)) == data.EI
        assert 0.25 * np.pi * data.diameter**2 >= 0.85 * area
        wire = catenary.wire(name, tension=12e3, EI=3.0)
        assert (wire.EA, wire.EI, wire.tension) == (data.EA, 3.0, 12e3)

    def test_unknown(self):
        with pytest.raises(ModelError, match='did you mean "CuAg AC-100"'):
            catenary.wire("CuAg AC100", tension=1e4)

    def test_in_a_file(self, tmp_path):
        text = catenary.line_file("en50318-2002").read_text(encoding="utf-8")
        own = "[contact_wire]\nEA = 15.0e6\nEI = 195.0\nmass = 1.35\n"
        assert own in text
        path = tmp_path / "own.toml"
        path.write_text(text.replace(own, '[contact_wire]\ntype = "CuAg AC-120"\nmass = 1.05\n'))
        wire = catenary.read_line(path).contact_wire
        assert (wire.EA, wire.mass, wire.diameter) == pytest.approx((14.4e6, 1.05, 13.2e-3))
        for given, said in (
            ("type = 3", "must be text"),
            ('type = "Cu 100"', "contact_wire.type"),
            ("", "contact_wire.EA: is missing"),
        ):
            path.write_text(text.replace(own, f"[contact_wire]\n{given}\n"))
            with pytest.raises(ModelError, match=said):
                catenary.read_line(path)

    @pytest.mark.parametrize(
        ("key", "value"), [("tension", "12.0"), ("tension", "12e6"), ("diameter", "12.0")]
    )
    def test_units(self, tmp_path, key, value):
        with pytest.raises(ModelError, match="units are"):
            catenary.read_line("en50318-2002", {f"contact_wire.{key}": float(value)})


class TestCommands:
    def test_list(self):
        done = CliRunner().invoke(app, ["catenary", "list"])
        assert done.exit_code == 0, done.output
        for name in (*catenary.line_names(), *catenary.pantographs(), "CuAg AC-100"):
            assert name in done.output

    def test_info(self, tmp_path):
        done = CliRunner().invoke(app, ["info", str(catenary.line_file("en50318-2018-ac-simple"))])
        assert done.exit_code == 0, done.output
        assert "10 spans, 90 droppers, 550 m, wave speed 460 km/h" in done.output
        path = tmp_path / "own.toml"
        path.write_text("spans = []\n")
        done = CliRunner().invoke(app, ["info", str(path)])
        assert done.exit_code == 2
        assert "contact_wire: is missing" in done.output

    def test_run_options(self, tmp_path):
        mine = tmp_path / "mine.toml"
        mine.write_text(
            "masses = [15.0, 7.2]\nstiffness = [50.0, 4200.0]\ndamping = [90.0, 10.0]\nstatic_force = 90.0\n"
        )
        options = [
            "--speed",
            "150",
            "--pantograph",
            str(mine),
            "--mesh",
            "2",
            "3",
            "--contact-stiffness",
            "20e3",
        ]
        options += [
            "--step",
            "0.002",
            "--until",
            "130",
            "--no-states",
            "--no-report",
            "--window",
            "96",
            "120",
        ]
        out = tmp_path / "out"
        line = tmp_path / "line.toml"
        text = catenary.line_file("en50318-2002").read_text(encoding="utf-8")
        line.write_text(text.replace("repeat = 10", "repeat = 3"))
        done = CliRunner().invoke(app, ["catenary", "run", str(line), "-o", str(out), *options])
        assert done.exit_code == 0, done.output
        said = (out / "run.json").read_text()
        assert '"contact stiffness [N/m]": 20000.0' in said
        assert '"elements of the contact wire": 108' in said
        position = (out / "force_1.csv").read_text().splitlines()[-1].split(",")[1]
        assert 130.0 <= float(position) < 130.2
