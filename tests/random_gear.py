"""Random worlds with machinery: joints, torsion springs, slides, guides, and wires that strips run along."""

from __future__ import annotations

from typing import Any

import numpy as np

import ancf
from ancf.model.bodies.beam import Beam
from random_worlds import Frame, World, unit

JOINTS = ("prismatic", "cylindrical", "planar", "universal", "hinge", "connect")
KINDS = ("strip", "strip", "joint", "joint", "ground_joint", "torsion", "guide", "slide", "slide", "rail")


class Gear(World):
    """A world of a seed in a frame, with one to three parts of machinery.

    Parameters
    ----------
    rough : bool
        With friction and damping of contacts; without, all motion is smooth but for where things meet.

    Attributes
    ----------
    made : list of str
        Kinds of the parts, and of joints.
    joints, twists, strips : dict
        Connections by a name that is the same in all frames.
    slides : dict
        With the beam along which each runs, or None.
    """

    def __init__(self, seed: int, frame: Frame | None = None, rough: bool = True) -> None:
        self.rough = rough
        self.made: list[str] = []
        self.joints: dict[str, Any] = {}
        self.twists: dict[str, Any] = {}
        self.strips: dict[str, Any] = {}
        self.slides: dict[str, tuple[Any, Any]] = {}
        super().__init__(seed, frame)
        rng, self.held = np.random.default_rng(seed + 77_000), set()
        for k in range(int(rng.integers(1, 4))):
            kind, own = str(rng.choice(KINDS)), np.random.default_rng(rng.integers(2**31))
            getattr(self, f"_{kind}")(k, own)
            self.made.append(kind)
        self.points = [point for name in sorted(self._points) for point in self._points[name]]

    def _law(self, rng: Any, per: float) -> dict[str, Any]:
        return super()._law(rng, per) | ({} if self.rough else {"friction": 0.0, "damping": 0.0})

    def _bare(self, point: Any) -> Any:
        """Where a point is in no frame."""
        f = self.frame
        return f.R.T @ (np.asarray(point.initial_position) / f.size[0] - f.o)

    def _end(self, rng: Any, turns: bool = False) -> Any:
        """A point of a rigid body or an end of a beam that nothing holds yet; ``turns``: not of a cable."""
        found = []
        for name, points in sorted(self._points.items()):
            beam = isinstance(points[0].body, Beam)
            if not (beam and (len(points) == 1 or (turns and not points[0].body.has_section))):
                found += [(name, k) for k in range(len(points)) if not (beam and k == 1)]
        found = [place for place in found if place not in self.held]
        name, k = found[int(rng.integers(len(found)))]
        self.held.add((name, k))
        return self._points[name][k]

    def _heavy(self, name: str, rng: Any, at: Any, like: Any = None) -> Any:
        """A rigid body that moves like the body of a point."""
        f = self.frame
        turn = f.R @ np.linalg.qr(rng.standard_normal((3, 3)))[0]
        inertia = turn @ np.diag(rng.uniform(0.05, 0.09, 3)) @ turn.T
        body = self.model.add_rigid_body(
            self.name(name),
            at=f.place(at),
            mass=f.number(rng.uniform(0.5, 3), mass=1),
            inertia=f.number(inertia, 2, 0, 1),
            volume=f.number(rng.uniform(0, 4e-3), 3),
            drag_area=f.number(rng.uniform(0, 0.1), 2),
        )
        self._points[name] = [body.centre, body.at(*f.vector(0.2 * rng.standard_normal(3), 1))]
        if like is not None:
            body.set_motion(velocity=tuple(like.body.velocity))
        return body

    def _joined(self, name: str, a: Any, b: Any, rng: Any) -> None:
        f, axis, kind = self.frame, unit(rng.standard_normal(3)), str(rng.choice(JOINTS))
        across = np.cross(axis, unit(rng.standard_normal(3)))
        axes = {"axis": f.vector(axis)}
        if kind == "connect":
            axes = {}
        elif kind == "universal":
            axes = {"axis_a": f.vector(axis), "axis_b": f.vector(across)}
        self.joints[name] = getattr(self.model, kind)(a, b, name=self.name(name), **axes)
        self.made.append(kind)

    def _twisted(self, name: str, a: Any, b: Any, rng: Any) -> None:
        f = self.frame
        given = {
            "axis": f.axial(unit(rng.standard_normal(3))),
            "stiffness": f.number(rng.uniform(1, 20), 2, -2, 1),
            "damping": f.number(rng.uniform(0, 0.2), 2, -1, 1),
            "angle": rng.uniform(-1, 1),
        }
        self.twists[name] = self.model.add_torsion_spring(a, b, name=self.name(name), **given)

    def _joint(self, k: int, rng: Any) -> None:
        """With a new body, and sometimes a torsion spring beside it."""
        a, arm = self._end(rng, turns=True), 0.2 * rng.standard_normal(3)
        b = self._heavy(f"j{k}", rng, self._bare(a) - arm, a).at(*self.frame.vector(arm, 1))
        self._joined(f"J{k}", a, b, rng)
        if rng.random() < 0.5:
            self._twisted(f"T{k}", a, b, rng)

    def _ground_joint(self, k: int, rng: Any) -> None:
        a = self._end(rng, turns=True)
        self._joined(f"G{k}", a, tuple(a.initial_position), rng)

    def _torsion(self, k: int, rng: Any) -> None:
        a, b = self._end(rng), self._end(rng)
        on_ground = rng.random() < 0.5 or b.body is a.body
        self._twisted(f"T{k}", a, tuple(a.initial_position) if on_ground else b, rng)

    def _guide(self, k: int, rng: Any) -> None:
        way = self.frame.vector(unit(rng.standard_normal(3)))
        self.model.guide(self._end(rng), axis=way, name=self.name(f"GU{k}"))

    def _wire(self, k: int, rng: Any, start: Any, end: Any) -> Any:
        """A stretched beam that is shaken at its start."""
        f, m = self.frame, self.model
        N, L = f.number, np.linalg.norm(end - start)
        ends = [f.place(x) for x in ((end, start) if f.flipped else (start, end))]
        EA, EI, rhoA = rng.uniform(100, 500), rng.uniform(0.1, 1), rng.uniform(0.3, 2)
        section = ancf.Section(
            EA=N(EA, 1, -2, 1),
            EI=N(EI, 3, -2, 1),
            rhoA=N(rhoA, -1, 0, 1),
            diameter=N(0.03, 1),
            bending_damping=N(0.01, 3, -1, 1),
            drag=(1.0, 0.1),
            added_mass=(1.0, 0.1),
        )
        given = {"section": section, "elements": int(rng.integers(2, 5)), "length": N(0.97 * L, 1)}
        wire = m.add_beam(self.name(f"wire{k}"), start=ends[0], end=ends[1], **given)
        first, last = (wire.end, wire.start) if f.flipped else (wire.start, wire.end)
        way, w = 0.01 * rng.standard_normal(3), rng.uniform(5, 20)
        m.pin(first, displacement=f.law(lambda s: way * (1 - np.cos(w * s)), 1), name=self.name(f"wp{k}"))
        if rng.random() < 0.5:
            m.pin(last, name=self.name(f"we{k}"))
        else:
            m.guide(last, axis=f.vector(unit(end - start)), name=self.name(f"wg{k}"))
            spring = {"stiffness": N(50.0, 0, -2, 1), "length": N(0.3, 1), "name": self.name(f"ws{k}")}
            m.add_spring(last, tuple(f.place(end + 0.5 * unit(end - start))), **spring)
        self._points[f"wire{k}"] = [wire.at(wire.length * abs(0.37 - f.flipped))]
        return wire

    def _strip(self, k: int, rng: Any) -> None:
        """On a mass or a body that springs hold, along a wire of its own."""
        f, m, p = self.frame, self.model, 0.6 * np.abs(rng.standard_normal(3))
        t, N, x = unit(rng.standard_normal(3)), f.number, rng.uniform(0.3, 0.7)
        n, L = unit(np.cross(t, rng.standard_normal(3))), rng.uniform(0.8, 1.5)
        wire = self._wire(k, rng, p - x * L * t, p + (1 - x) * L * t)
        at = p - rng.uniform(-2e-3, 3e-3) * n
        if rng.random() < 0.4:
            arm = 0.1 * rng.standard_normal(3)
            head = self._heavy(f"head{k}", rng, at - arm)
            point = head.at(*f.vector(arm, 1))
        else:
            given = {"at": f.place(at), "mass": N(rng.uniform(0.2, 2), mass=1)}
            head = m.add_point_mass(self.name(f"head{k}"), **given)
            point, self._points[f"head{k}"] = head.point, [head.point]
        side = np.cross(n, t)
        velocity = rng.uniform(0.2, 1) * n + rng.uniform(-2, 2) * t + rng.uniform(-0.5, 0.5) * side
        head.set_motion(velocity=tuple(f.vector(velocity, 1, -1)))
        for j, axis in enumerate(np.eye(3)):
            soft = {"stiffness": N(rng.uniform(5, 50), 0, -2, 1), "name": self.name(f"hs{k}{j}")}
            m.add_spring(point, tuple(f.place(at + 0.5 * axis)), **soft)
        stiff, damped = rng.uniform(500, 5000), float(rng.choice([0, 0.01])) * self.rough
        law = {"stiffness": N(stiff, 0, -2, 1), "damping": N(damped * stiff, 0, -1, 1)}
        if rng.random() < 0.3:
            heights = 1e-3 * rng.standard_normal(5)[:: -1 if f.flipped else 1]
            law["profile"] = np.column_stack([np.linspace(0, wire.length, 5), N(heights, 1)])
        given = {"strip": f.axial(-side if f.flipped else side), "normal": f.vector(n), **law}
        self.strips[f"strip{k}"] = m.add_contact(point, along=wire, name=self.name(f"strip{k}"), **given)

    def _slide(self, k: int, rng: Any) -> None:
        """A ring in space, a mass or a body on a beam; it is moved, or rubs and is pushed."""
        f, m, N = self.frame, self.model, self.frame.number
        beam, start, end, _ = self.beams[str(rng.choice(sorted(self.beams)))]
        x, kind = rng.uniform(0.25, 0.75), str(rng.choice(["ring", "mass", "body"]))
        at, arm = start + x * (end - start), 0.1 * rng.standard_normal(3)
        if kind == "ring":
            point = tuple(f.place(at))
        elif kind == "mass":
            given = {"at": f.place(at), "mass": N(rng.uniform(0.2, 2), mass=1)}
            mass = m.add_point_mass(self.name(f"sm{k}"), **given)
            mass.set_motion(velocity=tuple(beam.velocity))
            point, self._points[f"sm{k}"] = mass.point, [mass.point]
        else:
            point = self._heavy(f"sb{k}", rng, at - arm, beam.start).at(*f.vector(arm, 1))
        s, way = beam.length * abs(x - f.flipped), -1 if f.flipped else 1
        how: dict[str, Any] = self._pull(rng, way)
        if rng.random() < 0.25:
            w = rng.uniform(3, 12)
            how = {"motion": lambda t: s + way * N(0.05 * (1 - np.cos(w * max(f.clock(t), 0.0))), 1)}
        self.slides[f"SL{k}"] = m.slide(point, along=beam, name=self.name(f"SL{k}"), **how), beam

    def _pull(self, rng: Any, way: int) -> dict[str, Any]:
        """What a slide has along its way."""
        f, N, how = self.frame, self.frame.number, {}
        if rng.random() < 0.5:
            how["mass"] = N(rng.uniform(0.1, 1), mass=1)
        if rng.random() < 0.5:
            how["viscous"] = N(rng.uniform(0.1, 2), 0, -1, 1)
        if rng.random() < 0.5 and self.rough:
            how |= {"friction": rng.uniform(0.1, 0.4), "friction_velocity": N(0.1, 1, -1)}
        size, w = rng.uniform(1, 5), rng.uniform(3, 20)
        if rng.random() < 0.5:
            how["force"] = lambda t: way * N(size * np.cos(w * f.clock(t)), 1, -2, 1)
        return how

    def _rail(self, k: int, rng: Any) -> None:
        """A point runs along a line that a body carries."""
        f, a = self.frame, self._end(rng)
        axis, arm = unit(rng.standard_normal(3)), 0.1 * rng.standard_normal(3)
        body = self._heavy(f"rail{k}", rng, self._bare(a) - arm, a)
        line = [tuple(f.vector(arm - 0.6 * axis, 1)), tuple(f.vector(arm + 0.6 * axis, 1))]
        how = {"viscous": f.number(rng.uniform(0.1, 2), 0, -1, 1)} if rng.random() < 0.5 else {}
        slide = self.model.slide(a, along=body, line=line, name=self.name(f"RA{k}"), **how)
        self.slides[f"RA{k}"] = slide, None

    def answers(self, run: ancf.Result) -> dict[str, Any]:
        """With forces of joints and strips, angles, and places on beams."""
        out, f = super().answers(run), self.frame
        length, force = f.number(1.0, 1), f.number(1.0, 1, -2, 1)
        for name, joint in (self.joints | {key: slide for key, (slide, _) in self.slides.items()}).items():
            out[f"force of {name}"] = run.joint_force(joint) / force @ f.R
        for name, strip in self.strips.items():
            out[f"force of {name}"] = run.contact_force(strip) / force
        for name, spring in self.twists.items():
            out[f"angle of {name}"] = run.torsion_angle(spring)
        for name, (slide, beam) in self.slides.items():
            s = run.arc_length(slide) / length
            out[f"place of {name}"] = beam.length / length - s if beam and f.flipped else s
        return out
