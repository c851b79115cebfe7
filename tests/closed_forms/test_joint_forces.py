"""Forces of joints: what changes the momentum of all bodies, or of the part beyond the joint."""

import numpy as np
import pytest

import ancf
from helpers import EXACT, square

G = np.array([0.4, -1.1, -9.3])
STEP, STEPS = 1e-3, 20


def unit(rng):
    x = rng.standard_normal(3)
    return x / np.linalg.norm(x)


def ground(model, body, at, axis, across):
    """Joints of a point of a rigid body and the ground by their names."""
    point, place = body.at(*(at - body.position)), tuple(at)
    return {
        "connect": lambda: model.connect(point, place, name="it"),
        "hinge": lambda: model.hinge(point, place, axis=axis, name="it"),
        "cylindrical": lambda: model.cylindrical(point, place, axis=axis, name="it"),
        "prismatic": lambda: model.prismatic(point, place, axis=axis, name="it"),
        "planar": lambda: model.planar(point, place, axis=axis, name="it"),
        "universal": lambda: model.universal(point, place, axis_a=axis, axis_b=across, name="it"),
    }


KINDS = ["connect", "hinge", "cylindrical", "prismatic", "planar", "universal", "guide", "slide"]


def tied(kind, seed):
    """A rigid body with a cable that carries a mass, tied to the ground by one joint; all it weighs."""
    rng = np.random.default_rng(seed)
    model = ancf.Model(gravity=tuple(G))
    at, axis = rng.standard_normal(3), unit(rng)
    section = ancf.Section(EA=300.0, EI=0.4, rhoA=0.3)
    hub = model.add_rigid_body("hub", at=tuple(at), mass=1.3, inertia=(0.2, 0.3, 0.4))
    end = at + 0.2 * unit(rng)
    rope = model.add_beam("rope", start=tuple(end), end=tuple(end + unit(rng)), elements=3, section=section)
    ball = model.add_point_mass("ball", at=tuple(rope.end.initial_position), mass=0.7)
    model.connect(rope.start, hub.at(*(end - at)))
    model.connect(rope.end, ball)
    if kind == "guide":
        model.guide(hub.centre, axis=tuple(axis), name="it")
    elif kind == "slide":
        model.slide(tuple(rope.at(0.4).initial_position), along=rope, name="it", friction=0.1)
    else:
        across = np.cross(axis, unit(rng))
        ground(model, hub, at + 0.3 * unit(rng), tuple(axis), tuple(across))[kind]()
    return model, 1.3 + 0.7 + 0.3 * rope.length


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("kind", KINDS)
def test_change_the_momentum(kind, seed):
    """In trapezoidal steps exactly: h/2 of the forces at both ends. The ground is the second end."""
    model, mass = tied(kind, seed)
    run = ancf.simulate(
        model, t_end=STEPS * STEP, step=STEP, integrator=ancf.Trapezoidal(newton=EXACT), sensors=["it"]
    )
    force = run.joint_force("it")
    assert np.max(np.abs(force)) > 0.5
    received = force if kind == "slide" else -force  # the wire is the second end, by the ring that stands
    change = np.diff(run.momentum, axis=0) / STEP
    assert change == pytest.approx(mass * G + 0.5 * (received[1:] + received[:-1]), abs=1e-6)
    np.testing.assert_allclose(run.sensors.joint_force("it"), force, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(run.state(7).joint_force("it"), force[7], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("kind", ["cylindrical", "prismatic", "planar"])
def test_of_a_joint_that_slides_is_normal_to_its_way(kind):
    """Without a moment from it, by the mass beyond it: a block on an inclined axis or plane."""
    model, axis = ancf.Model(gravity=tuple(G)), np.array([2.0, -1.0, 2.0]) / 3.0
    block = model.add_rigid_body("block", at=(1, 2, 3), mass=1.5, inertia=(0.2, 0.3, 0.4))
    getattr(model, kind)(block.centre, (1, 2, 3), axis=tuple(axis), name="it")
    run = ancf.simulate(model, t_end=0.02, step=1e-3)
    along = np.outer(axis, axis)
    carried = 1.5 * G @ (along if kind == "planar" else np.eye(3) - along)
    assert run.joint_force("it") == pytest.approx(np.tile(carried, (21, 1)), abs=1e-9)
    assert run.joint_moment("it") == pytest.approx(np.zeros((21, 3)), abs=1e-9)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("pair", ["cables", "beams", "beam and body", "cable and body", "bodies"])
def test_of_what_is_rigid(pair, swapped):
    """A weld or a clamp to a body, of what hangs beyond it and its load."""
    rng = np.random.default_rng(len(pair))
    model, load, far = (
        ancf.Model(gravity=tuple(G)),
        rng.standard_normal(3),
        ("cable and body", "beam and body"),
    )
    element = "nonlocking" if "beam" in pair else "cable"
    section = square(element, EA=4e3, EI=30.0, rhoA=0.8)
    given = {"section": section, "elements": 2, "element": element}
    if pair == "bodies":
        root = model.add_rigid_body("root", at=(1, 0, 0), mass=1.0, inertia=(0.1, 0.1, 0.1)).centre
        model.clamp("root")
    else:
        root = model.add_beam("root", start=(0, 0, 0), end=(1, 0, 0), **given).end
        model.clamp(root.body.start)
    if pair in (*far, "bodies"):
        tip = model.add_rigid_body("tip", at=(1.3, 0.2, 0), mass=0.6, inertia=(0.1, 0.1, 0.1)).at(
            -0.3, -0.2, 0
        )
        mass = 0.6
    else:
        tip = model.add_beam("tip", start=(1, 0, 0), end=(2, 0, 0), **given).start
        mass = 0.8
    model.add_force(tip.body.end if pair in ("cables", "beams") else tip, tuple(load))
    if pair in far:
        model.clamp(root, to=tip.body, name="it")
    else:
        model.weld(*((tip, root) if swapped else (root, tip)), name="it")
    turned = swapped and pair not in far
    state = ancf.equilibrium(model)
    wanted = -(mass * G + load)  # what lies beyond is held by the joint
    assert state.joint_force("it") == pytest.approx(-wanted if turned else wanted, abs=1e-6)


class TestSharedNodes:
    """Nodes that share their position: there are no multipliers, but there is a force."""

    @pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
    @pytest.mark.parametrize("swapped", [False, True])
    def test_of_a_chain_at_rest(self, element, swapped):
        section = square(element, EA=2e3, EI=2.0, rhoA=0.8)
        model, above = ancf.Model(gravity=(0, 0, -9.81)), None
        for k in range(3):
            given = {"start": (0, 0, -k), "end": (0, 0, -k - 1), "elements": 2, "element": element}
            rope = model.add_beam(f"r{k}", section=section, **given)
            if above is None:
                model.pin(rope.start)
                if element != "cable":
                    model.hold(rope.start, twist=True)
            else:
                ends = (rope.start, above) if swapped else (above, rope.start)
                model.connect(*ends, name=f"j{k}")
                if element != "cable":
                    model.hold(rope.start, twist=True)
            above = rope.end
        state = ancf.equilibrium(model)
        for k in (1, 2):
            weight = (3 - k) * 0.8 * 9.81
            wanted = (0, 0, -weight if swapped else weight)  # b hangs, unless a does
            assert state.joint_force(f"j{k}") == pytest.approx(wanted, rel=1e-6, abs=1e-5)

    @pytest.mark.parametrize("turning", [False, True])
    @pytest.mark.parametrize("swapped", [False, True])
    def test_in_motion(self, swapped, turning):
        """A mass at the end of a cable, under a load of its own, is accelerated by what it receives."""
        model = ancf.Model(gravity=tuple(G))
        section = ancf.Section(EA=300.0, EI=0.4, rhoA=0.3, axial_damping=0.5, bending_damping=0.01)
        rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
        ball = model.add_point_mass("ball", at=(1, 0, 0), mass=0.7)
        model.clamp(rope.start, **({"rotation": "0.5*sin(6*t)", "axis": (0, 0.6, 0.8)} if turning else {}))
        model.connect(*((ball, rope.end) if swapped else (rope.end, ball)), name="it")
        model.add_force(ball, ["sin(9*t)", 0, "2*t"])
        run = ancf.simulate(model, t_end=0.1, step=1e-3, output_step=5e-3)
        load = np.stack([np.sin(9 * run.t), 0 * run.t, 2 * run.t], axis=1)
        received = 0.7 * (run.acceleration(ball) - G) - load
        wanted = -received if swapped else received
        assert run.joint_force("it") == pytest.approx(wanted, abs=1e-9 * np.max(np.abs(received)))
        assert run.state().joint_force("it") == pytest.approx(wanted[-1], abs=1e-9)

    def test_of_three_at_one_node(self):
        """Each joint carries what is on its second end."""
        model, section = ancf.Model(gravity=(0, 0, -9.81)), ancf.Section(EA=2e3, EI=0.5, rhoA=0.5)
        ends = {"left": (-1, 0, 1), "right": (1, 0, 1)}
        left, right = (
            model.add_beam(name, start=place, end=(0, 0, 0), elements=3, section=section)
            for name, place in ends.items()
        )
        ball = model.add_point_mass("ball", at=(0, 0, 0), mass=2.0)
        model.pin(left.start)
        model.pin(right.start)
        model.connect(left.end, right.end, name="ropes")
        model.connect(right.end, ball, name="load")
        state = ancf.equilibrium(model)
        assert state.joint_force("load") == pytest.approx((0, 0, 2.0 * 9.81), abs=1e-6)
        pull = state.joint_force("ropes")  # right and ball receive it from the left rope
        weight = 9.81 * (2.0 + 0.5 * right.length)
        assert pull + state.reaction("pin at right.start") == pytest.approx((0, 0, weight), abs=1e-6)

    def test_of_a_held_end(self):
        """What a support holds of one body is taken by the other's end; held both it is not determined."""
        model, section = ancf.Model(gravity=(0, 0, -9.81)), ancf.Section(EA=2e3, EI=0.5, rhoA=0.5)
        rope = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -1), elements=3, section=section)
        tail = model.add_beam("tail", start=(0, 0, 0), end=(0, 0, -2), elements=3, section=section)
        model.connect(rope.start, tail.start, name="it")
        model.pin(tail.start)
        state = ancf.equilibrium(model)
        assert state.joint_force("it") == pytest.approx((0, 0, -0.5 * 9.81), abs=1e-6)  # the rope hangs on it
        model.clamp(rope.start)
        with pytest.raises(
            ancf.ModelError, match="it: supports hold both of its nodes: what the joint carries"
        ):
            ancf.equilibrium(model).joint_force("it")

    def test_of_a_cable_with_a_winch(self):
        """The load at the end of a rope that is hauled in."""
        model, section = ancf.Model(gravity=(0, 0, -9.81)), ancf.Section(EA=2e3, EI=0.0, rhoA=0.5)
        rope = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -3), elements=6, section=section)
        ball = model.add_point_mass("ball", at=(0, 0, -3), mass=4.0)
        model.pin(rope.start)
        model.winch(rope.start, length="3 - 0.3*t**2")
        model.connect(ball, rope.end, name="it")
        run = ancf.simulate(model, t_end=0.1, step=2e-3, output_step=0.02)
        wanted = 4.0 * ((0, 0, -9.81) - run.acceleration(ball))
        assert run.joint_force("it") == pytest.approx(wanted, abs=1e-8)

    def test_of_sensors(self):
        model, section = ancf.Model(gravity=(0, 0, -9.81)), ancf.Section(EA=2e3, EI=0.5, rhoA=0.5)
        rope = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -1), elements=3, section=section)
        model.connect(rope.end, model.add_point_mass("ball", at=(0, 0, -1), mass=1.0), name="it")
        model.pin(rope.start)
        run = ancf.simulate(model, t_end=0.01, step=1e-3, sensors=[rope.end])
        with pytest.raises(ancf.ModelError, match="sensors record nothing of it"):
            run.sensors.joint_force("it")


def test_of_an_element_that_both_bodies_share_is_refused():
    """At the shared node nobody can tell what which of the two receives."""
    model, section = ancf.Model(gravity=(0, 0, -9.81)), ancf.Section(EA=2e3, EI=0.5, rhoA=0.5)
    one = model.add_beam("one", start=(0, 0, 0), end=(2, 0, 0), elements=2, section=section)
    two = model.add_beam("two", start=(0, 0, 0), end=(0, 2, 0), elements=2, section=section)
    model.connect(one.start, two.start, name="corner")
    hub = model.add_rigid_body("hub", at=(0.5, 0.5, 0), mass=1.0, inertia=(0.1, 0.1, 0.1))
    model.connect(one.at(0.5), hub.at(0, -0.5, 0), name="arm")
    model.connect(two.at(0.5), hub.at(-0.5, 0, 0), name="leg")
    model.pin(one.start)
    state = ancf.equilibrium(model, of=["one", "two"])
    assert state.joint_force("arm").shape == (3,)
    bar = model.add_beam("bar", start=(0, 0, 0), end=(2, 0, 0), elements=2, section=section)
    model.connect(bar.start, one.start, name="root")
    model.connect(bar.at(0.6), one.at(0.6), name="clip")
    with pytest.raises(ancf.ModelError, match="clip: it acts on an element at a node that bar and one share"):
        ancf.simulate(model, t_end=1e-4, step=1e-4).joint_force("clip")


def test_what_has_none():
    model = ancf.Model()
    ball = model.add_point_mass("ball", at=(0, 0, 0), mass=1.0)
    model.add_spring(ball, (1, 0, 0), stiffness=3.0, name="spring")
    run = ancf.simulate(model, t_end=1e-3, step=1e-3)
    with pytest.raises(ancf.ModelError, match="spring: is no joint with a force here; there are none"):
        run.joint_force("spring")
