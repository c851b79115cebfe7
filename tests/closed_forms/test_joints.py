"""Joints between points and axes of all kinds of bodies: statics, motion, modes, observer, bad input.

Every model here has a cable, a beam with a cross-section and a rigid body, so that it compiles once; what
a test does not need stands aside, held.
"""

from itertools import combinations

import numpy as np
import pytest

import ancf
from helpers import rotation
from motions import momentum

G = 9.81
EXACT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-13, modified=False))
CABLE = ancf.Section(EA=300.0, EI=0.5, rhoA=0.4)
BEAM = ancf.Section.rectangle(width=0.05, height=0.05, E=2e5, rho=160.0)  # rhoA 0.4 as well
Q = rotation((0.3, -1.0, 0.6), 2.1)


def cable(model, name, start, end, elements=2, **more):
    return model.add_beam(name, start=start, end=end, elements=elements, section=CABLE, **more)


def beam(model, name, start, end, elements=2, **more):
    given = {"section": BEAM, "element": "nonlocking"} | more
    return model.add_beam(name, start=start, end=end, elements=elements, **given)


def aside(model, turn=None):
    """One of each kind, far away and held altogether."""
    turn = np.eye(3) if turn is None else turn
    far = np.array([0, 50.0, 0])
    for make, name in ((cable, "held cable"), (beam, "held beam")):
        body = make(model, name, turn @ far, turn @ np.add(far, (1, 0, 0)), elements=1)
        for node in (body.start, body.end):
            model.clamp(node, stretch="fixed")
    body = model.add_rigid_body("held body", at=turn @ far, mass=1.0, inertia=(1, 1, 1))
    model.clamp(body)
    model.add_moment(body, (0, 0, 0))


def part(model, kind, name, where, direction):
    """A free body of a kind with a point at ``where``; returns the body and the point."""
    d, where = np.asarray(direction, float), np.asarray(where, float)
    if kind == "mass":
        body = model.add_point_mass(name, at=where, mass=0.3)
        return body, body.point
    if kind == "rigid":
        body = model.add_rigid_body(name, at=where + 0.3 * d, mass=0.4, inertia=(0.02, 0.03, 0.04))
        return body, body.at(*(-0.3 * d))
    if kind == "cable":  # inside its second element
        body = cable(model, name, where - 0.7 * d, where + 0.3 * d)
        return body, body.at(0.7 * np.linalg.norm(d))
    place = (0.3 * np.linalg.norm(d), 0.02, -0.01)  # off the centreline, inside its first element
    ends = where - 0.3 * d, where + 0.7 * d
    off = beam(ancf.Model(), name, *ends).at(*place).initial_position - where
    body = beam(model, name, ends[0] - off, ends[1] - off)
    return body, body.at(*place)


KINDS = ("cable", "beam", "rigid", "mass")
PAIRS = list(combinations(KINDS, 2)) + [(k, k) for k in KINDS] + [(k, "ground") for k in KINDS]


class TestSpherical:
    """Two bodies that turn freely about a common point, in flight or about the ground."""

    WHERE = (0.4, -0.2, 0.3)

    def run(self, one, two):
        model = ancf.Model(gravity=(0, 0, -G) if two == "ground" else (0, 0, 0))
        aside(model)
        first, a = part(model, one, "a", self.WHERE, (0.6, 0.3, 0.2))
        spins, bodies = [(0.5, 1.0, -2.0), (-1.0, 0.7, 3.0)], [first]
        if two == "ground":
            b = self.WHERE
        else:
            second, b = part(model, two, "b", self.WHERE, (-0.2, 0.5, -0.4))
            bodies.append(second)
        joint = model.connect(a, b, name="ball")
        for body, spin, kind in zip(bodies, spins, (one, two), strict=False):
            u = (0, 0, 0) if two == "ground" else (1.0, 0.5, -0.3)
            given = {} if kind == "mass" else {"angular_velocity": spin, "about": self.WHERE}
            body.set_motion(velocity=u, **given)
        return ancf.simulate(model, t_end=0.3, step=1e-3, integrator=EXACT), a, b, joint

    @pytest.mark.parametrize(("one", "two"), PAIRS)
    def test_motion(self, one, two):
        result, a, b, joint = self.run(one, two)
        here = result.position(a)
        there = np.asarray(b) if two == "ground" else result.position(b)
        assert np.max(np.abs(here - there)) < 1e-11
        energy = result.energy
        assert np.ptp(energy.total) < 1e-4 * np.max(energy.kinetic) + 1e-12
        if two == "ground":
            return
        p, L = zip(*(momentum(result, k) for k in (0, 150, 300)), strict=True)
        assert p[1:] == pytest.approx(np.stack([p[0], p[0]]), abs=1e-9)
        assert L[1:] == pytest.approx(np.stack([L[0], L[0]]), abs=2e-5 * max(np.linalg.norm(L[0]), 1))
        assert np.linalg.norm(p[0]) > 0.3
        if joint.shared:
            with pytest.raises(ancf.ModelError, match="ball"):
                result.multiplier(joint)

    @pytest.mark.parametrize("weight", [1.0, *np.random.default_rng(3).uniform(0.7, 1.3, 30)])
    def test_hanging_chain(self, weight):
        """Ground, cable, rigid body, beam, mass: each joint carries what hangs below it.

        The body spins freely between its ball joints, by what round-off leaves there.
        """
        g = G * weight
        model = ancf.Model(gravity=(0, 0, -g))
        aside(model)
        c = cable(model, "c", (0, 0, 0), (0.6, 0, -0.8))
        r = model.add_rigid_body("r", at=(0.6, 0, -1.0), mass=0.7, inertia=(0.01, 0.01, 0.002))
        b = beam(model, "b", (0.6, 0, -1.2), (0.6, 0, -2.2))
        m = model.add_point_mass("m", at=b.at(0.9, 0.02, 0.01).initial_position, mass=0.5)
        joints = [
            model.connect(c.start, (0, 0, 0)),
            model.connect(r.at(0, 0, 0.2), c.end),
            model.connect(b.start, r.at(0, 0, -0.2)),
            model.connect(m, b.at(0.9, 0.02, 0.01)),
        ]
        model.hold(r, position="y")
        state = ancf.equilibrium(model)
        weights = np.array([c.section.rhoA * c.length, 0.7, b.section.rhoA * b.length, 0.5]) * g
        below = np.cumsum(weights[::-1])[::-1]
        for joint, carried in zip(joints, below, strict=True):  # the second of each pair receives it
            assert state.multiplier(joint) == pytest.approx((0, 0, -carried), abs=1e-6)
        assert state.tension(c.end) == pytest.approx(below[1], rel=0.05)
        for joint in joints[1:]:
            assert state.position(joint.a) == pytest.approx(state.position(joint.b), abs=1e-10)
        assert state.position(m)[2] < -2.1

    def test_inner_point_on_the_ground(self):
        """A cable laid over a pin inside an element: the reactions carry the weight."""
        model = ancf.Model(gravity=(0, 0, -G))
        aside(model)
        c = cable(model, "c", (0, 0, 0), (2, 0, 0), elements=4)
        model.pin(c.start)
        model.pin(c.end)
        joint = model.connect(c.at(0.7), (0.7, 0, 0))
        state = ancf.equilibrium(model)
        assert state.position(c.at(0.7)) == pytest.approx((0.7, 0, 0), abs=1e-11)
        carried = -state.multiplier(joint)[2]  # by the pin, which receives it downwards
        assert 0.3 * 0.4 * 2 * G < carried < 0.4 * 2 * G
        assert state.position(c.at(1.35))[2] < -1e-3


class TestFixation:
    """A cable or beam clamped to a hub, against the same one clamped to the ground."""

    def build(self, kind, stretch, hub, **motion):
        model = ancf.Model(gravity=(0, 0.7, -G))
        aside(model)
        body = (cable if kind == "cable" else beam)(model, "body", (0.1, 0, 0), (1.1, 0.2, 0), elements=3)
        if not hub:
            model.clamp(body.start, stretch=stretch, **motion)
            return model, body
        axes = rotation((1, 1, 0.3), 0.5)
        centre = model.add_rigid_body("hub", at=(0.1, 0, 0), mass=1.0, inertia=(1, 1.2, 1.4), axes=axes)
        model.clamp(centre, **motion)
        model.clamp(body.start, to=centre, stretch=stretch)
        return model, body

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    @pytest.mark.parametrize("kind", ["cable", "beam"])
    def test_statics_and_modes(self, kind, stretch):
        shapes, frequencies = [], []
        for hub in (False, True):
            model, body = self.build(kind, stretch, hub)
            state = ancf.equilibrium(model)
            shapes.append([state.position(body.at(x)) for x in (0.4, 1.0)])
            frequencies.append(ancf.modes(model, about=state, count=4).frequencies)
        assert np.array(shapes[1]) == pytest.approx(np.array(shapes[0]), abs=1e-9)
        assert frequencies[1] == pytest.approx(frequencies[0], rel=1e-7)
        assert abs(shapes[0][1][2]) > 0.05

    @pytest.mark.parametrize("kind", ["cable", "beam"])
    def test_driven_hub(self, kind):
        motion = {"rotation": "0.4*(1 - cos(8*t))", "axis": (0, 0.3, 1)}
        ends = []
        for hub in (False, True):
            model, body = self.build(kind, "free", hub, **motion)
            result = ancf.simulate(model, t_end=0.2, step=1e-3, integrator=EXACT)
            ends.append(result.position(body.end)[-1])
        assert ends[1] == pytest.approx(ends[0], abs=2e-5)
        assert np.linalg.norm(ends[0] - body.initial_position(body.length)) > 0.05

    def test_reaction(self):
        """The force at the root is the weight, and the hub receives it."""
        model, body = self.build("cable", "fixed", True)
        state = ancf.equilibrium(model)
        joint = model.connections[-1]
        weight = body.section.rhoA * body.length * np.array([0, 0.7, -G])
        assert state.multiplier(joint)[:3] == pytest.approx(weight, abs=1e-7)
        assert state.multiplier(joint).shape == (6,)

    def test_spinning_hub(self):
        """A free hub with two cables: momentum, angular momentum and energy stay."""
        model = ancf.Model()
        aside(model)
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=0.5, inertia=(0.05, 0.06, 0.07))
        spin = {"velocity": (0.3, 0, 0), "angular_velocity": (0.5, 0, 4.0), "about": (0, 0, 0)}
        hub.set_motion(**spin)
        for k, make in ((1, cable), (-1, beam)):
            arm = make(model, f"arm {k}", (0.1 * k, 0, 0), (0.9 * k, 0, 0))
            arm.set_motion(**spin)
            model.clamp(arm.start, to=hub)
        result = ancf.simulate(model, t_end=0.4, step=1e-3, integrator=EXACT)
        p, L = zip(*(momentum(result, k) for k in (0, 200, 400)), strict=True)
        assert p[1:] == pytest.approx(np.stack([p[0], p[0]]), abs=1e-9)
        assert L[1:] == pytest.approx(np.stack([L[0], L[0]]), abs=2e-5 * np.linalg.norm(L[0]))
        assert np.ptp(result.energy.total) < 1e-4 * result.energy.total[0]


class TestTwoParts:
    """A beam cut in two and joined again by multipliers vibrates as the whole one."""

    def frequencies(self, make, parts, count=6):
        model = ancf.Model()
        aside(model)
        if parts == 1:
            one = make(model, "one", (0, 0, 0), (1, 0, 0), elements=4)
            model.clamp(one.start)
        else:
            one = make(model, "one", (0, 0, 0), (0.5, 0, 0))
            two = make(model, "two", (0.5, 0, 0), (1, 0, 0))
            model.clamp(one.start)
            if parts == "hub":
                hub = model.add_rigid_body("hub", at=(0.5, 0, 0), mass=1e-9, inertia=[1e-12] * 3)
                model.clamp(one.end, to=hub)
                model.clamp(two.start, to=hub)
            else:
                for k, (y, z) in enumerate(((0, 0), (0.02, 0), (0, 0.02))):
                    model.connect(one.at(0.5, y, z), two.at(0, y, z), name=f"bolt {k}")
        return ancf.modes(model, count=count).frequencies

    def test_cable(self):
        whole = self.frequencies(cable, 1)
        joined = self.frequencies(cable, "hub", count=7)
        assert joined[1:] == pytest.approx(whole, rel=1e-6)
        assert joined[0] < 0.1 * whole[0]  # nothing holds the hub about the axis of the cable

    def test_beam_by_a_hub(self):
        """The hub holds the angles of the section at the joint: shear and thickness have none there."""
        whole, joined = (self.frequencies(beam, parts) for parts in (1, "hub"))
        assert joined == pytest.approx(whole, rel=5e-3)
        assert np.all(joined > whole * (1 - 1e-9))

    def test_beam_by_three_bolts(self):
        """r, r_y and r_z agree; r_x may jump, which sets a little free."""
        whole, joined = (self.frequencies(beam, parts) for parts in (1, "bolts"))
        assert joined == pytest.approx(whole, rel=2e-2)
        assert np.all(joined < whole * (1 + 1e-9))


class TestHinge:
    def test_beam_hinged_to_the_ground(self):
        """As with supports that leave one rotation; it swings like a rod."""
        found = []
        for joint in (False, True):
            model = ancf.Model()
            aside(model)
            b = beam(model, "b", (0, 0, 0), (1, 0, 0), elements=3)
            if joint:
                model.hinge(b.start, (0, 0, 0), axis=(0, 1, 0))
            else:
                model.hold(b.start, position="xyz", slope_y="xz")
            found.append(ancf.modes(model, count=5).frequencies)
        assert found[1][1:] == pytest.approx(found[0][1:], rel=1e-7)
        assert found[1][0] < 1e-3 * found[1][1]

    def test_beam_between_bodies(self):
        """Hinged to a hub and to another beam, it stays in the plane of its hinges."""
        model = ancf.Model(gravity=(0, 0, -G))
        aside(model)
        hub = model.add_rigid_body("hub", at=(-0.2, 0, 0), mass=1.0, inertia=(0.02, 0.02, 0.02))
        one = beam(model, "one", (0, 0, 0), (0.6, 0, 0))
        two = beam(model, "two", (0.6, 0, 0), (1.2, 0, 0))
        model.hinge(hub.at(-0.2, 0, 0), (-0.4, 0, 0), axis=(0, 1, 0))
        model.hinge(one.start, hub.at(0.2, 0, 0), axis=(0, 1, 0))
        joint = model.hinge(one.end, two.start, axis=(0, 1, 0))
        model.add_force(two.end, (0, 0.02, 0))
        result = ancf.simulate(model, t_end=0.3, step=1e-3)
        assert result.position(one.end) == pytest.approx(result.position(two.start), abs=1e-10)
        assert np.ptp(result.energy.balance) < 1e-3 * np.max(result.energy.kinetic)
        assert np.min(result.position(two.end)[:, 2]) < -0.2
        assert result.multiplier(joint).shape == (301, 5)


def assembly(turn):
    """Cable, beam, two rigid bodies and a mass with every kind of joint, seen in turned axes."""
    model = ancf.Model(gravity=turn @ (1.0, 2.0, -G))
    aside(model, turn)
    c = cable(model, "c", turn @ (0, 0, 0), turn @ (1, 0, 0.2))
    hub = model.add_rigid_body(
        "hub", at=turn @ (1.2, 0, 0.2), mass=0.5, inertia=(0.02, 0.03, 0.04), axes=turn
    )
    arm = model.add_rigid_body("arm", at=turn @ (1.6, 0, 0.2), mass=0.4, inertia=(0, 0.02, 0.02), axes=turn)
    b = beam(model, "b", turn @ (1.8, 0, 0.2), turn @ (2.4, 0, 0.2), y_axis=turn @ (0, 1, 0))
    model.pin(c.start)
    joints = [
        model.clamp(c.end, to=hub),
        model.hinge(hub.at(0.2, 0, 0), arm.at(-0.2, 0, 0), axis=turn @ (0, 1, 1), name="hinge"),
        model.hinge(b.start, arm.at(0.2, 0, 0), axis=turn @ (0, 0, 1)),
    ]
    m = model.add_point_mass("m", at=c.at(0.4).initial_position, mass=0.2)
    joints.append(model.connect(m, c.at(0.4), name="ball"))
    model.add_force(b.end, lambda t: turn @ (0.0, np.sin(20 * t), 0.5))
    return model, joints, [c.at(0.7), hub.at(0, 0.1, 0), arm.centre, b.end, m.point]


class TestObserver:
    def test_turned_model(self):
        results = []
        for turn in (np.eye(3), Q):
            model, joints, points = assembly(turn)
            result = ancf.simulate(model, t_end=0.15, step=1e-3, integrator=EXACT)
            positions = [result.position(p) @ turn for p in points]
            forces = [result.multiplier(joint)[:, :3] @ turn for joint in joints]
            results.append((np.array(positions), np.array(forces), result.energy.balance))
        (x, f, e), (y, g, d) = results
        assert np.linalg.norm(x[:, -1] - x[:, 0], axis=1).min() > 0.03
        assert y == pytest.approx(x, abs=1e-9)
        assert g == pytest.approx(f, abs=1e-4 * np.abs(f).max())
        assert d == pytest.approx(e, abs=1e-9)

    def test_energy(self):
        model, *_ = assembly(np.eye(3))
        result = ancf.simulate(model, t_end=0.3, step=5e-4)
        assert np.ptp(result.energy.balance) < 2e-4 * np.max(result.energy.kinetic)


class TestResults:
    def test_saved_and_loaded(self, tmp_path):
        model, joints, points = assembly(np.eye(3))
        result = ancf.simulate(model, t_end=0.05, step=1e-3)
        result.save(tmp_path / "run.h5")
        loaded = ancf.load(tmp_path / "run.h5")
        for joint in joints:
            assert np.array_equal(loaded.multiplier(joint.name), result.multiplier(joint))
        for point in points:
            assert np.array_equal(loaded.position(str(point)), result.position(point))
            assert np.array_equal(loaded.velocity(str(point)), result.velocity(point))
        assert loaded.joints.keys() == result.joints.keys()
        assert loaded.multiplier("hub").shape == (51, 6)  # what keeps it rigid
        more = ancf.simulate(model, t_end=0.05, step=1e-3, start=result.state(20))
        for point in points:
            assert more.position(point) == pytest.approx(result.position(point)[20:], abs=1e-7)

    def test_unknown_names(self):
        model, _, _ = assembly(np.eye(3))
        result = ancf.simulate(model, t_end=2e-3, step=1e-3)
        with pytest.raises(ancf.ModelError, match=r"there are: .*hinge, .*ball"):
            result.multiplier("rope")
        with pytest.raises(ancf.ModelError, match="there are none"):
            result.arc_length("hinge")


class TestBad:
    @pytest.fixture
    def model(self):
        model = ancf.Model(gravity=(0, 0, -G))
        aside(model)
        return model

    @staticmethod
    def refused(model, match):
        for run in (lambda: ancf.simulate(model, t_end=1.0, step=0.01), lambda: ancf.equilibrium(model)):
            with pytest.raises(ancf.ModelError, match=match) as caught:
                run()
            assert caught.value.where == "connections"

    def test_joint_and_support(self, model):
        """A cable pinned at both ends and joined to the ground at one of them."""
        c = cable(model, "c", (0, 0, 0), (1, 0, 0))
        model.pin(c.start)
        model.connect(c.start, (0, 0, 0), name="bolt")
        self.refused(model, '"bolt" joins what supports hold already: it has nothing to do')

    def test_joint_held_in_one_direction(self, model):
        c = cable(model, "c", (0, 0, 0), (1, 0, 0))
        model.hold(c.start, position="y")
        model.connect(c.start, (0, 0, 0), name="bolt")
        self.refused(model, '"bolt" joins what supports hold already, in some direction')

    def test_clamp_and_ball_of_one_node(self, model):
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=1.0, inertia=(0.1, 0.1, 0.1))
        c = cable(model, "c", (0.1, 0, 0), (1, 0, 0))
        model.clamp(c.start, to=hub, name="clamp")
        model.connect(c.end, (1, 0, 0))
        model.connect(hub.at(0.1, 0, 0), (0.1, 0, 0), name="bolt")
        nut = model.connect(c.start, (0.1, 0, 0), name="nut")
        result = ancf.simulate(model, t_end=0.05, step=0.01)
        assert any('3 of the 3 conditions of "nut"' in note for note in result.notes)
        assert np.abs(result.multiplier(nut)).max() == 0.0
        assert np.abs(result.position(c.start) - (0.1, 0, 0)).max() < 1e-9
