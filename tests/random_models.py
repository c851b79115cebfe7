"""Random models, and all that acts on them from outside: supports, joints, springs, loads and weight."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss

import ancf
from ancf.model.bodies.beam import Beam
from ancf.model.joints.basic import Slide, Spherical

#: Gauss points that integrate a cubic times a cubic.
PLACES, WEIGHTS = leggauss(4)


class RandomModel:
    """A model of a seed; ``loose`` leaves out springs that an equilibrium needs, ``corners`` those of bodies.

    Attributes
    ----------
    outside : list of callables
        Each gives force and moment about the origin, (n, 3), on the model, of an answer and its times.
    refused : list of str
        What a model like this cannot have.
    """

    def __init__(self, seed: int, loose: bool = True, corners: bool = True) -> None:
        self.rng = rng = np.random.default_rng(seed)
        self.g = rng.standard_normal(3) * 5.0
        self.model = ancf.Model(gravity=tuple(self.g))
        self.points: list[Any] = []
        self.beams: list[Beam] = []
        self.bodies: list[Any] = []
        self.outside: list[Callable[..., Any]] = []
        self.refused: list[str] = []
        self.held: set[Any] = set()
        for k in range(int(rng.integers(1, 4))):
            self._beam(k)
        for k in range(int(rng.integers(1, 3))):
            self._body(k)
        for kind, most in (("_support", 4), ("_joint", 4), ("_spring", 4), ("_load", 4)):
            for _ in range(int(rng.integers(1, most))):
                self._try(getattr(self, kind))
        if not loose:
            more = [body.at(*arm) for body in self.bodies for arm in 0.3 * np.eye(3)]
            for point in (*self.points, *(more if corners else [])):
                self._tie(point)
        self.outside.append(self._weight)

    def _try(self, make: Callable[[], None]) -> None:
        try:
            make()
        except ancf.ModelError as error:
            self.refused.append(str(error))

    def _unit(self) -> Any:
        x = self.rng.standard_normal(3)
        return x / np.linalg.norm(x)

    def _any(self, items: list[Any]) -> Any:
        return items[int(self.rng.integers(len(items)))]

    def _beam(self, k: int) -> None:
        rng = self.rng
        element, start = str(rng.choice(["cable", "original", "nonlocking"])), rng.standard_normal(3)
        end = start + rng.uniform(0.5, 2.0) * self._unit()
        if element == "cable":
            section = ancf.Section(
                EA=rng.uniform(50, 500),
                EI=rng.uniform(0.1, 3),
                rhoA=rng.uniform(0.1, 2),
                bending_damping=0.01,
            )
        else:
            width, height = rng.uniform(0.05, 0.2, 2)
            section = ancf.Section.rectangle(
                width, height, E=rng.uniform(1e4, 1e5), rho=rng.uniform(20, 200), nu=rng.uniform(0, 0.4)
            )
        path = {"path": [start, 0.5 * (start + end) + 0.2 * self._unit(), end], "natural_shape": "path"}
        shape = path if rng.random() < 0.3 and element != "cable" else {"start": start, "end": end}
        given = {"section": section, "elements": int(rng.integers(1, 5)), "element": element}
        beam = self.model.add_beam(f"b{k}", **given, **shape)
        self.beams.append(beam)
        self.points += [beam.start, beam.end, beam.at(beam.length * rng.random())]

    def _body(self, k: int, at: Any = None) -> Any:
        rng, name = self.rng, f"m{k}"
        at = rng.standard_normal(3) if at is None else at
        if rng.random() < 0.3 and k < 10:
            self.points.append(self.model.add_point_mass(name, at=at, mass=rng.uniform(0.2, 3)).point)
            return None
        axes = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        inertia = axes @ np.diag(rng.uniform(0.3, 0.55, 3)) @ axes.T
        body = self.model.add_rigid_body(name, at=at, mass=rng.uniform(0.2, 3), inertia=inertia)
        self.bodies.append(body)
        self.points += [body.centre, body.at(*(0.3 * rng.standard_normal(3)))]
        return body

    def _support(self) -> None:
        rng, model = self.rng, self.model
        beam = self._any(self.beams)
        point = beam.start if rng.random() < 0.6 else beam.end
        way, turn, speed = 0.02 * rng.standard_normal(3), rng.uniform(0.1, 0.4), rng.uniform(5, 20)
        moved = {"displacement": lambda t: tuple(way * (1 - np.cos(speed * t)))}
        turned = {"rotation": lambda t: turn * (1 - np.cos(speed * t)), "axis": tuple(self._unit())}
        if point in self.held:
            return
        make = {
            "pin": lambda: model.pin(point),
            "moving pin": lambda: model.pin(point, **moved),
            "clamp": lambda: model.clamp(point),
            "fixed clamp": lambda: model.clamp(point, stretch="fixed"),
            "motor": lambda: model.clamp(point, **turned),
            "moving clamp": lambda: model.clamp(point, **moved),
            "hold": lambda: model.hold(point, position=str(rng.choice(["x", "yz", "xyz"])), slope="y"),
        }
        support = make[str(rng.choice(list(make)))]()
        self.held.add(point)

        def acts(known, t):
            force = known.reaction(support.name)
            return force, np.cross(known.position(point), force) + known.reaction_moment(support.name)

        self.outside.append(acts)

    def _joint(self) -> None:
        rng, model, a, axis = self.rng, self.model, self._any(self.points), tuple(self._unit())
        place = a.initial_position
        if rng.random() < 0.2:
            beam = self._any(self.beams)
            ring = tuple(beam.at(rng.uniform(0.2, 0.8) * beam.length).initial_position)
            joint = model.slide(ring, along=beam, friction=float(rng.choice([0.0, 0.2])))
            self.outside.append(self._of_joint(joint, ring))
            return
        if a in self.held:
            return
        b: Any = tuple(place)
        if rng.random() < 0.5:
            arm = 0.2 * rng.standard_normal(3)
            body = self._body(10 + len(model.bodies), at=place - arm)
            b = body.at(*arm)
        across = tuple(np.cross(axis, self._unit()))
        make = {
            "connect": lambda: model.connect(a, b),
            "hinge": lambda: model.hinge(a, b, axis=axis),
            "cylindrical": lambda: model.cylindrical(a, b, axis=axis),
            "prismatic": lambda: model.prismatic(a, b, axis=axis),
            "planar": lambda: model.planar(a, b, axis=axis),
            "universal": lambda: model.universal(a, b, axis_a=axis, axis_b=across),
        }
        joint = make[str(rng.choice(list(make)))]()
        if isinstance(b, tuple):
            self.held.add(a)
            self.outside.append(self._of_joint(joint, a))

    def _of_joint(self, joint: Any, a: Any) -> Callable[..., Any]:
        """Of a joint to the ground, which is its second end, and of a ring on its carrier."""

        def acts(known, t):
            force = known.joint_force(joint.name)
            if isinstance(joint, Slide):
                return force, np.cross(a, force)
            moment = np.cross(known.position(a), -force)
            return -force, moment if isinstance(joint, Spherical) else moment - known.joint_moment(joint.name)

        return acts

    def _tie(self, point: Any) -> None:
        """A spring in each direction, and one that keeps bodies from turning."""
        place = point.initial_position
        for axis in np.eye(3):
            self._string(point, place + 0.5 * axis, stiffness=20.0)

    def _string(self, a: Any, place: Any, **given: Any) -> None:
        spring = self.model.add_spring(a, tuple(place), **given)

        def acts(known, t):
            at = known.position(a)
            way = place - at
            force = known.spring_force(spring.name)[..., None] * way
            force /= np.linalg.norm(way, axis=-1, keepdims=True)
            return force, np.cross(at, force)

        self.outside.append(acts)

    def _spring(self) -> None:
        rng, a = self.rng, self._any(self.points)
        given = {"stiffness": rng.uniform(5, 50), "damping": rng.uniform(0, 2), "length": rng.uniform(0.1, 1)}
        if rng.random() < 0.5:
            self._string(a, a.initial_position + rng.uniform(0.2, 1) * self._unit(), **given)
        else:
            self.model.add_spring(a, self._any(self.points), **given)

    def _load(self) -> None:
        rng, model, point, size = self.rng, self.model, self._any(self.points), self.rng.standard_normal(3)
        speed = rng.uniform(1, 20)
        kind = str(rng.choice(["force", "moment", "distributed", "follower"]))

        def value(t):
            return np.cos(speed * np.asarray(t, float))[..., None] * size

        def law(t):
            return tuple(value(t))

        if kind == "force":
            model.add_force(point, law)
            self.outside.append(lambda known, t: (value(t), np.cross(known.position(point), value(t))))
        elif kind == "moment":
            model.add_moment(point, law)
            self.outside.append(lambda known, t: (0 * value(t), self._on_section(known, point, value(t))))
        elif kind == "distributed":
            beam = self._any(self.beams)
            low, high = np.sort(rng.uniform(0, beam.length, 2))
            model.add_distributed_load(beam, law, between=(low, high))
            self.outside.append(lambda known, t: along(known, beam, value(t), low, high))
        else:
            whole = size if getattr(point.body, "has_section", True) else np.array([size[0], 0, 0])
            model.add_follower_force(point, tuple(whole))
            self.outside.append(lambda known, t: self._following(known, point, whole))

    def _on_section(self, known: Any, point: Any, moment: Any) -> Any:
        """What a cable takes of a moment: the part along it does no work."""
        if getattr(point.body, "has_section", True):
            return moment
        tangent = known.slope(point)
        tangent = tangent / np.linalg.norm(tangent, axis=-1, keepdims=True)
        return moment - np.sum(moment * tangent, axis=-1, keepdims=True) * tangent

    def _following(self, known: Any, point: Any, size: Any) -> Any:
        if getattr(point.body, "has_section", True):
            force = known.section_rotation(point) @ size
        else:
            tangent = known.slope(point)
            force = size[0] * tangent / np.linalg.norm(tangent, axis=-1, keepdims=True)
        return force, np.cross(known.position(point), force)

    def _weight(self, known: Any, t: Any) -> Any:
        force, moment = np.zeros((2, *np.shape(t), 3))
        for body in self.model.bodies.values():
            if isinstance(body, Beam):
                part = along(known, body, body.section.rhoA * self.g, 0.0, body.length)
            else:
                weight = body.mass * self.g
                part = weight, np.cross(known.position(body), weight)
            force, moment = force + part[0], moment + part[1]
        return force, moment

    def acting(self, known: Any, t: Any) -> tuple[Any, Any, float]:
        """Force and moment about the origin of all that acts from outside, and the largest of its parts."""
        parts = [acts(known, t) for acts in self.outside]
        size = max(float(np.max(np.abs(x))) for part in parts for x in part)
        return sum(part[0] for part in parts), sum(part[1] for part in parts), size


def along(known: Any, beam: Beam, load: Any, low: float, high: float) -> tuple[Any, Any]:
    """Force and moment of a load per reference length."""
    cuts = np.array([low, *(x for x in beam.node_x if low < x < high), high])
    moment = 0.0
    for a, b in pairwise(cuts):
        for x, w in zip(PLACES, WEIGHTS, strict=True):
            place = known.position(beam.at(0.5 * (a + b) + 0.5 * (b - a) * x))
            moment = moment + 0.5 * (b - a) * w * np.cross(place, load)
    return (high - low) * load, moment
