"""States of a line beside its design: temperature, wind, ice, wear, droppers as built, tensioners."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

import ancf
from ancf import ModelError
from ancf.catenary import (
    Conditions,
    DropperErrors,
    Form,
    Line,
    Mesh,
    Route,
    Span,
    SteadyArm,
    Tensioner,
    Wire,
    assemble,
    dropper_errors,
    elasticity,
    form,
    read_line,
    run,
    verify,
)
from overhead_lines import COARSE, STEP, collector, short_line

G = 9.81
#: A wire that bends over its supports within a centimetre needs short elements there.
FINE = Mesh(contact_support=0.05)
#: Bends so little that it is a string.
STRING = Wire(EA=12e6, EI=1.0, mass=0.95, tension=10e3, diameter=12.2e-3)


def tram(length=40.0, spans=4, **changes):
    """Contact wire alone, held at its height at the supports."""
    given = {
        "spans": [Span(length=length, droppers=())] * spans,
        "contact_wire": STRING,
        "steady_arm": SteadyArm(vertical=1e8),
        "anchors": "tension" if spans > 1 else "fixed",
    }
    return Line(**(given | changes))


@cache
def found(**changes):
    return form(short_line(**changes), COARSE)


def at(line, mesh=COARSE, **conditions):
    return form(replace(line, conditions=Conditions(**conditions)), mesh)


def sag(made, track):
    """Depth of a level contact wire below its supports, m."""
    return -float(np.interp(track, made.contact.position[:, 0], made.contact.position[:, 2]))


def tension_of(wire, length, warmer, weight=None):
    """Tension in N of a wire between fixed ends that was hung with its tension: lengths of parabolas.

    Its natural length follows from the state in which it was hung; w^2 l^3/24 T^2 is the slack of its sag.
    """
    weight_0 = wire.mass * G
    weight = weight_0 if weight is None else weight

    def natural(tension, load):
        return (length + load**2 * length**3 / (24 * tension**2)) / (1 + tension / wire.EA)

    hung = natural(wire.tension, weight_0) * (1 + wire.expansion * warmer)
    return brentq(lambda tension: natural(tension, weight) - hung, 100.0, 1e5)


class TestTemperature:
    @pytest.mark.parametrize("degrees", [-30.0, 20.0, 50.0])
    @pytest.mark.parametrize("spans", [2, 5])
    def test_weights_travel(self, degrees, spans):
        """alpha L dT from the middle anchor to each end, under the same tension and with the same sag."""
        line = tram(spans=spans)
        anchored = line.supports[1 + int(np.argmin(np.abs(line.supports[1:-1] - line.length / 2)))]
        hot, rest = at(line, FINE, temperature=degrees), form(line, FINE)
        travel = (hot.contact.position - rest.contact.position)[[0, -1], 0]
        wanted = 17e-6 * (degrees - 10.0) * (np.array([0.0, line.length]) - anchored)
        assert travel == pytest.approx(wanted, rel=1e-3)
        assert np.all(hot.pull[0] == STRING.tension)

    @pytest.mark.parametrize("degrees", [-30.0, 50.0])
    def test_weights_of_a_catenary_travel(self, degrees):
        line = short_line(anchors="tension", messenger_support=500e3)
        hot = at(line, temperature=degrees)
        for shape in (hot.contact, hot.messenger):
            travel = np.ptp(shape.position[[0, -1], 0]) - line.length
            assert travel == pytest.approx(17e-6 * (degrees - 10.0) * line.length, rel=1e-3)

    @pytest.mark.parametrize("degrees", [-30.0, 0.0, 50.0])
    @pytest.mark.parametrize("length", [30.0, 60.0])
    def test_fixed_ends(self, degrees, length):
        """A wire of one span; and of several, where each is like it."""
        wanted = tension_of(STRING, length, degrees - 10.0)
        for spans in (1, 3):
            hot = at(tram(length, spans, anchors="fixed"), FINE, temperature=degrees)
            assert hot.pull[0] == pytest.approx([wanted, wanted], rel=1e-3)
            depth = STRING.mass * G * length**2 / (8 * wanted)
            layer = np.sqrt(STRING.EI / wanted)  # the ends turn freely, the supports inside do not
            assert sag(hot, 0.5 * length) == pytest.approx(depth, rel=3e-3 + 4 * layer / length)
            assert hot.wave_speed == pytest.approx(np.sqrt(wanted / STRING.mass), rel=1e-3)

    @pytest.mark.parametrize("degrees", [-20.0, 45.0])
    def test_springs(self, degrees):
        """Each half of the wire in series with its spring; what sag takes up is some hundredths of it."""
        spring = 4e3
        line = tram(20.0, 8, anchors="spring", tensioner=Tensioner(stiffness=spring))
        hot = at(line, FINE, temperature=degrees)
        half = 0.5 * line.length
        relative = -17e-6 * (degrees - 10.0) * half / (half / STRING.EA + 1 / spring)
        assert hot.pull[0] - STRING.tension == pytest.approx([relative, relative], rel=5e-3)
        travel = (hot.contact.position[[0, -1], 0] - [0.0, line.length]) * [-1, 1]
        assert hot.pull[0] == pytest.approx(STRING.tension - spring * travel, abs=1e-3)

    @pytest.mark.parametrize(("degrees", "slides"), [(10.6, False), (50.0, True), (-30.0, True)])
    def test_friction(self, degrees, slides):
        """Ends stay until the tension has changed by its share, then they slide with it."""
        line = tram(20.0, 8, tensioner=Tensioner(friction=0.04))
        hot = at(line, FINE, temperature=degrees)
        if slides:
            share = -0.04 if degrees > 10.0 else 0.04
            assert hot.pull[0] == pytest.approx(np.full(2, 10e3 * (1 + share)), rel=1e-9)
        else:
            stuck = at(replace(line, anchors="fixed", tensioner=Tensioner()), FINE, temperature=degrees)
            assert hot.pull[0] == pytest.approx(stuck.pull[0], rel=1e-6)
            assert hot.contact.position[[0, -1], 0] == pytest.approx([0.0, 160.0], abs=1e-12)

    def test_a_wire_that_becomes_slack(self):
        with pytest.raises(ModelError, match="contact wire is slack") as caught:
            at(tram(8.0, 3, anchors="fixed"), FINE, temperature=90.0)
        assert caught.value.where == "line.conditions.temperature"


class TestWind:
    @pytest.mark.parametrize("speed", [15.0, -35.0])
    @pytest.mark.parametrize("length", [30.0, 50.0])
    def test_one_wire(self, speed, length):
        """Blow-off in the middle of a span: w l^2/(8T)."""
        blown = at(tram(length, 2), FINE, wind=speed)
        pull = 0.5 * 1.225 * speed**2 * 12.2e-3
        y = np.interp(0.5 * length, blown.contact.position[:, 0], blown.contact.position[:, 1])
        assert y == pytest.approx(np.sign(speed) * pull * length**2 / 8 / 10e3, rel=0.01)

    @pytest.mark.parametrize("speed", [20.0, 30.0])
    def test_two_coupled_wires(self, speed):
        """Wires that droppers join are blown off together: parabolas with what they exchange.

        A dropper of the length h that carries w h/... pulls sideways by its lean; with many droppers the two
        strings are T y'' = -p + k (y - y'), k = w/(pitch h), solved here on a fine grid.
        """
        wires = {
            "contact_wire": Wire(EA=12e6, EI=1.0, mass=0.95, tension=12e3, diameter=12.2e-3),
            "messenger_wire": Wire(EA=7e6, EI=1.0, mass=0.6, tension=9e3, diameter=10.5e-3),
        }
        span = Span(length=48.0, droppers=tuple(np.arange(2.0, 48.0, 4.0)))
        line = short_line(spans=[span] * 3, stagger=0.0, anchors="tension", **wires)
        fine = Mesh(contact=1.0, messenger=1.0, contact_support=0.05, dropper=0.1)
        rest, blown = form(line, fine), at(line, fine, wind=speed)
        middle = slice(12, 24)
        lean = rest.dropper_force[middle] / rest.dropper_length[middle]
        wanted = strings(line, lean, 0.5 * 1.225 * speed**2)
        nodes = blown.contact.nodes.dropper[middle], blown.messenger.nodes.dropper[middle]
        for k, (shape, at_nodes) in enumerate(zip((blown.contact, blown.messenger), nodes, strict=True)):
            y = shape.position[at_nodes, 1]
            assert y.max() == pytest.approx(wanted[k].max(), rel=0.01)

    def test_needs_a_diameter(self):
        with pytest.raises(ModelError, match=r"contact_wire\.diameter: is missing"):
            at(short_line(), wind=10.0)


def strings(line, lean, pressure):
    """Sideways places (2, n) in m of two strings at the droppers, which pull with `lean` (n,) N/m."""
    x = np.array(line.spans[0].droppers)
    length, force = line.spans[0].length, []
    compliance = []
    for wire in (line.contact_wire, line.messenger_wire):
        low, high = np.minimum.outer(x, x), np.maximum.outer(x, x)
        compliance.append(low * (length - high) / length / wire.tension)
        force.append(pressure * wire.diameter * x * (length - x) / 2 / wire.tension)
    n = x.size
    coupling = np.block([[-np.diag(lean), np.diag(lean)], [np.diag(lean), -np.diag(lean)]])
    whole = np.zeros((2 * n, 2 * n))
    whole[:n, :n], whole[n:, n:] = compliance
    return np.linalg.solve(np.eye(2 * n) - whole @ coupling, np.concatenate(force)).reshape(2, n)


class TestIceAndWear:
    @pytest.mark.parametrize("ice", [0.3, 1.0])
    def test_ice_sags(self, ice):
        iced = at(tram(40.0, 3), FINE, ice=ice)
        assert sag(iced, 60.0) == pytest.approx((0.95 + ice) * G * 1600 / 8e4, rel=3e-3)
        assert iced.wave_speed == pytest.approx(np.sqrt(10e3 / (0.95 + ice)), rel=1e-5)

    @pytest.mark.parametrize("wear", [0.1, 0.3])
    def test_wear(self, wear):
        """Less mass under the same weights, less stiffness; between fixed ends less tension too."""
        worn = at(tram(40.0, 3), FINE, wear=wear)
        assert sag(worn, 60.0) == pytest.approx((1 - wear) * 0.95 * G * 1600 / 8e4, rel=3e-3)
        assert pytest.approx((1 - wear) * 12e6) == worn.contact.wire.EA
        fixed = at(tram(40.0, 3, anchors="fixed"), FINE, wear=wear)
        assert np.all(fixed.pull[0] < STRING.tension)

    def test_tension(self):
        pulled = at(tram(40.0, 3), FINE, contact_tension=14e3)
        assert sag(pulled, 60.0) == pytest.approx(0.95 * G * 1600 / 8 / 14e3, rel=3e-3)
        stretch = np.ptp(pulled.contact.position[[0, -1], 0]) - 120.0
        slack = (0.95 * G) ** 2 * 40.0**2 * 120.0 / 24 * (1 / 10e3**2 - 1 / 14e3**2)
        assert stretch == pytest.approx(4e3 / 12e6 * 120.0 + slack, rel=5e-3)


class TestAsBuilt:
    @pytest.mark.parametrize("anchors", ["tension", "fixed"])
    @pytest.mark.parametrize("mesh", [COARSE, Mesh(contact=1.3, messenger=2.2)])
    def test_lengths_of_the_design_give_its_heights(self, anchors, mesh):
        """0.1 mm, also on another mesh than that of the design."""
        line = short_line(anchors=anchors, stagger=0.25, contact_support="free")
        lengths = form(line, COARSE).dropper_natural
        built = form(replace(line, dropper_lengths=lengths), mesh)
        assert built.contact_height == pytest.approx(line.dropper_height, abs=1e-4)
        assert built.dropper_load == pytest.approx(form(line, COARSE).dropper_load, rel=0.02)

    @pytest.mark.parametrize("error", [0.004, -0.01])
    def test_all_too_long(self, error):
        """A wire that hangs free at the supports follows the length of all its droppers."""
        line = short_line(contact_support="free", steady_arm=SteadyArm(vertical=0.0), stagger=0.0)
        plain = form(line, COARSE)
        built = form(replace(line, dropper_lengths=plain.dropper_natural + error), COARSE)
        middle = slice(10, 15)  # the ends are held
        assert (built.contact_height - plain.contact_height)[middle] == pytest.approx(
            -error, abs=2e-3 * abs(error) + 2e-4
        )

    @pytest.mark.parametrize("anchors", ["tension", "fixed"])
    def test_is_mounted_under_the_tensions_of_the_design(self, anchors):
        """Ends are fixed only then: droppers that are too short do not pull them tighter."""
        plain = found(anchors=anchors)
        built = form(replace(plain.line, dropper_lengths=plain.dropper_natural - 0.02), COARSE)
        assert built.pull == pytest.approx(np.outer([20e3, 16e3], [1.0, 1.0]), rel=2e-4)

    @pytest.mark.parametrize("j", [7, 12])
    def test_one_too_long(self, j):
        """What the others take is linear in the error, as under a pair of forces."""
        plain = found(anchors="tension")
        error = 1e-3
        lengths = plain.dropper_natural.copy()
        lengths[j] += error
        built = form(replace(plain.line, dropper_lengths=lengths), COARSE)
        overhead = assemble(plain)
        pull = plain.spring_stiffness[j] * error  # what the spring would lose if nothing moved
        spring = overhead.droppers[j]
        for point, sign in ((spring.a, -1.0), (spring.b, 1.0)):
            overhead.model.add_force(point, (0.0, 0.0, sign * pull))
        state = ancf.equilibrium(overhead.model)
        forces = np.array([float(state.spring_force(d)) for d in overhead.droppers])
        forces[j] -= pull
        assert built.dropper_force == pytest.approx(
            forces, abs=0.02 * abs(plain.dropper_force - forces).max()
        )

    def test_too_short_lifts_others_slack(self):
        plain = found()
        lengths = plain.dropper_natural.copy()
        lengths[12] -= 0.12
        built = form(replace(plain.line, dropper_lengths=lengths), COARSE)
        assert built.dropper_force.min() == 0.0

    @pytest.mark.parametrize("value", [0.0, -0.3, float("nan")])
    def test_wrong_lengths(self, value):
        lengths = found().dropper_natural.copy()
        lengths[11] = value
        with pytest.raises(ModelError, match="dropper_lengths"):
            replace(found().line, dropper_lengths=lengths)
        with pytest.raises(ModelError, match=r"has shape \(3,\), wanted \(25,\)"):
            replace(found().line, dropper_lengths=(1.0, 1.0, 1.0))


class TestForms:
    """A state is a form like any other."""

    @pytest.mark.parametrize("anchors", ["tension", "fixed", "spring"])
    def test_rests_as_found(self, anchors):
        wire = {"contact_wire": replace(short_line().contact_wire, diameter=0.013)}
        wire["messenger_wire"] = replace(short_line().messenger_wire, diameter=0.012)
        given = {"tensioner": Tensioner(stiffness=2e3)} if anchors == "spring" else {}
        arm = SteadyArm(length=1.1, mass=1.2)
        line = short_line(anchors=anchors, contact_support="free", steady_arm=arm, **wire, **given)
        made = at(line, temperature=30.0, wind=12.0, ice=0.1)
        checked = verify(assemble(made))
        assert checked.place < 2e-6
        assert checked.load < 0.05

    def test_belongs_to_its_conditions(self):
        made = found()
        with pytest.raises(ModelError, match="conditions"):
            replace(made, line=replace(made.line, conditions=Conditions(ice=1.0)))

    def test_run_and_elasticity_know_of_it(self):
        """A line that is cold between fixed ends gives less, and its waves are faster."""
        line = short_line()
        cold = replace(line, conditions=Conditions(temperature=-20.0))
        gives = [elasticity(item, [50.0], points=2, mesh=COARSE).value.mean() for item in (line, cold)]
        assert gives[1] < 0.92 * gives[0]
        done = run(cold, speed=40.0, pantograph=collector(), step=STEP, mesh=COARSE)
        assert done.form.wave_speed > 1.1 * found().wave_speed
        assert isinstance(done.form, Form)


class TestFile:
    def test_conditions_by_path(self):
        """A file that has none gets some; a wrong one is named."""
        line = read_line("en50318-2002", {"conditions.temperature": -30.0, "conditions.ice": 0.5})
        assert line.conditions == Conditions(temperature=-30.0, ice=0.5)
        assert read_line("en50318-2002").conditions == Conditions()
        with pytest.raises(ModelError, match=r"conditions\.temprature") as caught:
            read_line("en50318-2002", {"conditions.temprature": -30.0})
        assert "temperature" in str(caught.value)


class TestWrong:
    @pytest.mark.parametrize(
        ("make", "where"),
        [
            (lambda: short_line(conditions=Conditions(temperature=900.0)), "line.conditions.temperature"),
            (lambda: short_line(conditions=Conditions(ice=-1.0)), "line.conditions.ice"),
            (lambda: short_line(conditions=Conditions(wear=0.9)), "line.conditions.wear"),
            (lambda: short_line(conditions=Conditions(wind=float("nan"))), "line.conditions.wind"),
            (
                lambda: short_line(conditions=Conditions(contact_tension=0.0)),
                "line.conditions.contact_tension",
            ),
            (
                lambda: short_line(conditions=Conditions(contact_tension=19e3)),
                "line.conditions.contact_tension",
            ),
            (
                lambda: short_line(conditions=Conditions(messenger_tension=15e3)),
                "line.conditions.messenger_tension",
            ),
            (
                lambda: tram(conditions=Conditions(messenger_tension=15e3)),
                "line.conditions.messenger_tension",
            ),
            (lambda: short_line(anchors="spring"), "line.tensioner.stiffness"),
            (lambda: short_line(tensioner=Tensioner(stiffness=1e3)), "line.tensioner.stiffness"),
            (lambda: short_line(tensioner=Tensioner(friction=0.1)), "line.tensioner.friction"),
            (
                lambda: short_line(anchors="tension", tensioner=Tensioner(friction=0.9)),
                "line.tensioner.friction",
            ),
        ],
    )
    def test_is_named(self, make, where):
        with pytest.raises(ModelError) as caught:
            make()
        assert caught.value.where == where


class TestDropperErrors:
    def test_are_those_of_the_seed(self):
        plain = found()
        lengths = []
        for seed in (3, 4, 3):
            made = form(short_line(dropper_errors=DropperErrors(deviation=0.002, seed=seed)), COARSE)
            lengths.append(made.dropper_natural - plain.dropper_natural)
        assert np.array_equal(lengths[0], lengths[2])
        assert np.std(lengths[0]) == pytest.approx(0.002, rel=0.4)
        assert abs(lengths[0] - lengths[1]).max() > 1e-3
        as_before = dropper_errors(plain, 0.002, seed=3).dropper_lengths
        assert np.array(as_before) - plain.dropper_natural == pytest.approx(lengths[0], abs=1e-12)

    def test_come_on_top_of_lengths_as_built(self):
        own = found().dropper_natural + 0.01
        errors = DropperErrors(deviation=0.001, seed=1)
        made = form(short_line(dropper_lengths=own, dropper_errors=errors), COARSE)
        assert np.mean(made.dropper_natural - found().dropper_natural) == pytest.approx(0.01, abs=1e-3)

    def test_in_a_file(self):
        """A study gives whole numbers as floats."""
        line = read_line("en50318-2002", {"dropper_errors.deviation": 0.003, "dropper_errors.seed": 7.0})
        assert line.dropper_errors == DropperErrors(deviation=0.003, seed=7)
        for value in (7.5, -1.0):
            with pytest.raises(ModelError, match=r"dropper_errors\.seed"):
                read_line("en50318-2002", {"dropper_errors.deviation": 0.003, "dropper_errors.seed": value})
        with pytest.raises(ModelError, match=r"dropper_errors\.deviation: .* leaves nothing of"):
            form(short_line(dropper_errors=DropperErrors(deviation=9.0)), COARSE)

    def test_tension_lengths_differ(self):
        line = short_line(anchors="tension", dropper_errors=DropperErrors(deviation=0.003))
        made = form(Route(lines=(line, line), starts=(0.0, 100.0)), COARSE)
        assert abs(np.subtract(*(one.dropper_natural for one in made.forms))).max() > 1e-3
