"""What the rows of the joints are made of, on bodies whose axes are turned: motions that they must allow."""

import numpy as np
import pytest

import ancf
from ancf.system.system import System
from helpers import SOFT, forces, rotation


def turned_mechanism(stretch="free"):
    """Cable, rigid bodies whose axes are turned, and a bead: each joint meets in the initial shape only if
    body axes and space axes are told apart.
    """
    model, R, Q = ancf.Model(), rotation((1, -2, 0.5), 0.8), rotation((0, 1, 3), -1.1)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=2, section=ancf.Section(**SOFT))
    hub = model.add_rigid_body("hub", at=(2.2, 0.1, 0.3), mass=1.5, inertia=(0.3, 0.4, 0.5), axes=R)
    arm = model.add_rigid_body("arm", at=(2.7, 0, 0), mass=0.8, inertia=(0.1, 0.2, 0.2), axes=Q)
    meet = np.array([2.5, 0.2, -0.1])
    model.clamp(wire.end, to=hub, stretch=stretch, name="clamp")
    local = (axes.T @ (meet - at) for axes, at in ((R, (2.2, 0.1, 0.3)), (Q, (2.7, 0, 0))))
    model.hinge(*(b.at(*x) for b, x in zip((hub, arm), local, strict=True)), axis=(0, 1, 1), name="hinge")
    model.connect(arm.at(0.2, -0.1, 0.4), Q @ (0.2, -0.1, 0.4) + (2.7, 0, 0), name="ball")
    start, end = np.array([-0.1, 0.05, 0.2]), np.array([0.6, -0.3, 0.1])
    bead = model.add_point_mass("bead", at=(2.7, 0, 0) + Q @ (0.75 * start + 0.25 * end), mass=0.4)
    s = 0.25 * float(np.linalg.norm(end - start))
    model.slide(bead, along=arm, line=(start, end), s=s, name="on arm")
    return System(model), Q @ (end - start) / np.linalg.norm(end - start)


class TestBuiltJoints:
    """What the rows of the joints are made of, on bodies whose axes are turned."""

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_all_hold_in_the_initial_shape(self, stretch):
        system, _ = turned_mechanism(stretch)
        q, _ = system.initial_state()
        gaps = forces(system, q)[system.multipliers]
        assert np.max(np.abs(gaps)) < 1e-14
        counts = {name: len(rows) for name, rows in system.numbering.multipliers.items()}
        clamp = 5 if stretch == "free" else 6
        assert counts == {"hub": 6, "arm": 6, "clamp": clamp, "hinge": 5, "ball": 3, "on arm": 3}

    def test_hold_while_everything_turns_about_the_ball(self):
        """A rigid motion that leaves the one fixed point where it is violates nothing."""
        system, _ = turned_mechanism("fixed")
        q, _ = system.initial_state()
        centre = next(c for c in system.model.connections if c.name == "ball").b
        R = rotation((0.3, 1.0, -0.6), 0.9)
        for slots in system.slots.values():
            for k in range(slots.shape[1]):
                at = slots[:, k, None] + np.arange(3)
                q[at] = (q[at] - centre) @ R.T + centre if k == 0 else q[at] @ R.T
        assert np.max(np.abs(forces(system, q)[system.multipliers])) < 1e-14

    def test_hinge_leaves_its_axis_and_no_other(self):
        """The arm turns against the hub about (0, 1, 1) and violates nothing; not so about (0, 1, -1)."""
        system, _ = turned_mechanism()
        rows = system.numbering.multipliers["hinge"]
        meet = np.array([2.5, 0.2, -0.1])
        for axis, stays in (((0, 1, 1), True), ((0, 1, -1), False)):
            q, _ = system.initial_state()
            R = rotation(axis, 0.7)
            for k, slot in enumerate(system.slots["arm"][0, :4]):
                at = slice(slot, slot + 3)
                q[at] = R @ (q[at] - meet) + meet if k == 0 else R @ q[at]
            gap = np.max(np.abs(forces(system, q)[rows]))
            assert gap < 1e-14 if stays else gap > 0.1

    def test_line_of_a_rigid_body(self):
        """The bead is on the line at s; a change of s moves the place on the line along its direction."""
        system, along = turned_mechanism()
        q, _ = system.initial_state()
        lam, s = system.numbering.multipliers["on arm"], system.numbering.arcs["on arm"]
        q[s] += 0.1
        assert forces(system, q)[lam] == pytest.approx(-0.1 * along, abs=1e-14)
