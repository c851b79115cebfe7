"""Closed beams: rings and belts, whose end is joined to their start."""

import pickle

import numpy as np
import pytest

import ancf
from ancf.model.bodies.axes import carried

R = 0.5
#: Soft enough in bending that shear and stretch do not count.
SECTION = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0, nu=0.3)


def circle(u, phase=0.0):
    angle = 2 * np.pi * u + phase
    return R * np.cos(angle), R * np.sin(angle), 0.0


def ring(elements, element="cable", phase=0.0, **given):
    model = ancf.Model()
    beam = model.add_beam(
        "ring",
        path=lambda u: circle(u, phase),
        closed=True,
        elements=elements,
        section=SECTION,
        element=element,
        **given,
    )
    return model, beam


class TestRing:
    @pytest.mark.parametrize("element", ["cable", "nonlocking"])
    def test_frequencies(self, element):
        """In-plane bending without extension: Hoppe, J. reine angew. Math. 73 (1871) 158."""
        EI, rhoA = SECTION.EI, SECTION.rhoA
        wanted = [n * (n**2 - 1) / np.sqrt(n**2 + 1) * np.sqrt(EI / rhoA) / R**2 for n in (2, 3)]
        errors = []
        for elements in (16, 48):
            model, beam = ring(elements, element)
            for x in beam.node_x[:-1]:
                model.hold(beam.at(x), position="z", slope="z")
            found = 2 * np.pi * ancf.modes(model, count=7).frequencies_hz
            assert found[:3] == pytest.approx(0.0, abs=1e-3)  # it is free in its plane
            assert found[3::2] == pytest.approx(found[4::2], rel=1e-6)  # each twice: no place is special
            errors.append(np.abs(found[3::2] / wanted - 1.0).max())
        assert errors[1] < 8e-3
        assert errors[1] < 0.2 * errors[0]

    def test_hoop_tension_of_a_spinning_ring(self):
        """T = rhoA (omega R)^2: with the natural length for it the ring keeps its radius."""
        omega, EA, rhoA = 20.0, SECTION.EA, SECTION.rhoA
        stretch = 1.0 / (1.0 - rhoA * (omega * R) ** 2 / EA)  # T = EA (stretch - 1), rhoA per natural length
        model, beam = ring(16, length=2 * np.pi * R / stretch)
        beam.set_motion(angular_velocity=(0, 0, omega), about=(0, 0, 0))
        result = ancf.simulate(model, t_end=0.1, step=5e-4)
        radius = np.linalg.norm(result.position(beam.at(0.3)), axis=1)
        assert np.abs(radius / R - 1.0).max() < 2e-3
        assert abs(result.energy.drift).max() < 1e-6 * result.energy.kinetic[0]
        turned = result.angular_momentum((0, 0, 0))[:, 2]
        assert np.ptp(turned) < 1e-6 * turned[0]

    @pytest.mark.parametrize("element", ["cable", "nonlocking"])
    def test_the_seam_is_nowhere(self, element):
        """A ring that is pulled at one place moves alike wherever its ends were joined."""
        places = []
        for phase in (0.0, 0.75 * np.pi):
            model, beam = ring(16, element, phase)
            x = beam.length * (1.0 - phase / (2 * np.pi))
            model.add_force(beam.at(x), (0.02, 0.0, 0.01))
            result = ancf.simulate(model, t_end=0.2, step=1e-3)
            places.append([result.position(beam.at(x + s))[-1] for s in (0.0, 0.4, 1.9, 3.0)])
        assert np.abs(np.subtract(*places)).max() < 1e-9

    @pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
    def test_position_and_slopes_are_continuous(self, element):
        model, beam = ring(8, element)
        model.add_force(beam.at(0.1), (0.5, 0.0, 0.2))
        result = ancf.simulate(model, t_end=0.05, step=1e-3)
        before, after = beam.at(beam.length * (1 - 1e-7)), beam.at(beam.length * 1e-7)
        for ask in (result.position, result.slope):
            assert np.abs(ask(before)[-1] - ask(after)[-1]).max() < 1e-5
        assert np.array_equal(result.position(beam.end), result.position(beam.start))
        round_once = result.position(beam.at(beam.length + 0.2)) - result.position(beam.at(0.2))
        assert np.abs(round_once).max() < 1e-12

    def test_bent_from_a_straight_beam(self):
        """Its energy is that of the curvature 1/R: pi EI/R."""
        model, _ = ring(24, natural_shape="straight")
        energy = ancf.simulate(model, t_end=1e-3, step=1e-3).energy.strain[0]
        assert energy == pytest.approx(np.pi * SECTION.EI / R, rel=1e-4)

    def test_axes_of_a_loop_in_space_come_back(self):
        def knot(u):
            a = 2 * np.pi * u
            return (2 + np.cos(3 * a)) * np.cos(2 * a), (2 + np.cos(3 * a)) * np.sin(2 * a), np.sin(3 * a)

        model = ancf.Model()
        beam = model.add_beam(
            "knot", path=knot, closed=True, elements=60, section=SECTION, element="nonlocking"
        )
        turn = np.sum(beam.node_y[1:] * beam.node_y[:-1], axis=1)
        assert turn.min() > 0.5
        # what the axes turn about the tangent is three times the same, the seam included
        d = 1e-5
        inside = np.clip(beam.node_x, d, beam.length - d)
        t = np.array([beam.initial_position(x + d) - beam.initial_position(x - d) for x in inside])
        t /= np.linalg.norm(t, axis=1, keepdims=True)
        came = carried(beam.node_y[:-1], t[:-1], t[1:])
        twist = np.sum(np.cross(came, beam.node_y[1:]) * t[1:], axis=1)
        assert twist.reshape(3, 20) == pytest.approx(np.tile(twist[20:40], (3, 1)), abs=1e-3)
        assert np.array_equal(beam.node_y[0], beam.node_y[-1])


class TestKept:
    @pytest.mark.parametrize("element", ["cable", "nonlocking"])
    def test_described_saved_pickled_refined(self, element, tmp_path):
        model, beam = ring(8, element)
        model.add_force(beam.start, (0.1, 0, 0))
        again = ancf.Model.from_dict(model.to_dict())
        assert again.body("ring").closed
        result = ancf.simulate(model, t_end=0.01, step=1e-3, file=tmp_path / "r.h5")
        same = ancf.simulate(pickle.loads(pickle.dumps(again)), t_end=0.01, step=1e-3)
        loaded = ancf.load(tmp_path / "r.h5")
        for other in (same, loaded):
            assert np.array_equal(other.position("ring.at(0.7)"), result.position(beam.at(0.7)))
        from ancf.model.refine import refined

        fine = refined(model).body("ring")
        assert fine.elements == 16
        assert np.array_equal(fine.node_position[0], fine.node_position[-1])

    def test_points_of_a_file_may_repeat_the_first(self):
        angle = np.linspace(0, 2 * np.pi, 40)
        points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        rings = []
        for given in (points, points[:-1]):
            model = ancf.Model()
            rings.append(model.add_beam("r", path=given, closed=True, elements=8, section=SECTION))
        assert np.array_equal(rings[0].node_position, rings[1].node_position)
        assert rings[0].length == pytest.approx(2 * np.pi, rel=1e-6)


class TestReeving:
    @staticmethod
    def length(r1, r2, apart, turn):
        wheels = [((0, 0, 0), r1, "left"), ((apart, 0, 0), r2, turn)]
        return ancf.Reeving(wheels, axis=(0, -1, 0)).length

    @pytest.mark.parametrize(("r1", "r2", "apart"), [(0.1, 0.1, 0.5), (0.1, 0.3, 0.7), (0.4, 0.05, 0.5)])
    def test_lengths_of_open_and_crossed_belts(self, r1, r2, apart):
        """Textbook formulas of belts on two pulleys."""
        a = np.arcsin((r2 - r1) / apart)
        opened = 2 * apart * np.cos(a) + np.pi * (r1 + r2) + 2 * a * (r2 - r1)
        assert self.length(r1, r2, apart, "left") == pytest.approx(opened, rel=1e-13)
        b = np.arcsin((r2 + r1) / apart)
        crossed = 2 * apart * np.cos(b) + (np.pi + 2 * b) * (r1 + r2)
        assert self.length(r1, r2, apart, "right") == pytest.approx(crossed, rel=1e-13)

    @pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -1)])
    def test_tangents_and_distances(self, axis):
        wheels = [((0, 0, 0), 0.2, "left"), ((1, 0.3, 0), 0.1, "right"), ((0.5, -0.8, 0), 0.3, "left")]
        curve = ancf.Reeving(wheels, axis=axis).curve("here", True)
        s = np.linspace(0, curve.length, 4001)
        position, tangent = curve.at(s)
        way = np.cumsum(0.5 * (tangent[1:] + tangent[:-1]) * np.diff(s)[:, None], axis=0)
        assert np.abs(way - (position[1:] - position[0])).max() < 1e-5
        assert np.allclose(position[0], position[-1], atol=1e-12)
        assert np.allclose(tangent[0], tangent[-1])
        for at, radius, _ in wheels:  # touches every wheel and enters none
            assert np.linalg.norm(position - at, axis=1).min() == pytest.approx(radius, rel=1e-6)

    def test_open_with_ends(self):
        path = ancf.Reeving(
            [((0, 0, 0), 0.2, "right")], axis=(0, -1, 0), start=(-0.2, 0, -1), end=(0.2, 0, -2)
        )
        assert path.length == pytest.approx(3.0 + 0.2 * np.pi, rel=1e-13)
        model = ancf.Model()
        beam = model.add_beam("rope", path=path, elements=30, section=SECTION)
        assert np.allclose(beam.initial_position(1.0 + 0.1 * np.pi), (0, 0, 0.2), atol=1e-4)


WHEELS = [((0, 0, 0), 0.1), ((0.5, 0, 0), 0.1)]
BAD = {
    "a straight beam": ({"start": (0, 0, 0), "end": (1, 0, 0)}, "closed", "needs a path"),
    "a path that does not close": ({"path": lambda u: (u, u**2, 0.0)}, "path", "does not close"),
    "too few elements": ({"path": circle, "elements": 2}, "elements", "3 or more"),
    "no flag": ({"path": circle, "closed": "yes"}, "closed", "True or False"),
    "a reeving with ends": (
        {"path": ancf.Reeving(WHEELS, axis=(0, 1, 0), start=(-1, 0, 0), end=(2, 0, 0))},
        "path",
        "has ends",
    ),
}


class TestBad:
    @pytest.mark.parametrize("case", BAD)
    def test_one_message(self, case):
        given, place, what = BAD[case]
        with pytest.raises(ancf.ModelError, match=what) as caught:
            ancf.Model().add_beam("loop", **{"section": SECTION, "elements": 8, "closed": True} | given)
        assert caught.value.where.endswith(place)

    @pytest.mark.parametrize(
        ("given", "place", "what"),
        [
            ({"wheels": [((0, 0, 0), 0.3), ((0.4, 0, 0), 0.3, "right")]}, "0 and 1", "no line touches"),
            ({"wheels": [((0, 0, 0), 0.0), ((1, 0, 0), 0.3)]}, "wheels[0].radius", "> 0"),
            ({"wheels": [((0, 0, 0), 0.1), ((1, 0.1, 0), 0.3)]}, "0 and 1", "one plane"),
            ({"wheels": [((0, 0, 0), 0.1)]}, "wheels", "two wheels"),
            ({"wheels": WHEELS, "start": (0, 0, 0)}, "end", "missing"),
            ({"wheels": [((0, 0, 0), 0.1, "up"), ((1, 0, 0), 0.1)]}, "turn", "one of"),
        ],
    )
    def test_wheels(self, given, place, what):
        with pytest.raises(ancf.ModelError, match=what) as caught:
            ancf.Reeving(**{"axis": (0, 1, 0)} | given)
        assert place in caught.value.where

    def test_no_carrier_of_a_sliding_joint(self):
        model, beam = ring(8)
        bead = model.add_point_mass("bead", at=(R, 0, 0), mass=1.0)
        with pytest.raises(ancf.ModelError, match="closed"):
            model.slide(bead, along=beam)

    def test_no_winch(self):
        model, beam = ring(8, natural_shape="straight")
        with pytest.raises(ancf.ModelError, match="no end of the cable"):
            model.winch(beam.start, length="3 + 0*t")
