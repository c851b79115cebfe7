"""Twin contact wires, two side by side: against strings by hand, one wire for both, and one of two alone."""

from dataclasses import replace
from typing import ClassVar

import numpy as np
import pytest

import ancf
from ancf import ModelError
from ancf.catenary import (
    Auxiliary,
    Conditions,
    DropperRule,
    Droppers,
    Line,
    Load,
    Mesh,
    Route,
    Span,
    SteadyArm,
    StitchWire,
    Wire,
    assemble,
    clamp_strains,
    elasticity,
    form,
    read_line,
    run,
    statistics,
    verify,
)
from helpers import some
from overhead_lines import COARSE, STAGGER, STEP, TOML, collector, droppers, short_line

G = 9.81
#: Each of two wires, the arm of each, and each of two droppers: halves of those of the short line.
HALF = {
    "contact_wire": Wire(EA=7.5e6, EI=97.5, mass=0.675, tension=10e3),
    "steady_arm": SteadyArm(vertical=150.0),
    "droppers": Droppers(stiffness=5e4),
}


def twin(apart=0.04, **changes):
    return short_line(**({"contact_spacing": apart} | HALF | changes))


class TestStrings:
    @pytest.mark.parametrize(("length", "apart"), [(30.0, 0.04), (45.0, 0.1)])
    def test_without_messenger(self, length, apart):
        """Each wire under T sags by w l^2/8T; a force on both lifts them by F l/(4 2T)."""
        wire = Wire(EA=12e6, EI=1.0, mass=0.95, tension=10e3)
        spans = [Span(length=length, droppers=())] * 2
        arm = SteadyArm(vertical=1e8)
        given = {"spans": spans, "contact_wire": wire, "steady_arm": arm, "anchors": "tension"}
        line, fine = Line(contact_spacing=apart, **given), Mesh(contact_support=0.05, contact=1.0)
        found = form(line, fine)
        for shape, force, y in zip(
            found.contacts, (found.arm_force, found.twin_arm_force), (0.5 * apart, -0.5 * apart), strict=True
        ):
            middle = np.argmin(np.abs(shape.position[:, 0] - 0.5 * length))
            depth = wire.mass * G * length**2 / 8.0 / 10e3
            assert -shape.position[middle, 2] == pytest.approx(depth, rel=5e-3)
            assert shape.position[:, 1] == pytest.approx(y, abs=1e-9)
            assert force[1, 2] == pytest.approx(wire.mass * G * length, rel=2e-3)
        give = elasticity(line, (80.0,), points=2, span=0, mesh=fine).lift[0, 1]
        assert give == pytest.approx(80.0 * length / 4.0 / 20e3, rel=0.015)

    @pytest.mark.parametrize("apart", [0.04, 0.12])
    def test_droppers_draw_them_together(self, apart):
        """Droppers pull each wire by force/length times its distance from the middle: discrete strings."""
        length, x = 48.0, np.arange(2.0, 48.0, 4.0)
        span = Span(length=length, droppers=tuple(x))
        wire = replace(HALF["contact_wire"], EI=1.0)
        line = twin(apart, spans=[span] * 3, stagger=0.0, anchors="tension", contact_wire=wire)
        found = form(line, Mesh(contact=2.0, messenger=3.0, contact_support=0.1, dropper=0.15))
        own = slice(24, 48, 2)
        lean = np.diag((found.dropper_force / found.dropper_length)[own])
        low, high = np.minimum.outer(x, x), np.maximum.outer(x, x)
        give = low * (length - high) / length / wire.tension
        ends = np.full(x.size, 0.5 * apart)
        wanted = np.linalg.solve(np.eye(x.size) + give @ lean, ends)
        y = [shape.position[shape.nodes.dropper, 1][own] for shape in found.contacts]
        assert wanted.min() < 0.9 * ends[0]
        assert y[0] == pytest.approx(wanted, rel=0.01)
        assert y[1] == pytest.approx(-wanted, rel=0.01)
        assert found.contact_height == pytest.approx(line.dropper_height, abs=1.1e-5)

    def test_each_carries_half(self):
        """Of one wire for both: loads of droppers and arms, elasticity, and the motion under a pantograph."""
        two, one = (form(line, COARSE) for line in (twin(), short_line()))
        pairs = two.dropper_force.reshape(-1, 2)
        assert pairs.sum(axis=1) == pytest.approx(one.dropper_force, rel=1e-3)
        assert pairs[:, 0] == pytest.approx(pairs[:, 1], rel=5e-3)
        assert two.arm_force + two.twin_arm_force == pytest.approx(one.arm_force, rel=5e-3, abs=0.5)
        gives = [elasticity(line, (100.0,), points=2, mesh=COARSE).value for line in (twin(), short_line())]
        assert gives[0] == pytest.approx(gives[1], rel=1e-3)
        runs = [run(found, speed=40.0, pantograph=collector(), step=STEP) for found in (two, one)]
        told = [statistics(made) for made in runs]
        assert told[0]["mean_force"].value == pytest.approx(told[1]["mean_force"].value, rel=2e-3)
        assert told[0]["deviation"].value == pytest.approx(told[1]["deviation"].value, rel=0.01)
        shares = np.array([runs[0].recordings[0].force_on(k).mean() for k in (0, 1)])
        assert shares == pytest.approx(0.5 * runs[1].recordings[0].force.mean(), rel=0.01)
        strains = [clamp_strains(made) for made in runs]
        assert [s.number for s in strains[0]] == [2 * s.number - odd for s in strains[1] for odd in (1, 0)]
        assert len(strains[0]) == 2 * len(strains[1])


class TestForms:
    @pytest.mark.parametrize(
        "changes",
        [
            {"contact_support": "free", "steady_arm": SteadyArm(length=1.1, mass=0.5), "anchors": "tension"},
            {"stitch": StitchWire(wire=Wire(EA=3e6, EI=10.0, mass=0.3, tension=3e3), reach=7.0)},
            {
                "auxiliary": Auxiliary(
                    wire=Wire(EA=6e6, EI=40.0, mass=0.9, tension=12e3),
                    height=0.3,
                    droppers=Droppers(EA=2e5, mass=0.1),
                    places=DropperRule(first=5.0, pitch_max=10.0),
                )
            },
            {
                "droppers": Droppers(EA=2e5, mass=0.1, clamp_contact=0.2, clamp_messenger=0.3),
                "loads": [Load(position=77.7, mass=6.0)],
            },
        ],
    )
    def test_the_model_rests_there(self, changes):
        """Form finding hangs one wire for both; heights and lengths are those of the two."""
        line = twin(**changes)
        checked = verify(assemble(form(line, COARSE)))
        assert checked.height < 1.1e-5
        assert checked.place < 1e-6
        assert checked.load < 1e-3

    def test_states(self):
        """Warm, windy, with measured droppers: what both wires have in common is that of one."""
        wires = {
            key: replace(getattr(twin(), key), diameter=0.012) for key in ("contact_wire", "messenger_wire")
        }
        line = twin(anchors="tension", **wires)
        hot = form(
            replace(line, conditions=Conditions(temperature=40.0, wind=15.0, contact_tension=9e3)), COARSE
        )
        assert hot.pull[[0, 3]] == pytest.approx(9e3)
        for shape in hot.contacts:
            stretch = 17e-6 * 30.0 - 1e3 / 7.5e6
            assert np.ptp(shape.position[[0, -1], 0]) - line.length == pytest.approx(
                stretch * line.length, rel=0.02
            )
        assert verify(assemble(hot)).place < 2e-6
        built = form(replace(line, dropper_lengths=form(line, COARSE).dropper_natural - 1e-3), COARSE)
        assert built.dropper_load.size == 50
        assert verify(assemble(built)).place < 2e-6

    def test_one_dropper_breaks(self):
        """The wire that it carried sinks, the other one is lifted by the messenger, which carries less."""
        found = form(twin(), COARSE)
        plain, broken = assemble(found), assemble(found)
        broken.break_dropper(3, 5)  # the third place, first wire
        sunk = [
            [float(ancf.equilibrium(o.model).position(point)[2]) for point in o.contacts_at(82.0)]
            for o in (plain, broken)
        ]
        down = np.subtract(*sunk)
        assert down[0] > 5e-3
        assert -0.5 * down[0] < down[1] < 0.0

    def test_of_two_tension_lengths(self):
        height = (0.0, 0.0, 0.0, 0.06, 0.35)
        spans = [Span(length=40.0, droppers=droppers(40.0))] * 4
        first = twin(
            spans=spans, height=height, stagger=(0.1,) * 5, anchors="tension", contact_support="free"
        )
        second = replace(first, height=height[::-1], stagger=(-0.1,) * 5)
        route = Route(lines=(first, second), starts=(0.0, 40.0))
        found = form(route, COARSE)
        assert len(assemble(found).contact_wires) == 4
        done = run(found, speed=40.0, pantograph=collector(), step=STEP, window=(80.0, 120.0))
        assert done.recordings[0].by_wire.shape[1] == 4
        assert done.recordings[0].force.mean() == pytest.approx(120.0, rel=0.02)
        assert len(clamp_strains(done)) > 10


class TestFile:
    def given(self, tmp_path, key="count = 2\nspacing = 0.05", **other):
        path = tmp_path / "line.toml"
        text = TOML.replace("[contact_wire]", f"[contact_wire]\n{key}", 1)
        for old, new in other.values():
            text = text.replace(old, new)
        path.write_text(text)
        return path

    def test_is_the_line_in_python(self, tmp_path):
        line = read_line(self.given(tmp_path))
        assert line.contact_spacing == 0.05
        assert line.contact_wire.tension == 20e3
        assert line.dropper_x.tolist() == np.repeat(read_line(self.given(tmp_path, "")).dropper_x, 2).tolist()

    def test_schedule_is_read_again(self, tmp_path):
        found = form(read_line(self.given(tmp_path)), COARSE)
        schedule = found.schedule()
        assert [(row.span, row.dropper) for row in schedule[6:10]] == [(1, 7), (1, 8), (2, 1), (2, 2)]
        assert schedule[9].position == 4.0
        found.save_schedule(tmp_path / "measured.csv")
        own = self.given(tmp_path, title=("stagger = 0.2", 'stagger = 0.2\ndropper_lengths = "measured.csv"'))
        assert read_line(own).dropper_lengths == pytest.approx(found.dropper_natural, abs=1e-4)

    @pytest.mark.parametrize(
        ("key", "said"),
        [
            ("count = 2\nspacing = 40.0", r"contact_wire\.spacing: must be .* 0\.5"),
            ("count = 2\nspacing = -0.04", r"contact_wire\.spacing"),
            ("spacing = 0.04", r"contact_wire\.spacing: is given with count = 1 .*count = 2"),
            ("count = 3\nspacing = 0.04", r"contact_wire\.spacing: is given with count = 3"),
        ],
    )
    def test_wrong(self, tmp_path, key, said):
        with pytest.raises(ModelError, match=said):
            read_line(self.given(tmp_path, key))

    def test_no_rail(self):
        with pytest.raises(ModelError, match=r"line\.contact_spacing: has no effect on a conductor rail"):
            Line(
                spans=[Span(length=10.0, droppers=())] * 3,
                contact_wire=Wire(EA=1.5e8, EI=2.3e5, mass=6.9, tension=0.0, rail=True),
                steady_arm=SteadyArm(vertical=1e9),
                contact_spacing=0.04,
            )


class TestUplift:
    """Of both wires the higher one counts, whichever it is."""

    GIVEN: ClassVar = {"speed": 45.0, "pantograph": collector(), "step": STEP, "start": 8.0}
    WAY: ClassVar = {"window": (60.0, 76.0), "until": 90.0}

    @pytest.mark.parametrize("reduce", [False, True])
    @pytest.mark.parametrize("place", [5, 4])
    @pytest.mark.parametrize("span", [2, 3])
    def test_of_the_wire_that_lacks_a_dropper(self, span, place, reduce):
        """The same on the left as on the right: beside the support one wire rises by far more."""
        found = form(twin(stagger=0.0), COARSE)
        lift = []
        for side in (0, 1):
            label = f"{span}-{2 * (place - 1) + 1 + side}"
            made = run(found, **self.GIVEN, **self.WAY, reduce=reduce, broken_droppers=[label])
            lift.append(made.uplift[:, span].max())
        whole = run(found, **self.GIVEN, **self.WAY, reduce=reduce).uplift[:, span].max()
        assert lift[1] == pytest.approx(lift[0], rel=2e-2 if reduce else 2e-3)
        if place == 5:
            assert min(lift) > 1.15 * whole

    @pytest.mark.parametrize("mass", [4.0, 12.0])
    def test_at_rest_of_a_changed_model_both_are_zero(self, mass):
        """Uplift is measured from where each wire rests with what hangs on it."""
        found = form(twin(), COARSE)

        def hang(overhead):
            overhead.add_mass("box", overhead.twin.point(found.twin.nodes.support[4]), mass)

        done = run(found, **self.GIVEN, **self.WAY, modify=hang)
        assert abs(done.uplift[0, 4]) < 2e-4
        assert done.uplift[:, 2].max() > 5e-3

    @pytest.mark.parametrize(
        ("broken", "label", "stagger"),
        some([("2-10", "3-1", 0.0), ("2-9", "3-1", STAGGER), ("2-10", "3-2", STAGGER), ("3-1", "2-7", 0.0)]),
    )
    def test_derivatives_are_those_of_the_higher_wire(self, broken, label, stagger):
        """They were those of the left wire. Differences of runs of changed models, whose rest is exact."""
        found, by = form(twin(stagger=stagger), COARSE), 2e-6
        tight = ancf.GeneralizedAlpha(0.9, newton=ancf.Newton(tolerance=1e-12, modified=False))
        given = self.GIVEN | self.WAY | {"pantograph": collector(relaxed_at="nominal"), "integrator": tight}
        given |= {"broken_droppers": [broken]}
        done = run(found, **given, sensitivities={"a": [label]})

        def lifted(change):
            def lengthen(overhead):
                spring = overhead.dropper(*map(int, label.split("-")))
                object.__setattr__(spring, "length", spring.length + change)

            return run(found, **given, modify=lengthen).uplift

        np.testing.assert_allclose(done.uplift, run(found, **given).uplift, atol=1e-9)
        differences = (lifted(by) - lifted(-by)) / (2.0 * by)
        size = np.abs(differences).max()
        off = np.abs(done.slopes["a"].uplift - differences) > 1e-6 * size
        assert off.sum() <= 2  # samples at which the wires change places within the difference
