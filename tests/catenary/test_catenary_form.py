"""Form finding, the model at rest, static elasticity and their commands."""

import csv
import json
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

import ancf
from ancf.catenary import (
    Conditions,
    Droppers,
    Line,
    Mesh,
    Rayleigh,
    Span,
    SteadyArm,
    StitchWire,
    Wire,
    assemble,
    elasticity,
    form,
    line_file,
    read_line,
    verify,
)
from ancf.catenary.forms.schedule import COLUMNS, rows, texts
from ancf.catenary.forms.strings import lumped, string_loads, string_shape
from ancf.cli.app import app
from ancf.errors import ModelError
from places import DATA, EXAMPLES

GIVEN = json.loads((DATA / "catenary.json").read_text(encoding="utf-8"))
EXAMPLE = EXAMPLES / "line.toml"
G = 9.81


def shortened(name, spans, **changes):
    """A line of the catalogue with fewer spans."""
    return replace(read_line(name).excerpt(0, spans), **changes)


@cache
def found_with(name, spans, support):
    return form(shortened(name, spans, contact_support=support))


def middle(values, made, span):
    return values[made.line.dropper_span == span]


def small(**changes):
    """Two spans, as cheap as it gets."""
    given = {
        "spans": [
            Span(length=40.0, droppers=(8.0, 20.0, 32.0)),
            Span(length=50.0, droppers=(8.0, 25.0, 42.0)),
        ],
        "contact_wire": Wire(EA=1.5e7, EI=150.0, mass=1.0, tension=15e3),
        "messenger_wire": Wire(EA=1.0e7, EI=80.0, mass=0.7, tension=12e3),
        "droppers": Droppers(stiffness=1e5),
        "steady_arm": SteadyArm(vertical=300.0),
        "system_height": 1.2,
    }
    return Line(**(given | changes))


STITCH = StitchWire(wire=Wire(EA=4e6, EI=10.0, mass=0.31, tension=3e3), reach=9.0)


def stitched(**changes):
    """Two spans with a stitch wire at the middle support, which carries the droppers at 8 m from it."""
    return small(**({"stitch": STITCH, "system_height": 1.6} | changes))


class TestStrings:
    def test_level_string_carries_its_weight(self):
        """Each support carries half of both cells, the tension does not matter."""
        x = np.array([0.0, 5.0, 10.5, 17.0])
        load = string_loads(x, np.zeros(4), 20e3, 10.0)
        assert load == pytest.approx([25.0, 52.5, 60.0, 32.5])

    def test_parabola(self):
        """w L^2/(8 T) in the middle."""
        x = np.linspace(0.0, 60.0, 31)
        held = np.full(31, np.nan)
        held[[0, -1]] = 0.0
        z = string_shape(x, held, lumped(x, 13.0), 16e3)
        assert z[15] == pytest.approx(-13.0 * 60.0**2 / (8 * 16e3), rel=1e-12)

    def test_are_inverse(self):
        rng = np.random.default_rng(1)
        x, z = np.cumsum(rng.uniform(1.0, 3.0, 12)), rng.normal(size=12)
        load = string_loads(x, z, 7e3, 9.0)
        held = np.full(12, np.nan)
        held[[0, -1]] = z[[0, -1]]
        assert string_shape(x, held, load + lumped(x, 9.0), 7e3) == pytest.approx(z)


class TestReferences:
    @pytest.mark.parametrize(
        ("span", "close", "near"), [(0, 1.0, 2.5e-3), (1, 0.5, 2.5e-3), (2, 1.0, 2.5e-3)]
    )
    def test_2002(self, span, close, near):
        """All spans are nearly alike: the contact wire turns freely at its anchors, over supports it bends.

        The reference has a messenger that bends over its supports: it hangs higher by sqrt(EI/T) times its
        slope there, 2 mm.
        """
        made, wanted = found_with("en50318-2002", 3, "held"), GIVEN["en50318-2002"]
        assert middle(made.dropper_load, made, span) == pytest.approx(wanted["load"], abs=close)
        assert middle(made.dropper_length, made, span) == pytest.approx(wanted["length"], abs=2.5e-3)
        assert np.abs(made.contact_height).max() < 1e-8

    def test_2002_hanging_free(self):
        made = found_with("en50318-2002", 5, "free")
        load = middle(made.dropper_load, made, 2)
        assert load[[0, -1]] == pytest.approx(GIVEN["en50318-2002"]["free_end_load"], abs=0.5)
        assert np.all(made.arm_force[:, 2] == 0.0)

    def test_2018_free(self):
        """The published table fits a contact wire that hangs free at the supports ..."""
        made, wanted = found_with("en50318-2018-ac-simple", 5, "free"), GIVEN["en50318-2018-ac-simple"]
        assert middle(made.dropper_length, made, 2) == pytest.approx(wanted["length"], abs=3e-3)

    def test_2018_held(self):
        """... and not one that is held: every dropper is 8 to 10 mm longer."""
        made, wanted = found_with("en50318-2018-ac-simple", 3, "held"), GIVEN["en50318-2018-ac-simple"]
        longer = middle(made.dropper_length, made, 1) - wanted["length"]
        assert longer.min() > 7.5e-3
        assert longer.max() < 10.5e-3

    def test_paper(self):
        """The reference has no weight of the droppers, which is worth 4 mm."""
        light = shortened("paper-7.5", 3)
        light = form(replace(light, droppers=replace(light.droppers, mass=0.0)))
        assert light.dropper_length.min() == pytest.approx(GIVEN["paper-7.5"]["shortest"], abs=2e-3)
        heavy = found_with("paper-7.5", 3, "held")
        assert heavy.dropper_length.min() == pytest.approx(GIVEN["paper-7.5"]["shortest"], abs=5e-3)

    def test_lengths_do_not_depend_on_the_mesh(self):
        """A tenth of a millimetre: the clamps hang by what the nodes give too little, 0.4 mm, below them."""
        line = shortened("en50318-2002", 2)
        coarse, fine = form(line), form(line, Mesh(contact=0.5, messenger=1.0, dropper=0.1))
        assert fine.dropper_length == pytest.approx(coarse.dropper_length, abs=0.08e-3)
        assert fine.dropper_load == pytest.approx(coarse.dropper_load, abs=0.3)
        assert np.max(coarse.clamp_give * coarse.dropper_force) > 0.3e-3

    def test_bending_over_the_supports(self):
        """Between two supports the messenger hangs higher by sqrt(EI/T) times its slope there."""
        line = shortened("en50318-2002", 5)
        stiff = replace(line, messenger_clamp="continuous")
        mesh = Mesh(messenger_support=0.03)
        slope = 0.5 * found_with("en50318-2002", 3, "held").support_load[1] / 16e3
        higher = form(stiff, mesh).dropper_length - form(line, mesh).dropper_length
        assert higher[18:27] == pytest.approx(np.sqrt(131.7 / 16e3) * slope, abs=0.15e-3)


class TestBalance:
    """Identities that hold for any line whose spans are alike."""

    @pytest.mark.parametrize("support", ["held", "free"])
    def test_weights(self, support):
        """What a middle span and its support carry is what hangs there."""
        made = found_with("en50318-2018-ac-simple", 5, support)
        line, own = made.line, 0.117 * middle(made.dropper_length, made, 2) * G
        tension = middle(made.dropper_load, made, 2)
        clamps = 9 * 0.165 * G
        carried = tension.sum() + made.arm_force[2, 2]
        assert carried == pytest.approx(line.contact_wire.mass * 55.0 * G + clamps, rel=2e-4)
        hung = tension.sum() + own.sum() + 9 * 0.195 * G + line.messenger_wire.mass * 55.0 * G
        assert made.support_load[2] == pytest.approx(hung, rel=5e-4)

    def test_stagger(self):
        """A steady arm holds the bend of the tension: 4 T a/L for a zigzag of +-a."""
        made = found_with("en50318-2018-ac-simple", 5, "free")
        assert made.contact.position[made.contact.nodes.support, 1] == pytest.approx(made.line.stagger)
        assert np.abs(made.arm_force[1:-1, 1]) == pytest.approx(22e3 * 4 * 0.2 / 55.0, rel=0.01)
        assert np.all(np.sign(made.arm_force[1:-1, 1]) == np.sign(made.line.stagger[1:-1]))

    def test_leaning_droppers(self):
        """The messenger over the track pulls the contact wire to it and is pulled itself."""
        made = found_with("paper-7.5", 3, "held")
        side = made.messenger.position[made.messenger.nodes.dropper, 1]
        below = made.contact.position[made.contact.nodes.dropper, 1]
        away = np.abs(below) > 0.05
        assert np.all(side[away] * below[away] > 0.0)
        assert np.abs(side).max() > 0.01
        assert np.all(np.abs(side[away]) < np.abs(below[away]))


LINES = {
    "2002": lambda: shortened("en50318-2002", 2),
    "2002 with weights": lambda: shortened("en50318-2002", 3, anchors="tension"),
    "2018": lambda: shortened("en50318-2018-ac-simple", 2),
    "paper": lambda: shortened("paper-7.5", 2),
    "continuous": lambda: small(messenger_clamp="continuous", stagger=0.2),
    "hinged arm": lambda: small(
        contact_support="free", stagger=0.3, steady_arm=SteadyArm(length=1.2, mass=1.5)
    ),
    "hinged arm, held": lambda: small(stagger=0.3, steady_arm=SteadyArm(length=1.2, mass=1.5)),
    "springs": lambda: small(
        stagger=0.2, steady_arm=SteadyArm(vertical=200.0, lateral=1e4, mass=1.0), messenger_support=1e5
    ),
    "no vertical": lambda: small(stagger=(0.1, -0.3, 0.0), steady_arm=SteadyArm(vertical=0.0)),
    "stitch wires": lambda: stitched(),
    "stitch wires, hinged arms": lambda: stitched(
        stagger=0.3, messenger_stagger=0.0, contact_support="free", steady_arm=SteadyArm(length=1.0)
    ),
    "low tension": lambda: small(contact_wire=replace(small().contact_wire, tension=400.0)),
    "three parts": lambda: small(droppers=Droppers(EA=1e5, mass=0.2, clamp_contact=0.3, clamp_messenger=0.2)),
}


class TestStitchWire:
    def test_takes_tension_off_the_messenger(self):
        """Between its ends the messenger has what it leaves: seen in the assembled line."""
        overhead = assemble(form(stitched()))
        state = verify(overhead).state
        inside, outside = (
            overhead.messenger.at(overhead.messenger.arc_at(36.0)),
            overhead.messenger.beams[0].at(15.0),
        )
        for point, tension in ((inside, 9e3), (outside, 12e3)):
            slope = state.slope(point)
            along = state.tension(point) * slope[0] / np.linalg.norm(slope)
            assert along == pytest.approx(tension, rel=2e-3)

    def test_carries_its_droppers(self):
        """Its ends carry two droppers and its weight, and it hangs below the messenger."""
        limp = replace(STITCH, wire=replace(STITCH.wire, EI=0.01))
        made = form(stitched(stitch=limp), Mesh(messenger=0.5, dropper=0.02))
        assert made.line.dropper_stitch.tolist() == [-1, -1, 1, 1, -1, -1]
        shape = made.stitches[0]
        assert shape.position[0, 2] == pytest.approx(
            np.interp(31.0, *made.messenger.position[:, [0, 2]].T), abs=1e-3
        )
        clamps = shape.position[shape.nodes.dropper, 2]  # but for the bend, some centimetres of a limp wire
        assert made.messenger_height[2:4] == pytest.approx(clamps, abs=1e-4)
        assert np.all(made.messenger_height[2:4] < clamps)
        drop = shape.position[0, 2] - shape.position[shape.nodes.dropper[0], 2]
        share = made.dropper_load[2] * 17 / 18 + made.dropper_load[3] / 18 + 0.31 * G * (9 - 0.5)
        tilt = (shape.position[-1, 2] - shape.position[0, 2]) / 18
        assert drop == pytest.approx(share / 3e3 - tilt, rel=0.01)

    def test_softens_the_support(self):
        """The contact wire gives more at a support with a stitch wire beside it."""
        lines = [small(contact_support="free", system_height=1.6), stitched(contact_support="free")]
        plain, soft = (elasticity(line, (50.0,), points=2, span=1).value[0, 0] for line in lines)
        assert soft > 1.1 * plain

    def test_wrong(self):
        with pytest.raises(ModelError, match="the messenger has 12000 N only"):
            stitched(stitch=replace(STITCH, wire=replace(STITCH.wire, tension=12e3)))
        with pytest.raises(ModelError, match="half of the shortest span"):
            stitched(stitch=replace(STITCH, reach=20.0))


class TestWholeLine:
    @pytest.mark.parametrize("name", LINES)
    def test_rests_as_found(self, name):
        """The assembled model in equilibrium: heights, places, dropper forces."""
        made = form(LINES[name]())
        checked = verify(assemble(made))
        assert checked.height < 1e-6
        assert checked.place < 1e-5
        assert checked.load < 1e-3

    @pytest.mark.parametrize("name", ["2002", "2018", "paper"])
    def test_tensions_at_the_anchors(self, name):
        made = form(LINES[name]())
        assert verify(assemble(made)).tension < 1e-4 * made.line.messenger_wire.tension

    def test_weights_and_fixed_ends_rest_alike(self):
        """The forces at the anchors are the tensions: with them instead of pins nothing moves."""
        line = shortened("en50318-2002", 2)
        fixed, pulled = (verify(assemble(form(replace(line, anchors=a)))) for a in ("fixed", "tension"))
        assert pulled.place < 1e-6
        assert pulled.tension == pytest.approx(fixed.tension, abs=1e-3)

    def test_another_mesh(self):
        made = form(small())
        overhead = assemble(made, Mesh(contact=0.5, messenger=1.0))
        assert overhead.form.mesh == Mesh(contact=0.5, messenger=1.0)
        assert np.diff(overhead.form.contact.nodes.x).max() <= 0.5 + 1e-9
        assert verify(overhead).height < 1e-6

    def test_points(self):
        """Track positions are those under tension, arc lengths are shorter."""
        overhead = assemble(form(small()))
        state = verify(overhead).state
        assert state.position(overhead.contact_at(31.7))[0] == pytest.approx(31.7, abs=1e-4)
        for x, point in zip((0.0, 40.0, 90.0), overhead.supports, strict=True):
            assert overhead.track_x(point) == pytest.approx(x, abs=1e-6)
        assert overhead.contact_wire.length == pytest.approx(90.0 / 1.001, rel=2e-5)
        assert len(overhead.droppers) == 6
        assert overhead.droppers[3].name == "dropper 2-1"

    def test_stays_at_rest(self):
        overhead = assemble(form(small(damping=Rayleigh(alpha=0.01, beta=1e-4))))
        state = ancf.equilibrium(overhead.model)
        result = ancf.simulate(overhead.model, t_end=0.02, step=1e-3, start=state)
        moved = result.position(overhead.supports[1]) - state.position(overhead.supports[1])
        assert np.abs(moved).max() < 1e-8

    def test_hinged_arm_is_stiff_by_its_pull(self):
        """A bar of length l under a sideways force R has the vertical stiffness R/l."""
        line = small(contact_support="free", stagger=0.3, steady_arm=SteadyArm(length=1.2))
        made = form(line)
        springs = replace(line, steady_arm=SteadyArm(vertical=abs(made.arm_force[1, 1]) / 1.2))
        lifts = []
        for item in (line, springs, replace(line, steady_arm=SteadyArm(vertical=0.0))):
            overhead = assemble(form(item))
            rest = ancf.equilibrium(overhead.model)
            overhead.model.add_force(overhead.supports[1], (0.0, 0.0, 20.0))
            lifted = ancf.equilibrium(overhead.model)
            place = overhead.supports[1]
            lifts.append(float((lifted.position(place) - rest.position(place))[2]))
        hinged, sprung, free = lifts
        assert hinged == pytest.approx(sprung, rel=0.01)
        assert free > 1.04 * hinged

    def test_example(self):
        made = form(read_line(EXAMPLE))
        checked = verify(assemble(made))
        assert checked.height < 1e-5
        assert checked.load < 0.01
        assert made.dropper_load.min() > 20.0
        assert made.dropper_length.min() > 0.5


class TestRefused:
    def test_negative_load(self):
        """A dropper below its neighbours' line would have to push."""
        line = small(
            spans=[
                Span(length=40.0, droppers=(8.0, 20.0, 32.0)),
                Span(length=50.0, droppers=(8.0, 25.0, 42.0), pre_sag=(0.0, 0.3, 0.0)),
            ]
        )
        with pytest.raises(ModelError, match="would carry -") as caught:
            form(line)
        assert caught.value.where == "line.spans[1].droppers[1]"

    def test_messenger_below(self):
        with pytest.raises(ModelError, match="below the contact wire there") as caught:
            form(small(system_height=0.2))
        assert caught.value.where == "line.spans[1].droppers[1]"
        assert "system_height" in caught.value.hint

    def test_loose_contact_wire(self):
        with pytest.raises(ModelError, match="is too low: the wire would hang at a slope of") as caught:
            form(small(contact_wire=replace(small().contact_wire, tension=100.0)))
        assert caught.value.where == "line.contact_wire.tension"

    def test_soft_droppers(self):
        with pytest.raises(ModelError, match="is stretched by") as caught:
            form(small(droppers=Droppers(stiffness=100.0)))
        assert caught.value.where.startswith("line.spans[")

    @pytest.mark.parametrize("EA", [0.2, 2.0, 200e3])
    def test_units_of_droppers(self, EA):
        """200 kN as 0.2 MN: a rope that is 500 times as long as without force."""
        if EA > 100.0:
            assert form(small(droppers=Droppers(EA=EA))).dropper_natural.min() > 0.0
            return
        with pytest.raises(ModelError, match=r"is stretched by [\d.]+ mm of its [\d.]+ mm") as caught:
            form(small(droppers=Droppers(EA=EA)))
        assert "EA is in N" in caught.value.hint

    def test_weights_on_one_span(self):
        line = small(anchors="tension")
        with pytest.raises(ModelError, match="nothing holds along the track"):
            assemble(form(line.excerpt(0, 1)))

    def test_hinged_arm_without_stagger(self):
        with pytest.raises(ModelError, match="would hang down") as caught:
            assemble(form(small(steady_arm=SteadyArm(length=1.2))))
        assert caught.value.where == "line.steady_arm.length"


class TestSchedule:
    def test_file(self, tmp_path):
        made = form(small())
        path = made.save_schedule(tmp_path / "deep" / "schedule.csv")
        with path.open(newline="", encoding="utf-8") as file:
            head, *rows = csv.reader(file)
        assert tuple(head) == COLUMNS
        table = np.array(rows, dtype=float)
        assert table[:, 0].tolist() == [1, 1, 1, 2, 2, 2]
        assert table[:, 1].tolist() == [1, 2, 3, 1, 2, 3]
        assert table[:, 2].tolist() == [8.0, 20.0, 32.0, 8.0, 25.0, 42.0]
        assert table[:, 3] == pytest.approx(made.line.dropper_x)
        assert table[:, 4] == pytest.approx(1e3 * made.dropper_length, abs=0.051)
        assert table[:, 5] == pytest.approx(1e3 * made.dropper_natural, abs=0.051)
        assert table[:, 6] == pytest.approx(made.dropper_load, abs=0.051)
        assert "-0.0" not in path.read_text(encoding="utf-8")

    @pytest.mark.parametrize("spacing", [None, 0.04])
    def test_rows_are_what_the_droppers_have(self, spacing):
        """In millimetres but for places and loads; of twin wires each place comes twice."""
        line, rng = small(contact_spacing=spacing), np.random.default_rng(4)
        wires, places = 1 if spacing is None else 2, ((8.0, 20.0, 32.0), (8.0, 25.0, 42.0))
        names = ("dropper_length", "cut_length", "dropper_load", "contact_height", "messenger_height")
        values = {name: rng.uniform(-2.0, 2.0, 6 * wires) for name in names}
        made = rows(SimpleNamespace(line=line, **values))
        x = np.repeat(np.ravel(places), wires)
        assert [row.position for row in made] == x.tolist()
        assert [row.track for row in made] == (x + 40.0 * (np.arange(len(x)) >= 3 * wires)).tolist()
        assert [row.span for row in made] == [1] * 3 * wires + [2] * 3 * wires
        assert [row.dropper for row in made] == 2 * [*range(1, 3 * wires + 1)]
        columns = ("length", "natural", "load", "contact_height", "messenger_height")
        for column, name in zip(columns, names, strict=True):
            scale = 1.0 if column == "load" else 1e3
            assert [getattr(row, column) for row in made] == pytest.approx(scale * values[name], rel=1e-14)
        told = texts(replace(made[0], length=1234.56, natural=1233.94, load=-0.04, contact_height=-7.25))
        assert told[:7] == ["1", "1", "8.000", "8.000", "1234.6", "1233.9", "0.0"]
        assert told[7] in ("-7.2", "-7.3")

    def test_cannot_be_written(self, tmp_path):
        (tmp_path / "file").write_text("")
        with pytest.raises(ModelError, match="cannot be written"):
            form(small()).save_schedule(tmp_path / "file" / "schedule.csv")


def two_strings(line, made, track, force):
    """Lift of the contact wire by a small force: two strings, dropper springs and arms, linear."""
    n = 901
    x = np.linspace(0.0, line.length, n)
    stiffness = np.zeros((2 * n, 2 * n))
    for k, tension in enumerate((line.contact_wire.tension, line.messenger_wire.tension)):
        for i in range(n - 1):
            both = np.array([k * n + i, k * n + i + 1])
            stiffness[np.ix_(both, both)] += tension / (x[1] - x[0]) * np.array([[1, -1], [-1, 1]])
    for place, k_dropper in zip(line.dropper_x, made.dropper_stiffness, strict=True):
        i = int(np.argmin(np.abs(x - place)))
        both = np.array([i, n + i])
        stiffness[np.ix_(both, both)] += k_dropper * np.array([[1, -1], [-1, 1]])
    held = [0, n - 1, n, 2 * n - 1]
    for place in line.supports[1:-1]:
        i = int(np.argmin(np.abs(x - place)))
        stiffness[i, i] += line.steady_arm.vertical
        held.append(n + i)
    free = np.setdiff1d(np.arange(2 * n), held)
    load = np.zeros(2 * n)
    i = int(np.argmin(np.abs(x - track)))
    load[i] = force
    return np.linalg.solve(stiffness[np.ix_(free, free)], load[free])[np.searchsorted(free, i)]


class TestElasticity:
    def test_of_two_strings(self):
        """A force that leaves all droppers taut; the whole line differs by its bending stiffness only."""
        line = small(anchors="tension")
        made, got = form(line), elasticity(line, forces=(10.0,), points=5, span=0)
        wanted = [two_strings(line, made, x, 1e3) for x in got.x[1:]]  # mm/N
        assert got.value[0, 1:] == pytest.approx(wanted, rel=0.02)
        assert got.value[0, 0] == pytest.approx(0.0, abs=1e-9)

    def test_slack_droppers_give_more(self):
        line = small(contact_support="free")
        got = elasticity(line, forces=(10.0, 300.0), points=4, span=1)
        at_dropper = np.isin(got.x, line.spans[1].droppers)
        assert np.all(got.value[1, at_dropper] > 1.02 * got.value[0, at_dropper])
        high, low = got.value[1].max(), got.value[1].min()
        assert got.nonuniformity[1] == pytest.approx((high - low) / (high + low))

    def test_part_of_a_line(self):
        """Fewer spans beside the one that is lifted make it a little stiffer, and symmetry stays."""
        line = read_line("en50318-2002")
        whole = elasticity(replace(line, spans=line.spans[:7], stagger=0.0, system_height=1.2), (100.0,), 2)
        part = elasticity(line, (100.0,), 2, beside=2)
        assert whole.span == 3
        assert part.x == pytest.approx(whole.x)
        assert part.value == pytest.approx(whole.value, rel=0.03)
        assert part.value[0] == pytest.approx(part.value[0, ::-1], rel=1e-3)

    @pytest.mark.parametrize("changes", [{}, {"conditions": Conditions(temperature=-20.0)}])
    def test_of_a_form(self, changes):
        """That of its line, as it was found and on its mesh."""
        line, mesh = small(**changes), Mesh(contact=2.0, messenger=2.0)
        made = form(line, mesh)
        got, wanted = elasticity(made, (100.0,), 4), elasticity(line, (100.0,), 4, mesh=mesh)
        assert got.value == pytest.approx(wanted.value, rel=1e-9)
        assert got.form is made
        for key, value in (("beside", 1), ("mesh", mesh)):
            with pytest.raises(ModelError, match=f"elasticity.{key}: has no effect"):
                elasticity(made, **{key: value})

    def test_of_lengths_as_built(self):
        """Droppers 10 mm longer at the middle of a span change what the wire gives there."""
        line = small()
        longer = form(line).dropper_natural + np.where(line.dropper_span == 0, 0.01, 0.0)
        built = form(replace(line, dropper_lengths=longer))
        got, wanted = elasticity(built, (100.0,), 4, span=0), elasticity(built.line, (100.0,), 4, span=0)
        assert got.value == pytest.approx(wanted.value, rel=1e-9)

    @pytest.mark.parametrize(
        ("given", "where"),
        [
            ({"forces": (0.0,)}, "elasticity.forces[0]"),
            ({"points": 1}, "elasticity.points"),
            ({"span": 2}, "elasticity.span"),
        ],
    )
    def test_wrong(self, given, where):
        with pytest.raises(ModelError) as caught:
            elasticity(small(), **given)
        assert caught.value.where == where


class TestCommands:
    def own(self, tmp_path, old="repeat = 10", new="repeat = 2"):
        path = tmp_path / "own.toml"
        text = line_file("en50318-2002").read_text(encoding="utf-8")
        path.write_text(text.replace("repeat = 10", "repeat = 2").replace(old, new), encoding="utf-8")
        return str(path)

    def test_form(self, tmp_path):
        done = CliRunner().invoke(app, ["catenary", "form", self.own(tmp_path), "-o", str(tmp_path / "out")])
        assert done.exit_code == 0, done.output
        assert "EN 50318:2002 reference model: 2 spans, 120 m, wave speed 438 km/h" in done.output
        assert "18 droppers" in done.output
        rows = (tmp_path / "out" / "schedule.csv").read_text(encoding="utf-8").splitlines()
        assert len(rows) == 19
        assert rows[1].split(",")[4] in done.output

    def test_elasticity(self, tmp_path):
        arguments = [self.own(tmp_path), "-o", str(tmp_path / "out"), "--force", "50"]
        done = CliRunner().invoke(app, ["catenary", "elasticity", *arguments])
        assert done.exit_code == 0, done.output
        assert "non-uniformity at 50 N" in done.output
        head = (tmp_path / "out" / "elasticity.csv").read_text(encoding="utf-8").splitlines()[0]
        assert head == "x_m,elasticity_50N_mm_per_N"

    @pytest.mark.parametrize(
        ("old", "new", "message"),
        [
            ("tension = 20e3", "tension = -20e3", "contact_wire.tension: must be > 0, is -20000"),
            ("system_height = 1.2", "system_height = 0.5", "spans[0].droppers[4]"),
        ],
    )
    def test_wrong_input(self, tmp_path, old, new, message):
        done = CliRunner().invoke(app, ["catenary", "form", self.own(tmp_path, old, new)])
        assert done.exit_code == 2
        assert message in done.output

    def test_unknown_line(self):
        done = CliRunner().invoke(app, ["catenary", "elasticity", "en50318-2001"])
        assert done.exit_code == 2
        assert "did you mean" in done.output
