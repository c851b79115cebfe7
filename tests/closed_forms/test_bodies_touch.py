"""Rigid bodies that touch: bounces, balls that slide and roll, momenta, capsules at rest and side by side."""

import itertools
import math

import numpy as np
import pytest
from scipy.optimize import brentq

import ancf

G = 9.81


def ball(model, name, at, radius=0.1, mass=1.0, velocity=(0, 0, 0), spin=(0, 0, 0)):
    body = model.add_rigid_body(name, at=at, mass=mass, inertia=(0.4 * mass * radius**2,) * 3)
    body.set_motion(velocity=velocity, angular_velocity=spin)
    return body, model.add_surface(f"skin of {name}", ancf.Sphere(radius=radius), on=body)


class TestBall:
    def test_bounces(self):
        """Without damping: up to where it fell from, and in contact for pi sqrt(m/k) and a bit."""
        model, height, k = ancf.Model(gravity=(0, 0, -G)), 0.05, 1e5
        body, skin = ball(model, "ball", (0, 0, 0.1 + height))
        contact = model.add_contact(skin, model.add_surface("floor", "plane"), stiffness=k)
        run = ancf.simulate(model, t_end=0.6, step=1e-4, sensors=[contact])
        z, force, fall = (
            run.position(body.centre)[:, 2],
            run.sensors.contact_force(contact),
            math.sqrt(2 * height / G),
        )
        assert z.max() == pytest.approx(0.1 + height, abs=1e-6)
        # m z'' = -m g - k z from z = 0 downwards: half a period, and twice the way to where weight is borne
        omega = math.sqrt(k)
        touch = (math.pi + 2 * math.atan(G / (omega * G * fall))) / omega
        bounces = 0.6 // (2 * fall + touch) + 1.0
        assert np.count_nonzero(force > 0) * 1e-4 / bounces == pytest.approx(touch, abs=2e-4)
        period = 2 * fall + touch
        again = np.abs(run.t - period) < 0.3 * period
        assert run.t[again][np.argmax(z[again])] == pytest.approx(period, abs=2e-4)
        assert force.max() == pytest.approx(G + math.sqrt(G**2 + k * (G * fall) ** 2), rel=1e-3)
        assert abs(run.energy.drift).max() < 5e-4 * G * height

    @pytest.mark.parametrize(
        ("friction", "speed", "spin"), [(0.1, 1.0, 0.0), (0.3, 2.0, 5.0), (0.2, 1.0, -30.0)]
    )
    def test_slides_until_it_rolls(self, friction, speed, spin):
        """v = (5 v0 + 2 R w0)/7, after (2/7)(v0 - R w0)/(mu g): by the moment about the place of contact."""
        model, R = ancf.Model(gravity=(0, 0, -G)), 0.1
        k = 1e5
        body, skin = ball(model, "ball", (0, 0, R - G / k), velocity=(speed, 0, 0), spin=(0, spin, 0))
        contact = model.add_contact(
            skin, model.add_surface("floor", "plane"), stiffness=k, damping=300.0, friction=friction
        )
        until = 2 / 7 * abs(speed - R * spin) / (friction * G)
        run = ancf.simulate(model, t_end=until + 0.1, step=5e-4, sensors=[contact])
        v, w = run.velocity(body.centre)[:, 0], run.angular_velocity(body)[:, 1]
        r, J = R - 0.5 * G / k, 0.4 * R**2  # in the middle of the depth
        assert v[-1] == pytest.approx(r * (r * speed + J * spin) / (r**2 + J), rel=5e-4)
        assert v[-1] == pytest.approx(r * w[-1], rel=1e-4)
        k = np.searchsorted(run.t, 0.5 * until)
        side = np.sign(speed - R * spin)
        assert v[k] == pytest.approx(speed - side * friction * G * run.t[k], rel=1e-3)
        assert run.sensors.slipping(contact)[k] == 1.0
        assert run.sensors.slipping(contact)[-1] == 0.0
        lost = 0.5 * speed**2 + 0.2 * (R * spin) ** 2 - 0.7 * v[-1] ** 2
        assert run.energy.dissipated[-1] == pytest.approx(lost, rel=2e-3)
        assert abs(run.energy.drift).max() < 1e-3 * lost

    @pytest.mark.parametrize("slope", [0.1, 0.3])
    def test_rolls_down(self, slope):
        """5/7 g sin without sliding, as long as tan < 7/2 mu; else g (sin - mu cos)."""
        for friction in (0.5, 0.2 * math.tan(slope)):
            model, k = ancf.Model(gravity=(G * math.sin(slope), 0, -G * math.cos(slope))), 1e5
            body, skin = ball(model, "ball", (0, 0, 0.1 - G * math.cos(slope) / k))
            floor = model.add_surface("floor", "plane")
            model.add_contact(skin, floor, stiffness=k, damping=300.0, friction=friction)
            run = ancf.simulate(model, t_end=0.3, step=5e-4)
            rolls = friction == 0.5
            a = 5 / 7 * math.sin(slope) if rolls else math.sin(slope) - friction * math.cos(slope)
            assert run.velocity(body.centre)[-1, 0] == pytest.approx(G * a * 0.3, rel=2e-3)


def restitution(x):
    """e for x = chi v of F = k g (1 + chi dg/dt), from chi (1 + e) v = ln((1 + chi v)/(1 - e chi v))."""
    return brentq(lambda e: x * (1 + e) - math.log((1 + x) / (1 - e * x)), 1e-9, min(1.0, (1 - 1e-12) / x))


class TestRestitution:
    """Where it is less deep than a fiftieth of the radius the law is that of Hunt and Crossley (1975).

    m v dv/dg = -k g (1 + chi v) has the same integral over g on both ways, whatever m and k are; for small
    chi v it is e = 1 - 2/3 chi v (their 1 - alpha v with chi = 3/2 alpha).
    """

    @pytest.mark.parametrize(("x", "speed", "mass"), [(0.02, 0.5, 1.0), (0.3, 0.2, 0.5), (2.0, 0.4, 1.0)])
    def test_on_a_plane(self, x, speed, mass):
        k, R = 1e6, 0.1
        model = ancf.Model()
        body, skin = ball(model, "ball", (0, 0, R + 1e-4), R, mass, velocity=(0, 0, -speed))
        floor = model.add_surface("floor", "plane")
        contact = model.add_contact(skin, floor, stiffness=k, damping=x / speed * k * 0.02 * R)
        half = math.pi * math.sqrt(mass / k)
        run = ancf.simulate(model, t_end=3 * half + 1e-4 / speed, step=half / 300, sensors=[contact])
        assert -run.sensors.contact_gap(contact).min() < 0.02 * R
        e = run.velocity(body.centre)[-1, 2] / speed
        assert run.sensors.contact_force(contact)[-1] == 0.0
        assert e == pytest.approx(restitution(x), abs=5e-4)
        if x < 0.1:
            assert e == pytest.approx(1 - 2 / 3 * x, abs=x**2)


def test_two_balls_keep_momenta():
    """Off the middle, of two sizes, with friction; the angular one as the trapezoidal rule does, by h^2."""
    left, drift = [], []
    for step in (2e-4, 1e-4):
        model = ancf.Model()
        _, skin = ball(model, "one", (0, 0, 0), 0.1, 1.0, (1.0, 0, 0), (0, 20.0, 3.0))
        two, other = ball(model, "two", (0.19, 0.08, 0.03), 0.12, 2.5)
        contact = model.add_contact(skin, other, stiffness=1e4, damping=5.0, friction=0.3)
        run = ancf.simulate(model, t_end=0.1, step=step, sensors=[contact])
        p, L, force = run.momentum, run.angular_momentum(), run.sensors.contact_force(contact)
        assert force.max() > 10.0
        assert force[-1] == 0.0
        assert np.abs(p - p[0]).max() < 1e-12
        left.append(np.abs(L[-1] - L[0]).max() / np.abs(L[0]).max())
        drift.append(abs(run.energy.drift).max() / run.energy.kinetic[0])
        assert run.energy.dissipated[-1] > 0.01 * run.energy.kinetic[0]
        assert np.linalg.norm(run.velocity(two.centre)[-1]) > 0.1
    assert drift[1] < 1e-4
    assert drift[0] > 1.8 * drift[1]
    assert left[1] < 2e-6
    assert left[0] / left[1] == pytest.approx(4.0, rel=0.2)


def capsule(model, name, at, axis=(1, 0, 0), radius=0.05, length=0.4):
    body = model.add_rigid_body(name, at=at, mass=1.0, inertia=(0.01, 0.02, 0.02))
    return body, model.add_surface(
        f"skin of {name}", ancf.Capsule(radius=radius, length=length, axis=axis), on=body
    )


class TestCapsules:
    @pytest.mark.parametrize("other", ["plane", "capsule along", "capsule across"])
    def test_rests_on(self, other):
        """Its weight is borne; on a plane and along another one it does not tip over."""
        model = ancf.Model(gravity=(0, 0, -G))
        below = 0.0
        if other == "plane":
            ground = model.add_surface("ground", "plane")
        else:
            below, axis = 0.05, (1, 0, 0) if "along" in other else (0, 1, 0)
            ground = model.add_surface("ground", "capsule", radius=0.05, length=0.5, axis=axis, at=(0, 0, 0))
        body, skin = capsule(model, "log", (0, 0, 0.05 + below - 2e-4))
        model.hold(body, position="y")
        contact = model.add_contact(skin, ground, stiffness=1e4, damping=40.0, friction=0.5)
        run = ancf.simulate(model, t_end=0.5, step=1e-3, sensors=[contact])
        assert run.contact_force(contact)[-1] == pytest.approx(G, rel=1e-3)
        assert np.abs(run.velocity(body.centre)[-1]).max() < 1e-3
        ends = run.position(body.at(0.2, 0, 0))[-1] - run.position(body.at(-0.2, 0, 0))[-1]
        assert abs(ends[2]) < 1e-3

    @pytest.mark.parametrize("seed", range(3))
    def test_nearest_places(self, seed):
        """Gaps against all pairs of places on both axes, wherever the bodies are."""
        rng = np.random.default_rng(seed)
        model = ancf.Model()
        places, pairs, up = {}, [], np.array([0.0, 0.0, 1.0])
        for k, length in enumerate((0.0, 0.3, 0.5)):
            at, axis = rng.uniform(-1, 1, 3) + 2 * k * up, rng.standard_normal(3)
            axis /= np.linalg.norm(axis)
            body = model.add_rigid_body(f"b{k}", at=at, mass=1.0, inertia=(1, 1, 1))
            shape = ancf.Capsule(radius=0.1, length=length, axis=axis) if k else ancf.Sphere(radius=0.1)
            places[model.add_surface(f"s{k}", shape, on=body)] = (
                at + np.linspace(-0.5, 0.5, 801)[:, None] * length * axis
            )
        plane = model.add_surface("plane", "plane", at=(0, 0, -2), normal=(0.1, 0.2, 1.0))
        normal = np.array([0.1, 0.2, 1.0]) / math.sqrt(1.05)
        for one, two in itertools.combinations(places, 2):
            away = np.linalg.norm(places[one][:, None] - places[two], axis=-1).min()
            pairs.append((model.add_contact(one, two, stiffness=1.0), away - 0.2))
        for one, there in places.items():
            pairs.append(
                (model.add_contact(one, plane, stiffness=1.0), ((there + 2 * up) @ normal).min() - 0.1)
            )
        run = ancf.simulate(model, t_end=1e-3, step=1e-3)
        for contact, gap in pairs:
            assert run.contact_gap(contact)[0] == pytest.approx(gap, abs=1e-5)


def test_sphere_in_a_ring_and_on_a_drum():
    """Every surface of revolution: a ball that rolls to and fro in a torus as in a gutter."""
    model = ancf.Model(gravity=(0, 0, -G))
    body, skin = ball(model, "ball", (0.0, 0.05, 0.4 - 0.05), radius=0.03)
    drum = model.add_surface("drum", "cylinder", radius=0.3, axis=(1, 0, 0), at=(0, 0, 0))
    contact = model.add_contact(skin, drum, stiffness=1e4, damping=20.0)
    run = ancf.simulate(model, t_end=0.35, step=1e-3, sensors=[contact])
    r = run.position(body.centre)[:, 1:]
    assert run.sensors.contact_force(contact).max() > 5.0
    assert np.linalg.norm(r, axis=1).min() > 0.32
    assert r[-1, 0] > 0.07  # it slides off to its side


@pytest.mark.parametrize("speed", [10.0, 2000.0])
def test_does_not_go_through(speed):
    """A ball against a ball and against a thin drum: smaller steps, or a message."""
    for shape in (ancf.Sphere(radius=0.02), ancf.Cylinder(radius=0.01, axis=(0, 1, 0))):
        model = ancf.Model()
        body, skin = ball(model, "shot", (0, 0, 0.2), radius=0.02, velocity=(0, 0, -speed))
        model.add_contact(skin, model.add_surface("post", shape), stiffness=1e6)
        if speed > 1000.0:
            with pytest.raises(ancf.SolveError, match="goes through a surface"):
                ancf.simulate(model, t_end=0.01, step=1e-3)
        else:
            run = ancf.simulate(model, t_end=0.03, step=2e-4)
            assert run.position(body.centre)[:, 2].min() > 0.0
            assert run.velocity(body.centre)[-1, 2] > 0.9 * speed


class TestCapsuleOnOthers:
    """Capsules on drums, rings and sheaves, at rest and in motion."""

    STIFF = 1e4

    def lay(self, other, at, axis, **law):
        """A capsule of 1 kg at rest above a surface on the ground, held in nothing; its contact."""
        model = ancf.Model(gravity=(0, 0, -G))
        body, skin = capsule(model, "rod", at, axis, radius=0.03, length=0.4)
        ground = model.add_surface("ground", other)
        law = {"stiffness": self.STIFF, "damping": 40.0, "friction": 0.5} | law
        return model, body, model.add_contact(skin, ground, **law)

    @pytest.mark.parametrize("angle", [0.4, 1.0, math.pi / 2])
    def test_lies_across_a_drum(self, angle):
        """In one place, m g/k deep, whatever the angle is; friction holds it in balance."""
        across = (math.cos(angle), math.sin(angle), 0.0)
        drum = ancf.Cylinder(0.1, axis=(1, 0, 0))
        depth = G / self.STIFF
        model, body, contact = self.lay(drum, (0, 0, 0.13 - depth), across)
        run = ancf.simulate(model, t_end=0.3, step=1e-3)
        assert -run.contact_gap(contact)[-1] == pytest.approx(depth, rel=1e-6)
        assert run.contact_force(contact)[-1] == pytest.approx(G, rel=1e-6)
        assert np.abs(run.velocity(body.centre)).max() < 1e-6

    @pytest.mark.parametrize("other", ["ring", "sheave", "drum along", "can along"])
    def test_lies_on_two_places(self, other):
        """On both sides of a ring and on both rims, and flat with both ends: each place bears its part."""
        shape, height, springs = {
            "ring": (ancf.Torus(0.12, 0.02), 0.05, 2),
            "sheave": (ancf.Sheave(0.1, 0.02, 0.05, 0.8, axis=(1, 0, 0)), 0.18, 4),
            "drum along": (ancf.Cylinder(0.1, axis=(1, 0, 0)), 0.13, 2),
            "can along": (ancf.Cylinder(0.1, axis=(1, 0, 0), length=0.2), 0.13, 2),
        }[other]
        depth = G / (springs * self.STIFF)
        model, body, contact = self.lay(shape, (0, 0, height - depth), (1, 0, 0))
        run = ancf.simulate(model, t_end=0.2, step=1e-3)
        assert -run.contact_gap(contact)[-1] == pytest.approx(depth, rel=1e-6)
        assert run.contact_force(contact)[-1] == pytest.approx(G, rel=1e-6)
        assert np.abs(run.position(body.centre)[-1] - (0, 0, height - depth)).max() < 1e-9

    @pytest.mark.parametrize("radius", [0.1, 0.25])
    def test_rocks_across_a_drum(self, radius):
        """omega^2 = m g (R - a)/(J + m a^2), small and without sliding, where the axis is a above the drum.

        The place of contact goes by R phi along it for the angle phi: m g ((R + a) cos phi + R phi sin phi).
        """
        R, a, k = radius, 0.03, 1e6
        model, body, contact = self.lay(
            ancf.Cylinder(R, axis=(0, 1, 0)), (0, 0, R + a - G / k), (1, 0, 0), stiffness=k, friction=2.0
        )
        body.set_motion(velocity=(0.02 * a, 0, 0), angular_velocity=(0, 0.02, 0))
        model.hold(body, position="y")
        omega = math.sqrt(G * (R - a) / (0.02 + a**2))
        t_end = 3.5 * 2 * math.pi / omega
        run = ancf.simulate(model, t_end=t_end, step=t_end / 2000, sensors=[contact])
        spin = run.angular_velocity(body)[:, 1]
        zero = np.flatnonzero(np.diff(np.sign(spin)))
        crossings = run.t[zero] - spin[zero] * np.diff(run.t)[zero] / np.diff(spin)[zero]
        assert math.pi / np.diff(crossings).mean() == pytest.approx(omega, rel=1e-3)
        assert abs(run.energy.drift).max() < 1e-3 * run.energy.kinetic[0]

    @pytest.mark.parametrize("friction", [0.0, 0.2])
    def test_slides_down_along_a_drum(self, friction):
        """g (sin - mu cos) along a sloping drum, flat on it."""
        slope, k = 0.5, 1e5
        model = ancf.Model(gravity=(G * math.sin(slope), 0, -G * math.cos(slope)))
        depth = G * math.cos(slope) / (2 * k)
        body, skin = capsule(model, "rod", (0, 0, 0.13 - depth), radius=0.03)
        ground = model.add_surface("ground", ancf.Cylinder(0.1, axis=(1, 0, 0)))
        model.hold(body, position="y")
        contact = model.add_contact(skin, ground, stiffness=k, damping=300.0, friction=friction)
        run = ancf.simulate(model, t_end=0.3, step=5e-4, sensors=[contact])
        a = G * (math.sin(slope) - friction * math.cos(slope))
        assert run.velocity(body.centre)[-1, 0] == pytest.approx(0.3 * a, rel=3e-3)
        lost = friction * G * math.cos(slope) * (run.position(body.centre)[-1, 0])
        assert run.energy.dissipated[-1] == pytest.approx(lost, rel=1e-2, abs=1e-6)

    @pytest.mark.parametrize("other", ["cylinder", "torus", "sheave"])
    def test_collisions_keep_momenta(self, other):
        """Two free bodies, off the middle, with friction; what is lost is booked."""
        shape = {
            "cylinder": ancf.Cylinder(0.1, axis=(0.1, 1, 0.2), length=0.3),
            "torus": ancf.Torus(0.12, 0.02, axis=(0.1, 1, 0.2)),
            "sheave": ancf.Sheave(0.1, 0.02, 0.05, 0.8, axis=(0.1, 1, 0.2)),
        }[other]
        left, drift = [], []
        for step in (2e-4, 1e-4):
            model = ancf.Model()
            rod, skin = capsule(model, "rod", (0.02, 0.03, 0.25), (1, 0.4, 0.1), radius=0.03)
            rod.set_motion(velocity=(0.3, 0, -2.0), angular_velocity=(2.0, 5.0, 1.0))
            wheel = model.add_rigid_body("wheel", at=(0, 0, 0), mass=2.0, inertia=(0.01, 0.02, 0.01))
            around = model.add_surface("around", shape, on=wheel)
            contact = model.add_contact(skin, around, stiffness=1e4, damping=5.0, friction=0.3)
            run = ancf.simulate(model, t_end=0.12, step=step, sensors=[contact])
            p, L = run.momentum, run.angular_momentum()
            assert run.sensors.contact_force(contact).max() > 10.0
            assert np.abs(p - p[0]).max() < 1e-11
            left.append(np.abs(L[-1] - L[0]).max() / np.abs(L[0]).max())
            drift.append(abs(run.energy.drift).max() / run.energy.kinetic[0])
            assert run.energy.dissipated[-1] > 1e-3 * run.energy.kinetic[0]
        assert left[1] < 1e-5
        assert drift[1] < 1e-3
        assert drift[0] > 1.5 * drift[1]


@pytest.mark.parametrize("rod", [False, True])
def test_falls_through_a_ring(rod):
    """Past its axis, where the nearest place changes sides: nothing has gone through anything."""
    model = ancf.Model(gravity=(0, 0, -G))
    if rod:
        body, skin = capsule(model, "rod", (0.02, 0, 0.05), (0.1, 0, 1), radius=0.03, length=0.1)
    else:
        body, skin = ball(model, "ball", (0.02, 0, 0.05), radius=0.03)
    body.set_motion(velocity=(-0.4, 0, -0.5))
    ring = model.add_surface("ring", ancf.Torus(radius=0.1, tube=0.01))
    contact = model.add_contact(skin, ring, stiffness=1e4)
    run = ancf.simulate(model, t_end=0.15, step=1e-3, sensors=[contact])
    x, z = run.position(body.centre)[-1, [0, 2]]
    assert run.sensors.contact_force(contact).max() == 0.0
    assert (x, z) == pytest.approx((0.02 - 0.06, 0.05 - 0.075 - G * 0.15**2 / 2), abs=1e-6)


@pytest.mark.parametrize("speed", [10.0, 2000.0])
def test_a_rod_does_not_go_through_a_drum(speed):
    """Smaller steps, or a message."""
    model = ancf.Model()
    body, skin = capsule(model, "rod", (0, 0, 0.2), radius=0.02)
    body.set_motion(velocity=(0, 0, -speed))
    post = model.add_surface("post", ancf.Cylinder(radius=0.01, axis=(0, 1, 0)))
    model.add_contact(skin, post, stiffness=1e6)
    if speed > 1000.0:
        with pytest.raises(ancf.SolveError, match="goes through a surface"):
            ancf.simulate(model, t_end=0.01, step=1e-3)
    else:
        run = ancf.simulate(model, t_end=0.03, step=2e-4)
        assert run.position(body.centre)[:, 2].min() > 0.0
        assert run.velocity(body.centre)[-1, 2] > 0.9 * speed
