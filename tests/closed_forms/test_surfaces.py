"""Cables on surfaces: capstan, line load, rest, slip, sheaves, pulleys that turn."""

import numpy as np
import pytest

import ancf
from ancf.system.system import System

R, D = 0.2, 0.02
#: Weights of the points of an element.
GAUSS = 0.5 * np.polynomial.legendre.leggauss(5)[1]
RC = R + 0.5 * D


def wound(turns, pitch=0.0, tail=0.1, per_turn=32, EA=1e6, radius=RC, rhoA=0.3, axial=0.0):
    """A cable wound about the y axis with straight ends; its curvature, tangent at its end and length."""
    phi, p = 2 * np.pi * turns, pitch / (2 * np.pi)
    ds = np.hypot(radius, p)
    n = max(4, round(per_turn * turns))

    def point(a):
        return np.stack([radius * np.cos(a), p * a, radius * np.sin(a)], axis=-1)

    def tangent(a):
        return np.array([-radius * np.sin(a), p, radius * np.cos(a)]) / ds

    ends = np.linspace(0.0, tail, 12)[1:, None]
    path = [
        point(0.0) - ends[::-1] * tangent(0.0),
        point(np.linspace(0, phi, 20 * n)),
        point(phi) + ends * tangent(phi),
    ]
    lengths = [
        np.linspace(0, tail, 3),
        tail + np.linspace(0, phi * ds, n + 1),
        tail + phi * ds + np.linspace(0, tail, 3),
    ]
    nodes = np.unique(np.concatenate(lengths).round(12))
    model = ancf.Model()
    section = ancf.Section(EA=EA, EI=1e-3, rhoA=rhoA, diameter=D, axial_damping=axial)
    rope = model.add_beam("rope", path=np.concatenate(path), nodes=nodes, length=nodes[-1], section=section)
    return model, rope, radius / ds**2, tangent(phi), phi * ds


class TestCapstan:
    """T2/T1 = exp(mu phi), phi the angle by which the tangent turns."""

    @staticmethod
    def ratio(mu, turns, load=1000.0, k=1e8, **given):
        model, rope, curvature, way, length = wound(turns, **given)
        drum = model.add_surface("drum", ancf.Cylinder(radius=R, axis=(0, 1, 0)))
        model.add_contact(rope, drum, stiffness=k, friction=mu)
        held = model.pin(rope.start)
        model.add_force(rope.end, load * way)
        state = ancf.equilibrium(model)
        return load / np.linalg.norm(state.reaction(held)), np.exp(mu * curvature * length), state

    @pytest.mark.parametrize("mu", [0.05, 0.2, 0.5])
    @pytest.mark.parametrize("turns", [0.25, 0.5, 1.0])
    def test_ratio(self, mu, turns):
        found, wanted, _ = self.ratio(mu, turns)
        assert found == pytest.approx(wanted, rel=1e-3)

    @pytest.mark.parametrize("mu", [0.1, 0.5])
    def test_two_turns(self, mu):
        """Beside each other, as on a drum; up to 533 times the force."""
        found, wanted, _ = self.ratio(mu, 2.0, pitch=0.05, per_turn=64, EA=1e5)
        assert found == pytest.approx(wanted, rel=2e-3)

    @pytest.mark.parametrize(
        ("EA", "elements"), [(1e6, 38), *((EA, n) for EA in (1e6, 1e7) for n in (68, 75, 97, 135))]
    )
    def test_many_turns_whose_held_end_gives(self, EA, elements):
        """By more than a mesh departs from the path: held still friction acts either way at the slack end."""
        radius, pitch, angle = 0.21, 0.026, np.linspace(0.0, 5 * np.pi, 190)
        helix = np.stack(
            [radius * np.cos(angle), pitch * angle / (2 * np.pi), radius * np.sin(angle)], axis=1
        )
        on, off = (
            np.array([-radius * np.sin(x), pitch / (2 * np.pi), radius * np.cos(x)]) for x in angle[[0, -1]]
        )
        on, off = on / np.linalg.norm(on), off / np.linalg.norm(off)
        ends = np.linspace(0.15, 0.0, 6)[:-1, None]
        path = np.vstack([helix[0] - ends * on, helix, helix[-1] + ends[::-1] * off])
        model = ancf.Model()
        section = ancf.Section(EA=EA, EI=1e-3, rhoA=0.3, diameter=0.02)
        rope = model.add_beam("rope", path=path, elements=elements, section=section)
        drum = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0, 1, 0)))
        model.add_contact(rope, drum, stiffness=1e8, friction=0.3)
        held = model.pin(rope.start, displacement=1e-4 * on)
        model.add_force(rope.end, 1000.0 * off)
        ratio = 1000.0 / np.linalg.norm(ancf.equilibrium(model).reaction(held))
        assert ratio == pytest.approx(np.exp(0.3 * 5 * np.pi), rel=3e-3)

    def test_converges_with_mesh_and_stiffness(self):
        stiffnesses = [
            abs(found / wanted - 1.0)
            for k in (1e6, 1e7, 1e8)
            for found, wanted, _ in [self.ratio(0.3, 0.5, per_turn=64, k=k)]
        ]
        assert stiffnesses[0] > 4 * stiffnesses[1] > 16 * stiffnesses[2]
        meshes = [
            abs(found / wanted - 1.0)
            for per_turn in (8, 16, 64)
            for found, wanted, _ in [self.ratio(0.3, 0.5, per_turn=per_turn)]
        ]
        assert meshes[0] > 4 * meshes[1] > 4 * meshes[2]
        assert meshes[2] < 5e-5

    def test_slips_on_all_of_the_drum_and_the_tension_falls_as_it_should(self):
        _, _, state = self.ratio(0.3, 0.5)
        line = state.contact_line("contact of rope and drum")
        touching = line.normal > 1.0
        inside = (line.x > 0.15) & (line.x < 0.1 + 0.9 * np.pi * RC)
        assert line.slips[touching & inside].all()
        at = 0.1 + 0.5 * np.pi * RC
        assert state.tension(f"rope.at({at})") == pytest.approx(1000.0 * np.exp(-0.3 * np.pi / 2), rel=2e-3)
        size = np.linalg.norm(line.friction, axis=1)
        assert size[inside] == pytest.approx(0.3 * line.normal[inside], rel=5e-3)


class TestLine:
    @pytest.mark.parametrize("power", [1.0, 1.7])
    @pytest.mark.parametrize("radius", [None, 0.03])
    @pytest.mark.parametrize("tilt", [0.0, 3e-3, -8e-3])
    def test_gap_and_force_of_a_tilted_rope(self, tilt, radius, power):
        """The height of its axis above the plane less its radius, and the stiffness times what is below."""
        low = 0.01 if radius is None else radius
        model = ancf.Model()
        section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.3, diameter=0.02)
        above = low - 1e-3
        ends = {"start": (0, 0, above - 0.5 * tilt), "end": (1.3, 0, above + 0.5 * tilt)}
        nodes = np.hypot(1.3, tilt) * np.linspace(0.0, 1.0, 8) ** power
        rope = model.add_beam("rope", **ends, nodes=nodes, section=section)
        floor = model.add_surface("floor", ancf.Plane())
        contact = model.add_contact(rope, floor, stiffness=2e5, radius=radius)
        system = System(model)
        state = ancf.State(system, 0.0, *system.initial_state())
        line = state.contact_line(contact)
        gap = above + tilt * (line.x / rope.length - 0.5) - low
        assert line.x.reshape(7, -1).mean(axis=1) == pytest.approx(0.5 * (nodes[1:] + nodes[:-1]), rel=1e-12)
        assert line.gap == pytest.approx(gap, abs=1e-12)
        assert line.normal == pytest.approx(2e5 * np.maximum(-gap, 0.0), rel=1e-9, abs=1e-6)
        assert line.gap.min() == pytest.approx(float(state.contact_gap(contact)), abs=1e-12)
        assert not line.friction.any()
        assert not line.limit.any()
        assert not line.slips.any()


class TestWithoutFriction:
    @pytest.mark.parametrize("load", [100.0, 3000.0])
    def test_line_load(self, load):
        """T/R at the radius of the axis."""
        model, rope, _, way, _ = wound(0.5)
        model.add_contact(
            rope, model.add_surface("drum", "cylinder", radius=R, axis=(0, 1, 0)), stiffness=1e8
        )
        model.pin(rope.start)
        model.add_force(rope.end, load * way)
        line = ancf.equilibrium(model).contact_line("contact of rope and drum")
        force = line.normal.reshape(-1, 5) @ GAUSS
        at = line.x.reshape(-1, 5) @ GAUSS
        inside = np.abs(at - 0.1 - 0.5 * np.pi * RC) < 0.25 * np.pi * RC  # its ends bend
        wanted = load * (1.0 + load / 1e6) / (RC - load / (RC * 1e8))  # per length without load
        assert force[inside] == pytest.approx(np.full(inside.sum(), wanted), rel=1e-3)
        shape_error = 6e-7  # m, of a cubic against the circle: it is felt with the stiffness
        assert np.abs(line.normal.reshape(-1, 5)[inside] - wanted).max() < 1e8 * shape_error

    @pytest.mark.parametrize("low", [0.1, 0.125, 0.2, 0.3, 0.4])
    def test_ends_at_different_heights(self, low):
        """T - w z is the same all along, whatever the drum does."""
        drop, w = 0.5, 2.0 * 9.81
        arc = np.linspace(0.0, np.pi, 60)
        left = np.stack([np.full(20, RC), np.zeros(20), np.linspace(-drop, 0, 20, endpoint=False)], axis=1)
        right = np.stack([np.full(20, -RC), np.zeros(20), np.linspace(0, -low, 21)[1:]], axis=1)
        over = np.stack([RC * np.cos(arc), 0 * arc, RC * np.sin(arc)], axis=1)
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e6, EI=1e-3, rhoA=2.0, diameter=D)
        path = np.concatenate([left, over, right])
        rope = model.add_beam("rope", path=path, elements=60, section=section)
        model.add_contact(
            rope, model.add_surface("drum", "cylinder", radius=R, axis=(0, 1, 0)), stiffness=1e7
        )
        ends = model.pin(rope.start, displacement=(0, 0, -2e-4)), model.pin(rope.end)
        state = ancf.equilibrium(model)
        T = [np.linalg.norm(state.reaction(end)) for end in ends]
        assert T[1] - T[0] == pytest.approx(w * (drop + 2e-4 - low), rel=1e-3)

    def test_slides_off_a_sphere(self):
        """A rope along a great circle is in balance there and nowhere else: one beside it slides down."""
        ways = []
        for aside in (0.0, 0.04):
            a = np.linspace(-0.9, 0.9, 60)
            r = np.sqrt(RC**2 - aside**2)
            path = np.stack([r * np.sin(a), np.full(60, aside), r * np.cos(a)], axis=1)
            model = ancf.Model(gravity=(0, 0, -9.81))
            section = ancf.Section(EA=1e4, EI=1e-3, rhoA=0.3, diameter=D)
            rope = model.add_beam("rope", path=path, elements=12, section=section)
            ball = model.add_surface("ball", ancf.Sphere(radius=R))
            model.add_contact(rope, ball, stiffness=1e5, damping=30.0)
            run = ancf.simulate(model, t_end=0.4, step=1e-3, output_step=0.1)
            ways.append(run.position(rope.at(0.5 * rope.length))[:, 1])
        assert np.abs(ways[0]).max() < 1e-9
        assert ways[1][-1] > 0.1


def hung(I=None, mu=0.5, k=1e6, damping=300.0, drop=0.5, shape=None, masses=(2.5, 2.5)):  # noqa: E741
    """Two masses on a rope over a pulley, which turns if it has a moment of inertia I."""
    nt, n = 14, 12
    arc = np.linspace(0.0, np.pi, 60)
    left = np.stack([np.full(20, RC), np.zeros(20), np.linspace(-drop, 0, 20, endpoint=False)], axis=1)
    right = np.stack([np.full(20, -RC), np.zeros(20), np.linspace(0, -drop, 21)[1:]], axis=1)
    over = np.stack([RC * np.cos(arc), 0 * arc, RC * np.sin(arc)], axis=1)
    length = np.pi * RC
    parts = [
        np.linspace(0, drop, nt + 1),
        drop + np.linspace(0, length, n + 1),
        drop + length + np.linspace(0, drop, nt + 1),
    ]
    nodes = np.unique(np.concatenate(parts).round(12)) * (1.0 - 1e-6)
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e5, EI=1e-5, rhoA=0.05, diameter=D, axial_damping=20.0)
    path = np.concatenate([left, over, right])
    rope = model.add_beam("rope", path=path, nodes=nodes, length=nodes[-1], section=section)
    for label, end, m in (("A", rope.start, masses[0]), ("B", rope.end, masses[1])):
        x = RC if label == "A" else -RC
        model.connect(model.add_point_mass(label, at=(x, 0, -drop), mass=m), end)
    hub = None
    if I is not None:
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=2.0, inertia=(0.6 * I, I, 0.6 * I))
        model.hinge(hub, (0, 0, 0), axis=(0, 1, 0))
    drum = model.add_surface("drum", shape or ancf.Cylinder(radius=R, axis=(0, 1, 0)), on=hub)
    contact = model.add_contact(rope, drum, stiffness=k, damping=damping, friction=mu)
    return model, rope, contact


class TestPulley:
    @pytest.mark.parametrize("I", [0.01, 0.2])
    def test_friction_drives_it(self, I):  # noqa: E741
        """Atwood's machine: a push F(t) on one mass moves both and turns the pulley."""
        model, rope, contact = hung(I)
        F, T = 4.0, 0.4
        model.add_force("A", (0, 0, f"-{F}*sin(pi*t/{T})**2"))
        start = ancf.equilibrium(model, of=["rope", "A", "B"])
        run = ancf.simulate(model, t_end=T, step=5e-4, output_step=0.1, start=start, sensors=[contact])
        wanted = 0.5 * F * T / (5.0 + I / RC**2 + 0.05 * rope.length)
        found = 0.5 * (run.velocity("B") - run.velocity("A"))[-1, 2]
        assert found == pytest.approx(wanted, rel=5e-3)
        turned = run.velocity("hub.at(1, 0, 0)")[-1, 2] * RC
        assert -turned == pytest.approx(wanted, rel=2e-2)
        supplied = np.ptp(run.energy.supplied)
        assert np.abs(run.energy.drift).max() < 1e-6 * supplied
        force = run.sensors.contact_force(contact)  # between what bears both masses and a uniform tension
        assert 2 * 2.5 * 9.81 < force.min() < force.max() < np.pi * 2.55 * 9.81
        assert run.sensors.friction_force(contact).min() > 0.0

    @pytest.mark.parametrize("heavier", [1.3, 3.0])
    def test_holds_below_the_limit_and_slips_above(self, heavier):
        """On a pulley that stands still; the limit is exp(0.3 pi) = 2.57."""
        model, _, _ = hung(None, mu=0.3, masses=(2.0, 2.0))
        push = 2.0 * 9.81 * (heavier - 1.0)
        model.add_force("A", (0, 0, f"-{push}*ramp(t, 0, 0.1)"))
        run = ancf.simulate(model, t_end=0.3, step=1e-3, output_step=0.05, start=ancf.equilibrium(model))
        moved = run.position("A")[:, 2] - run.position("A")[0, 2]
        if heavier < np.exp(0.3 * np.pi):
            assert np.abs(moved).max() < 2e-3
        else:
            assert moved[-1] < -0.01
            assert run.energy.dissipated[-1] > 0.0
        assert np.abs(run.energy.drift).max() < 1e-4 * 2.0 * 9.81

    def test_does_not_creep(self):
        """At two thirds of the limit, once the ropes have come to rest."""
        model, rope, _ = hung(None, mu=0.3, masses=(2.5, 1.5), damping=1000.0)
        run = ancf.simulate(
            model, t_end=12.0, step=2e-3, output_step=1.0, start=ancf.equilibrium(model), energy=False
        )
        z = run.position(rope.at(0.5 * rope.length))[:, [0, 2]]
        assert np.abs(z[4:] - z[4]).max() < 1e-6 * 2 * np.pi * R

    def test_a_sheave_keeps_its_rope(self):
        """A push to the side that throws the rope off a drum does not throw it out of the groove."""
        aside = []
        for shape in (
            ancf.Cylinder(radius=R, axis=(0, 1, 0), length=0.06),
            ancf.Sheave(R, 0.012, 0.03, axis=(0, 1, 0)),
        ):
            model, rope, _ = hung(None, mu=0.0, shape=shape)
            model.add_distributed_load(rope, (0, "8*ramp(t, 0, 0.1)", 0))
            for mass in ("A", "B"):
                model.hold(mass, position="y")
            run = ancf.simulate(model, t_end=0.5, step=1e-3, output_step=0.05)
            aside.append(np.abs(run.position(rope.at(0.5 * rope.length))[:, 1]).max())
        assert aside[0] > 0.02
        assert aside[1] < 0.012

    def test_memory_goes_with_a_file(self, tmp_path):
        """A run in two halves is the whole run; friction of the last state is known."""
        model, _, contact = hung(0.05, masses=(2.5, 2.3))
        whole = ancf.simulate(model, t_end=0.2, step=1e-3)
        ancf.simulate(model, t_end=0.1, step=1e-3, file=tmp_path / "half.h5")
        resumed = ancf.resume(tmp_path / "half.h5", t_end=0.2)
        assert np.array_equal(resumed.position("A")[-1], whole.position("A")[-1])
        line = ancf.load(tmp_path / "half.h5").state(-1).contact_line(contact.name)
        assert line.limit.max() > 0.0
        assert (line.normal >= 0.0).all()
        with pytest.raises(ancf.ModelError, match="friction is not known"):
            whole.friction_force(contact.name)


@pytest.mark.parametrize("speed", [5.0, 30.0, 400.0])
def test_a_rope_never_passes_through(speed):
    """One thrown at a thin post, up to so fast that it would be beyond it in a step."""
    section = ancf.Section(EA=1e4, EI=1e-2, rhoA=0.3, diameter=D)
    model = ancf.Model()
    rope = model.add_beam("rope", start=(-0.5, 0, 0.3), end=(0.5, 0, 0.3), elements=16, section=section)
    rope.set_motion(velocity=(0, 0, -speed))
    model.add_contact(
        rope, model.add_surface("post", ancf.Cylinder(radius=0.05, axis=(0, 1, 0))), stiffness=1e6
    )
    given = {"t_end": 0.5 / speed, "step": min(0.01, 0.35 / speed)}
    if speed < 100.0:
        run = ancf.simulate(model, **given)
        assert run.velocity(rope.at(0.5))[:, 2].max() > 0.1 * speed  # it bounces
    else:
        with pytest.raises(ancf.SolveError, match="through a surface") as caught:
            ancf.simulate(model, **given)
        run = caught.value.result
    assert run.position(rope.at(0.5))[:, 2].min() > 0.0


def test_explicit_steps_know_a_surface_before_anything_touches_it():
    """Bound of central differences: 2/omega of the mass of a length on the stiffness per length."""
    model = ancf.Model()
    section = ancf.Section(EA=1e2, EI=0.0, rhoA=0.3, diameter=D)
    rope = model.add_beam("rope", start=(-0.5, 0, 0.5), end=(0.5, 0, 0.5), elements=1, section=section)
    model.add_contact(rope, model.add_surface("ball", ancf.Sphere(radius=0.1)), stiffness=1e6)
    assert ancf.stable_step(model, safety=1.0) == pytest.approx(2.0 / np.sqrt(1e6 / 0.3), rel=0.05)
