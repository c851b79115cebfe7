"""Joints on beams whose sections shear: one motion, however the model is turned, mirrored and numbered."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ancf
from random_worlds import Frame, unit

TURN = Rotation.from_rotvec([0.4, -1.1, 0.7]).as_matrix()
QUARTER = Rotation.from_rotvec([0.0, 0.5 * np.pi, 0.0]).as_matrix()
FRAMES = {
    "turned": Frame(R=TURN),
    "by a quarter": Frame(R=QUARTER),
    "mirrored": Frame(R=TURN @ np.diag([1.0, -1.0, 1.0])),
    "from the other end": Frame(flipped=True),
    "mirrored, from the other end": Frame(R=TURN @ np.diag([-1.0, 1.0, 1.0]), flipped=True),
}
KINDS = ["hinge", "cylindrical", "prismatic", "planar", "universal"]
EXACT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-13))
STEP, COUNT = 5e-4, 40


class Jointed:
    """A soft beam that is pushed, with a joint at one end, to the ground, a body or another beam."""

    def __init__(self, kind: str, to: str, element: str, seed: int, frame: Frame) -> None:
        self.rng, self.frame, self.element = np.random.default_rng(seed), frame, element
        self.model = ancf.Model(gravity=frame.vector((0.0, 2.0, -9.81)))
        corner = self.rng.standard_normal(3)
        beam, near, far = self._beam("beam", corner, 4.0)
        other: Any = tuple(near.initial_position)
        if to == "body":
            other = self._body(corner)
        elif to == "beam":
            _, other, end = self._beam("other", corner, 1.0)
            self.model.pin(end)
        axis = unit(self.rng.standard_normal(3))
        across = np.cross(axis, unit(self.rng.standard_normal(3)))
        if kind == "universal":
            axes = {"axis_a": frame.vector(axis), "axis_b": frame.vector(across)}
            self.joint = self.model.universal(near, other, **axes)
        else:
            self.joint = getattr(self.model, kind)(near, other, axis=frame.vector(axis))
        self.model.add_force(far, frame.vector(3.0 * self.rng.standard_normal(3)))
        self.model.add_force(beam.at(0.5 * beam.length), frame.vector(5.0 * self.rng.standard_normal(3)))
        self.points = [near, far]

    def _beam(self, name: str, corner: Any, size: float) -> tuple[Any, Any, Any]:
        f, rng = self.frame, self.rng
        end = corner + rng.uniform(0.4, 0.8) * unit(rng.standard_normal(3))
        section = ancf.Section.rectangle(0.06, 0.1, E=3e4 * size, rho=150.0, nu=0.3)
        ends = [f.place(x) for x in ((end, corner) if f.flipped else (corner, end))]
        given = {"elements": 2, "element": self.element, "section": section}
        side = f.vector(unit(rng.standard_normal(3)))
        beam = self.model.add_beam(name, start=ends[0], end=ends[1], y_axis=side, **given)
        return (beam, *((beam.end, beam.start) if f.flipped else (beam.start, beam.end)))

    def _body(self, corner: Any) -> Any:
        f, arm = self.frame, 0.2 * self.rng.standard_normal(3)
        turned = f.R @ np.linalg.qr(self.rng.standard_normal((3, 3)))[0]
        inertia = turned @ np.diag([0.03, 0.04, 0.05]) @ turned.T
        body = self.model.add_rigid_body("body", at=f.place(corner - arm), mass=0.8, inertia=inertia)
        return body.at(*f.vector(arm))

    def answers(self) -> Any:
        run = ancf.simulate(self.model, t_end=COUNT * STEP, step=STEP, integrator=EXACT)
        places = [run.position(point) @ self.frame.R for point in self.points]
        return np.array([*places, run.joint_force(self.joint) @ self.frame.R])


@pytest.mark.parametrize("to", ["ground", "body", "beam"])
@pytest.mark.parametrize("element", ["original", "nonlocking"])
@pytest.mark.parametrize("kind", KINDS)
def test_frames(kind, element, to):
    """Two directions across the axis of a prismatic joint were told by the global axes."""
    for seed in range(3):
        wanted = Jointed(kind, to, element, seed, Frame()).answers()
        size = np.max(np.abs(wanted), axis=(1, 2), keepdims=True)
        for name, frame in FRAMES.items():
            off = np.abs(Jointed(kind, to, element, seed, frame).answers() - wanted) / size
            assert np.max(off) < 1e-5, f"{seed}, {name}"
