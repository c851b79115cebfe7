"""Contacts as the theory page has them, for tests: distances, normal forces, friction that remembers.

All laws take a run with every step of it, since friction depends on the way.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss

import ancf
from ancf.contact.profiles import distances

Force = tuple[Any, Any]


def unit(x: Any) -> Any:
    """Of length one."""
    return np.asarray(x) / np.linalg.norm(x)


def to_triangle(x: Any, corners: Any) -> float:
    """Distance of a place from a triangle."""
    n = unit(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
    edges = [(corners[k], corners[k - 2] - corners[k]) for k in range(3)]
    foot = x - ((x - corners[0]) @ n) * n
    if all(np.cross(edge, foot - at) @ n >= 0.0 for at, edge in edges):
        return abs(float((x - corners[0]) @ n))
    near = [at + np.clip((x - at) @ edge / (edge @ edge), 0.0, 1.0) * edge for at, edge in edges]
    return min(float(np.linalg.norm(x - place)) for place in near)


def to_mesh(shape: ancf.Mesh, x: Any) -> Any:
    """Signed distances of places (n, 3) from a convex mesh."""
    faces = (np.asarray(shape.points) + np.asarray(shape.at))[np.asarray(shape.triangles)]
    normals = [unit(np.cross(f[1] - f[0], f[2] - f[0])) for f in faces]
    above = np.array([(x - f[0]) @ n for f, n in zip(faces, normals, strict=True)]).max(axis=0)
    return np.array(
        [
            a if a < 0.0 else min(to_triangle(place, f) for f in faces)
            for a, place in zip(above, x, strict=True)
        ]
    )


def distance(shape: Any, x: Any) -> Any:
    """Signed distances of places (n, 3) in the axes of what carries a shape."""
    if isinstance(shape, ancf.Mesh):
        return to_mesh(shape, x)
    if isinstance(shape, ancf.Sheave):
        return distances(shape, x)
    y = x - np.asarray(shape.at)
    if isinstance(shape, ancf.Plane):
        return y @ unit(shape.normal)
    if isinstance(shape, ancf.Sphere):
        return np.linalg.norm(y, axis=1) - shape.radius
    z = y @ unit(shape.axis)
    rho = np.sqrt(np.maximum(np.sum(y * y, axis=1) - z * z, 0.0))
    if isinstance(shape, ancf.Capsule):
        return np.hypot(rho, np.maximum(np.abs(z) - 0.5 * shape.length, 0.0)) - shape.radius
    if isinstance(shape, ancf.Torus):
        return np.hypot(rho - shape.radius, z) - shape.tube
    side = rho - shape.radius
    if shape.length is None:
        return side
    end = np.abs(z) - 0.5 * shape.length
    return np.where((side > 0.0) & (end > 0.0), np.hypot(side, end), np.maximum(side, end))


def normals(shape: Any, x: Any, h: float = 1e-6) -> Any:
    """Gradients of the distance."""
    moves = h * np.eye(3)
    return np.stack([(distance(shape, x + d) - distance(shape, x - d)) / (2 * h) for d in moves], axis=1)


class Carried:
    """Motion of what carries a surface."""

    def __init__(self, run: ancf.Result, body: Any) -> None:
        n = len(run.t)
        self.at, self.v, self.spin = np.zeros((3, n, 3))
        self.axes = np.tile(np.eye(3), (n, 1, 1))
        if body is not None:
            self.at, self.v = run.position(body.centre), run.velocity(body.centre)
            self.axes, self.spin = run.section_rotation(body), run.angular_velocity(body)

    def local(self, x: Any) -> Any:
        """Directions in its axes."""
        return np.einsum("nji,nj->ni", self.axes, x)

    def turned(self, x: Any) -> Any:
        """Directions in its axes along global ones."""
        return np.einsum("nij,nj->ni", self.axes, x)

    def velocity(self, x: Any) -> Any:
        """At places."""
        return self.v + np.cross(self.spin, x - self.at)


def pressure(law: Any, depth: Any, rate: Any, radius: float) -> Any:
    """N per length, or of bodies."""
    soft = np.minimum(1.0, depth / (0.02 * radius))
    return np.where(depth > 0.0, np.maximum(0.0, law.stiffness * depth + law.damping * soft * rate), 0.0)


def across(n: Any, x: Any) -> Any:
    """The part of a vector along a surface."""
    return x - (x @ n) * n


def rubbed(law: Any, width: float, N: Any, n: Any, x: Any, v: Any, foreseen: bool) -> Any:
    """Friction of a point at each step, in the axes in which its anchor stays, (steps, 3).

    ``foreseen``: the limit of a step is continued from the last two, by a tenth at most; else it is that of
    the step before.
    """
    stick = law.stiffness if law.stick is None else law.stick
    drag, out, anchor, limit = (
        law.damping * np.sqrt(stick / law.stiffness),
        np.zeros_like(x),
        x[0],
        law.friction * N[0],
    )
    for i in range(len(x)):
        w = width * across(n[i], stick * (x[i] - anchor) + drag * v[i])
        size = np.linalg.norm(w)
        share = limit / size if size > limit else 1.0
        out[i] = -share * w
        if N[i] <= 0.0:
            anchor = x[i]
        elif size > limit:
            way = across(n[i], x[i] - anchor)
            pull = width * stick * np.linalg.norm(way)
            if pull > limit:
                anchor = x[i] - limit / pull * way
        limit = law.friction * N[i]
        if foreseen and i > 0 and N[i] > 0.0 and N[i - 1] > 0.0:
            limit = law.friction * np.clip(2.0 * N[i] - N[i - 1], 0.9 * N[i], 1.1 * N[i])
    return out


def points_of(beam: Any, count: int) -> Any:
    """Gauss points of all elements, and their weights."""
    for a, b in pairwise(beam.node_x):
        for xi, w in zip(*leggauss(count), strict=True):
            yield beam.at(0.5 * (a + b) + 0.5 * (b - a) * xi), 0.5 * (b - a) * w


def on_beam(run: ancf.Result, contact: Any) -> tuple[Any, Any, Any, Any]:
    """Force and moment about the origin on a beam, and its normal force and friction added up by size."""
    shape, carrier = contact.surface.shape, Carried(run, contact.surface.on)
    radius = 0.5 * contact.body.section.diameter
    force, moment, (normal, friction) = *np.zeros((2, len(run.t), 3)), np.zeros((2, len(run.t)))
    for point, w in points_of(contact.body, 5):
        r = run.position(point)
        x, u = carrier.local(r - carrier.at), run.velocity(point) - carrier.velocity(r)
        n = normals(shape, x)
        N = pressure(contact, radius - distance(shape, x), -np.sum(carrier.local(u) * n, axis=1), radius)
        T = rubbed(contact, 1.0, N, n, x, carrier.local(u), True)
        f = w * carrier.turned(N[:, None] * n + T)
        force, moment = force + f, moment + np.cross(r, f)
        normal, friction = normal + w * N, friction + w * np.linalg.norm(T, axis=1)
    return force, moment, normal, friction


def on_ground(run: ancf.Result, ground: Any, beam: Any) -> Force:
    """Force and moment about the origin on a beam."""
    d, n = beam.section.diameter, np.tile(ground.up, (len(run.t), 1))
    force, moment = np.zeros((2, len(run.t), 3))
    for point, w in points_of(beam, 10):
        r, v = run.position(point), run.velocity(point)
        depth = np.array([0.0, 0.0, ground.height]) @ ground.up - r @ ground.up
        on = np.clip(1.0 + 100.0 * depth / d, 0.0, 1.0)
        N = d * np.maximum(0.0, ground.stiffness * depth - ground.damping * on * (v @ ground.up)) * (on > 0.0)
        f = w * (N[:, None] * n + rubbed(ground, d, N, n, r, v, False))
        force, moment = force + f, moment + np.cross(r, f)
    return force, moment


def on_ball(run: ancf.Result, contact: Any) -> tuple[Any, Any, Any, Any]:
    """The same as of a beam, of a sphere on a body, with the other surface on what may be another one."""
    one, two = Carried(run, contact.surface.on), Carried(run, contact.other.on)
    ball, shape = contact.surface.shape, contact.other.shape
    middle = one.at + one.turned(np.tile(ball.at, (len(run.t), 1)))
    x = two.local(middle - two.at)
    depth, n = ball.radius - distance(shape, x), two.turned(normals(shape, x))
    place = middle - (ball.radius - 0.5 * depth)[:, None] * n
    u = one.velocity(place) - two.velocity(place)
    least = min(ball.radius, shape.radius) if isinstance(shape, ancf.Sphere | ancf.Capsule) else ball.radius
    N = pressure(contact, depth, -np.sum(u * n, axis=1), least)
    stick = contact.stiffness if contact.stick is None else contact.stick
    drag = contact.damping * np.sqrt(stick / contact.stiffness)
    T, limit, kept, met = np.zeros_like(n), 0.0, np.zeros(3), (np.zeros(3), np.zeros(3))
    for i in range(len(N)):
        A, B, held = one.axes[i], two.axes[i], np.zeros(3)
        if limit > 0.0:
            way = across(n[i], one.at[i] + A @ met[0] - two.at[i] - B @ met[1] + B @ kept)
            w = stick * way + across(n[i], drag * u[i])
            T[i] = -min(1.0, limit / np.linalg.norm(w)) * w
            pull = stick * np.linalg.norm(way)
            shorter = limit / pull if np.linalg.norm(w) > limit and pull > limit else 1.0
            held = shorter * way * (N[i] > 0.0)
        met, kept = (A.T @ (place[i] - one.at[i]), B.T @ (place[i] - two.at[i])), B.T @ held
        limit = contact.friction * N[i]
    force = N[:, None] * n + T
    return force, np.cross(place, force), N, np.linalg.norm(T, axis=1)
